#include "pipeline/study.h"

#include <cmath>

#include <Eigen/QR>
#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "core/timer.h"
#include "fea/body_loads.h"
#include "optimize/problem.h"
#include "pipeline/match_targets.h"
#include "pipeline/part_warnings.h"
#include "pipeline/responses.h"
#include "pipeline/results.h"

namespace meniscus {

namespace {

constexpr const char* kModelName = "base";
// A response's error estimate is its change when all edges double, times a
// factor: 1 / (2^p - 1) at the order p = 0.74 of a clamped rim
// (docs/decisions/0006, docs/verification.md).
constexpr double kCoarserEdges = 2.0;
constexpr double kErrorPerChange = 1.5;

void add(StageSeconds& sum, const StageSeconds& part) {
  sum.film += part.film;
  sum.mesh += part.mesh;
  sum.fea += part.fea;
}

RunStatus status_of(Termination termination) {
  switch (termination) {
    case Termination::Converged:
      return RunStatus::Converged;
    case Termination::LimitReached:
      return RunStatus::Stopped;
    case Termination::Stalled:
    case Termination::AtBound:
    case Termination::NoFeasible:
    case Termination::Infeasible:
    case Termination::Constant:
    case Termination::NoFreedom:
      return RunStatus::Infeasible;
  }
  return RunStatus::Error;
}

/// One study on one frozen model.
class StudyRunner {
 public:
  StudyRunner(const Case& input, StudyStore& store, const StudyOptions& options)
      : input_(input),
        store_(store),
        options_(options),
        monitor_(options.monitor != nullptr ? *options.monitor
                                            : silent_monitor()) {}

  RunResult run(EvaluationFields* fields);

 private:
  EvaluationRecord evaluate(const VectorX& design, const std::string& phase);
  void analyse();
  void match();
  ResidualAnswer answer(const MatchTargets& targets,
                        const EvaluationRecord& record);
  void finish_best(EvaluationFields* fields);
  void solve_eigenproblems();
  void estimate_errors();
  void warn();

