#include "evolve/groom/junctions.h"

#include <algorithm>

#include "evolve/groom/pop.h"

namespace meniscus::groom {

namespace {

bool has_lines(const films::FilmComplex& complex) {
  std::vector<Edge> edges;
  std::vector<Triangle> facet_edges;
  list_edges(complex.mesh.facets, edges, facet_edges);
  std::vector<int> films(edges.size(), 0);
  for (std::size_t f = 0; f < facet_edges.size(); ++f) {
    if (complex.surfaces[complex.mesh.facet_label[f]].liquid) {
      for (const int e : facet_edges[f]) {
        ++films[e];
      }
    }
  }
  return std::any_of(films.begin(), films.end(), [](int n) { return n > 2; });
}

}  // namespace

std::optional<UnstableJunction> unstable_junction(
    const films::FilmComplex& complex) {
  if (!has_lines(complex)) {
    return std::nullopt;
  }
  films::FilmComplex trial = complex;
  const PopReport edges = pop_edges(trial);
  if (edges.popped > 0) {
    return UnstableJunction{edges.places.front(), true};
  }
  trial = complex;
  const PopReport vertices = pop_vertices(trial);
  if (vertices.popped > 0) {
    return UnstableJunction{vertices.places.front(), false};
  }
  return std::nullopt;
}

}  // namespace meniscus::groom
