#include "pipeline/study.h"

#include <algorithm>
#include <cmath>
#include <optional>

#include <Eigen/QR>
#include <fmt/format.h>

#include "core/timer.h"
#include "pipeline/part_warnings.h"
#include "pipeline/precision.h"
#include "pipeline/results.h"
#include "pipeline/study_kinds.h"

namespace meniscus {

namespace {

// A response's error estimate is its change when all edges double, times a
// factor: 1 / (2^p - 1) at the order p = 0.74 of a clamped rim
// (docs/decisions/0006, docs/verification.md).
constexpr double kCoarserEdges = 2.0;
constexpr double kErrorPerChange = 1.5;

/// From the frozen model to the answer with its error, step by step.
class StudyRun {
 public:
  StudyRun(const Case& input, StudyStore& store, const StudyOptions& options)
      : input_(input),
        store_(store),
        options_(options),
        monitor_(options.monitor != nullptr ? *options.monitor
                                            : silent_monitor()) {}

  RunResult run();
  /// Of the best design; or what there is of a surface that was not filled.
  EvaluationFields take_fields() { return std::move(fields_); }

 private:
  bool freeze();
  bool start();
  VectorX begin();
  void conduct_study();
  bool finish_best();
  void solve_eigenproblems();
  void estimate_element_errors_of_best();
  void estimate_errors();
  void combine_errors(const VectorX& coarse);
  void warn();
  void cannot_begin(const Failure& failure, const Evaluation& there);

