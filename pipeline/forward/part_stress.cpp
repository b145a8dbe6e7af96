#include "pipeline/forward/part_stress.h"

#include "fea/loads/body_loads.h"

namespace meniscus::forward {

std::vector<PartStress> part_stresses(
    const TetMesh& mesh, const case_data::EvaluatedCase& inputs,
    const equations::ElasticSolution& solution) {
  std::vector<PartStress> stresses;
  for (std::size_t k = 0; k < inputs.load_cases.size(); ++k) {
    const VectorX& u = solution.displacements[k];
    PartStress& stress = stresses.emplace_back();
    stress.temperature_change =
        loads::temperature_change(mesh, inputs.load_cases[k]);
    stress.points = element::point_stress(mesh, inputs.materials, u,
                                          stress.temperature_change);
    stress.recovered = stress::recover_by_patches(mesh, stress.points);
    stress.error = stress::estimate_error(
        mesh, inputs.materials,
        {u, stress.recovered, stress.temperature_change});
  }
  return stresses;
}

}  // namespace meniscus::forward
