#include <algorithm>
#include <cmath>

#include "evolve/grooming.h"
#include "evolve/rims.h"

namespace meniscus {

Refinement refine(const FilmComplex& complex) {
  Refinement result;
  FilmComplex& fine = result.complex;
  fine = complex;
  std::vector<Triangle> facet_edges;
  list_edges(complex.mesh.facets, result.parents, facet_edges);
  const std::vector<Edge>& edges = result.parents;
  // A vertex is a cap's when no film touches its edge.
  std::vector<char> in_film(edges.size(), 0);
  for (std::size_t f = 0; f < facet_edges.size(); ++f) {
    if (complex.surfaces[complex.mesh.facet_label[f]].liquid) {
      for (const int e : facet_edges[f]) {
        in_film[e] = 1;
      }
    }
  }
  const std::vector<int> next = rim_neighbours(complex);
  for (std::size_t e = 0; e < edges.size(); ++e) {
    const auto [a, b] = edges[e];
    ComplexVertex made;
    Vec3 place = 0.5 * (complex.mesh.points[a] + complex.mesh.points[b]);
    if (next[a] == b || next[b] == a) {
      made.kind = VertexKind::OnCurve;
      made.curve = complex.vertices[a].curve;
      const CurveShape& shape = complex.curves[made.curve].shape;
      made.t = middle_parameter(shape, complex.vertices[a].t,
                                complex.vertices[b].t);
      place = point_at(shape, made.t);
    } else if (in_film[e] == 0) {
      made.kind = VertexKind::InCap;
    }
    fine.mesh.points.push_back(place);
    fine.vertices.push_back(made);
  }
  fine.mesh.facets.clear();
  fine.mesh.facet_label.clear();
  const int first = static_cast<int>(complex.mesh.points.size());
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
