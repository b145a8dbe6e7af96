#include "pipeline/study/study_stage.h"

#include <algorithm>

#include <fmt/format.h>

#include "pipeline/accuracy/mesh_sequence.h"
#include "pipeline/case_films/film_start.h"
#include "pipeline/store/refreeze.h"
#include "pipeline/store/stored_case.h"
#include "pipeline/study/study_records.h"

namespace meniscus::study {

namespace {

/// The study goes on with another model, from there.
struct EarlyStop {
  VectorX best;
};

}  // namespace

StudyStage::StudyStage(const case_data::Case& input, store::StudyStore& store,
                       const StudyOptions& options, const StageModel& model)
    : input_(input),
      store_(store),
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
  const store::EvaluationRecord record =
      evaluator_.evaluate(case_data::initial_design(input_), "start");
  failure_ = record.failure;
  start_ = to_evaluation(record);
  count(record);
  if (!failure_ && input_.study.fit) {
    evaluator_.set_mismatch(
        [fit = *input_.study.fit](const VectorX& responses) {
          return responses[fit];
        });
  } else if (!failure_ && input_.study.kind == case_data::StudyKind::Match) {
    targets_.emplace(input_, model_.reference.value_or(record.responses));
    evaluator_.set_mismatch([this](const VectorX& responses) {
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

std::optional<store::Refreeze> StudyStage::wanted(const VectorX& best,
                                                  bool converged) const {
  return store::find_refreeze(
      {.input = input_,
       .records = records(),
       .model = model_.name,
       .best = best,
       .min_dihedral_deg = evaluator_.model().frozen().tet.min_dihedral_deg,
       .converged = converged});
}

void StudyStage::count(const store::EvaluationRecord& record) {
  if (std::find(asked_.begin(), asked_.end(), record.number) == asked_.end()) {
    asked_.push_back(record.number);
  }
}

/// Ends the study after so many designs beyond the model's reach, as soon as
/// there is a design to freeze another model at.
void StudyStage::stop_if_beyond(const store::EvaluationRecord& record) {
  if (!record.failure) {
    return;
  }
  const VectorX best =
      store::best_record(input_, records(), model_.name).inputs;
  beyond_ += store::is_beyond_reach(input_, record, best) ? 1 : 0;
  if (beyond_ < store::kMostBeyond) {
    return;
  }
  if (wanted(best, false)) {
    throw EarlyStop{best};
  }
}

void StudyStage::conduct(Leave leave, double reach) {
  const VectorX start = begin();
  evaluator_.reset_counts();  // the kinds of study ask for the start again
  left_early_ = false;
  beyond_ = 0;
  evaluator_.set_observer([this, leave](const store::EvaluationRecord& record) {
    count(record);
    if (leave == Leave::Early) {
      stop_if_beyond(record);
    }
  });
  try {
    outcome_ = meniscus::study::conduct({.input = input_,
                                         .evaluator = evaluator_,
                                         .options = options_,
                                         .targets = targets(),
                                         .start = start,
                                         .reach = reach});
  } catch (const EarlyStop& left) {
    left_early_ = true;
    outcome_ = {.status = RunStatus::Infeasible,
                .message = "the study left the reach of its frozen mesh",
                .best = left.best};
  }
  evaluator_.set_observer({});
}

std::vector<VectorX> StudyStage::swept() const {
  return designs_of_sweep(input_, start_.design);
}

StudyOutcome StudyStage::sum_up(
    const std::vector<store::EvaluationRecord>& records) {
  return outcome_of_sweep({.input = input_,
                           .evaluator = evaluator_,
                           .options = options_,
                           .start = start_.design},
                          static_cast<int>(records.size()), records);
}

void StudyStage::leave(StudyOutcome outcome) {
  evaluator_.set_observer({});
  outcome_ = std::move(outcome);
}

void StudyStage::judge(const StudyOutcome& found,
                       const case_data::Case& asked) {
  outcome_ = found;
  outcome_.best = start_.design;
  outcome_.constraints =
      input_.study.kind == case_data::StudyKind::Match
          ? match_constraints(input_, targets(), start_.responses)
          : bound_constraints(asked, start_.responses);
  if (input_.study.kind == case_data::StudyKind::Match) {
    if (targets() != nullptr) {
      outcome_.objective =
          0.5 * targets()->residuals(start_.responses).squaredNorm();
    }
  } else {
    outcome_.objective = start_.responses[*input_.study.objective];
    const ShownUnit shown =
        case_data::shown_unit(input_, *input_.study.objective);
    outcome_.message +=
        fmt::format(". On a mesh made for it: {} {}",
                    input_.responses[*input_.study.objective].name,
                    shown.text(outcome_.objective));
  }
  if (const std::string misses = missed_bounds(asked, outcome_.constraints);
      !misses.empty()) {
    outcome_.message += fmt::format(
        ". On a mesh made for this design it is not kept: {}", misses);
    if (outcome_.status == RunStatus::Converged) {
      outcome_.status = RunStatus::Infeasible;
    }
  }
}

CoarseStage run_coarse_stage(const case_data::Case& input,
                             store::StudyStore& store,
                             const StudyOptions& options) {
  const double factor = input.study.coarse_first;
  CoarseStage result;
  result.figures.edge_factor = factor;
  const std::string name = fmt::format("coarse x{}", factor);
  const std::string prevented = what_prevents([&] {
    case_data::Case working = input;
    StudyOptions asked = options;
    std::optional<VectorX> reference;
    // Each round on a mesh of the last one's best design, which many of its
    // designs have left the reach of.
    for (int round = 0;; ++round) {
      StudyStage stage(
          working, store, asked,
          {.name = round == 0 ? name : fmt::format("{} ({})", name, round + 1),
           .edge_factor = factor,
           .reference = reference});
      if (stage.failure()) {
        result.seconds += stage.evaluator().seconds();
        result.figures.message =
            result.best ? result.figures.message : stage.failure()->message;
        return;
      }
      const bool last = !input.study.refreeze || round == store::kMostRefreezes;
      stage.conduct(last ? StudyStage::Leave::Late : StudyStage::Leave::Early);
      // A mesh made where it began would be the same.
      if (stage.stopped_early() &&
          stage.outcome().best == stage.start().design) {
        stage.conduct(StudyStage::Leave::Late);
      }
      const int evaluations =
          store::count_of_model(store.all(), stage.model_name());
      result.seconds += stage.evaluator().seconds();
      result.best = stage.outcome().best;
      result.figures.design = stage.outcome().best;
      result.figures.message = stage.outcome().message;
      result.figures.evaluations += evaluations;
      result.figures.gradients += stage.evaluator().counts().gradients;
      if (!stage.stopped_early()) {
        return;
      }
      working = case_films::frozen_at(std::move(working), *result.best);
      working.study.max_evaluations =
          std::max(1, working.study.max_evaluations - evaluations);
      asked.start.reset();
      if (round == 0) {
        reference = stage.start().responses;
      }
    }
  });
  if (!prevented.empty()) {
    result.figures.message = prevented;
  }
  return result;
}

}  // namespace meniscus::study
