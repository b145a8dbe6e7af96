#include "evolve/settle/settle_pops.h"

#include <string>
#include <utility>

#include <fmt/format.h>

#include "evolve/groom/junctions.h"
#include "evolve/groom/pop.h"

namespace meniscus::settle {

namespace {

constexpr int kMostRounds = 12;  // a pop may run lines into each other anew

/// Lines keep their ends: where a film that was pulled off has one on a wall,
/// at which it would open; empty: nowhere.
std::string end_on_wall(const films::FilmComplex& complex) {
  for (std::size_t f = 0; f < complex.mesh.facets.size(); ++f) {
    const films::ComplexSurface& surface =
        complex.surfaces[complex.mesh.facet_label[f]];
    for (const int v : complex.mesh.facets[f]) {
      if (!surface.pulled_from.empty() &&
          complex.vertices[v].constraints >= 0) {
        const Vec3& at = complex.mesh.points[v];
        return fmt::format(
            "the line where more than three films meet ends at a wall, at "
            "({:.4g}, {:.4g}, {:.4g}), and pops keep the ends of lines: draw "
            "the film that comes between, beside '{}', between two free lines",
            at.x(), at.y(), at.z(), surface.pulled_from);
      }
    }
  }
  return "";
}

}  // namespace

FilmState settle_pops(films::FilmComplex& complex, FilmState state,
                      const FindOptions& options) {
  for (int round = 0; round < kMostRounds && groom::unstable_junction(complex);
       ++round) {
    films::FilmComplex popped = complex;
    const int lines = groom::pop_edges(popped).popped;
    if (lines + groom::pop_vertices(popped).popped == 0) {
      return state;
    }
    if (const std::string end = end_on_wall(popped); !end.empty()) {
      state.report.verdict = "unstable: " + end;
      state.failure = Failure{FailureKind::FilmUnstable, state.report.verdict};
      return state;
    }
    complex = std::move(popped);
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
  return state;
}

}  // namespace meniscus::settle
