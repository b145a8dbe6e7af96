#include "pipeline/study/progress_tracker.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "pipeline/case_data/study_kinds.h"
#include "pipeline/store/incumbent.h"

namespace meniscus::study {

namespace {

/// Evaluations that the study asks for at most, where that is known.
std::optional<int> planned_of(const case_data::Case& input) {
  const auto planned = case_data::row_of(input.study.kind).planned;
  return planned == nullptr ? std::nullopt
                            : std::optional<int>(planned(input.study));
}

}  // namespace

std::string duration_text(double seconds) {
  const auto whole = static_cast<long>(std::ceil(seconds));
  if (whole < 100) {
    return fmt::format("{} s", whole);
  }
  return whole < 6000 ? fmt::format("{} min", (whole + 59) / 60)
                      : fmt::format("{} h", (whole + 3599) / 3600);
}

ProgressTracker::ProgressTracker(const case_data::Case& input,
                                 std::string model, double time_limit)
    : input_(input),
      model_(std::move(model)),
      time_limit_(time_limit),
      planned_(planned_of(input)) {}

DesignStatus ProgressTracker::merit_of(
    const store::EvaluationRecord& record) const {
  DesignStatus standing{.evaluation = record.number};
  if (record.failure) {
    return standing;
  }
  const case_data::StudyEntry& study = input_.study;
  if (study.kind == case_data::StudyKind::Match) {
    standing.objective = record.mismatch;
  } else if (study.objective) {
    const store::Merit found =
        meniscus::store::merit_of(study, record.responses);
    standing.objective = found.objective;
    if (!study.constraints.empty()) {
      standing.violation = found.violation;
      if (found.worst >= 0) {
        standing.worst =
            input_.responses[static_cast<std::size_t>(found.worst)].name;
      }
    }
  }
  return standing;
}

bool ProgressTracker::better(const DesignStatus& a,
                             const DesignStatus& b) const {
  return store::is_better(
      {.violation = a.violation.value_or(0.0), .objective = *a.objective},
      {.violation = b.violation.value_or(0.0), .objective = *b.objective});
}

void ProgressTracker::add(const store::EvaluationRecord& record) {
  if (record.model != model_) {
    return;
  }
  ++evaluations_;
  failed_ += record.failure ? 1 : 0;
  const DesignStatus standing = merit_of(record);
  if (standing.objective && (!best_ || better(standing, *best_))) {
    best_ = standing;
  }
}

EvaluationEvent ProgressTracker::add_new(
    const store::EvaluationRecord& record) {
  add(record);
  if (++timed_ == 1) {
    first_ = timer_.seconds();
  }
  return event(record);
}

EvaluationEvent ProgressTracker::event(
    const store::EvaluationRecord& record) const {
  EvaluationEvent event;
  event.record = &record;
  event.status = merit_of(record);
  event.best = best_;
  if (const std::optional<int>& fit = input_.study.fit) {
    event.objective_name =
        input_.responses[static_cast<std::size_t>(*fit)].name;
    event.objective_shown = case_data::shown_unit(input_, *fit);
  } else if (input_.study.kind == case_data::StudyKind::Match) {
    event.objective_name = "mismatch";
  } else if (input_.study.objective) {
    const int response = *input_.study.objective;
    event.objective_name =
        input_.responses[static_cast<std::size_t>(response)].name;
    event.objective_shown = case_data::shown_unit(input_, response);
  }
  event.evaluations = evaluations_;
  event.failed = failed_;
  event.planned = planned_;
  event.elapsed = timer_.seconds();
  event.left = time_left();
  return event;
}

std::optional<double> ProgressTracker::time_left() const {
  const double now = timer_.seconds();
  std::optional<double> left;
  if (planned_ && timed_ > 0) {
    const double each = timed_ > 1 ? (now - first_) / (timed_ - 1) : now;
    left = each * std::max(*planned_ - evaluations_, 0);
  }
  if (time_limit_ > 0.0) {
    const double limit = std::max(time_limit_ - now, 0.0);
    left = left ? std::min(*left, limit) : limit;
  }
  return left;
}

std::string progress_text(const EvaluationEvent& event) {
  std::string text;
  const auto add = [&](const std::string& part) {
    text += (text.empty() ? "" : ", ") + part;
  };
  if (event.status.violation) {
    add(*event.status.violation <= store::kFeasible
            ? "keeps all constraints"
            : fmt::format("violation {:.2g} of '{}'", *event.status.violation,
                          event.status.worst));
  }
  if (event.best && event.best->evaluation != event.status.evaluation) {
    const bool kept = event.best->violation.value_or(0.0) <= store::kFeasible;
    add(fmt::format(
        "best so far {} = {}{} (evaluation {})", event.objective_name,
        event.objective_shown.text(*event.best->objective),
        kept ? ""
             : fmt::format(" with violation {:.2g} of '{}'",
                           *event.best->violation, event.best->worst),
        event.best->evaluation));
  } else if (event.best) {
    add("the best so far");
  }
  if (event.left && *event.left > 0.0) {
    // New models and meshes beside them come on top of what is planned.
    add(fmt::format("at most {} left on this model",
                    duration_text(*event.left)));
  }
  return text;
}

}  // namespace meniscus::study
