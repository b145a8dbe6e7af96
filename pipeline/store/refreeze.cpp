#include "pipeline/store/refreeze.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <set>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "core/json.h"
#include "pipeline/case_films/film_start.h"

namespace meniscus::store {

namespace {

constexpr const char* kRefrozen = "frozen at evaluation ";
constexpr const char* kRejoined = "joined at evaluation ";
// The smallest dihedral angle, over that of the freeze.
constexpr double kFlatter = 0.5;
// Designs are one within this part of the ranges, and near within that.
constexpr double kSame = 1e-3;
constexpr double kNear = 0.25;
constexpr double kClose = 0.02;

double min_dihedral_of(const EvaluationRecord& record) {
  const auto figures = parse_json(record.figures);
  const nlohmann::json::json_pointer at("/tet/min_dihedral_deg");
  return figures.is_object() && figures.contains(at) ? figures[at].get<double>()
                                                     : 0.0;
}

/// The designs that were beyond the reach of the stage's model.
std::vector<const EvaluationRecord*> beyond_of(const FrozenStage& stage) {
  std::vector<const EvaluationRecord*> beyond;
  for (const EvaluationRecord& record : stage.records) {
    if (record.model == stage.model &&
        is_beyond_reach(stage.input, record, stage.best)) {
      beyond.push_back(&record);
    }
  }
  return beyond;
}

/// What they do, said of `count` of them.
std::string beyond_text(const std::vector<const EvaluationRecord*>& beyond,
                        std::ptrdiff_t count) {
  const bool all_invert = std::all_of(
      beyond.begin(), beyond.end(), [](const EvaluationRecord* record) {
        return record->failure->kind == FailureKind::ElementsInverted;
      });
  const char* one = count == 1 ? "s" : "";
  return all_invert ? fmt::format("invert{} elements", one)
                    : fmt::format("fail{} on its model", one);
}

/// Why the model no longer serves at `best`; empty: it does.
std::string reason_at(const FrozenStage& stage, const EvaluationRecord& best) {
  const double angle = min_dihedral_of(best);
  if (angle < kFlatter * stage.min_dihedral_deg) {
    return fmt::format(
        "the smallest dihedral angle of the best design is {:.1f} degrees, "
        "that of the frozen mesh {:.1f}",
        angle, stage.min_dihedral_deg);
  }
  const std::vector<const EvaluationRecord*> beyond = beyond_of(stage);
  const auto near = std::count_if(
      beyond.begin(), beyond.end(), [&](const EvaluationRecord* record) {
        return design_distance(stage.input, record->inputs, best.inputs) <=
               kNear;
      });
  if (stage.converged || beyond.empty()) {
    return "";
  }
  if (near > 0) {
    return fmt::format("{} design{} near the best one {}", near,
                       near == 1 ? "" : "s", beyond_text(beyond, near));
  }
  return std::ssize(beyond) >= kMostBeyond
             ? fmt::format("{} designs {}", beyond.size(),
                           beyond_text(beyond, std::ssize(beyond)))
             : "";
}

/// Of the designs that answered off the freeze, the one nearest to one that
/// was beyond reach: from there the search can go on towards it.
const EvaluationRecord* nearest_to_beyond(const FrozenStage& stage) {
  const VectorX frozen = case_data::initial_design(stage.input);
  const EvaluationRecord* nearest = nullptr;
  double least = std::numeric_limits<double>::infinity();
  for (const EvaluationRecord& record : stage.records) {
    if (record.failure || record.model != stage.model ||
        design_distance(stage.input, record.inputs, frozen) <= kSame) {
      continue;
    }
    for (const EvaluationRecord* beyond : beyond_of(stage)) {
      const double distance =
          design_distance(stage.input, record.inputs, beyond->inputs);
      if (distance < least) {
        least = distance;
        nearest = &record;
      }
    }
  }
  return nearest;
}

}  // namespace

std::string refrozen_model(int evaluation) {
  return fmt::format("{}{}", kRefrozen, evaluation);
}

std::string rejoined_model(int evaluation) {
  return fmt::format("{}{}", kRejoined, evaluation);
}

bool is_study_model(const std::string& model) {
  return model == kStudyModel || model.rfind(kRefrozen, 0) == 0 ||
         model.rfind(kRejoined, 0) == 0;
}

bool is_beyond_reach(const case_data::Case& input,
                     const EvaluationRecord& record, const VectorX& best) {
  if (!record.failure) {
    return false;
  }
  const FailureKind kind = record.failure->kind;
  // Iterations have the factor of the freeze's stiffness, facets the shape and
  // fillets the bands that they have there: all fail far from it.
  return kind == FailureKind::ElementsInverted ||
         kind == FailureKind::SurfaceInvalid ||
         kind == FailureKind::SolverFailed ||
         (kind == FailureKind::FilmNotFound &&
          design_distance(input, record.inputs, best) <= kClose);
}

int count_of_model(const std::vector<EvaluationRecord>& records,
                   const std::string& model) {
  return static_cast<int>(std::count_if(
      records.begin(), records.end(),
      [&](const EvaluationRecord& r) { return r.model == model; }));
}

std::string answering_model(const std::vector<EvaluationRecord>& records,
                            const std::optional<VectorX>& answer) {
  // A sweep that grows adds designs to its first model after the best of the
  // shorter one had its own: it is the last to begin that counts. A study that
  // goes on later may come back to a model before that.
  std::vector<std::string> begun = {kStudyModel};
  std::set<std::string> knowing;
  for (const EvaluationRecord& record : records) {
    if (record.failure || !is_study_model(record.model) ||
        record.model.rfind(kRejoined, 0) == 0) {
      continue;
    }
    if (std::find(begun.begin(), begun.end(), record.model) == begun.end()) {
      begun.push_back(record.model);
    }
    if (!answer || record.inputs == *answer) {
      knowing.insert(record.model);
    }
  }
  const auto last = std::find_if(
      begun.rbegin(), begun.rend(),
      [&](const std::string& model) { return knowing.count(model) > 0; });
  return last != begun.rend() ? *last : kStudyModel;
}

double design_distance(const case_data::Case& input, const VectorX& a,
                       const VectorX& b) {
  double largest = 0.0;
  for (std::size_t k = 0; k < input.design.size(); ++k) {
    const case_data::DesignVariable& v = input.design[k];
    const auto j = static_cast<Eigen::Index>(k);
    if (v.upper > v.lower) {
      largest = std::max(largest, std::abs(a[j] - b[j]) / (v.upper - v.lower));
    }
  }
  return largest;
}

case_data::Case frozen_as_answered(case_data::Case input,
                                   const std::vector<EvaluationRecord>& records,
                                   const VectorX& answer) {
  // Back from the last model to the first: each names the design that it is
  // frozen at, whose record names the model before.
  std::vector<VectorX> way;
  std::string model = answering_model(records, answer);
  while (model != kStudyModel) {
    const auto at = std::find_if(
        records.begin(), records.end(), [&](const EvaluationRecord& record) {
          return refrozen_model(record.number) == model ||
                 rejoined_model(record.number) == model;
        });
    if (at == records.end()) {
      return input;
    }
    way.push_back(at->inputs);
    model = at->model;
  }
  for (auto design = way.rbegin(); design != way.rend(); ++design) {
    input = case_films::frozen_at(std::move(input), *design);
  }
  return input;
}

std::optional<EvaluationRecord> rejoined_beside(
    const case_data::Case& input, const std::vector<EvaluationRecord>& records,
    const VectorX& best) {
  std::optional<EvaluationRecord> nearest;
  double least = kNear;
  for (const EvaluationRecord& record : records) {
    const double distance = design_distance(input, record.inputs, best);
    if (record.failure && record.failure->kind == FailureKind::FilmRejoins &&
        distance < least) {
      nearest = record;
      least = distance;
    }
  }
  return nearest;
}

std::optional<Refreeze> find_refreeze(const FrozenStage& stage) {
  const auto best = std::find_if(stage.records.begin(), stage.records.end(),
                                 [&](const EvaluationRecord& record) {
                                   return record.model == stage.model &&
                                          record.inputs == stage.best;
                                 });
  if (best == stage.records.end() || best->failure) {
    return std::nullopt;
  }
  const std::string reason = reason_at(stage, *best);
  if (reason.empty()) {
    return std::nullopt;
  }
  Refreeze result{.evaluation = best->number,
                  .design = stage.best,
                  .reason = reason,
                  .shift = {},
                  .responses = best->responses};
  if (design_distance(stage.input, stage.best,
                      case_data::initial_design(stage.input)) <= kSame) {
    const EvaluationRecord* there = nearest_to_beyond(stage);
    if (there == nullptr) {
      return std::nullopt;
    }
    result.evaluation = there->number;
    result.design = there->inputs;
    result.responses = there->responses;
    result.go_on_from = stage.best;
  }
  return result;
}

}  // namespace meniscus::store
