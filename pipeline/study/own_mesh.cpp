#include "pipeline/study/own_mesh.h"

#include <algorithm>
#include <array>
#include <functional>
#include <optional>

#include <fmt/format.h>

#include "pipeline/accuracy/doubted_margins.h"
#include "pipeline/store/incumbent.h"
#include "pipeline/study/held_margins.h"

namespace meniscus::study {

namespace {

// An answer that is not kept on a model frozen at it is sought there again, so
// often and this near to it, x the ranges of the variables: another mesh moves
// every figure by its own noise, so that a search without these bounds would
// find another answer on each. The last is within what counts as the same
// design; it is tried some times more, for where nothing so near is kept the
// whole of the bounds is searched and may end elsewhere.
constexpr std::array<double, 6> kReaches = {1.0,   0.1,   0.03,
                                            0.009, 0.009, 0.009};

// Where a margin is missed on the answer's own mesh, so many evaluations there
// may find it before it is sought on the model before: above its bound by so
// much of what that model has too much of it, and this near to the answer, x
// the ranges.
constexpr int kFewEvaluations = 40;
constexpr double kExcess = 1.1;
constexpr double kReturnReach = 0.3;

// A minimum that misses its bounds by less on its own mesh (incumbent.h) is the
// answer all the same: two meshes differ by that.
constexpr double kSlightMiss = 0.01;

OwnMesh point_on_own_mesh(const case_data::Case& input,
                          const VectorX& responses) {
  const std::vector<Constraint> constraints =
      bound_constraints(input, responses);
  return {.first = responses[*input.study.objective],
          .second = responses[*input.study.second],
          .kept = all_kept(constraints)};
}

/// Of a study that holds margins to collapse: it misses nothing else.
bool misses_margins_only(const case_data::Case& input,
                         const std::vector<Constraint>& constraints) {
  if (!holds_margins(input)) {
    return false;
  }
  const auto& entries = input.study.constraints;
  for (std::size_t k = 0; k < constraints.size(); ++k) {
    if (!constraints[k].satisfied &&
        !accuracy::holds_margin(input, entries[k])) {
      return false;
    }
  }
  return true;
}

/// What was sought above raised bounds is judged by those that count.
StudyOutcome judged_by(const case_data::Case& input, StudyOutcome found,
                       const VectorX& responses) {
  found.constraints = bound_constraints(input, responses);
  if (found.status == RunStatus::Infeasible && all_kept(found.constraints)) {
    found.status = RunStatus::Stopped;
    found.unproven = true;
  }
  return found;
}

/// Seeks an answer that near to where the stage starts; beyond the reach of its
/// mesh on new models, from there.
void search_near(StudyModels& models, double reach) {
  using Leave = StudyStage::Leave;
  models.stage()->conduct(models.may_refreeze() ? Leave::Early : Leave::Late,
                          reach);
  if (!models.stage()->stopped_early()) {
    return;
  }
  if (models.refreeze()) {
    models.conduct();
  } else {
    models.stage()->conduct(Leave::Late, reach);
  }
}

/// True where the stage is now another's, with another answer.
bool seek_on_model_before(StudyModels& models) {
  const forward::Evaluation own = models.stage()->start();
  const auto bounds = models.working().study.constraints;
  models.go_back(own.design);
  const auto there =
      models.store().find(models.stage()->model_name(), own.design);
  if (!there || there->failure) {
    models.go_back(own.design);
    return false;
  }
  models.log(
      "no design found on the answer's own mesh keeps its margin: it is sought "
      "on the model before, above its bound by what that has too much of it");
  case_data::Case& working = models.working();
  working.study.constraints = bounds;
  for (case_data::ConstraintEntry& entry : working.study.constraints) {
    if (accuracy::holds_margin(working, entry) && entry.lower > 0.0) {
      entry.lower += kExcess * std::max(0.0, there->responses[entry.response] -
                                                 own.responses[entry.response]);
    }
  }
  models.limit_to_what_is_left();
  models.stage()->conduct(models.may_refreeze() ? StudyStage::Leave::Early
                                                : StudyStage::Leave::Late,
                          kReturnReach);
  working.study.constraints = bounds;
  if (models.stage()->stopped_early() && models.refreeze()) {
    models.conduct();  // beyond the reach of the model before
    return true;
  }
  const StudyOutcome& found = models.stage()->outcome();
  if (found.best.size() == 0 || found.best == own.design ||
      !models.stage()->was_answered(found.best)) {
    models.go_back(own.design);
    return false;
  }
  models.stage()->leave(judged_by(working, found, models.answer().responses));
  return true;
}

}  // namespace

bool search_again(StudyModels& models, const std::function<void()>& search) {
  const bool may_return =
      models.may_go_back() &&
      misses_margins_only(models.working(),
                          bound_constraints(models.working(),
                                            models.stage()->start().responses));
  models.limit_to_what_is_left(may_return ? kFewEvaluations
                                          : StudyModels::kNoLimit);
  search();
  if (!may_return) {
    return false;
  }
  const StudyOutcome& found = models.stage()->outcome();
  if (!all_kept(found.constraints) && seek_on_model_before(models)) {
    return true;
  }
  if (found.ended_by_limit() && models.evaluations_left() > 0) {
    models.start_at(found.best);
    models.limit_to_what_is_left();
    search();
  }
  return false;
}

bool return_to_kept(StudyModels& models) {
  const std::optional<int> best = models.best_kept();
  const StudyOutcome& found = models.stage()->outcome();
  if (!best || found.best.size() == 0 || models.has_dragged_answer()) {
    return false;
  }
  // By the bounds of the case: those of the search may have been raised.
  const VectorX responses = models.answer().responses;
  if (store::merit_of(models.input().study, responses).violation <
      kSlightMiss) {
    return false;
  }
  const std::string missed = missed_bounds(
      models.input(), bound_constraints(models.input(), responses));
  const bool limited = found.ended_by_limit();
  if (!models.go_on_at_best_kept()) {
    return false;
  }
  models.stage()->judge(
      {.status = RunStatus::Stopped,
       .message = fmt::format(
           "the design that {} ended at is not kept on a mesh made for it: "
           "{}; of the designs that keep every bound on meshes of their own "
           "that of evaluation {} is the best",
           limited ? "a limit of the search" : "the search", missed, *best),
       .best = {},
       .unproven = true},
      models.input());
  return true;
}

StudyOutcome without_own_mesh(StudyOutcome found) {
  if (found.status == RunStatus::Converged) {
    found.status = RunStatus::Stopped;
  }
  found.message +=
      ". No mesh can be made at this design, so that nothing proves its "
      "figures: they are those of a mesh that followed it there. Narrow the "
      "bounds, or add a constraint that keeps away from it";
  return found;
}

bool judge_answer(StudyModels& models, const DeadlineMonitor& limited,
                  const std::function<void()>& hold_margins) {
  const case_data::StudyEntry& study = models.input().study;
  if (study.kind == case_data::StudyKind::Pareto) {
    return true;
  }
  std::size_t round = 0;
  while (models.has_dragged_answer()) {
    const StudyOutcome found = models.stage()->outcome();
    if (limited.expired()) {
      models.warn(
          "the time ended the study: its best design was not evaluated on a "
          "mesh of its own");
      return true;
    }
    if (!models.go_on_at_answer()) {
      return false;
    }
    models.stage()->judge(found, models.input());
    if (study.kind == case_data::StudyKind::Sweep || found.ended_by_limit()) {
      return true;  // nothing goes on: its designs are given, or used up
    }
    const bool kept = all_kept(models.stage()->outcome().constraints);
    if (all_kept(found.constraints) == kept || !study.refreeze ||
        models.evaluations_left() <= 0 || round >= kReaches.size()) {
      return true;
    }
    models.log(fmt::format("{} on a mesh of its own{}: the study goes on there",
                           kept ? "kept" : "not kept",
                           kept ? ", and not on that before" : ""));
    hold_margins();
    const double reach = kReaches[round++];
    if (search_again(models, [&] { search_near(models, reach); })) {
      continue;
    }
    if (reach < 1.0 && !all_kept(models.stage()->outcome().constraints) &&
        models.evaluations_left() > 0) {
      models.log(
          "nothing near it is kept: the whole of the bounds is searched");
      models.limit_to_what_is_left();
      search_near(models, 1.0);
    }
  }
  return true;
}

std::vector<std::string> judge_front(StudyModels& models,
                                     const DeadlineMonitor& limited) {
  StudyOutcome found = models.stage()->outcome();
  std::vector<std::string> left_out;
  if (!found.front || found.best.size() == 0) {
    return left_out;
  }
  const auto look = [&](FrontPoint& point, const VectorX& responses) {
    point.own_mesh = point_on_own_mesh(models.input(), responses);
  };
  for (FrontPoint& point : found.front->points) {
    const std::optional<store::EvaluationRecord> record =
        models.store().find(models.stage()->model_name(), point.design);
    if (!record || limited.expired()) {
      left_out.emplace_back("a point of the front on a mesh of its own");
      continue;
    }
    if (point.design == found.best) {
      continue;
    }
    if (const auto start =
            models.look_at(point.design, record->number,
                           "a point of the front, on a mesh of its own")) {
      look(point, start->responses);
    }
  }
  if (!models.has_dragged_answer()) {
    return left_out;
  }
  if (models.go_on_at_answer()) {
    for (FrontPoint& point : found.front->points) {
      if (point.design == found.best) {
        look(point, models.stage()->start().responses);
      }
    }
    models.stage()->judge(found, models.input());
  } else {
    models.stage()->leave(without_own_mesh(std::move(found)));
  }
  return left_out;
}

}  // namespace meniscus::study
