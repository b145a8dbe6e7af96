#include "pipeline/study/own_mesh.h"

#include <algorithm>
#include <array>
#include <optional>

#include <fmt/format.h>

namespace meniscus::study {

namespace {

// An answer that is not kept on a model frozen at it is sought there again, so
// often and this near to it, x the ranges of the variables: another mesh moves
// every figure by its own noise, so that a search without these bounds would
// find another answer on each. The last is within what counts as the same
// design.
constexpr std::array<double, 4> kReaches = {1.0, 0.1, 0.03, 0.009};

OwnMesh point_on_own_mesh(const case_data::Case& input,
                          const VectorX& responses) {
  const std::vector<Constraint> constraints =
      bound_constraints(input, responses);
  return {.first = responses[*input.study.objective],
          .second = responses[*input.study.second],
          .kept = all_kept(constraints)};
}

}  // namespace

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

bool judge_answer(StudyModels& models, const DeadlineMonitor& limited) {
  const case_data::StudyEntry& study = models.input().study;
  if (study.kind == case_data::StudyKind::Pareto) {
    return true;
  }
  for (std::size_t round = 0; models.has_dragged_answer(); ++round) {
    const StudyOutcome found = models.stage()->outcome();
    if (found.ended_by_limit() || limited.expired()) {
      // Of no use yet: with a higher limit the study goes on from its model.
      models.warn(
          "a limit ended the study: its best design was not evaluated on a "
          "mesh of its own");
      return true;
    }
    if (!models.go_on_at_answer()) {
      return false;
    }
    StudyStage& stage = *models.stage();
    stage.judge(found, models.input());
    if (study.kind == case_data::StudyKind::Sweep) {
      return true;  // its designs are given: there is nothing to go on with
    }
    const bool kept = all_kept(stage.outcome().constraints);
    if (all_kept(found.constraints) == kept || !study.refreeze ||
        models.evaluations_left() <= 0 || round >= kReaches.size()) {
      return true;
    }
    models.log(fmt::format("{} on a mesh of its own{}: the study goes on there",
                           kept ? "kept" : "not kept",
                           kept ? ", and not on that before" : ""));
    stage.conduct(StudyStage::Leave::Late, kReaches[round]);
    if (kReaches[round] < 1.0 && !all_kept(stage.outcome().constraints) &&
        models.evaluations_left() > 0) {
      models.log(
          "nothing near it is kept: the whole of the bounds is searched");
      models.limit_evaluations();
      stage.conduct(StudyStage::Leave::Late);
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
