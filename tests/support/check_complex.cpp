#include "tests/support/check_complex.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>
#include <tuple>
#include <variant>

#include <fmt/format.h>

#include "core/error.h"
#include "core/geometry/edge_key.h"
#include "evolve/films/edge_marks.h"

namespace meniscus::test_films {

namespace {

// Rim vertices are computed by point_at; only a different compilation of it
// may differ in the last bits.
constexpr double kOnCurve = 1e-12;  // x bounding-box diagonal
// Walls are projected to, by Newton's method in other coordinates.
constexpr double kOnWall = 1e-7;  // x bounding-box diagonal

// One of `count` things, or none (-1) where `none` says so.
enum class MayBeNone { No, Yes };
void check_index(int index, std::size_t count, MayBeNone none,
                 const std::string& what) {
  if (index >= static_cast<int>(count) ||
      index < (none == MayBeNone::Yes ? -1 : 0)) {
    throw MeshError(fmt::format("{} {}, of {}", what, index, count));
  }
}

bool along_curve(films::VertexKind kind) {
  return kind == films::VertexKind::OnCurve ||
         kind == films::VertexKind::Slides;
}

void check_sizes(const films::FilmComplex& complex) {
  const SurfaceMesh& mesh = complex.mesh;
  const auto equal = [](std::size_t a, std::size_t b, const char* what) {
    if (a != b) {
      throw MeshError(
          fmt::format("film complex: {}: {} and {} must be equal", what, a, b));
    }
  };
  equal(complex.vertices.size(), mesh.points.size(), "vertices and points");
  equal(mesh.facet_label.size(), mesh.facets.size(), "labels and facets");
  equal(complex.surfaces.size(), mesh.labels.size(), "surfaces and labels");
  for (std::size_t s = 0; s < complex.surfaces.size(); ++s) {
    if (complex.surfaces[s].name != mesh.labels[s]) {
      throw MeshError(
          fmt::format("film complex: surface {} is '{}' but label "
                      "{} is '{}'",
                      s, complex.surfaces[s].name, s, mesh.labels[s]));
    }
  }
}

void check_facets(const films::FilmComplex& complex) {
  const SurfaceMesh& mesh = complex.mesh;
  const int points = static_cast<int>(mesh.points.size());
  std::vector<char> used(mesh.points.size(), 0);
  for (std::size_t f = 0; f < mesh.facets.size(); ++f) {
    const Triangle& t = mesh.facets[f];
    const int label = mesh.facet_label[f];
    if (label < 0 || label >= static_cast<int>(complex.surfaces.size())) {
      throw MeshError(fmt::format("facet {} has label {}, of {} surfaces", f,
                                  label, complex.surfaces.size()));
    }
    for (const int v : t) {
      if (v < 0 || v >= points) {
        throw MeshError(
            fmt::format("facet {} names point {} of {}", f, v, points));
      }
      used[v] = 1;
      const films::VertexKind kind = complex.vertices[v].kind;
      const bool liquid = complex.surfaces[label].liquid;
      if (liquid ? kind == films::VertexKind::InCap
                 : kind == films::VertexKind::Free) {
        throw MeshError(fmt::format(
            "facet {} of '{}' has vertex {}, which is {}", f,
            complex.surfaces[label].name, v,
            liquid ? "inside a cap" : "free though it is on a cap"));
      }
    }
    if (t[0] == t[1] || t[1] == t[2] || t[2] == t[0]) {
      throw MeshError(fmt::format("facet {} repeats a point: {} {} {}", f, t[0],
                                  t[1], t[2]));
    }
  }
  for (const films::ComplexEdge& edge : complex.edges) {
    used[edge.a] = 1;
    used[edge.b] = 1;
  }
  for (int v = 0; v < points; ++v) {
    if (used[v] == 0) {
      throw MeshError(fmt::format("vertex {} belongs to no facet", v));
    }
  }
}

void check_same_facets(const SurfaceMesh& mesh) {
  std::vector<Triangle> sorted = mesh.facets;
  for (Triangle& t : sorted) {
    std::sort(t.begin(), t.end());
  }
  std::vector<int> order(sorted.size());
  std::iota(order.begin(), order.end(), 0);
  std::sort(order.begin(), order.end(), [&](int f, int g) {
    return std::tie(sorted[f], f) < std::tie(sorted[g], g);
  });
  for (std::size_t i = 1; i < order.size(); ++i) {
    const int f = order[i - 1];
    const int g = order[i];
    if (sorted[f] == sorted[g] && mesh.facet_label[f] == mesh.facet_label[g]) {
      throw MeshError(
          fmt::format("facets {} and {} of '{}' have the same points: {} {} {}",
                      f, g, mesh.labels[mesh.facet_label[f]], sorted[f][0],
                      sorted[f][1], sorted[f][2]));
    }
  }
}

void check_sets(const films::FilmComplex& complex) {
  for (const auto& set : complex.constraint_sets) {
    for (const int wall : set) {
      check_index(wall, complex.level_sets.size(), MayBeNone::No,
                  "a constraint set names level set");
    }
  }
  for (const auto& set : complex.integral_sets) {
    for (const int integral : set) {
      check_index(integral, complex.integrals.size(), MayBeNone::No,
                  "an integral set names line integral");
    }
  }
  for (const films::FilmQuantity& quantity : complex.quantities) {
    check_index(quantity.body, complex.bodies.size(), MayBeNone::Yes,
                fmt::format("quantity '{}' is of body", quantity.name));
    for (const int surface : quantity.surfaces) {
      check_index(surface, complex.surfaces.size(), MayBeNone::No,
                  fmt::format("quantity '{}' is of surface", quantity.name));
    }
  }
}

void check_marks(const films::FilmComplex& complex) {
  std::vector<Edge> ends;
  for (std::size_t m = 0; m < complex.edges.size(); ++m) {
    const films::ComplexEdge& edge = complex.edges[m];
    const std::string name = fmt::format("marked edge {}", m);
    for (const int v : {edge.a, edge.b}) {
      check_index(v, complex.mesh.points.size(), MayBeNone::No,
                  name + " ends at point");
    }
    // Seams of faces in planes of symmetry are inside caps.
    if (edge.a == edge.b ||
        (edge.kind == films::VertexKind::InCap && edge.constraints < 0)) {
      throw MeshError(
          fmt::format("{} from {} to {} {}", name, edge.a, edge.b,
                      edge.a == edge.b ? "has no length" : "is inside a cap"));
    }
    if (along_curve(edge.kind)) {
      check_index(edge.curve, complex.curves.size(), MayBeNone::No,
                  name + " is on curve");
    }
    check_index(edge.constraints, complex.constraint_sets.size(),
                MayBeNone::Yes, name + " is on constraint set");
    check_index(edge.integrals, complex.integral_sets.size(), MayBeNone::Yes,
                name + " has integral set");
    ends.push_back(edge_key(edge.a, edge.b));
  }
  std::sort(ends.begin(), ends.end());
  const auto twice = std::adjacent_find(ends.begin(), ends.end());
  if (twice != ends.end()) {
    throw MeshError(
        fmt::format("edge {}-{} is marked twice", (*twice)[0], (*twice)[1]));
  }
}

void check_on_curve(const films::FilmComplex& complex, std::size_t v,
                    double bound) {
  const films::ComplexVertex& vertex = complex.vertices[v];
  const bool known = vertex.curve >= 0 &&
                     vertex.curve < static_cast<int>(complex.curves.size());
  const bool closed = known && !std::holds_alternative<curves::ParametricCurve>(
                                   complex.curves[vertex.curve].shape);
  if (!known || !std::isfinite(vertex.t) ||
      (closed && !(vertex.t >= 0.0 && vertex.t < 1.0))) {
    throw MeshError(fmt::format("vertex {} is on curve {} of {} at t = {}", v,
                                vertex.curve, complex.curves.size(), vertex.t));
  }
  const curves::Curve& curve = complex.curves[vertex.curve];
  const double off =
      (curves::point_at(curve.shape, vertex.t) - complex.mesh.points[v]).norm();
  if (!(off <= kOnCurve * bound)) {
    throw MeshError(
        fmt::format("vertex {} is {:.3g} off its curve '{}' at t = {}", v, off,
                    curve.name, vertex.t));
  }
}

// Off its level sets by how far the next point of them is.
void check_on_walls(const films::FilmComplex& complex, std::size_t v,
                    double bound) {
  const films::ComplexVertex& vertex = complex.vertices[v];
  const Vec3& p = complex.mesh.points[v];
  const Vec3 foot =
      films::onto_walls(complex, vertex.constraints, vertex.held, p);
  if (!((foot - p).norm() <= kOnWall * bound)) {
    const int first = complex.constraint_sets[vertex.constraints].front();
    throw MeshError(fmt::format(
        "vertex {} at ({:.6g}, {:.6g}, {:.6g}) is {:.3g} off its level sets "
        "('{}' is one of {})",
        v, p.x(), p.y(), p.z(), (foot - p).norm(),
        complex.level_sets[first].name,
        complex.constraint_sets[vertex.constraints].size()));
  }
}

void check_vertices(const films::FilmComplex& complex) {
  const double size = bounding_diagonal(complex.mesh.points);
  for (std::size_t v = 0; v < complex.vertices.size(); ++v) {
    const films::ComplexVertex& vertex = complex.vertices[v];
    const Vec3& p = complex.mesh.points[v];
    if (!p.allFinite()) {
      throw MeshError(
          fmt::format("vertex {} is at ({}, {}, {})", v, p.x(), p.y(), p.z()));
    }
    if (along_curve(vertex.kind)) {
      check_on_curve(complex, v, size);
      continue;
    }
    check_index(vertex.constraints, complex.constraint_sets.size(),
                MayBeNone::Yes, fmt::format("vertex {} is on set", v));
    if (vertex.kind == films::VertexKind::Free && vertex.constraints >= 0) {
      check_on_walls(complex, v, size);
    }
  }
}

// Two facets of one surface run opposite ways along their edge; an edge with
// one facet is marked, or has both ends on a curve.
void check_edges(const films::FilmComplex& complex) {
  const SurfaceMesh& mesh = complex.mesh;
  std::vector<Edge> edges;
  std::vector<Triangle> facet_edges;
  list_edges(mesh.facets, edges, facet_edges);
  struct Count {
    int facets = 0;
    int balance = 0;
    int label = -1;
    bool mixed = false;
  };
  // Per edge the number of facets, the balance of their senses (0: one each
  // way), and whether several surfaces meet.
  const films::EdgeMarks marks(complex);
  std::vector<Count> counts(edges.size());
  for (std::size_t f = 0; f < mesh.facets.size(); ++f) {
    for (int k = 0; k < 3; ++k) {
      const int e = facet_edges[f][k];
      Count& count = counts[e];
      ++count.facets;
      count.balance += mesh.facets[f][k] == edges[e][0] ? 1 : -1;
      count.mixed = count.mixed ||
                    (count.label >= 0 && count.label != mesh.facet_label[f]);
      count.label = mesh.facet_label[f];
    }
  }
  for (std::size_t e = 0; e < edges.size(); ++e) {
    const auto [a, b] = edges[e];
    const Count& count = counts[e];
    const Vec3 p = 0.5 * (mesh.points[a] + mesh.points[b]);
    // One facet: a free end, allowed on curves and marks only. Two of one
    // surface: neighbours of a consistent orientation.
    const bool on_curve =
        complex.vertices[a].kind == films::VertexKind::OnCurve &&
        complex.vertices[b].kind == films::VertexKind::OnCurve;
    if (!on_curve && count.facets == 1 && marks.find(a, b) < 0) {
      throw MeshError(fmt::format(
          "edge {}-{} of '{}' at ({:.6g}, {:.6g}, {:.6g}) has one facet, but "
          "is neither on a curve nor marked",
          a, b, mesh.labels[count.label], p.x(), p.y(), p.z()));
    }
    if (!count.mixed && count.facets == 2 && count.balance != 0) {
      throw MeshError(
          fmt::format("edge {}-{} of '{}' at ({:.6g}, {:.6g}, "
                      "{:.6g}): its facets run the same way",
                      a, b, mesh.labels[count.label], p.x(), p.y(), p.z()));
    }
  }
}

// A body's facets use every edge as often one way as the other; they may end
// on walls, and on any marked edge where columns measure volumes.
void check_closed(const films::FilmComplex& complex,
                  const films::ComplexBody& body,
                  const films::EdgeMarks& marks) {
  std::vector<int> signs(complex.surfaces.size(), 0);
  for (const films::BodySide& side : body.sides) {
    signs[side.surface] += side.sign;
  }
  // The body's boundary as one set of facets that all run outward.
  SurfaceMesh shell;
  shell.points = complex.mesh.points;
  for (std::size_t f = 0; f < complex.mesh.facets.size(); ++f) {
    Triangle t = complex.mesh.facets[f];
    const int sign = signs[complex.mesh.facet_label[f]];
    if (sign != 0) {
      if (sign < 0) {
        std::swap(t[1], t[2]);
      }
      shell.facets.push_back(t);
    }
  }
  std::vector<Edge> edges;
  std::vector<Triangle> facet_edges;
  list_edges(shell.facets, edges, facet_edges);
  // Its boundary chain is zero where every edge is used as often each way.
  // Other edges must end where walls or columns make up for the open part.
  std::vector<std::array<int, 2>> runs(edges.size(), {0, 0});
  for (std::size_t f = 0; f < shell.facets.size(); ++f) {
    for (int k = 0; k < 3; ++k) {
      const int e = facet_edges[f][k];
      ++runs[e][shell.facets[f][k] == edges[e][0] ? 0 : 1];
    }
  }
  bool closed = true;
  for (std::size_t e = 0; e < edges.size(); ++e) {
    if (runs[e][0] == runs[e][1]) {
      continue;
    }
    closed = false;
    const int mark = marks.find(edges[e][0], edges[e][1]);
    const bool may_end =
        mark >= 0 && (complex.volume_rule == films::VolumeRule::Column ||
                      marks.all()[mark].constraints >= 0 ||
                      marks.all()[mark].integrals >= 0);
    if (!may_end) {
      throw MeshError(fmt::format(
          "body '{}': edge {}-{} is used {} times one way and {} times the "
          "other; a closed body uses it as often each way",
          body.name, edges[e][0], edges[e][1], runs[e][0], runs[e][1]));
    }
  }
  // Closed and outward means a volume above 0.
  const double volume = enclosed_volume(shell);
  if (closed && !(volume > 0.0)) {
    throw MeshError(fmt::format("body '{}' is inside out: its volume is {}",
                                body.name, volume));
  }
}

void check_bodies(const films::FilmComplex& complex) {
  const films::EdgeMarks marks(complex);
  for (const films::ComplexBody& body : complex.bodies) {
    for (const films::BodySide& side : body.sides) {
      if (side.surface < 0 ||
          side.surface >= static_cast<int>(complex.surfaces.size()) ||
          (side.sign != 1 && side.sign != -1)) {
        throw MeshError(fmt::format("body '{}' has side {} with sign {}",
                                    body.name, side.surface, side.sign));
      }
    }
    check_closed(complex, body, marks);
  }
}

}  // namespace

void check_complex(const films::FilmComplex& complex) {
  check_sizes(complex);
  check_sets(complex);
  check_marks(complex);
  check_facets(complex);
  check_same_facets(complex.mesh);
  check_vertices(complex);
  check_edges(complex);
  check_bodies(complex);
}

}  // namespace meniscus::test_films
