#include "pipeline/results/even_surface.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>
#include <vector>

#include <Eigen/Geometry>

#include "core/geometry/box_tree.h"
#include "core/heed_stop.h"
#include "evolve/films/film_complex.h"
#include "evolve/groom/surface_editor.h"

namespace meniscus::results {

namespace {

constexpr double kBend = 0.2;       // edges where faces bend, x their radius
constexpr double kGrowth = 0.35;    // of the edges with the distance from there
constexpr double kShortest = 0.05;  // x the edge asked for, however they bend
// Bends of a tessellation are below 0.35 rad from facet to facet.
constexpr double kSharp = 0.7;  // [rad] between facets of one face
constexpr double kTurn = 0.6;   // [rad] of a line
constexpr int kRounds = 3;
constexpr int kPasses = 3;
// A point is not moved where a facet beside it would turn by more.
constexpr double kKeptSide = 0.5;  // cosine

struct Bend {
  Vec3 place = Vec3::Zero();
  double size = 0.0;  // of edges there
};

/// Wanted edge lengths about the places where faces bend. Each node of the tree
/// knows the least size in it, so that of a hundred thousand bends only those
/// that may matter are asked.
class BendSizes {
 public:
  BendSizes(std::vector<Bend> bends, double edge)
      : edge_(edge),
        bends_(std::move(bends)),
        tree_(items(bends_)),
        least_(tree_.nodes().size(), edge) {
    for (std::size_t k = least_.size(); k-- > 0;) {  // children before parents
      const BoxTree::Node& node = tree_.nodes()[k];
      if (!node.is_leaf()) {
        least_[k] = std::min(least_[k + 1], least_[node.second_child]);
        continue;
      }
      for (int i = node.first; i < node.last; ++i) {
        least_[k] = std::min(least_[k], bend_at(i).size);
      }
    }
  }

  /// The least of what all bends leave here.
  double at(const Vec3& place) const {
    double size = edge_;
    if (!least_.empty()) {
      ask(0, place, size);
    }
    return size;
  }

 private:
  static std::vector<BoxTree::Item> items(const std::vector<Bend>& bends) {
    std::vector<BoxTree::Item> items;
    items.reserve(bends.size());
    for (const Bend& bend : bends) {
      items.push_back({.id = static_cast<int>(items.size()),
                       .bounds = {bend.place, bend.place},
                       .center = bend.place});
    }
    return items;
  }

  const Bend& bend_at(int item) const {
    return bends_[static_cast<std::size_t>(tree_.items()[item].id)];
  }

  /// What the bends of a node leave at `place` is no less.
  double bound(int id, const Vec3& place) const {
    return least_[id] + kGrowth * tree_.nodes()[id].bounds.to(place);
  }

  void ask(int id, const Vec3& place, double& size) const {
    if (bound(id, place) >= size) {
      return;
    }
    const BoxTree::Node& node = tree_.nodes()[id];
    if (node.is_leaf()) {
      for (int i = node.first; i < node.last; ++i) {
        const Bend& bend = bend_at(i);
        size =
            std::min(size, bend.size + kGrowth * (place - bend.place).norm());
      }
      return;
    }
    const bool turned = bound(node.second_child, place) < bound(id + 1, place);
    ask(turned ? node.second_child : id + 1, place, size);
    ask(turned ? id + 1 : node.second_child, place, size);
  }

