/// One run of one of NLopt's algorithms on a minimisation.
#pragma once

#include "optimize/minimize_evaluator.h"

namespace meniscus::optimize {

/// Who keeps the constraints.
enum class ConstraintStyle {
  TrustRegion,         // no algorithm of NLopt's (optimize/trust_region.h)
  Native,              // the algorithm
  NativeInequalities,  // the algorithm, equations by augmented Lagrangian
  Lagrangian,          // augmented Lagrangian, all of them
  FeasibleFirst        // any kept point beats any other (K. Deb, Comput.
                       // Methods Appl. Mech. Engrg. 186, 2000)
};

struct NloptTraits {
  MinimizeMethod method;
  int algorithm = 0;  // nlopt::algorithm, -1: none
  ConstraintStyle style = ConstraintStyle::Native;
  /// What a point that cannot be evaluated looks like: +infinity where the
  /// algorithm steps back from it, else worse than anything seen.
  bool infinite_wall = false;
  bool restarts = false;  // its simplex can collapse: begin it again
  bool of_match = false;  // serves a match too (optimize/nlopt_match.h)
};

/// All methods, in the order of the reference.
const std::vector<NloptTraits>& nlopt_traits();

/// f / unit + sum over the sides in the Lagrangian of
/// rho/2 max(0, g + m/rho)^2, without the max for equations
/// (R. T. Rockafellar, Math. Program. 5, 1973).
struct NloptTask {
  VectorX start;            // has answered
  double radius = 1.0;      // box about the start, x range
  double first_step = 0.1;  // x the box, where the method has to choose one
  double step_tolerance = 1e-6;  // x range
  double rho = 1.0;
  VectorX multipliers;  // per side
  /// Per side, where the method keeps inequalities only: +1 or -1 for an
  /// equation that it sees as value <= 0 or >= 0; 0: in the Lagrangian.
  VectorX one_sided;
  /// What the method may miss a constraint by [scales], and the gain of a step,
  /// x the objective, that ends it; 0: as fine as there is.
  double loose = 0.0;
  double least_gain = 0.0;
};

struct NloptResult {
  VectorX x;  // the library's own answer
  int iterations = 0;
  bool finished = false;  // by its own tolerance, not halted, not an error
  /// Only the box about the start holds the objective up: what is left to gain
  /// within it is little beside what the next box would give.
  bool box_used_up = false;
  std::string message;  // its last word
};

/// Never throws: ask the evaluator.
NloptResult run_nlopt(MinimizeEvaluator& evaluator, const NloptTraits& traits,
                      const NloptTask& task);

/// True for a side that no one-sided view serves and the method does not keep.
bool in_lagrangian(const NloptTraits& traits, const ConstraintSide& side);

}  // namespace meniscus::optimize
