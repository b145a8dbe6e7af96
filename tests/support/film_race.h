/// The five works of the speed table: this program's films and Surface
/// Evolver's from the same starts to the same facet counts.
#pragma once

#include <iosfwd>
#include <string>
#include <utility>
#include <vector>

#include "evolve/films/film_complex.h"
#include "evolve/frozen/film_model.h"
#include "tests/support/evolver.h"

namespace meniscus {

/// A film and how many times faster than Surface Evolver it has to settle.
struct SpeedWork {
  std::string name;
  films::FilmComplex (*start)() = nullptr;
  int refinements = 0;     // at full size
  std::string descent;     // Surface Evolver's, per level
  double least_tuned = 0;  // ratios of user CPU time
  double least_typical = 0;
  double aim_tuned = 0;
  double aim_typical = 0;
};

/// Its name, for test output.
void PrintTo(const SpeedWork& work, std::ostream* out);

const std::vector<SpeedWork>& speed_works();

/// What one call of find_equilibrium() took and gave.
struct FilmRun {
  bool settled = false;  // residual within its bound, stable
  std::string verdict;   // or the message of what was thrown
  double user_seconds = 0.0;
  double system_seconds = 0.0;  // of the whole process
  double wall_seconds = 0.0;
  double peak_bytes = 0.0;  // of the whole process
  int facets = 0;           // of films, caps not counted
  double energy = 0.0;
  double residual = 0.0;        // along normals, largest [force]
  double residual_bound = 0.0;  // 1e-10 x tension x mean edge [force]
  double min_eigenvalue = 0.0;
};

/// find_equilibrium() after nested refinements, to 1e-10 x tension x mean
/// edge; `complex` becomes the film.
settle::FilmState find_refined(films::FilmComplex& complex, int refinements);

/// Settles `start` after nested refinements, one thread, in a child process of
/// its own.
FilmRun run_film(const films::FilmComplex& start, int refinements);

/// The run of least user time of `count`, each `run()`: what else the machine
/// did only adds to it.
template <class Run>
auto fastest(int count, Run&& run) {
  auto best = run();
  for (int i = 1; i < count; ++i) {
    auto next = run();
    if (next.user_seconds < best.user_seconds) {
      best = std::move(next);
    }
  }
  return best;
}

}  // namespace meniscus
