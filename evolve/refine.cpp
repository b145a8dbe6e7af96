#include <algorithm>
#include <cmath>
#include <unordered_map>

#include <Eigen/Dense>

#include "evolve/film_space.h"
#include "evolve/grooming.h"
#include "evolve/rims.h"

namespace meniscus {

namespace {

std::uint64_t key_of(int a, int b) {
  return (static_cast<std::uint64_t>(std::min(a, b)) << 32) |
         static_cast<std::uint32_t>(std::max(a, b));
}

constexpr int kWallSteps = 30;

/// The nearest point on the level sets, by Newton's least steps.
Vec3 onto_walls(const FilmComplex& complex, int set, Vec3 at) {
  const std::vector<int>& walls = complex.constraint_sets[set];
  const auto count = static_cast<Eigen::Index>(walls.size());
  for (int step = 0; step < kWallSteps; ++step) {
    Eigen::MatrixX3d rows(count, 3);
    VectorX gap(count);
    for (Eigen::Index i = 0; i < count; ++i) {
      const PlaceJet jet = jet_at(complex.level_sets[walls[i]].formula, at);
      rows.row(i) = jet.gradient;
      gap[i] = jet.value;
    }
    const Vec3 move = rows.completeOrthogonalDecomposition().solve(gap);
    at -= move;
    if (!(move.norm() > 1e-14 * at.norm())) {
      break;
    }
  }
  return at;
}

/// The vertex born inside a surface with an obstacle.
ComplexVertex born_by(const FilmComplex& complex, int set, const Edge& edge) {
  ComplexVertex made;
  made.constraints = set;
  const auto touches = [&](int v) {
    const ComplexVertex& vertex = complex.vertices[v];
    return vertex.constraints < 0 || vertex.held;
  };
  made.held = touches(edge[0]) && touches(edge[1]);
  return made;
}

/// The vertex born on a marked edge, and its place.
ComplexVertex born_on(const FilmComplex& complex, const ComplexEdge& edge,
                      Vec3& place) {
  ComplexVertex made;
  made.kind = edge.kind;
  made.constraints = edge.constraints;
  if (edge.kind == VertexKind::OnCurve || edge.kind == VertexKind::Slides) {
    const CurveShape& shape = complex.curves[edge.curve].shape;
    made.curve = edge.curve;
    made.t = middle_parameter(shape, complex.vertices[edge.a].t,
                              complex.vertices[edge.b].t);
    place = point_at(shape, made.t);
  } else if (edge.kind == VertexKind::Free && edge.constraints >= 0) {
    place = onto_walls(complex, edge.constraints, place);
  }
  return made;
}

}  // namespace

Refinement refine(const FilmComplex& complex) {
  Refinement result;
  FilmComplex& fine = result.complex;
  fine = complex;
  std::vector<Triangle> facet_edges;
  list_edges(complex.mesh.facets, result.parents, facet_edges);
  const std::vector<Edge>& edges = result.parents;
  // A vertex is a cap's when no film touches its edge.
  std::vector<char> in_film(edges.size(), 0);
  std::vector<int> obstacle(edges.size(), -1);
  for (std::size_t f = 0; f < facet_edges.size(); ++f) {
    if (complex.surfaces[complex.mesh.facet_label[f]].liquid) {
      for (const int e : facet_edges[f]) {
        in_film[e] = 1;
      }
    }
    const int set = complex.surfaces[complex.mesh.facet_label[f]].constraints;
    for (const int e : facet_edges[f]) {
      obstacle[e] = std::max(obstacle[e], set);
    }
  }
  std::unordered_map<std::uint64_t, int> marked;
  for (std::size_t m = 0; m < complex.edges.size(); ++m) {
    marked[key_of(complex.edges[m].a, complex.edges[m].b)] =
        static_cast<int>(m);
  }
  const std::vector<int> next = rim_neighbours(complex);
  const int first = static_cast<int>(complex.mesh.points.size());
  fine.edges.clear();
  fine.vertices.reserve(first + edges.size());
  fine.mesh.points.reserve(first + edges.size());
  for (std::size_t e = 0; e < edges.size(); ++e) {
    const auto [a, b] = edges[e];
    ComplexVertex made;
    Vec3 place = 0.5 * (complex.mesh.points[a] + complex.mesh.points[b]);
    const auto mark = marked.empty() ? marked.end() : marked.find(key_of(a, b));
    if (mark != marked.end()) {
      const ComplexEdge& edge = complex.edges[mark->second];
      made = born_on(complex, edge, place);
      ComplexEdge half = edge;
      half.b = first + static_cast<int>(e);
      fine.edges.push_back(half);
      half.a = half.b;
      half.b = edge.b;
      fine.edges.push_back(half);
    } else if (next[a] == b || next[b] == a) {
      const CurveShape& shape = complex.curves[complex.vertices[a].curve].shape;
      made.kind = VertexKind::OnCurve;
      made.curve = complex.vertices[a].curve;
      made.t =
          middle_parameter(shape, complex.vertices[a].t, complex.vertices[b].t);
      place = point_at(shape, made.t);
    } else if (in_film[e] == 0) {
      made.kind = VertexKind::InCap;
    } else if (obstacle[e] >= 0) {
      made = born_by(complex, obstacle[e], edges[e]);
      if (made.held) {
        place = onto_walls(complex, obstacle[e], place);
      }
    }
    fine.mesh.points.push_back(place);
    fine.vertices.push_back(made);
  }
  fine.mesh.facets.clear();
  fine.mesh.facet_label.clear();
  fine.mesh.facets.reserve(4 * facet_edges.size());
  fine.mesh.facet_label.reserve(4 * facet_edges.size());
  for (std::size_t f = 0; f < facet_edges.size(); ++f) {
    const Triangle& t = complex.mesh.facets[f];
    const int ab = first + facet_edges[f][0];
    const int bc = first + facet_edges[f][1];
    const int ca = first + facet_edges[f][2];
    for (const Triangle& small :
         {Triangle{t[0], ab, ca}, Triangle{ab, t[1], bc},
          Triangle{ca, bc, t[2]}, Triangle{ab, bc, ca}}) {
      fine.mesh.facets.push_back(small);
      fine.mesh.facet_label.push_back(complex.mesh.facet_label[f]);
    }
  }
  return result;
}

}  // namespace meniscus
