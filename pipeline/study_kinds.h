/// The kinds of study, each a function from a task to an outcome (internal to
/// run_study()).
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "optimize/problem.h"
#include "pipeline/design_evaluator.h"
#include "pipeline/match_targets.h"
#include "pipeline/study.h"

namespace meniscus {

/// Everything a kind of study works with; the references are on loan.
struct StudyTask {
  const Case& input;
  DesignEvaluator& evaluator;
  const StudyOptions& options;
  const MatchTargets* targets = nullptr;  // of a match, else null
  VectorX start;  // where to begin; evaluated, within the bounds
};

struct StudyOutcome {
  RunStatus status = RunStatus::Failed;
  std::string message;  // why it ended, in words, with figures
  VectorX best;         // a design that has been evaluated
  double objective = 0.0;
  std::vector<Constraint> constraints;
  Eigen::MatrixXd jacobian;  // of a match: d residual / d x near `best`
  std::optional<SweepFigures> sweep;
};

/// What the case's study.kind says.
StudyOutcome conduct(const StudyTask& task);

/// Looks at every design of a grid or a sample.
StudyOutcome sweep(const StudyTask& task);

/// The study's method asks for derivatives, and all that it looks at have them.
bool uses_gradients(const Case& input);

/// The design variables as the optimizers want them, starting at `start`.
std::vector<Variable> variables_of(const Case& input, const VectorX& start);

}  // namespace meniscus
