#include <array>
#include <cmath>

#include <fmt/format.h>

#include "core/error.h"
#include "evolve/body_sides.h"
#include "evolve/grooming.h"

namespace meniscus {

namespace {

// Rim vertices are computed by point_at; only a different compilation of it
// may differ in the last bits.
constexpr double kOnCurve = 1e-12;  // x bounding-box diagonal

void check_sizes(const FilmComplex& complex) {
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

void check_facets(const FilmComplex& complex) {
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
      const VertexKind kind = complex.vertices[v].kind;
      const bool liquid = complex.surfaces[label].liquid;
      if (liquid ? kind == VertexKind::InCap : kind == VertexKind::Free) {
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
  for (int v = 0; v < points; ++v) {
    if (used[v] == 0) {
      throw MeshError(fmt::format("vertex {} belongs to no facet", v));
    }
  }
}

void check_vertices(const FilmComplex& complex) {
  const double bound = kOnCurve * bounding_diagonal(complex.mesh.points);
  for (std::size_t v = 0; v < complex.vertices.size(); ++v) {
    const ComplexVertex& vertex = complex.vertices[v];
    const Vec3& p = complex.mesh.points[v];
    if (!p.allFinite()) {
      throw MeshError(
          fmt::format("vertex {} is at ({}, {}, {})", v, p.x(), p.y(), p.z()));
    }
    if (vertex.kind != VertexKind::OnCurve) {
      continue;
    }
    if (vertex.curve < 0 ||
        vertex.curve >= static_cast<int>(complex.curves.size()) ||
        !(vertex.t >= 0.0 && vertex.t < 1.0)) {
      throw MeshError(fmt::format("vertex {} is on curve {} of {} at t = {}", v,
                                  vertex.curve, complex.curves.size(),
                                  vertex.t));
    }
    const Curve& curve = complex.curves[vertex.curve];
    const double off = (point_at(curve.shape, vertex.t) - p).norm();
    if (!(off <= bound)) {
      throw MeshError(
          fmt::format("vertex {} is {:.3g} off its curve '{}' at "
                      "t = {}",
                      v, off, curve.name, vertex.t));
    }
  }
}

// Two facets of one surface run opposite ways along their edge; an edge has
// another number of facets only where both its ends are on a curve.
void check_edges(const FilmComplex& complex) {
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
    const bool on_curve = complex.vertices[a].kind == VertexKind::OnCurve &&
                          complex.vertices[b].kind == VertexKind::OnCurve;
    if (!on_curve && (count.facets != 2 || count.mixed)) {
      throw MeshError(fmt::format(
          "edge {}-{} of '{}' at ({:.6g}, {:.6g}, "
          "{:.6g}) has {} facets away from the curves",
          a, b, mesh.labels[count.label], p.x(), p.y(), p.z(), count.facets));
    }
    if (!count.mixed && count.facets == 2 && count.balance != 0) {
      throw MeshError(
          fmt::format("edge {}-{} of '{}' at ({:.6g}, {:.6g}, "
                      "{:.6g}): its facets run the same way",
                      a, b, mesh.labels[count.label], p.x(), p.y(), p.z()));
    }
  }
}

void check_bodies(const FilmComplex& complex) {
  for (const ComplexBody& body : complex.bodies) {
    for (const BodySide& side : body.sides) {
      if (side.surface < 0 ||
          side.surface >= static_cast<int>(complex.surfaces.size()) ||
          (side.sign != 1 && side.sign != -1)) {
        throw MeshError(fmt::format("body '{}' has side {} with sign {}",
                                    body.name, side.surface, side.sign));
      }
    }
    const SurfaceMesh shell = body_surface(complex, body);
    std::vector<Edge> edges;
    std::vector<Triangle> facet_edges;
    list_edges(shell.facets, edges, facet_edges);
    std::vector<std::array<int, 2>> runs(edges.size(), {0, 0});
    for (std::size_t f = 0; f < shell.facets.size(); ++f) {
      for (int k = 0; k < 3; ++k) {
        const int e = facet_edges[f][k];
        ++runs[e][shell.facets[f][k] == edges[e][0] ? 0 : 1];
      }
    }
    for (std::size_t e = 0; e < edges.size(); ++e) {
      if (runs[e][0] != 1 || runs[e][1] != 1) {
        throw MeshError(fmt::format(
            "body '{}': edge {}-{} is used {} times one way and {} times the "
            "other; a closed body uses it once each way",
            body.name, edges[e][0], edges[e][1], runs[e][0], runs[e][1]));
      }
    }
    const double volume = enclosed_volume(shell);
    if (!(volume > 0.0)) {
      throw MeshError(fmt::format("body '{}' is inside out: its volume is {}",
                                  body.name, volume));
    }
  }
}

}  // namespace

void check_complex(const FilmComplex& complex) {
  check_sizes(complex);
  check_facets(complex);
  check_vertices(complex);
  check_edges(complex);
  check_bodies(complex);
}

}  // namespace meniscus
