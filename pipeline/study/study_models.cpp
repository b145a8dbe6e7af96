#include "pipeline/study/study_models.h"

#include <algorithm>
#include <map>
#include <set>
#include <utility>

#include <fmt/format.h>

#include "core/error.h"
#include "pipeline/case_films/film_advice.h"
#include "pipeline/case_films/film_start.h"
#include "pipeline/store/incumbent.h"
#include "pipeline/store/stored_case.h"
#include "pipeline/study/held_margins.h"

namespace meniscus::study {

namespace {

// A model frozen this near to a design, x the ranges of the variables, is one
// of that design.
constexpr double kAtDesign = 1e-2;

}  // namespace

StudyModels::StudyModels(const case_data::Case& input, store::StudyStore& store,
                         const StudyOptions& options)
    : input_(input),
      case_(input),
      store_(store),
      options_(options),
      limit_(options.time_limit) {}

std::optional<CoarseFigures> StudyModels::run_coarse() {
  if (!(input_.study.coarse_first > 1.0)) {
    return std::nullopt;
  }
  log("first on a coarser model");
  CoarseStage coarse = run_coarse_stage(input_, store_, options_);
  earlier_seconds_ += coarse.seconds;
  if (coarse.best) {
    options_.start = coarse.best;
  } else {
    warn("the coarser model gave no start: " + coarse.figures.message);
  }
  update_time_limit();
  return std::move(coarse.figures);
}

/// What a stage took is gone for the next.
void StudyModels::update_time_limit() {
  constexpr double kLeast = 1e-3;
  if (limit_ > 0.0) {
    options_.time_limit = std::max(limit_ - timer_.seconds(), kLeast);
  }
}

void StudyModels::freeze() {
  now_.stage = std::make_unique<StudyStage>(case_, store_, options_);
  reference_ = now_.stage->start().responses;
  note_kept();
}

/// Remembers where the stage's model is frozen, if that is the best so far.
void StudyModels::note_kept() {
  if (input_.study.kind != case_data::StudyKind::Minimize ||
      now_.stage->failure()) {
    return;
  }
  const forward::Evaluation& start = now_.stage->start();
  const auto objective = static_cast<Eigen::Index>(*input_.study.objective);
  const auto record = store_.find(now_.stage->model_name(), start.design);
  if (!record ||
      (kept_ && start.responses[objective] >= kept_->at.responses[objective]) ||
      !all_kept(bound_constraints(input_, start.responses))) {
    return;
  }
  kept_ = {.frozen = now_.frozen ? *now_.frozen : case_,
           .at = {.evaluation = record->number,
                  .design = start.design,
                  .reason = "the best design that keeps every bound on a mesh "
                            "of its own",
                  .shift = {},
                  .responses = start.responses}};
}

/// Its totals are all that stays of it.
void StudyModels::end(Model model) {
  if (model.stage != nullptr) {
    earlier_seconds_ += model.stage->evaluator().seconds();
    earlier_gradients_ += model.stage->evaluator().counts().gradients;
    earlier_evaluations_ += model.stage->evaluations();
  }
}

/// A stage on a model frozen there, or null where it cannot be.
std::unique_ptr<StudyStage> StudyModels::stage_at(
    const store::Refreeze& refreeze, const std::string& name,
    const case_data::Case& input) {
  std::unique_ptr<StudyStage> stage;
  std::string reason = what_prevents([&] {
    stage = std::make_unique<StudyStage>(
        input, store_, options_,
        StageModel{.name = name, .reference = reference_});
  });
  lost_film_ = stage != nullptr && stage->failure() &&
               case_films::is_of_films(*stage->failure());
  if (stage != nullptr && !stage->failure()) {
    return stage;
  }
  if (stage != nullptr) {
    earlier_seconds_ += stage->evaluator().seconds();
    reason = stage->failure()->message;
  }
  warn(fmt::format("{}, but no new model can be frozen there: {}",
                   refreeze.reason, reason));
  return nullptr;
}

bool StudyModels::may_refreeze() const {
  const case_data::StudyEntry& study = input_.study;
  return study.refreeze &&
         static_cast<int>(refrozen_.size()) < store::kMostRefreezes &&
         (study.kind == case_data::StudyKind::Match ||
          study.kind == case_data::StudyKind::Minimize);
}

void StudyModels::conduct() {
  conduct_in_reach();
  sweep_rejoined();
  while (search_rejoined()) {
  }
}

/// On the stage's model, and on new ones where it has left the reach of that.
void StudyModels::conduct_in_reach() {
  using Leave = StudyStage::Leave;
  do {
    now_.stage->conduct(may_refreeze() ? Leave::Early : Leave::Late);
  } while (refreeze());
  if (now_.stage->stopped_early()) {
    now_.stage->conduct();
  }
}

/// A sweep whose case asks for pops.
bool StudyModels::pops_on_the_way() const {
  return input_.study.kind == case_data::StudyKind::Sweep &&
         input_.study.refreeze && input_.resolution.pop;
}

void StudyModels::sweep_rejoined() {
  const StudyOutcome& first = now_.stage->outcome();
  if (!pops_on_the_way() || first.sweep->looked_at < first.sweep->designs) {
    return;
  }
  std::vector<store::EvaluationRecord> records =
      now_.stage->evaluator().evaluate_all(now_.stage->swept(), "sweep");
  std::map<std::string, case_data::Case> frozen;  // by model
  std::set<int> tried;
  const auto rejoins = [&](const store::EvaluationRecord& record) {
    return record.failure && record.failure->kind == FailureKind::FilmRejoins &&
           tried.count(record.number) == 0;
  };
  for (int round = 0; round < store::kMostRefreezes; ++round) {
    const auto at = std::find_if(records.begin(), records.end(), rejoins);
    if (at == records.end()) {
      break;
    }
    tried.insert(at->number);
    store::Refreeze wanted{.evaluation = at->number,
                           .design = at->inputs,
                           .reason = "films join in another way there",
                           .shift = {},
                           .responses = {}};
    log(fmt::format("a new model is frozen at evaluation {}: {}",
                    wanted.evaluation, wanted.reason));
    const std::string name = store::rejoined_model(wanted.evaluation);
    const auto before = frozen.find(at->model);
    const case_data::Case input = case_films::frozen_at(
        before == frozen.end() ? case_ : before->second, wanted.design);
    update_time_limit();
    const std::unique_ptr<StudyStage> stage = stage_at(wanted, name, input);
    if (stage == nullptr) {
      continue;
    }
    std::vector<VectorX> designs;
    std::vector<std::size_t> places;
    for (std::size_t k = 0; k < records.size(); ++k) {
      if (rejoins(records[k]) || records[k].inputs == wanted.design) {
        designs.push_back(records[k].inputs);
        places.push_back(k);
      }
    }
    const std::vector<store::EvaluationRecord> found =
        stage->evaluator().evaluate_all(designs, "sweep");
    for (std::size_t k = 0; k < found.size(); ++k) {
      records[places[k]] = found[k];
    }
    earlier_seconds_ += stage->evaluator().seconds();
    frozen.emplace(name, input);
    refrozen_.push_back(std::move(wanted));
  }
  if (!frozen.empty()) {
    take_swept(records, frozen);
  }
}

/// The outcome of a sweep by what several models answered; its best design is
/// put on a model of its own where it is of a later one.
void StudyModels::take_swept(
    const std::vector<store::EvaluationRecord>& records,
    const std::map<std::string, case_data::Case>& frozen) {
  StudyOutcome outcome = now_.stage->sum_up(records);
  const auto best = std::find_if(
      records.begin(), records.end(), [&](const store::EvaluationRecord& r) {
        return !r.failure && r.inputs == outcome.best;
      });
  if (best == records.end() || frozen.count(best->model) == 0) {
    now_.stage->leave(std::move(outcome));
    return;
  }
  if (go_on_at({.evaluation = best->number,
                .design = best->inputs,
                .reason = "the answer on a mesh of its own",
                .shift = {},
                .responses = best->responses},
               frozen.at(best->model))) {
    now_.stage->judge(outcome, input_);
  }
}

bool StudyModels::refreeze() {
  const StudyOutcome& outcome = now_.stage->outcome();
  if (!may_refreeze() || outcome.ended_by_limit() || evaluations_left() <= 0) {
    return false;
  }
  std::optional<store::Refreeze> wanted =
      now_.stage->wanted(outcome.best, outcome.status == RunStatus::Converged);
  return wanted && go_on_at(*std::move(wanted), working());
}

/// A model frozen at a design of one frozen of `from`; its shift is filled in.
std::optional<StudyModels::Model> StudyModels::model_at(
    store::Refreeze& wanted, const case_data::Case& from) {
  log(fmt::format("a new model is frozen at evaluation {}: {}",
                  wanted.evaluation, wanted.reason));
  auto input = std::make_unique<case_data::Case>(
      case_films::frozen_at(from, wanted.design));
  input->study.max_evaluations = std::max(1, evaluations_left());
  input->study.earlier_evaluations =
      input_.study.max_evaluations - input->study.max_evaluations;
  update_time_limit();
  end(std::exchange(before_, {}));
  std::unique_ptr<StudyStage> stage =
      stage_at(wanted, store::refrozen_model(wanted.evaluation), *input);
  if (stage == nullptr) {
    return std::nullopt;
  }
  if (wanted.responses.size() > 0) {  // else that design has failed before
    wanted.shift = stage->start().responses - wanted.responses;
  }
  return Model{.frozen = std::move(input), .stage = std::move(stage)};
}

bool StudyModels::go_on_at(store::Refreeze wanted,
                           const case_data::Case& from) {
  std::optional<Model> next = model_at(wanted, from);
  if (!next) {
    return false;
  }
  Model left = std::exchange(now_, *std::move(next));
  if (holds_margins(working())) {
    before_ = std::move(left);
  } else {
    end(std::move(left));
  }
  options_.start = wanted.go_on_from;
  refrozen_.push_back(std::move(wanted));
  note_kept();
  return true;
}

/// Of a minimum or a match, by what their outcomes have.
bool StudyModels::is_better_than(const Model& other) const {
  const auto record_of = [&](const StudyStage& stage) {
    return store_.find(stage.model_name(), stage.outcome().best);
  };
  const auto own = record_of(*now_.stage);
  const auto others = record_of(*other.stage);
  if (!own || own->failure || !others || others->failure) {
    return own && !own->failure;
  }
  return input_.study.objective
             ? store::is_better(
                   store::merit_of(input_.study, own->responses),
                   store::merit_of(input_.study, others->responses))
             : now_.stage->outcome().objective <
                   other.stage->outcome().objective;
}

bool StudyModels::search_rejoined() {
  const StudyOutcome& outcome = now_.stage->outcome();
  if (!may_refreeze() || !input_.resolution.pop || outcome.ended_by_limit() ||
      evaluations_left() <= 0) {
    return false;
  }
  const std::optional<store::EvaluationRecord> beyond =
      store::rejoined_beside(input_, now_.stage->records(), outcome.best);
  if (!beyond) {
    return false;
  }
  store::Refreeze wanted{
      .evaluation = beyond->number,
      .design = beyond->inputs,
      .reason = "films join in another way there, beside the best design",
      .shift = {},
      .responses = {}};
  std::optional<Model> next = model_at(wanted, working());
  if (!next) {
    return false;
  }
  const int spent = now_.stage->evaluations();
  Model left = std::exchange(now_, *std::move(next));
  earlier_evaluations_ += spent;
  options_.start.reset();
  refrozen_.push_back(std::move(wanted));
  note_kept();
  conduct_in_reach();
  earlier_evaluations_ -= spent;
  if (is_better_than(left)) {
    end(std::move(left));
    return true;
  }
  log("the films that are beyond are no better: the study stays before them");
  end(std::exchange(now_, std::move(left)));
  return false;
}

bool StudyModels::has_dragged_answer() const {
  const case_data::StudyKind kind = input_.study.kind;
  const VectorX& best = now_.stage->outcome().best;
  const bool seeks = kind == case_data::StudyKind::Match ||
                     kind == case_data::StudyKind::Minimize ||
                     kind == case_data::StudyKind::Pareto ||
                     (kind == case_data::StudyKind::Sweep &&
                      input_.study.objective.has_value());
  return seeks && best.size() > 0 && now_.stage->was_answered(best) &&
         store::design_distance(input_, best, now_.stage->start().design) >
             kAtDesign;
}

store::EvaluationRecord StudyModels::answer() const {
  return *store_.find(now_.stage->model_name(), now_.stage->outcome().best);
}

bool StudyModels::go_on_at_answer() {
  const store::EvaluationRecord record = answer();
  return go_on_at({.evaluation = record.number,
                   .design = now_.stage->outcome().best,
                   .reason = "the answer on a mesh of its own",
                   .shift = {},
                   .responses = record.responses},
                  working());
}

bool StudyModels::go_on_at_best_kept() {
  // A copy: what it is kept as may change on the way.
  const std::optional<KeptStart> kept = kept_;
  return kept && go_on_at(kept->at, kept->frozen);
}

std::optional<forward::Evaluation> StudyModels::look_at(
    const VectorX& design, int evaluation, const std::string& reason) {
  const case_data::Case input = case_films::frozen_at(input_, design);
  const std::unique_ptr<StudyStage> stage =
      stage_at({.evaluation = evaluation,
                .design = design,
                .reason = reason,
                .shift = {},
                .responses = {}},
               fmt::format("point of evaluation {}", evaluation), input);
  if (stage == nullptr) {
    return std::nullopt;
  }
  earlier_seconds_ += stage->evaluator().seconds();
  return stage->start();
}

void StudyModels::go_back(const VectorX& design) {
  std::swap(now_, before_);
  options_.start = design;
}

void StudyModels::limit_to_what_is_left(int most) {
  update_time_limit();
  case_data::StudyEntry& study = working().study;
  study.max_evaluations = std::clamp(evaluations_left(), 1, most);
  study.earlier_evaluations =
      input_.study.max_evaluations - study.max_evaluations;
}

void StudyModels::add_to(RunResult& result) const {
  result.warnings.insert(result.warnings.begin(), warnings_.begin(),
                         warnings_.end());
  result.refrozen = refrozen_;
  result.seconds += earlier_seconds_;
  result.gradient_evaluations += earlier_gradients_;
  for (const StudyStage* stage : {before_.stage.get(), now_.stage.get()}) {
    if (stage != nullptr) {
      result.seconds += stage->evaluator().seconds();
      result.gradient_evaluations += stage->evaluator().counts().gradients;
    }
  }
}

}  // namespace meniscus::study