  const Case& input_;
  StudyStore& store_;
  const StudyOptions& options_;
  Monitor& monitor_;
  Timer timer_;
  std::optional<DesignEvaluator> evaluator_;
  std::optional<MatchTargets> targets_;
  StudyOutcome outcome_;
  EvaluationFields fields_;
  StageSeconds own_seconds_;  // beside those of the evaluator
  RunResult result_;
};

void StudyRun::cannot_begin(const Failure& failure, const Evaluation& there) {
  result_.status = RunStatus::Failed;
  result_.message = fmt::format("the initial design cannot be evaluated: {}",
                                failure.message);
  result_.start = there;
  result_.best = there;
}

bool StudyRun::freeze() {
  evaluator_.emplace(
      input_, store_,
      DesignEvaluatorOptions{.with_gradients = uses_gradients(input_),
                             .jobs = options_.jobs,
                             .monitor = options_.monitor});
  const ForwardModel& model = evaluator_->model();
  if (model.failure()) {
    cannot_begin(*model.failure(), model.frozen());
    fields_.surface.base = model.unfilled_surface();
    fields_.findings = model.findings();
    return false;
  }
  if (const Adaptation* adaptation = model.adaptation()) {
    result_.adaptation = *adaptation;
  }
  return true;
}

bool StudyRun::start() {
  const EvaluationRecord record =
      evaluator_->evaluate(initial_design(input_), "start");
  if (record.failure) {
    cannot_begin(*record.failure, to_evaluation(record));
    return false;
  }
  result_.start = to_evaluation(record);
  if (input_.study.kind == StudyKind::Match) {
    targets_.emplace(input_, record.responses);
    evaluator_->judge_by([this](const VectorX& responses) {
      return targets_->mismatch(responses).maxCoeff();
    });
  }
  return true;
}

/// The caller's design where it can be evaluated, else the initial one.
VectorX StudyRun::begin() {
  const VectorX& initial = result_.start->design;
  if (!options_.start || *options_.start == initial) {
    return initial;
  }
  if (const auto failure =
          evaluator_->evaluate(*options_.start, "start").failure) {
    monitor_.log(Severity::Info,
                 "starts from the initial design instead: " + failure->message);
    return initial;
  }
  return *options_.start;
}

void StudyRun::conduct_study() {
  const VectorX start = begin();
  evaluator_->reset_counts();  // the kinds of study ask for the start again
  outcome_ = conduct({.input = input_,
                      .evaluator = *evaluator_,
                      .options = options_,
                      .targets = targets_ ? &*targets_ : nullptr,
                      .start = start});
  result_.status = outcome_.status;
  result_.message = outcome_.message;
  result_.objective = outcome_.objective;
  result_.constraints = outcome_.constraints;
  result_.sweep = outcome_.sweep;
  result_.tolerance = outcome_.tolerance;
  result_.front = outcome_.front;
  result_.warnings.insert(result_.warnings.end(), outcome_.warnings.begin(),
                          outcome_.warnings.end());
}

bool StudyRun::finish_best() {
  result_.best = evaluator_->with_fields(outcome_.best, fields_);
  if (result_.best->failure) {  // only an analysis can end here
    result_.status = RunStatus::Failed;
    result_.message = result_.best->failure->message;
    return false;
  }
  fields_.stresses =
      part_stresses(fields_.mesh, fields_.inputs, fields_.solution);
  result_.stress = stress_figures(fields_);
  result_.exclusion = fields_.exclusion;
  for (std::string& warning : part_warnings(input_, fields_, result_.stress)) {
    result_.warnings.push_back(std::move(warning));
  }
  solve_eigenproblems();
  return true;
}

void StudyRun::solve_eigenproblems() {
  monitor_.progress({.stage = "fea", .detail = "buckling, frequencies"});
  result_.eigen = eigen_figures(
      input_, fields_, evaluator_->model().elasticity(), options_.monitor);
  own_seconds_.fea += result_.eigen->seconds;
  fields_.modes = mode_shapes(input_, *result_.eigen);
  for (std::string& warning : buckling_warnings(*result_.eigen)) {
    result_.warnings.push_back(std::move(warning));
  }
}

void StudyRun::estimate_element_errors_of_best() {
  monitor_.progress({.stage = "accuracy", .detail = "dual solutions"});
  const Timer timer;
  ElementErrors errors =
      estimate_element_errors(input_, fields_, result_.best->responses,
                              evaluator_->model().elasticity());
  own_seconds_.fea += timer.seconds();
  if (errors.failure) {
    result_.warnings.push_back("no estimate of the elements' errors: " +
                               errors.failure->message);
  } else {
    result_.element_errors = std::move(errors);
  }
}

void StudyRun::estimate_errors() {
  estimate_element_errors_of_best();
  monitor_.progress({.stage = "accuracy",
                     .detail = "a second model with edges twice as long"});
  try {
    const ForwardModel coarse(
        input_, {.edge_factor = kCoarserEdges, .monitor = options_.monitor});
    own_seconds_ += coarse.frozen().seconds;
    const std::optional<Failure>& failure = coarse.failure();
    Evaluation there;
    if (!failure) {
      there = coarse.evaluate(outcome_.best);
      own_seconds_ += there.seconds;
    }
    if (failure || there.failure) {
      result_.warnings.push_back(
          "no error estimate, the coarser model cannot be evaluated: " +
          (failure ? *failure : *there.failure).message);
      return;
    }
    combine_errors(there.responses);
  } catch (const MeshError& error) {
    result_.warnings.push_back(std::string("no error estimate: ") +
                               error.what());
  }
}

/// From the responses of the coarser model.
void StudyRun::combine_errors(const VectorX& coarse) {
  result_.response_errors =
      kErrorPerChange * (coarse - result_.best->responses).cwiseAbs();
  if (result_.element_errors) {  // no smaller than the elements' own part
    result_.response_errors = result_.response_errors.binaryExpr(
        result_.element_errors->responses, [](double all, double part) {
          return std::isfinite(part) ? std::max(all, std::abs(part)) : all;
        });
  }
  if (targets_ && outcome_.jacobian.size() > 0) {
    const Eigen::MatrixXd inverse =
        outcome_.jacobian.completeOrthogonalDecomposition().pseudoInverse();
    result_.design_errors =
        inverse.cwiseAbs() * targets_->residual_errors(result_.response_errors);
  }
}

void StudyRun::warn() {
  const std::string note =
      precision_statement(input_, targets_ ? &*targets_ : nullptr,
                          result_.best->responses, result_.response_errors);
  if (!note.empty()) {
    result_.message += ". " + note;
    result_.warnings.push_back(note);
  }
}

RunResult StudyRun::run() {
  if (freeze() && start()) {
    conduct_study();
    if (finish_best() && options_.estimate_errors) {
      estimate_errors();
    }
    warn();
  }
  const EvaluationCounts& counts = evaluator_->counts();
  result_.evaluations = counts.evaluations;
  result_.failed_evaluations = counts.failed;
  result_.gradient_evaluations = counts.gradients;
  result_.seconds = evaluator_->seconds();
  result_.seconds += own_seconds_;
  result_.total_seconds = timer_.seconds();
  return std::move(result_);
}

}  // namespace

const char* name_of(RunStatus status) {
  switch (status) {
    case RunStatus::Converged:
      return "converged";
    case RunStatus::Infeasible:
      return "infeasible";
    case RunStatus::Stopped:
      return "stopped";
    case RunStatus::Failed:
      return "failed";
    case RunStatus::Error:
      return "error";
    case RunStatus::Interrupted:
      return "interrupted";
  }
  return "unknown";
}

RunResult run_study(const Case& input, StudyStore& store,
                    const StudyOptions& options, EvaluationFields* fields) {
  StudyRun run(input, store, options);
  RunResult result = run.run();
  if (fields != nullptr) {
    *fields = run.take_fields();
  }
  return result;
}

}  // namespace meniscus
