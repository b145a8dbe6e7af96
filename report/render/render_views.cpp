#include "report/render/render_views.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <set>
#include <string>
#include <utility>
#include <vector>
#include <vtkDataArray.h>
#include <vtkPointData.h>
#include <vtkPolyData.h>

#include <Eigen/Geometry>
#include <fmt/format.h>

#include "core/error.h"
#include "core/geometry/edge_key.h"
#include "core/math/union_find.h"
#include "report/render/shaded_surface.h"

namespace meniscus::render {

namespace {

constexpr double kShownDeflection = 0.06;  // x bounding-box diagonal, at most
constexpr double kArrowLength = 0.17;      // x diagonal, of the largest load
constexpr double kRobustPart = 0.998;      // of the nodes lie below the bar's
                                           // top: corners peak without limit
constexpr double kThickestRim = 0.01;      // x length of the shortest rim
constexpr Colour kLoadColour = {0.80, 0.18, 0.22};
constexpr Colour kGroundColour = {0.42, 0.45, 0.50};
constexpr Colour kInk = {0.13, 0.16, 0.20};

std::vector<char> every_label(const SurfaceMesh& mesh) {
  return std::vector<char>(mesh.labels.size(), 1);
}

std::vector<char> labels_among(const SurfaceMesh& mesh,
                               const std::vector<std::string>& names) {
  std::vector<char> use(mesh.labels.size(), 0);
  for (std::size_t l = 0; l < use.size(); ++l) {
    use[l] = static_cast<char>(
        std::find(names.begin(), names.end(), mesh.labels[l]) != names.end());
  }
  return use;
}

/// Length of the shortest chain of `rims`; infinite where there is none.
double shortest_rim(const Points& points, const std::vector<Edge>& rims) {
  UnionFind chains(points.size());
  for (const Edge& e : rims) {
    chains.join(e[0], e[1]);
  }
  std::vector<double> length(points.size(), 0.0);
  for (const Edge& e : rims) {
    length[chains.root(e[0])] += (points[e[1]] - points[e[0]]).norm();
  }
  double least = std::numeric_limits<double>::infinity();
  for (const double one : length) {
    least = one > 0.0 ? std::min(least, one) : least;
  }
  return least;
}

/// Middle and mean normal (unit) of one surface.
struct Patch {
  Vec3 centre = Vec3::Zero();
  Vec3 normal = Vec3::Zero();
  bool found = false;
};

Patch patch_of(const SurfaceMesh& mesh, const std::string& name) {
  Patch patch;
  const int label = mesh.label_of(name);
  double area = 0.0;
  for (std::size_t f = 0; f < mesh.facets.size(); ++f) {
    if (label < 0 || mesh.facet_label[f] != label) {
      continue;
    }
    const Vec3 n = area_vector2(mesh, static_cast<int>(f));
    for (const int id : mesh.facets[f]) {
      patch.centre += n.norm() / 3 * mesh.points[static_cast<std::size_t>(id)];
    }
    patch.normal += n;
    area += n.norm();
  }
  patch.found = area > 0.0;
  if (patch.found) {
    patch.centre /= area;
    patch.normal.normalize();
  }
  return patch;
}

/// A block on which the surface stands, a little wider than it.
SurfaceMesh ground_block(const SurfaceMesh& mesh, const std::string& name,
                         double diagonal) {
  constexpr double kWider = 1.14;
  const Patch patch = patch_of(mesh, name);
  const double gap = 0.001 * diagonal;
  const double thickness = 0.035 * diagonal;
  SurfaceMesh block;
  block.labels = {"bottom", "top", "wall"};
  SurfaceMesh only;
  only.labels = {"surface"};
  const int label = mesh.label_of(name);
  for (std::size_t f = 0; f < mesh.facets.size(); ++f) {
    if (mesh.facet_label[f] == label) {
      only.facets.push_back(mesh.facets[f]);
      only.facet_label.push_back(0);
    }
  }
  const int count = static_cast<int>(mesh.points.size());
  for (const double depth : {gap, thickness}) {
    for (const Vec3& p : mesh.points) {
      block.points.push_back(patch.centre + kWider * (p - patch.centre) +
                             depth * patch.normal);
    }
  }
  const auto add = [&](int a, int b, int c, int which) {
    block.facets.push_back({a, b, c});
    block.facet_label.push_back(which);
  };
  for (const Triangle& t : only.facets) {
    add(t[0] + count, t[1] + count, t[2] + count, 0);
    add(t[0], t[2], t[1], 1);
  }
  const std::vector<Edge> edges = rim_edges(only);
  const std::set<Edge> rim(edges.begin(), edges.end());
  for (const Triangle& t : only.facets) {
    for (std::size_t k = 0; k < 3; ++k) {
      const int a = t[k];
      const int b = t[(k + 1) % 3];
      const Edge key = edge_key(a, b);
      if (rim.count(key) != 0) {
        add(a, b, b + count, 2);
        add(a, b + count, a + count, 2);
      }
    }
  }
  return block;
}

void draw_supports(Panel& panel, const picture::PictureJob& job,
                   const SurfaceMesh& mesh, double diagonal) {
  for (const std::string& name : job.supports) {
    if (patch_of(mesh, name).found) {
      const SurfaceMesh block = ground_block(mesh, name, diagonal);
      SurfaceStyle style;
      style.colour = kGroundColour;
      const ShadedSurface shaded = shade(block, every_label(block));
      panel.add_surface(shaded.data, style);
      Points seen;
      for (const int id : shaded.source) {
        seen.push_back(block.points[static_cast<std::size_t>(id)]);
      }
      panel.show(seen);
    }
  }
}

void draw_loads(Panel& panel, const picture::PictureJob& job,
                const SurfaceMesh& mesh, double diagonal, int text) {
  double largest = 0.0;
  for (const picture::PictureLoad& load : job.loads) {
    largest = std::max(largest, load.direction.norm());
  }
  for (const picture::PictureLoad& load : job.loads) {
    const Patch patch = patch_of(mesh, load.surface);
    if (!patch.found || load.direction.norm() == 0.0) {
      continue;
    }
    const Vec3 along = load.direction.normalized();
    // Small loads stay visible: an arrow is at least half the largest.
    const double length =
        kArrowLength * diagonal * (0.5 + 0.5 * load.direction.norm() / largest);
    const double gap = 0.008 * diagonal;
    // Pressing arrows end on the surface, others begin on it.
    const bool presses = along.dot(patch.normal) < -0.05;
    const Vec3 root = patch.centre + 2 * gap * patch.normal;
    const Vec3 tip = presses ? Vec3(patch.centre - gap * along)
                             : Vec3(root + length * along);
    const Vec3 tail = tip - length * along;
    panel.add_arrow(tail, tip, kLoadColour);
    if (!load.label.empty()) {
      const Vec3 away = presses ? Vec3(-along) : along;
      const Vec3 end = presses ? tail : tip;
      panel.add_label(end, away, load.label,
                      {.size = text, .colour = kLoadColour, .bold = true});
      // Room for it, wherever it finds its place.
      const Vec3 aside = Vec3::UnitZ().cross(job.view).normalized();
      const Vec3 at = end + 3 * gap * away;
      const Vec3 half(0, 0, 0.03 * diagonal);
      panel.show({at + half, at - half, at + 0.05 * diagonal * aside,
                  at - 0.05 * diagonal * aside});
    }
  }
}

/// Top of the colour bar and distance of its ticks.
std::pair<double, double> bar_range(std::vector<double> values) {
  const auto at = static_cast<std::ptrdiff_t>(
      kRobustPart * static_cast<double>(values.size() - 1));
  std::nth_element(values.begin(), values.begin() + at, values.end());
  const double robust = values[static_cast<std::size_t>(at)];
  if (!(robust > 0.0) || !std::isfinite(robust)) {
    return {1.0, 0.5};
  }
  const double step = round_down_nice(robust / 3.0);
  return {step * std::ceil(robust / step * (1 - 1e-9)), step};
}

/// A factor that makes values up to `top` short to print, and what they are
/// then in: 1.4e6 Pa is 1.4 [MPa].
std::pair<double, std::string> readable_unit(double top,
                                             const std::string& unit) {
  if (unit == "Pa") {
    constexpr std::array<std::pair<double, const char*>, 3> kPrefixes = {
        {{1e9, " [GPa]"}, {1e6, " [MPa]"}, {1e3, " [kPa]"}}};
    for (const auto& [size, name] : kPrefixes) {
      if (top >= size) {
        return {1.0 / size, name};
      }
    }
  }
  constexpr double kLongest = 1e5;
  if (top >= kLongest) {
    return {1e-3, fmt::format(" [1000 {}]", unit)};
  }
  return {1.0, unit.empty() ? "" : fmt::format(" [{}]", unit)};
}

}  // namespace

bool draw_film(Panel& panel, const picture::PictureJob& job,
               const picture::PictureSurface& film) {
  const SurfaceMesh& mesh = film.mesh;
  const double diagonal = bounding_diagonal(mesh.points);
  const Vec3 eye = job.view.normalized();
  const std::vector<char> solid = labels_among(mesh, job.solids);
  std::vector<char> liquid(solid.size());
  for (std::size_t l = 0; l < solid.size(); ++l) {
    liquid[l] = static_cast<char>(solid[l] == 0);
  }
  const ShadedSurface skin = shade(mesh, liquid);
  const bool any = skin.data->GetNumberOfPoints() > 0;
  if (any) {
    // Light passes a film best where it falls straight through: opacity and
    // tint follow the angle to the eye (Schlick's curve, exaggerated).
    constexpr Colour kGrazing = {0.06, 0.27, 0.62};
    auto* normals = skin.data->GetPointData()->GetNormals();
    std::vector<Paint> colours;
    for (vtkIdType i = 0; i < skin.data->GetNumberOfPoints(); ++i) {
      Vec3 n;
      normals->GetTuple(i, n.data());
      const double g = std::pow(1.0 - std::abs(n.dot(eye)), 2.0);
      auto& c = colours.emplace_back();
      for (std::size_t k = 0; k < 3; ++k) {
        c[k] = (1 - g) * kFilmColour[k] + g * kGrazing[k];
      }
      c[3] = 0.30 + 0.60 * g;
    }
    SurfaceStyle style;
    style.finish.specular = 0.7;
    style.edges = job.facet_edges;
    style.edge_colour = {0.10, 0.30, 0.55};
    style.edge_width = 0.7;
    panel.add_surface(skin.data, style, colours);
  }
  SurfaceStyle cap;
  cap.colour = kCapColour;
  cap.opacity = 0.95;
  const ShadedSurface caps = shade(mesh, solid);
  if (caps.data->GetNumberOfPoints() > 0) {
    panel.add_surface(caps.data, cap);
  }
  const std::vector<Edge> rims = rim_edges(mesh);
  const double thick = std::min(0.0045 * diagonal,
                                kThickestRim * shortest_rim(mesh.points, rims));
  panel.add_tubes(mesh.points, rims, thick, kRimColour);
  // The camera of a series must not depend on the film.
  panel.show(job.seen.empty() ? mesh.points : job.seen);
  return any;
}

void draw_cut_mesh(Panel& panel, const picture::PictureJob& job,
                   const picture::PictureTets& tets) {
  // The cut faces the eye and stays upright: what stands before it goes.
  const Vec3 flat(0.0, job.view.y(), 0.0);
  const Vec3 normal = flat.norm() > 0.1 * job.view.norm()
                          ? flat.normalized()
                          : job.view.normalized();
  const SurfaceMesh mesh = cut_open(tets, normal);
  SurfaceStyle style;
  style.flat = true;
  style.only_front = true;
  style.edges = true;
  style.finish = {.specular = 0.0, .ambient = 0.3};
  style.edge_width = 0.8;
  style.colour = kOutsideColour;
  style.edge_colour = {0.22, 0.33, 0.46};
  panel.add_surface(shade(mesh, {1, 0}).data, style);
  style.colour = kInsideColour;
  style.edge_colour = {0.50, 0.34, 0.12};
  panel.add_surface(shade(mesh, {0, 1}).data, style);
  panel.show(tets.nodes);
}

PartFigures draw_part(Panel& panel, const picture::PictureJob& job,
                      const picture::PictureSurface& part,
                      const ViewLayout& layout) {
  const SurfaceMesh& rest = part.mesh;
  if (part.displacement.empty() || part.von_mises.empty()) {
    throw InvalidInput(fmt::format(
        "the part of '{}' has no 'displacement' and 'von_mises'", job.output));
  }
  const double diagonal = bounding_diagonal(rest.points);
  double largest = 0.0;
  for (const Vec3& u : part.displacement) {
    largest = std::max(largest, u.norm());
  }
  const double factor =
      largest > 0.0 ? round_down_nice(kShownDeflection * diagonal / largest)
                    : 1.0;
  SurfaceMesh moved = rest;
  for (std::size_t i = 0; i < moved.points.size(); ++i) {
    moved.points[i] += factor * part.displacement[i];
  }
  const auto [top, step] = bar_range(part.von_mises);
  const ShadedSurface shaded = shade(moved, every_label(moved));
  std::vector<Paint> colours;
  for (const int id : shaded.source) {
    const Colour c =
        viridis(part.von_mises[static_cast<std::size_t>(id)] / top);
    colours.push_back({c[0], c[1], c[2], 1.0});
  }
  panel.add_surface(
      shaded.data,
      {.finish = {.specular = 0.15, .ambient = 0.4}, .only_front = true},
      colours);
  panel.add_tubes(moved.points, rim_edges(moved), 0.0016 * diagonal, kInk);
  panel.add_surface(
      shade(rest, every_label(rest)).data,
      {.colour = {0.45, 0.5, 0.58}, .opacity = 0.13, .only_front = true});
  panel.add_tubes(rest.points, rim_edges(rest), 0.0013 * diagonal,
                  {0.66, 0.69, 0.73});
  panel.show(rest.points);
  panel.show(moved.points);
  draw_supports(panel, job, rest, diagonal);
  draw_loads(panel, job, moved, diagonal, layout.text);
  const auto [scale, unit] = readable_unit(top, part.stress_unit);
  panel.add_colour_bar(layout.bar, "von Mises stress" + unit, top * scale,
                       step * scale, layout.text);
  return {factor, largest,
          *std::max_element(part.von_mises.begin(), part.von_mises.end())};
}

}  // namespace meniscus::render
