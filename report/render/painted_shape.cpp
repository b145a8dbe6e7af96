#include "report/render/painted_shape.h"

#include <algorithm>
#include <cmath>
#include <vtkCellArray.h>
#include <vtkDataArray.h>
#include <vtkNew.h>
#include <vtkPointData.h>
#include <vtkPolyData.h>
#include <vtkPolyDataNormals.h>
#include <vtkTriangleFilter.h>

#include <Eigen/Geometry>

#include "core/geometry/surface_mesh.h"
#include "report/render/shaded_surface.h"

namespace meniscus::render {

namespace {

constexpr double kPatch = 12.0;  // triangles' sides at most, about [pixel]
constexpr std::size_t kMostTriangles = 400000;  // of a refined shape

unsigned char to_byte(double value) {
  return static_cast<unsigned char>(
      std::lround(255.0 * std::clamp(value, 0.0, 1.0)));
}

/// Each triangle in four, `rounds` times: light and colours then follow their
/// curves between the points that were given.
void refine(PaintedShape& shape, int rounds) {
  for (int round = 0; round < rounds; ++round) {
    std::vector<Edge> edges;
    std::vector<Triangle> sides;
    list_edges(shape.triangles, edges, sides);
    const int first = static_cast<int>(shape.points.size());
    for (const Edge& edge : edges) {
      const auto a = static_cast<std::size_t>(edge[0]);
      const auto b = static_cast<std::size_t>(edge[1]);
      shape.points.emplace_back(0.5 * (shape.points[a] + shape.points[b]));
      shape.normals.emplace_back(
          (shape.normals[a] + shape.normals[b]).normalized());
      Paint& paint = shape.paints.emplace_back();
      for (std::size_t c = 0; c < paint.size(); ++c) {
        paint[c] = 0.5 * (shape.paints[a][c] + shape.paints[b][c]);
      }
    }
    std::vector<Triangle> finer;
    finer.reserve(4 * shape.triangles.size());
    for (std::size_t t = 0; t < sides.size(); ++t) {
      const auto [a, b, c] = shape.triangles[t];
      const int ab = first + sides[t][0];
      const int bc = first + sides[t][1];
      const int ca = first + sides[t][2];
      finer.insert(finer.end(),
                   {{a, ab, ca}, {ab, b, bc}, {ca, bc, c}, {ab, bc, ca}});
    }
    shape.triangles = std::move(finer);
  }
}

int rounds_of(const PaintedShape& shape, const EyeView& view) {
  if (shape.style.flat || shape.triangles.empty()) {
    return 0;
  }
  double sum = 0.0;
  for (const Triangle& t : shape.triangles) {
    const Vec3& p = shape.points[static_cast<std::size_t>(t[0])];
    sum += (shape.points[static_cast<std::size_t>(t[1])] - p).norm() /
           view.pixel_at(p);
  }
  const double count = static_cast<double>(shape.triangles.size());
  const double wanted = std::ceil(std::log2(sum / count / kPatch));
  const double most =
      std::floor(0.5 * std::log2(static_cast<double>(kMostTriangles) / count));
  return static_cast<int>(std::clamp(std::min(wanted, most), 0.0, 6.0));
}

/// A normal for each facet, which then shares no point.
PaintedShape flattened(const PaintedShape& shape) {
  PaintedShape flat;
  flat.style = shape.style;
  flat.points.reserve(3 * shape.triangles.size());
  for (const Triangle& t : shape.triangles) {
    const auto at = [&](int k) -> const Vec3& {
      return shape
          .points[static_cast<std::size_t>(t[static_cast<std::size_t>(k)])];
    };
    const Vec3 normal = (at(1) - at(0)).cross(at(2) - at(0)).normalized();
    const int first = static_cast<int>(flat.points.size());
    for (int k = 0; k < 3; ++k) {
      flat.points.push_back(at(k));
      flat.normals.push_back(normal);
      flat.paints.push_back(shape.paints[static_cast<std::size_t>(
          t[static_cast<std::size_t>(k)])]);
    }
    flat.triangles.push_back({first, first + 1, first + 2});
  }
  return flat;
}

/// From shapes to the lists that are drawn.
class Painter {
 public:
  explicit Painter(const EyeView& view) : view_(view) {}

