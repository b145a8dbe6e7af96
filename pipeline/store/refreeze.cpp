#include "pipeline/store/refreeze.h"

#include <algorithm>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "core/json.h"

namespace meniscus::store {

namespace {

constexpr const char* kRefrozen = "frozen at evaluation ";
// The smallest dihedral angle, over that of the freeze.
constexpr double kFlatter = 0.5;
// Designs are one within this part of the ranges, and near within that.
constexpr double kSame = 1e-3;
constexpr double kNear = 0.25;

/// Largest difference of a variable, x its range.
double distance(const case_data::Case& input, const VectorX& a,
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

double min_dihedral_of(const EvaluationRecord& record) {
  const auto figures = parse_json(record.figures);
  const nlohmann::json::json_pointer at("/tet/min_dihedral_deg");
  return figures.is_object() && figures.contains(at) ? figures[at].get<double>()
                                                     : 0.0;
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
  const auto inverted = std::count_if(
      stage.records.begin(), stage.records.end(),
      [&](const EvaluationRecord& record) {
        return record.model == stage.model && record.failure &&
               record.failure->kind == FailureKind::ElementsInverted &&
               distance(stage.input, record.inputs, best.inputs) <= kNear;
      });
  return stage.converged || inverted == 0
             ? ""
             : fmt::format("{} design{} near the best one invert{} elements",
                           inverted, inverted == 1 ? "" : "s",
                           inverted == 1 ? "s" : "");
}

}  // namespace

std::string refrozen_model(int evaluation) {
  return fmt::format("{}{}", kRefrozen, evaluation);
}

bool is_study_model(const std::string& model) {
  return model == kStudyModel || model.rfind(kRefrozen, 0) == 0;
}

int count_of_model(const std::vector<EvaluationRecord>& records,
                   const std::string& model) {
  return static_cast<int>(std::count_if(
      records.begin(), records.end(),
      [&](const EvaluationRecord& r) { return r.model == model; }));
}

std::string answering_model(const std::vector<EvaluationRecord>& records) {
  const auto last = std::find_if(
      records.rbegin(), records.rend(), [](const EvaluationRecord& record) {
        return !record.failure && is_study_model(record.model);
      });
  return last == records.rend() ? kStudyModel : last->model;
}

case_data::Case frozen_at(case_data::Case input, const VectorX& design) {
  for (std::size_t k = 0; k < input.design.size(); ++k) {
    input.design[k].initial = design[static_cast<Eigen::Index>(k)];
  }
  return input;
}

case_data::Case frozen_as_answered(
    case_data::Case input, const std::vector<EvaluationRecord>& records) {
  const std::string model = answering_model(records);
  const auto at = std::find_if(records.begin(), records.end(),
                               [&](const EvaluationRecord& record) {
                                 return refrozen_model(record.number) == model;
                               });
  return at == records.end() ? input : frozen_at(std::move(input), at->inputs);
}

std::optional<Refreeze> find_refreeze(const FrozenStage& stage) {
  const auto best = std::find_if(stage.records.begin(), stage.records.end(),
                                 [&](const EvaluationRecord& record) {
                                   return record.model == stage.model &&
                                          record.inputs == stage.best;
                                 });
  if (best == stage.records.end() || best->failure ||
      distance(stage.input, stage.best,
               case_data::initial_design(stage.input)) <= kSame) {
    return std::nullopt;
  }
  const std::string reason = reason_at(stage, *best);
  if (reason.empty()) {
    return std::nullopt;
  }
  return Refreeze{.evaluation = best->number,
                  .design = stage.best,
                  .reason = reason,
                  .shift = {}};
}

}  // namespace meniscus::store
