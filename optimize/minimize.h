/// Least objective within bounds on the variables and on other responses, by
/// the algorithms of NLopt behind one interface.
#pragma once

#include <cstdint>
#include <limits>
#include <string>
#include <vector>

#include "optimize/first_order.h"
#include "optimize/problem.h"

namespace meniscus::optimize {

/// lower <= response <= upper; equal bounds make it an equation.
struct ResponseBounds {
  std::string name;
  double lower = -std::numeric_limits<double>::infinity();
  double upper = std::numeric_limits<double>::infinity();
  /// What counts as one unit of violation [the response's unit], > 0;
  /// automatic: the larger |finite bound|, and when that is 0 the larger of
  /// |value at the start| and its change over the range of a variable, or 1.
  std::optional<double> scale = {};
  /// True for a value that falls like a square root towards designs that have
  /// none (the lowest eigenvalue before a fold): the search sees its square,
  /// which is nearly straight there. No effect on a bound of 0.
  bool root_like = false;
  ShownUnit shown = {};  // in messages
};

/// The function answers with 1 + constraints.size() values: the objective,
/// then the constraints in order.
struct MinimizeProblem {
  std::vector<Variable> variables;
  std::string objective;  // its name, for messages
  std::vector<ResponseBounds> constraints;
  VectorFunction function;
  /// Asked only where a method needs derivatives, always after the function
  /// answered at the same x; empty: forward differences within the bounds.
  JacobianFunction jacobian = {};
  ShownUnit shown = {};  // the objective in messages

  std::string objective_text(double value) const;  // "mass 0.485 kg"
};

struct MinimizeOptions {
  std::string method = "slsqp";  // one of minimize_methods()
  /// First-order residual (FirstOrderReport) that counts as a minimum, > 0.
  double optimality_tolerance = 1e-5;
  /// Violation x scale that still counts as kept, > 0.
  double feasibility_tolerance = 1e-6;
  /// Without derivatives: steps below this x range end the search, > 0.
  double step_tolerance = 1e-6;
  int max_evaluations = 300;      // finite-difference ones included, >= 1
  int earlier_evaluations = 0;    // of the caller's limit, for messages
  double time_limit = 0.0;        // [s], 0: none
  double difference_step = 1e-4;  // x (upper - lower)
  std::uint32_t seed = 1;         // of the global methods
  Monitor* monitor = nullptr;
  /// As in MatchOptions.
  std::function<void(EvaluationPhase)> announce = {};
  std::function<void(const std::vector<VectorX>&)> prefetch = {};
  /// Estimated error of each value, objective first [its unit]; empty: not
  /// known. The message says what lies below it (precision_note).
  VectorX value_error = {};
};

/// What designs that keep every constraint are compared by: the objective, and
/// ten times its magnitude x the violation [scales] that still counts as kept.
/// Else what is missed within the tolerance would buy a better objective than
/// a minimum has.
double kept_objective(double objective, double violation);

struct ConstraintState {
  std::string name;
  ShownUnit shown = {};
  double value = 0.0;
  double lower = 0.0;
  double upper = 0.0;
  double scale = 1.0;      // as in ResponseBounds
  double violation = 0.0;  // [scales], 0 when kept
  bool satisfied = false;  // violation <= feasibility_tolerance
  /// As in FirstOrderReport; NaN when no derivatives are known.
  double multiplier = std::numeric_limits<double>::quiet_NaN();
};

struct MinimizeReport {
  Termination termination = Termination::Stalled;
  std::string message;  // why it stopped, in words, with figures
  /// The incumbent, kept by us: the least kept_objective() among the points
  /// that keep every constraint, else the one that violates them least. A
  /// search that converged ends there or at a point that is better by no more
  /// than 10 tolerances.
  VectorX best;
  VectorX values;  // at `best`: objective, constraints
  double objective = 0.0;
  bool feasible = false;
  std::vector<ConstraintState> constraints;
  Eigen::MatrixXd jacobian;  // at `best`, of `values`; may be empty
  /// At `best`; none when no derivatives are known there.
  std::optional<FirstOrderReport> first_order;
  int evaluations = 0;  // calls of the function, finite differences included
  int failed_evaluations = 0;
  int gradient_evaluations = 0;  // calls of MinimizeProblem::jacobian
  int iterations = 0;            // the library's own count
};

struct MinimizeMethod {
  std::string name;
  bool gradients = false;  // uses derivatives
  bool global = false;     // spends most of max_evaluations, then polishes
};

/// slsqp (Kraft 1994; steps by optimize/trust_region.h), mma, ccsa (Svanberg
/// 2002), bobyqa (Powell 2009), cobyla (Powell 1994), sbplx (Rowan 1990),
/// neldermead, isres (Runarsson & Yao 2005), crs2 (Kaelo & Ali 2006), direct_l
/// (Gablonsky & Kelley 2001).
const std::vector<MinimizeMethod>& minimize_methods();

/// The method of that name, or null.
const MinimizeMethod* find_minimize_method(const std::string& name);

/// Throws InvalidInput for an unknown method, bad bounds, sizes or options.
///
/// The function is never asked twice for the same x, never outside the bounds,
/// always on the calling thread and in an order that depends on its answers
/// only: replayed answers give the same sequence. A failed point (NaN counts)
/// is an answer: the method is shown a wall there, and when it gives up beside
/// one it starts again from the incumbent in a smaller box. What the function
/// throws ends the search and reaches the caller, and so does Interrupted.
///
/// Converged means: every constraint kept, and the first-order residual within
/// tolerance; without derivatives, that the method's steps became smaller than
/// step_tolerance.
MinimizeReport minimize(const MinimizeProblem& problem,
                        const MinimizeOptions& options = {});

/// A sentence for each thing asked finer than the values are known, "" when
/// nothing is: the optimality tolerance below the objective's error, active
/// constraints kept or missed by less than their error. `value_error` as in
/// MinimizeOptions.
std::string precision_note(const MinimizeProblem& problem,
                           const MinimizeReport& report,
                           double optimality_tolerance,
                           const VectorX& value_error);

}  // namespace meniscus::optimize
