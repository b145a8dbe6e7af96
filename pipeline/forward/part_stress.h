/// The stresses of an evaluated design with their errors, found once and used
/// by figures, error estimates and files.
#pragma once

#include <vector>

#include "fea/elastic/elasticity.h"
#include "fea/stress/error_estimate.h"
#include "pipeline/case_data/case.h"

namespace meniscus::forward {

/// Of one load case.
struct PartStress {
  VectorX temperature_change;  // per node, or empty
  element::PointStress points;
  stress::RecoveredStress recovered;
  stress::EnergyError error;
};

/// Of every load case, in their order.
std::vector<PartStress> part_stresses(
    const TetMesh& mesh, const case_data::EvaluatedCase& inputs,
    const equations::ElasticSolution& solution);

}  // namespace meniscus::forward
