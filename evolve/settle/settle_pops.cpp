#include "evolve/settle/settle_pops.h"

#include <utility>

#include <fmt/format.h>

#include "evolve/groom/junctions.h"
#include "evolve/groom/pop.h"

namespace meniscus::settle {

namespace {

constexpr int kMostRounds = 12;  // a pop may run lines into each other anew

/// Lines keep their ends: one that could slide apart on a wall is no rest.
void check_ends(const films::FilmComplex& complex, FilmState& state) {
  for (std::size_t f = 0; f < complex.mesh.facets.size() && !state.failure;
       ++f) {
    const films::ComplexSurface& surface =
        complex.surfaces[complex.mesh.facet_label[f]];
    for (const int v : surface.pulled_from.empty() ? Triangle{-1, -1, -1}
                                                   : complex.mesh.facets[f]) {
      if (v >= 0 && complex.vertices[v].constraints >= 0) {
        const Vec3& at = complex.mesh.points[v];
        state.report.verdict = fmt::format(
            "unstable: film '{}', pulled from '{}', ends at a wall in one "
            "point, ({:.4g}, {:.4g}, {:.4g}), where it would open; pops keep "
            "the ends of lines: draw that film, between two free lines",
            surface.name, surface.pulled_from, at.x(), at.y(), at.z());
        state.failure =
            Failure{FailureKind::FilmUnstable, state.report.verdict};
        return;
      }
    }
  }
}

}  // namespace

FilmState settle_pops(films::FilmComplex& complex, FilmState state,
                      const FindOptions& options) {
  for (int round = 0; round < kMostRounds && groom::unstable_junction(complex);
       ++round) {
    const int lines = groom::pop_edges(complex).popped;
    if (lines + groom::pop_vertices(complex).popped == 0) {
      break;
    }
    const int before = state.report.iterations;
    // New films are narrower than an edge: they open first.
    state = find_equilibrium(complex, {.settle = options.settle});
    if (options.edge && !state.failure) {
      state = find_equilibrium(
          complex,
          {.edge = options.edge, .halvings = 0, .settle = options.settle});
    }
    state.report.iterations += before;
  }
  if (!state.failure) {
    check_ends(complex, state);
  }
  return state;
}

}  // namespace meniscus::settle
