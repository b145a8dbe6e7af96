#include "pipeline/study_stage.h"

#include <fmt/format.h>

#include "pipeline/refreeze.h"
#include "pipeline/results.h"

namespace meniscus {

StudyStage::StudyStage(const Case& input, StudyStore& store,
                       const StudyOptions& options, const StageModel& model)
    : input_(input),
      options_(options),
      model_(model),
      evaluator_(input, store,
                 DesignEvaluatorOptions{.model = model.name,
                                        .edge_factor = model.edge_factor,
                                        .with_gradients = uses_gradients(input),
                                        .jobs = options.jobs,
                                        .time_limit = options.time_limit,
                                        .listener = options.listener,
                                        .monitor = options.monitor}) {
  if (evaluator_.model().failure()) {
    failure_ = evaluator_.model().failure();
    start_ = evaluator_.model().frozen();
    return;
  }
  const EvaluationRecord record =
      evaluator_.evaluate(initial_design(input_), "start");
  failure_ = record.failure;
  start_ = to_evaluation(record);
  if (!failure_ && input_.study.kind == StudyKind::Match) {
    targets_.emplace(input_, model_.reference.value_or(record.responses));
    evaluator_.judge_by([this](const VectorX& responses) {
      return targets_->mismatch(responses).maxCoeff();
    });
  }
}

VectorX StudyStage::begin() {
  const VectorX& initial = start_.design;
  if (!options_.start || *options_.start == initial) {
    return initial;
  }
  if (const auto failure =
          evaluator_.evaluate(*options_.start, "start").failure) {
    Monitor& monitor =
        options_.monitor != nullptr ? *options_.monitor : silent_monitor();
    monitor.log(Severity::Info,
                "starts from the initial design instead: " + failure->message);
    return initial;
  }
  return *options_.start;
}

void StudyStage::conduct() {
  const VectorX start = begin();
  evaluator_.reset_counts();  // the kinds of study ask for the start again
  outcome_ = meniscus::conduct({.input = input_,
                                .evaluator = evaluator_,
                                .options = options_,
                                .targets = targets(),
                                .start = start});
}

CoarseStage run_coarse_stage(const Case& input, StudyStore& store,
                             const StudyOptions& options) {
  const double factor = input.study.coarse_first;
  CoarseStage result;
  result.figures.edge_factor = factor;
  try {
    StudyStage stage(
        input, store, options,
        {.name = fmt::format("coarse x{}", factor), .edge_factor = factor});
    result.seconds = stage.evaluator().seconds();
    if (stage.failure()) {
      result.figures.message = stage.failure()->message;
      return result;
    }
    stage.conduct();
    result.best = stage.outcome().best;
    result.figures.design = stage.outcome().best;
    result.figures.message = stage.outcome().message;
    result.figures.evaluations =
        count_of_model(store.all(), stage.model_name());
    result.figures.gradients = stage.evaluator().counts().gradients;
    result.seconds = stage.evaluator().seconds();
  } catch (const MeshError& error) {
    result.figures.message = error.what();
  }
  return result;
}

}  // namespace meniscus