  void add(const PaintedShape& shape);
  void add_edges(const PaintedShape& shape);
  PaintedScene take();

 private:
  int lit(const PaintedShape& shape, std::size_t point, bool front);

  struct Sorted {
    double depth;
    Triangle triangle;
  };

  const EyeView& view_;
  Lights lights_;
  PaintedScene scene_;
  std::vector<Sorted> translucent_;
  std::vector<std::array<int, 2>> ids_;  // of the shape's points in the scene,
                                         // seen from behind, from the front
};

/// The point with the light on the side that is looked at.
int Painter::lit(const PaintedShape& shape, std::size_t point, bool front) {
  int& id = ids_[point][front ? 1 : 0];
  if (id < 0) {
    const Paint& paint = shape.paints[point];
    const Vec3 seen = view_.seen(shape.points[point]);
    const Vec3 normal = view_.turned(shape.normals[point]);
    Colour c = lights_.shade({paint[0], paint[1], paint[2]},
                             front ? normal : Vec3(-normal), -seen.normalized(),
                             shape.style.finish);
    // A highlight on a film is as bright as the light in it.
    const double dazzle = *std::max_element(c.begin(), c.end());
    double opacity = paint[3];
    if (opacity < 1.0 && dazzle > 1.0) {
      opacity = std::min(1.0, opacity * dazzle);
      std::transform(c.begin(), c.end(), c.begin(),
                     [&](double part) { return part / dazzle; });
    }
    id = static_cast<int>(scene_.points.size());
    scene_.points.push_back(shape.points[point]);
    scene_.colours.push_back(
        {to_byte(c[0]), to_byte(c[1]), to_byte(c[2]), to_byte(opacity)});
  }
  return id;
}

void Painter::add(const PaintedShape& shape) {
  ids_.assign(shape.points.size(), {-1, -1});
  for (const Triangle& t : shape.triangles) {
    std::array<std::size_t, 3> at{};
    std::copy(t.begin(), t.end(), at.begin());
    const Vec3& a = shape.points[at[0]];
    const Vec3 normal =
        (shape.points[at[1]] - a).cross(shape.points[at[2]] - a);
    const bool front = normal.dot(view_.eye - a) > 0.0;
    if (shape.style.only_front && !front) {
      continue;
    }
    const Triangle triangle = {lit(shape, at[0], front),
                               lit(shape, at[1], front),
                               lit(shape, at[2], front)};
    double depth = 0.0;
    bool opaque = true;
    for (const std::size_t id : at) {
      depth += view_.seen(shape.points[id]).z();
      opaque = opaque && shape.paints[id][3] >= 1.0;
    }
    if (opaque) {
      scene_.triangles.push_back(triangle);
    } else {
      translucent_.push_back({depth, triangle});
    }
  }
}

/// Ribbons that face the eye, a little before the facets.
void Painter::add_edges(const PaintedShape& shape) {
  constexpr double kBefore = 1.5;  // [pixel]
  std::vector<Edge> edges;
  std::vector<Triangle> sides;
  list_edges(shape.triangles, edges, sides);
  std::vector<char> seen(edges.size(), 0);
  for (std::size_t t = 0; t < sides.size(); ++t) {
    const Triangle& ids = shape.triangles[t];
    const Vec3& a = shape.points[static_cast<std::size_t>(ids[0])];
    const Vec3 normal =
        (shape.points[static_cast<std::size_t>(ids[1])] - a)
            .cross(shape.points[static_cast<std::size_t>(ids[2])] - a);
    for (const int side : sides[t]) {
      seen[static_cast<std::size_t>(side)] |=
          static_cast<char>(normal.dot(view_.eye - a) > 0.0);
    }
  }
  const Colour& c = shape.style.edge_colour;
  for (std::size_t e = 0; e < edges.size(); ++e) {
    if (seen[e] == 0) {
      continue;
    }
    const Vec3& a = shape.points[static_cast<std::size_t>(edges[e][0])];
    const Vec3& b = shape.points[static_cast<std::size_t>(edges[e][1])];
    const Vec3 to_eye = (view_.eye - 0.5 * (a + b)).normalized();
    const Vec3 across = to_eye.cross(b - a).normalized();
    const double pixel = view_.pixel_at(a);
    const Vec3 half = 0.5 * shape.style.edge_width * pixel * across;
    const Vec3 before = kBefore * pixel * to_eye;
    const int first = static_cast<int>(scene_.points.size());
    for (const Vec3& p :
         {Vec3(a - half), Vec3(b - half), Vec3(b + half), Vec3(a + half)}) {
      scene_.points.push_back(p + before);
      scene_.colours.push_back(
          {to_byte(c[0]), to_byte(c[1]), to_byte(c[2]), 255});
    }
    scene_.triangles.push_back({first, first + 1, first + 2});
    scene_.triangles.push_back({first, first + 2, first + 3});
  }
}

PaintedScene Painter::take() {
  std::stable_sort(
      translucent_.begin(), translucent_.end(),
      [](const Sorted& a, const Sorted& b) { return a.depth < b.depth; });
  for (const Sorted& sorted : translucent_) {
    scene_.triangles.push_back(sorted.triangle);
  }
  return std::move(scene_);
}

}  // namespace

PaintedShape painted(vtkPolyData* data, const SurfaceStyle& style,
                     const std::vector<Paint>& paints) {
  vtkNew<vtkTriangleFilter> triangles;
  triangles->SetInputData(data);
  triangles->PassVertsOff();
  triangles->PassLinesOff();
  vtkNew<vtkPolyDataNormals> normals;
  normals->SetFeatureAngle(kCreaseAngle);
  normals->ConsistencyOff();
  vtkPolyData* result = data;
  const bool plain = data->GetNumberOfStrips() == 0 &&
                     data->GetPolys()->GetNumberOfConnectivityIds() ==
                         3 * data->GetPolys()->GetNumberOfCells();
  if (!plain) {
    triangles->Update();
    result = triangles->GetOutput();
  }
  if (result->GetPointData()->GetNormals() == nullptr) {
    normals->SetInputData(result);
    normals->Update();
    result = normals->GetOutput();
  }
  PaintedShape shape;
  shape.style = style;
  vtkDataArray* directions = result->GetPointData()->GetNormals();
  for (vtkIdType i = 0; i < result->GetNumberOfPoints(); ++i) {
    shape.points.emplace_back(result->GetPoint(i));
    shape.normals.emplace_back(directions->GetTuple3(i));
  }
  const Colour& c = style.colour;
  shape.paints = paints;
  shape.paints.resize(shape.points.size(), {c[0], c[1], c[2], style.opacity});
  const vtkIdType* ids = nullptr;
  vtkIdType size = 0;
  vtkCellArray* cells = result->GetPolys();
  for (cells->InitTraversal(); cells->GetNextCell(size, ids) != 0;) {
    shape.triangles.push_back({static_cast<int>(ids[0]),
                               static_cast<int>(ids[1]),
                               static_cast<int>(ids[2])});
  }
  return shape;
}

PaintedScene paint(std::vector<PaintedShape> shapes, const EyeView& view) {
  Painter painter(view);
  for (PaintedShape& shape : shapes) {
    if (shape.style.edges) {
      painter.add_edges(shape);
    }
    if (shape.style.flat) {
      painter.add(flattened(shape));
    } else {
      refine(shape, rounds_of(shape, view));
      painter.add(shape);
    }
  }
  return painter.take();
}

}  // namespace meniscus::render
