/// Runs Surface Evolver on the starts of tests/support/film_complexes.h, to
/// compare times and energies side by side.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "evolve/films/film_complex.h"

namespace meniscus {

bool have_evolver();

/// How its users drive it. Both refine nested, level by level.
enum class EvolverScript {
  Tuned,   // the two finest levels by `hessian` alone
  Typical  // the same on every level
};

struct EvolverJob {
  int refinements = 4;
  EvolverScript script = EvolverScript::Tuned;
  // Before the two `hessian` of a level that descends.
  std::string descent = "g 10; u; V; g 5;";
  int last_hessians = 2;      // on the finest level
  double time_limit = 300.0;  // of CPU time [s]
};

struct EvolverRun {
  bool ended = false;         // the script ran to its end
  bool converged = false;     // and the last `hessian` changed nothing
  double user_seconds = 0.0;  // CPU, start to the last `hessian`
  double system_seconds = 0.0;
  double peak_bytes = 0.0;
  double start_energy = 0.0;          // as loaded
  std::vector<double> start_volumes;  // one per body [length^3]
  int facets = 0;
  double energy = 0.0;
  double mean_edge = 0.0;  // [length]
  // Largest force along a vertex normal [force]; with more than one body, or
  // line integrals, it is not known.
  std::optional<double> residual;
  std::string output;  // all that it printed
};

/// A datafile of `complex`: circles as parametric boundaries, other rims and
/// frames fixed, level sets, line integrals and bodies. Solid caps must be
/// level; they are left out, and their share of the volume is the bodies'
/// volconst, which costs Surface Evolver nothing. For the starts of
/// film_complexes.h; throws std::runtime_error for what it cannot say.
std::string evolver_datafile(const films::FilmComplex& complex);

/// What the left-out caps of a body hold after nested refinements: the columns
/// under them [length^3].
double evolver_cap_volume(const films::FilmComplex& complex,
                          const films::ComplexBody& body, int refinements);

/// The commands of a job.
std::string evolver_commands(const films::FilmComplex& start,
                             const EvolverJob& job);

/// Runs a job to its end; one that fails or diverges is a result.
EvolverRun run_evolver(const films::FilmComplex& start, const EvolverJob& job);

}  // namespace meniscus