  double edge_;
  std::vector<Bend> bends_;
  BoxTree tree_;
  std::vector<double> least_;  // by node
};

/// An edge between two facets.
struct Hinge {
  int a = -1;
  int b = -1;
  int facets = 0;
  std::array<int, 2> facet = {-1, -1};
};

std::vector<Hinge> hinges_of(const SurfaceMesh& part) {
  std::vector<Edge> edges;
  std::vector<Triangle> facet_edges;
  list_edges(part.facets, edges, facet_edges);
  std::vector<Hinge> hinges(edges.size());
  for (std::size_t e = 0; e < edges.size(); ++e) {
    hinges[e].a = edges[e][0];
    hinges[e].b = edges[e][1];
  }
  for (std::size_t f = 0; f < facet_edges.size(); ++f) {
    for (const int e : facet_edges[f]) {
      Hinge& hinge = hinges[e];
      if (hinge.facets < 2) {
        hinge.facet[hinge.facets] = static_cast<int>(f);
      }
      ++hinge.facets;
    }
  }
  return hinges;
}

double angle_between(const SurfaceMesh& part, const Hinge& hinge) {
  const Vec3 m = area_vector2(part, hinge.facet[0]);
  const Vec3 n = area_vector2(part, hinge.facet[1]);
  return std::atan2(m.cross(n).norm(), m.dot(n));
}

bool is_inside_face(const SurfaceMesh& part, const Hinge& hinge) {
  return hinge.facets == 2 &&
         part.facet_label[hinge.facet[0]] == part.facet_label[hinge.facet[1]];
}

/// Twice the radius of two facets' cylinder is their height over its angle.
BendSizes bend_sizes(const SurfaceMesh& part, const std::vector<Hinge>& hinges,
                     double edge) {
  constexpr double kFlat = 1e-3;  // [rad]
  std::vector<Bend> bends;
  for (const Hinge& hinge : hinges) {
    const double angle =
        is_inside_face(part, hinge) ? angle_between(part, hinge) : 0.0;
    if (angle < kFlat || angle > kSharp) {
      continue;
    }
    const Vec3 a = part.points[hinge.a];
    const Vec3 along = part.points[hinge.b] - a;
    const double length = along.norm();
    const double height = (area_vector2(part, hinge.facet[0]).norm() +
                           area_vector2(part, hinge.facet[1]).norm()) /
                          length;
    const double size =
        std::max(kShortest * edge, kBend * 0.5 * height / angle);
    const int pieces = static_cast<int>(
        std::ceil(std::min(length / std::min(size, edge), 1000.0)));
    for (int k = 0; k <= pieces && size < edge; ++k) {
      bends.push_back({a + static_cast<double>(k) / pieces * along, size});
    }
  }
  return {std::move(bends), edge};
}

/// Lines between faces, and sharp edges inside one.
struct Creases {
  std::vector<films::ComplexEdge> sharp;  // inside a face
  std::vector<char> turns;                // per point: a line turns there
};

Creases creases_of(const SurfaceMesh& part, const std::vector<Hinge>& hinges) {
  Creases creases;
  creases.turns.assign(part.points.size(), 0);
  std::vector<std::vector<int>> lines(part.points.size());
  for (const Hinge& hinge : hinges) {
    const bool inside = is_inside_face(part, hinge);
    if (inside && angle_between(part, hinge) <= kSharp) {
      continue;
    }
    if (inside) {
      creases.sharp.push_back({.a = hinge.a, .b = hinge.b});
    }
    lines[hinge.a].push_back(hinge.b);
    lines[hinge.b].push_back(hinge.a);
  }
  for (std::size_t v = 0; v < lines.size(); ++v) {
    if (lines[v].size() == 2) {
      const Vec3 in = part.points[v] - part.points[lines[v][0]];
      const Vec3 out = part.points[lines[v][1]] - part.points[v];
      creases.turns[v] =
          std::atan2(in.cross(out).norm(), in.dot(out)) > kTurn ? 1 : 0;
    }
  }
  return creases;
}

/// Faces beside each point.
std::vector<std::vector<int>> labels_at(const SurfaceMesh& mesh) {
  std::vector<std::vector<int>> labels(mesh.points.size());
  for (std::size_t f = 0; f < mesh.facets.size(); ++f) {
    for (const int v : mesh.facets[f]) {
      std::vector<int>& there = labels[v];
      if (std::find(there.begin(), there.end(), mesh.facet_label[f]) ==
          there.end()) {
        there.push_back(mesh.facet_label[f]);
      }
    }
  }
  return labels;
}

/// Points onto their faces and lines, but for those that would turn a facet.
void put_on_shape(films::FilmComplex& complex, const PartShape& shape) {
  SurfaceMesh& mesh = complex.mesh;
  const SurfaceMesh old = mesh;
  const std::vector<std::vector<int>> labels = labels_at(mesh);
  for (std::size_t v = 0; v < mesh.points.size(); ++v) {
    if (complex.vertices[v].kind == films::VertexKind::Free &&
        !labels[v].empty() && labels[v].size() <= 2) {
      mesh.points[v] =
          shape.nearest(mesh.points[v], {labels[v].front(), labels[v].back()});
    }
  }
  bool turned = true;
  while (turned) {
    turned = false;
    for (int f = 0; f < static_cast<int>(mesh.facets.size()); ++f) {
      const Vec3 was = area_vector2(old, f);
      const Vec3 is = area_vector2(mesh, f);
      if (is.dot(was) > kKeptSide * is.norm() * was.norm()) {
        continue;
      }
      for (const int v : mesh.facets[f]) {
        turned = turned || mesh.points[v] != old.points[v];
        mesh.points[v] = old.points[v];
      }
    }
  }
}

}  // namespace

SurfaceMesh even_surface(const SurfaceMesh& part, double edge,
                         const PartShape& shape) {
  // 1. What must stay, and how long edges should be.
  const std::vector<Hinge> hinges = hinges_of(part);
  const BendSizes sizes = bend_sizes(part, hinges, edge);
  Creases creases = creases_of(part, hinges);
  // 2. The part as films that meet on lines.
  films::FilmComplex complex;
  complex.mesh = part;
  complex.edges = std::move(creases.sharp);
  for (const char corner : creases.turns) {
    complex.vertices.push_back({.kind = corner != 0 ? films::VertexKind::Fixed
                                                    : films::VertexKind::Free});
  }
  for (const std::string& label : part.labels) {
    complex.surfaces.push_back({.name = label, .tension = 1.0});
  }
  // 3. Facets made even and put back onto the faces, in turn.
  const groom::EdgeTarget target{
      .edge = edge, .field = [&](const Vec3& at) { return sizes.at(at); }};
  for (int round = 0; round < kRounds; ++round) {
    heed_stop("mesh");
    groom::SurfaceEditor editor(std::move(complex));
    groom::make_isotropic(editor, target, kPasses);
    complex = std::move(editor).finish();
    put_on_shape(complex, shape);
  }
  return std::move(complex.mesh);
}

}  // namespace meniscus::results
