#include <algorithm>
#include <cmath>
#include <limits>

#include <Eigen/QR>
#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "fea/body_loads.h"
#include "pipeline/part_warnings.h"
#include "pipeline/precision.h"
#include "pipeline/responses.h"
#include "pipeline/results.h"
#include "pipeline/study_runner.h"

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
  sum.gradient += part.gradient;
}

/// The rows of `responses` are all there.
bool has_rows(const Eigen::MatrixXd& gradient,
              const std::vector<int>& responses) {
  return gradient.size() > 0 &&
         std::all_of(responses.begin(), responses.end(),
                     [&](int r) { return gradient.row(r).allFinite(); });
}

}  // namespace

EvaluationRecord StudyRunner::evaluate(const VectorX& design,
                                       const std::string& phase) {
  throw_if_stopped(monitor_, "the study");
  ++result_.evaluations;
  if (auto known = store_.find(kModelName, design)) {
    result_.failed_evaluations += known->failure ? 1 : 0;
    return *known;
  }
  last_ = model_->evaluate(design, &last_fields_, adjoint_wanted());
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

/// Rows by response, NaN in those that are not among `responses`. The design
/// has been evaluated.
JacobianAnswer StudyRunner::gradient(const VectorX& design,
                                     const std::vector<int>& responses) {
  throw_if_stopped(monitor_, "the study");
  ++result_.gradient_evaluations;
  const EvaluationRecord record = *store_.find(kModelName, design);
  if (has_rows(record.gradient, responses)) {
    return {record.gradient, std::nullopt};
  }
  if (!is_last(design) || last_adjoint_.elastic.empty()) {
    last_ = model_->evaluate(design, &last_fields_, &last_adjoint_);
    add(result_.seconds, last_.seconds);
  }
  const DesignGradient found =
      model_->gradient(last_, last_fields_, last_adjoint_, responses);
  result_.seconds.gradient += found.seconds;
  if (found.failure) {
    monitor_.log(Severity::Warning, "no gradient: " + found.failure->message);
    return {{}, found.failure};
  }
  Eigen::MatrixXd gradient = Eigen::MatrixXd::Constant(
      static_cast<Eigen::Index>(input_.responses.size()), design.size(),
      std::numeric_limits<double>::quiet_NaN());
  for (std::size_t k = 0; k < responses.size(); ++k) {
    gradient.row(responses[k]) =
        found.jacobian.row(static_cast<Eigen::Index>(k));
  }
  store_.set_gradient(record.number, gradient);
  return {std::move(gradient), std::nullopt};
}

void StudyRunner::finish_best(EvaluationFields* fields) {
  if (!is_last(best_design_)) {
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
    ElementErrors errors = estimate_element_errors(
        input_, last_fields_, result_.best->responses, model_->elasticity());
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
  const std::string note =
      precision_statement(input_, targets_ ? &*targets_ : nullptr,
                          result_.best->responses, result_.response_errors);
  if (!note.empty()) {
    result_.message += ". " + note;
    result_.warnings.push_back(note);
  }
}

void StudyRunner::conduct() {
  result_.evaluations = 0;  // the optimizers ask for the start again
  switch (input_.study.kind) {
    case StudyKind::Match:
      return match();
    case StudyKind::Minimize:
      return minimize();
    case StudyKind::Analyse:
      result_.evaluations = 1;
      return analyse();
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
  with_gradients_ = uses_gradients(input_);
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
    conduct();
    finish_best(fields);
    if (options_.estimate_errors && !result_.best->failure) {
      estimate_errors();
    }
    warn();
  }
  result_.total_seconds = timer_.seconds();
  return result_;
}

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
