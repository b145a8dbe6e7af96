#include "pipeline/store/incumbent.h"

#include <algorithm>
#include <cmath>

#include "optimize/minimize.h"

namespace meniscus::store {

double violation_of(const case_data::ConstraintEntry& constraint,
                    double value) {
  double scale = 0.0;
  for (const double bound : {constraint.lower, constraint.upper}) {
    if (std::isfinite(bound)) {
      scale = std::max(scale, std::abs(bound));
    }
  }
  const double off =
      std::max({constraint.lower - value, value - constraint.upper, 0.0});
  return off / (scale > 0.0 ? scale : 1.0);
}

Merit merit_of(const case_data::StudyEntry& study, const VectorX& responses) {
  Merit standing{.objective = responses[*study.objective]};
  for (const case_data::ConstraintEntry& constraint : study.constraints) {
    const double off = violation_of(constraint, responses[constraint.response]);
    if (off > standing.violation) {
      standing.violation = off;
      standing.worst = constraint.response;
    }
  }
  return standing;
}

bool is_better(const Merit& a, const Merit& b) {
  if (a.feasible() != b.feasible()) {
    return a.feasible();
  }
  return a.feasible() ? optimize::kept_objective(a.objective, a.violation) <
                            optimize::kept_objective(b.objective, b.violation)
                      : a.violation < b.violation;
}

const EvaluationRecord* best_by_objective(
    const case_data::StudyEntry& study,
    const std::vector<EvaluationRecord>& records, const std::string& model) {
  const EvaluationRecord* best = nullptr;
  Merit standing;
  for (const EvaluationRecord& record : records) {
    if (record.failure || record.model != model) {
      continue;
    }
    const Merit other = merit_of(study, record.responses);
    if (best == nullptr || is_better(other, standing)) {
      best = &record;
      standing = other;
    }
  }
  return best;
}

}  // namespace meniscus::store
