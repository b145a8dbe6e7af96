#include "evolve/frozen/resolutions.h"

#include <cmath>
#include <utility>

#include <fmt/format.h>

#include "core/error.h"
#include "evolve/energy/film_space.h"
#include "evolve/groom/bend_midpoints.h"
#include "evolve/groom/refine.h"
#include "evolve/settle/find_equilibrium.h"

namespace meniscus::frozen {

namespace {

constexpr double kMostFacets = 1e7;

/// Halvings after which edges of `from` are nearest to `edge` in ratio.
int halvings_to(const films::FilmComplex& settled, double from, double edge) {
  if (!std::isfinite(edge) || edge <= 0.0) {
    throw InvalidInput(fmt::format("edge length is {}, must be above 0", edge));
  }
  const double ratio = from / edge;
  const double facets =
      static_cast<double>(settled.mesh.facets.size()) * ratio * ratio;
  if (facets > kMostFacets) {
    throw InvalidInput(fmt::format(
        "an edge length of {:.4g} would give {:.2g} facets, the film's mean "
        "edge being {:.4g} now; ask for a longer one",
        edge, facets, from));
  }
  return std::max(0, static_cast<int>(std::lround(std::log2(ratio))));
}

}  // namespace

FilmResolution at_edge(const films::FilmComplex& settled, double edge,
                       const settle::SettleOptions& options) {
  FilmResolution result{.edge = edge, .complex = settled, .state = {}};
  films::FilmComplex& complex = result.complex;
  const int halvings =
      halvings_to(settled, mean_edge_length(settled.mesh), edge);
  for (int k = 0; k < halvings; ++k) {
    groom::Refinement finer = groom::refine(complex);
    groom::bend_midpoints(energy::FilmSpace(complex), complex.mesh.points,
                          finer);
    complex = std::move(finer.complex);
  }
  result.state = settle::find_equilibrium(
      complex, {.edge = edge, .halvings = 0, .settle = options});
  return result;
}

std::vector<FilmResolution> at_edges(const films::FilmComplex& settled,
                                     const std::vector<double>& edges,
                                     const settle::SettleOptions& options) {
  std::vector<FilmResolution> films;
  films.reserve(edges.size());
  for (const double edge : edges) {
    films.push_back(at_edge(settled, edge, options));
  }
  return films;
}

}  // namespace meniscus::frozen
