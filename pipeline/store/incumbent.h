/// Which of two designs a study prefers, where it has an objective.
#pragma once

#include <string>
#include <vector>

#include "core/types.h"
#include "pipeline/case_data/case.h"
#include "pipeline/store/study_store.h"

namespace meniscus::store {

/// Violation that still counts as kept, x the constraint's scale: the larger
/// magnitude of its bounds, 1 where that is 0.
inline constexpr double kFeasible = 1e-6;

/// What a response is off its bounds, in scales; 0 when within.
double violation_of(const case_data::ConstraintEntry& constraint, double value);

struct Merit {
  double violation = 0.0;  // the largest of all constraints
  double objective = 0.0;
  int worst = -1;  // response of that constraint; -1: all are kept

  bool feasible() const { return violation <= kFeasible; }
};

/// Of a study with an objective; `responses` of all, in the case's order.
Merit merit_of(const case_data::StudyEntry& study, const VectorX& responses);

/// The optimizer's order: among designs that keep every constraint the lower
/// optimize::kept_objective(), else the smaller violation; a design that keeps
/// all goes before one that does not.
bool is_better(const Merit& a, const Merit& b);

/// The first of the best records of `model` by objective and constraints, or
/// null when all failed. `records` must be of a study with an objective.
const EvaluationRecord* best_by_objective(
    const case_data::StudyEntry& study,
    const std::vector<EvaluationRecord>& records, const std::string& model);

}  // namespace meniscus::store
