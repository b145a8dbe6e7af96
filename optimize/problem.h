/// What an optimizer needs of a design: variables with bounds and a function
/// that answers with numbers or says why it cannot; and `match`, which moves
/// the variables until targets are met. Its sibling: optimize/minimize.h.
#pragma once

#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "core/error.h"
#include "core/monitor.h"
#include "core/types.h"
#include "core/units.h"

namespace meniscus::optimize {

struct Variable {
  std::string name;
  double initial = 0.0;
  double lower = 0.0;
  double upper = 0.0;  // initial within; lower == upper: it is held there
  /// What counts as one unit of it, > 0; none: upper - lower. Larger where the
  /// bounds hold a search near its start.
  std::optional<double> range = {};
  ShownUnit shown = {};  // in messages
  /// The name that people know it by together with its neighbours of the same
  /// group, in messages; empty: its own.
  std::string group = {};
};

/// The values of all responses at a design, or why there are none.
struct VectorAnswer {
  VectorX values;
  std::optional<Failure> failure;  // then `values` is empty
};
using VectorFunction = std::function<VectorAnswer(const VectorX& x)>;

/// d value_i / d x_j, rows by value. A failure here (an adjoint solve that did
/// not converge) is no failure of the point: differences take its place.
struct JacobianAnswer {
  Eigen::MatrixXd jacobian;
  std::optional<Failure> failure;
};
using JacobianFunction = std::function<JacobianAnswer(const VectorX& x)>;

/// Residuals r(x) of a least-squares match, each meant to become 0, scaled so
/// that |r| is the relative mismatch that the user's tolerance bounds.
/// `gradient`: d r_i / d x_j, rows by residual, when the function can give it.
struct ResidualAnswer {
  VectorX residuals;
  VectorX mismatch;  // relative mismatch per target, compared to tolerance
  std::optional<Eigen::MatrixXd> jacobian;
  std::optional<Failure> failure;  // then the rest is empty
};
using ResidualFunction = std::function<ResidualAnswer(const VectorX& x)>;

/// Why a point is asked for.
enum class EvaluationPhase {
  Start,       // the initial point
  Probe,       // the initial point failed: looking for one that does not
  Difference,  // neighbour for a finite difference
  Step,        // the method's proposal
  Gradient     // the Jacobian at a point that has answered
};
const char* name_of(EvaluationPhase phase);

enum class Termination {
  Converged,    // within tolerance: a match's mismatch, a minimum's residual
  Stalled,      // the method found nothing better, and misses the tolerance
  AtBound,      // as Stalled, with a variable at its bound
  NoFeasible,   // no point could be evaluated
  Infeasible,   // points answer, but none keeps every constraint
  Constant,     // no variable changes what is to be minimised
  NoFreedom,    // every variable is held by equal bounds
  LimitReached  // evaluations or time
};
const char* name_of(Termination termination);

struct MatchOptions {
  std::string method = "ceres";  // or NLopt's: "bobyqa", "cobyla", "sbplx", ...
  double tolerance = 1e-3;       // largest mismatch accepted
  int max_evaluations = 100;     // finite-difference ones included, >= 1
  int earlier_evaluations = 0;   // of the caller's limit, for messages
  double time_limit = 0.0;       // [s], 0: none
  double difference_step = 1e-3;  // x (upper - lower), for finite differences
  Monitor* monitor = nullptr;
  /// Told before each call of the function what the call is for; optional.
  std::function<void(EvaluationPhase)> announce = {};
  /// d residual / d x, asked only at points that a step was accepted at, after
  /// the function answered there; empty: the answer's own, or differences.
  JacobianFunction jacobian = {};
  /// Told the points that will be asked one by one next (neighbours of a
  /// difference), so that the caller can compute them side by side; optional.
  std::function<void(const std::vector<VectorX>&)> prefetch = {};
  /// Estimated error of each mismatch [1]; empty: not known. The message says
  /// when the tolerance is below it.
  VectorX mismatch_error = {};
};

struct MatchReport {
  Termination termination = Termination::Stalled;
  std::string message;    // why it stopped, in words, with figures
  VectorX best;           // the incumbent, kept by us, not by the library
  ResidualAnswer answer;  // at `best`
  double cost = 0.0;      // sum of squares / 2 at `best`
  int evaluations = 0;    // calls of the function, finite differences included
  int failed_evaluations = 0;
  int gradient_evaluations = 0;  // calls of MatchOptions::jacobian
  int iterations = 0;
  Eigen::MatrixXd jacobian;  // last known at or near `best`, may be empty
};

/// The methods that MatchOptions::method may name.
std::vector<std::string> match_methods();

/// Moves the variables until every mismatch is within tolerance, or says why
/// that cannot be had. Dispatches on options.method; throws InvalidInput for
/// an unknown one (the message lists those there are) and for bad bounds or
/// start. Variables held by equal bounds stay where they are; when all are,
/// the outcome is NoFreedom.
///
/// The function is never asked twice for the same x and never outside the
/// bounds; points come in a fixed order on the calling thread. A failed point
/// is counted and stepped back from; a NaN or infinite answer counts as failed
/// (NotANumber). What the function throws ends the match and reaches the
/// caller, and so does Interrupted once the monitor asks to stop.
MatchReport match(const std::vector<Variable>& variables,
                  const ResidualFunction& function,
                  const MatchOptions& options);

}  // namespace meniscus::optimize
