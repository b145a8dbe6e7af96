/// How the kinds of study are done, a function each from a task to an outcome
/// (internal to run_study()).
#pragma once

#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "optimize/minimize.h"
#include "optimize/multipliers.h"
#include "pipeline/study/design_evaluator.h"
#include "pipeline/study/match_targets.h"
#include "pipeline/study/study.h"

namespace meniscus::study {

/// Everything a kind of study works with; the references are on loan.
struct StudyTask {
  const case_data::Case& input;
  DesignEvaluator& evaluator;
  const StudyOptions& options;
  const MatchTargets* targets = nullptr;  // of a match, else null
  VectorX start;       // where to begin; evaluated, within the bounds
  double reach = 1.0;  // designs stay this near to it, x the ranges
};

struct StudyOutcome {
  RunStatus status = RunStatus::Failed;
  std::string message;    // why it ended, in words, with figures
  VectorX best;           // a design that has been evaluated
  bool unproven = false;  // stopped because the search ended by itself
  double objective = 0.0;
  std::vector<Constraint> constraints;
  std::optional<optimize::Multipliers> multipliers;  // of a minimum
  Eigen::MatrixXd jacobian;  // of a match: d residual / d x near `best`
  std::optional<SweepFigures> sweep;
  std::optional<ToleranceFigures> tolerance;
  std::optional<FrontFigures> front;
  std::vector<std::string> warnings;

  /// Not by the search itself.
  bool ended_by_limit() const {
    return status == RunStatus::Stopped && !unproven;
  }
};

bool all_kept(const std::vector<Constraint>& constraints);

/// What the case's study.kind says.
StudyOutcome conduct(const StudyTask& task);

/// A match of the films with a scan.
StudyOutcome fit_scan(const StudyTask& task);
StudyOutcome minimize(const StudyTask& task);
/// Looks at every design of a grid or a sample.
StudyOutcome sweep(const StudyTask& task);
/// These; variables without levels in a grid stay where `start` has them.
std::vector<VectorX> designs_of_sweep(const case_data::Case& input,
                                      const VectorX& start);
/// What a sweep of so many designs comes to by the records of those looked at,
/// in order, each of the model that answered.
StudyOutcome outcome_of_sweep(
    const StudyTask& task, int designs,
    const std::vector<store::EvaluationRecord>& records);
/// How far the responses of the start spread when the design scatters.
StudyOutcome tolerance(const StudyTask& task);
/// Compromises of two objectives by bounds on the second.
StudyOutcome pareto(const StudyTask& task);

/// The objective and the constraints as the optimizer sees them; a second
/// objective is the last constraint, without bounds. `phase`, which records
/// are given, and the task must outlive the problem.
optimize::MinimizeProblem minimize_problem(const StudyTask& task,
                                           const std::string& phase);

/// The case's; `phase` receives what is asked for next.
optimize::MinimizeOptions minimize_options(const StudyTask& task,
                                           std::string& phase);

RunStatus status_of(optimize::Termination termination);

/// Of two bounds, either of which may be infinite.
double nearer_bound(double lower, double upper, double value);

/// As result.json has it, with the nearer bound.
Constraint to_constraint(const optimize::ConstraintState& state);

/// The constraints of a minimum, and the targets of a match (`targets` null: a
/// fit to a scan), as they are at `responses`.
std::vector<Constraint> bound_constraints(const case_data::Case& input,
                                          const VectorX& responses);
std::vector<Constraint> match_constraints(const case_data::Case& input,
                                          const MatchTargets* targets,
                                          const VectorX& responses);

/// Those of a minimum or a match that are not satisfied, in words; empty: none.
std::string missed_bounds(const case_data::Case& input,
                          const std::vector<Constraint>& constraints);

/// Computes the neighbours of a difference side by side.
std::function<void(const std::vector<VectorX>&)> prefetch_of(
    const StudyTask& task);

/// The study's method asks for derivatives, and all that it looks at have them.
bool uses_gradients(const case_data::Case& input);

/// The design variables as the optimizers want them, starting at `start` and
/// staying within `reach` x their ranges of it; 1 or more: within their bounds.
std::vector<optimize::Variable> variables_of(const case_data::Case& input,
                                             const VectorX& start,
                                             double reach = 1.0);

}  // namespace meniscus::study