  const Case& input_;
  StudyStore& store_;
  const StudyOptions& options_;
  Monitor& monitor_;
  Timer timer_;
  std::optional<ForwardModel> model_;
  std::optional<MatchTargets> targets_;
  Eigen::MatrixXd jacobian_;
  std::string phase_ = "start";
  VectorX best_design_;
  RunResult result_;
  // What the last computed evaluation left, so that the best design's meshes
  // need no second evaluation when it came last.
  Evaluation last_;
  EvaluationFields last_fields_;
};

EvaluationRecord StudyRunner::evaluate(const VectorX& design,
                                       const std::string& phase) {
  throw_if_stopped(monitor_, "the study");
  ++result_.evaluations;
  if (auto known = store_.find(kModelName, design)) {
    result_.failed_evaluations += known->failure ? 1 : 0;
    return *known;
  }
  last_ = model_->evaluate(design, &last_fields_);
  add(result_.seconds, last_.seconds);
  EvaluationRecord record = make_record(input_, last_);
  record.model = kModelName;
  record.phase = phase;
  if (targets_ && !record.failure) {
    record.mismatch = targets_->mismatch(record.responses).maxCoeff();
  }
  record.number = store_.append(record);
  result_.failed_evaluations += record.failure ? 1 : 0;
  monitor_.log(Severity::Info, describe(input_, record));
  return record;
}

ResidualAnswer StudyRunner::answer(const MatchTargets& targets,
                                   const EvaluationRecord& record) {
  ResidualAnswer found;
  found.failure = record.failure;
  if (!record.failure) {
    found.residuals = targets.residuals(record.responses);
    found.mismatch = targets.mismatch(record.responses);
  }
  return found;
}

void StudyRunner::analyse() {
  result_.status = RunStatus::Converged;
  result_.message = "analysed the initial design";
  best_design_ = initial_design(input_);
}

void StudyRunner::match() {
  std::vector<Variable> variables;
  for (const DesignVariable& v : input_.design) {
    variables.push_back({.name = v.name,
                         .initial = v.initial,
                         .lower = v.lower,
                         .upper = v.upper});
  }
  const MatchReport report = meniscus::match(
      variables,
      [&](const VectorX& x) { return answer(*targets_, evaluate(x, phase_)); },
      {.method = input_.study.method,
       .tolerance = input_.study.tolerance,
       .max_evaluations = input_.study.max_evaluations,
       .time_limit = options_.time_limit,
       .monitor = options_.monitor,
       .announce = [&](EvaluationPhase phase) { phase_ = name_of(phase); }});
  result_.status = status_of(report.termination);
  result_.message = report.message;
  result_.objective = report.cost;
  best_design_ = report.best;
  jacobian_ = report.jacobian;
  for (Eigen::Index k = 0; k < report.answer.mismatch.size(); ++k) {
    const double value = report.answer.mismatch[k];
    result_.constraints.push_back(
        {.name = targets_->name(k),
         .value = value,
         .bound = input_.study.tolerance,
         .satisfied = value <= input_.study.tolerance});
  }
}

void StudyRunner::finish_best(EvaluationFields* fields) {
  const bool is_last = last_.design.size() == best_design_.size() &&
                       last_.design == best_design_;
  if (!is_last) {
    monitor_.progress({.stage = "study", .detail = "the best design's fields"});
    last_ = model_->evaluate(best_design_, &last_fields_);
    add(result_.seconds, last_.seconds);
  }
  result_.best = last_;
  if (result_.best->failure) {  // only an analysis can end here
    result_.status = RunStatus::Failed;
    result_.message = result_.best->failure->message;
    return;
  }
  last_fields_.stresses = part_stresses(last_fields_.mesh, last_fields_.inputs,
                                        last_fields_.solution);
  result_.stress = stress_figures(last_fields_);
  result_.exclusion = last_fields_.exclusion;
  for (std::string& warning :
       part_warnings(input_, last_fields_, result_.stress)) {
    result_.warnings.push_back(std::move(warning));
  }
  solve_eigenproblems();
  if (options_.estimate_errors) {
    monitor_.progress({.stage = "error", .detail = "dual solutions"});
    const Timer timer;
    ElementErrors errors =
        estimate_element_errors(input_, last_fields_, model_->elasticity());
    result_.seconds.fea += timer.seconds();
    if (errors.failure) {
      result_.warnings.push_back("no estimate of the elements' errors: " +
                                 errors.failure->message);
    } else {
      result_.element_errors = std::move(errors);
    }
  }
  if (fields != nullptr) {
    *fields = std::move(last_fields_);
  }
}

void StudyRunner::solve_eigenproblems() {
  monitor_.progress({.stage = "fea", .detail = "buckling, frequencies"});
  result_.eigen = eigen_figures(input_, last_fields_, model_->elasticity(),
                                options_.monitor);
  result_.seconds.fea += result_.eigen->seconds;
  last_fields_.modes = mode_shapes(input_, *result_.eigen);
  for (std::string& warning : buckling_warnings(*result_.eigen)) {
    result_.warnings.push_back(std::move(warning));
  }
}

void StudyRunner::estimate_errors() {
  monitor_.progress(
      {.stage = "error", .detail = "a second model with edges twice as long"});
  try {
    const ForwardModel coarse(
        input_, {.edge_factor = kCoarserEdges, .monitor = options_.monitor});
    add(result_.seconds, coarse.frozen().seconds);
    const std::optional<Failure>& failure = coarse.failure();
    Evaluation there;
    if (!failure) {
      there = coarse.evaluate(best_design_);
      add(result_.seconds, there.seconds);
    }
    if (failure || there.failure) {
      result_.warnings.push_back(
          "no error estimate, the coarser model cannot be evaluated: " +
          (failure ? *failure : *there.failure).message);
      return;
    }
    result_.response_errors =
        kErrorPerChange *
        (there.responses - result_.best->responses).cwiseAbs();
    if (result_.element_errors) {  // no smaller than the elements' own part
      result_.response_errors = result_.response_errors.binaryExpr(
          result_.element_errors->responses, [](double all, double part) {
            return std::isfinite(part) ? std::max(all, std::abs(part)) : all;
          });
    }
    if (targets_ && jacobian_.size() > 0) {
      const Eigen::MatrixXd inverse =
          jacobian_.completeOrthogonalDecomposition().pseudoInverse();
      result_.design_errors = inverse.cwiseAbs() * targets_->residual_errors(
                                                       result_.response_errors);
    }
  } catch (const MeshError& error) {
    result_.warnings.push_back(std::string("no error estimate: ") +
                               error.what());
  }
}

void StudyRunner::warn() {
  if (!targets_ || result_.response_errors.size() == 0) {
    return;
  }
  const double error =
      targets_
          ->mismatch_errors(result_.best->responses, result_.response_errors)
          .maxCoeff();
  if (error > input_.study.tolerance) {
    result_.warnings.push_back(fmt::format(
        "the tolerance {:.1e} is below the mesh's own error of the mismatch, "
        "about {:.1e}: shorten resolution.fea to trust more digits",
        input_.study.tolerance, error));
  }
}

RunResult StudyRunner::run(EvaluationFields* fields) {
  model_.emplace(input_, ForwardModelOptions{.monitor = options_.monitor});
  result_.seconds = model_->frozen().seconds;
  if (model_->failure()) {
    result_.status = RunStatus::Failed;
    result_.message = fmt::format("the initial design cannot be evaluated: {}",
                                  model_->failure()->message);
    result_.start = model_->frozen();
    result_.best = model_->frozen();
    if (fields != nullptr) {
      fields->surface.base = model_->unfilled_surface();
      fields->findings = model_->findings();
    }
    result_.total_seconds = timer_.seconds();
    return result_;
  }
  if (const Adaptation* adaptation = model_->adaptation()) {
    result_.adaptation = *adaptation;
  }
  const bool matches = input_.study.kind == StudyKind::Match;
  const EvaluationRecord start = [&] {
    const VectorX design = initial_design(input_);
    EvaluationRecord record = evaluate(design, "start");
    if (matches && !record.failure) {
      targets_.emplace(input_, record.responses);
    }
    result_.start = to_evaluation(record);
    return record;
  }();
  if (start.failure) {
    result_.status = RunStatus::Failed;
    result_.message = fmt::format("the initial design cannot be evaluated: {}",
                                  start.failure->message);
    result_.best = result_.start;
  } else {
    if (matches) {
      result_.evaluations = 0;  // the match asks for the start again
      match();
    } else {
      analyse();
    }
    finish_best(fields);
    if (options_.estimate_errors && !result_.best->failure) {
      estimate_errors();
    }
    warn();
  }
  result_.total_seconds = timer_.seconds();
  return result_;
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
  return StudyRunner(input, store, options).run(fields);
}

}  // namespace meniscus
