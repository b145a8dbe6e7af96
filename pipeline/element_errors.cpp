#include "pipeline/element_errors.h"

#include <algorithm>
#include <limits>

#include "fea/body_loads.h"
#include "fea/error_estimate.h"

namespace meniscus {

namespace {

/// The load case's supports under a force spread over the response's surface:
/// the load whose work is the mean displacement times `force`. It is as large
/// as the load case's own, for the solver starts from that one's solution.
struct DualLoad {
  LoadCase load;
  double force = 1.0;
};
DualLoad dual_load(const EvaluationFields& fields, const LoadCase& load_case,
                   const ResponseEntry& response, const Vec3& direction) {
  LoadCase dual = load_case;
  dual.forces = {{response.surface, direction.normalized()}};
  dual.pressures.clear();
  dual.tractions.clear();
  dual.remote_loads.clear();
  dual.gravity.setZero();
  dual.spin.reset();
  dual.temperature.reset();
  dual.nodal.resize(0);
  const auto& materials = fields.inputs.materials;
  const double force = nodal_forces(fields.mesh, load_case, materials).norm() /
                       nodal_forces(fields.mesh, dual, materials).norm();
  dual.forces.front().total *= force;
  return {std::move(dual), force};
}

RecoveredStress recovered(const EvaluationFields& fields, const VectorX& u,
                          const VectorX& temperature) {
  return recover_by_patches(
      fields.mesh,
      point_stress(fields.mesh, fields.inputs.materials, u, temperature));
}

/// A load case's solution with its stresses and its error in energy.
struct Primal {
  VectorX temperature;
  RecoveredStress stress;
  EnergyError energy;
};

Primal primal(const EvaluationFields& fields, std::size_t load_case) {
  const VectorX& u = fields.solution.displacements[load_case];
  Primal result;
  result.temperature =
      temperature_change(fields.mesh, fields.inputs.load_cases[load_case]);
  result.stress = recovered(fields, u, result.temperature);
  result.energy = estimate_error(fields.mesh, fields.inputs.materials,
                                 {u, result.stress, result.temperature});
  return result;
}

double dual_weighted(const EvaluationFields& fields, std::size_t load_case,
                     const Primal& primal, const VectorX& dual) {
  const RecoveredStress stress = recovered(fields, dual, {});
  return response_error(fields.mesh, fields.inputs.materials,
                        {fields.solution.displacements[load_case],
                         primal.stress, primal.temperature},
                        {dual, stress, {}})
      .value;
}

/// Responses that need a dual solution, by load case.
std::vector<std::vector<std::size_t>> duals_needed(const Case& input,
                                                   std::size_t load_cases) {
  std::vector<std::vector<std::size_t>> needed(load_cases);
  for (std::size_t r = 0; r < input.responses.size(); ++r) {
    if (input.responses[r].kind == ResponseKind::MeanDisplacement) {
      needed[static_cast<std::size_t>(input.responses[r].load_case)].push_back(
          r);
    }
  }
  return needed;
}

}  // namespace

ElementErrors estimate_element_errors(const Case& input,
                                      const EvaluationFields& fields,
                                      const ElasticModel& model) {
  const auto& load_cases = fields.inputs.load_cases;
  ElementErrors errors;
  errors.responses =
      VectorX::Zero(static_cast<Eigen::Index>(input.responses.size()));
  std::vector<Primal> primals;
  for (std::size_t k = 0; k < load_cases.size(); ++k) {
    primals.push_back(primal(fields, k));
    errors.energy = std::max(errors.energy, primals[k].energy.relative());
  }
  for (std::size_t r = 0; r < input.responses.size(); ++r) {
    const ResponseEntry& response = input.responses[r];
    const auto k = static_cast<std::size_t>(response.load_case);
    double& error = errors.responses[static_cast<Eigen::Index>(r)];
    if (response.kind == ResponseKind::StrainEnergy) {
      error = 0.5 * primals[k].energy.error * primals[k].energy.error;
    } else if (response.kind == ResponseKind::MaxVonMises) {
      error = std::numeric_limits<double>::quiet_NaN();
    }
  }
  // One dual a load case at a time, all load cases together.
  const auto needed = duals_needed(input, load_cases.size());
  for (std::size_t round = 0;; ++round) {
    std::vector<LoadCase> loads = load_cases;
    std::vector<double> force(load_cases.size(), 1.0);
    bool any = false;
    for (std::size_t k = 0; k < load_cases.size(); ++k) {
      if (round < needed[k].size()) {
        const std::size_t r = needed[k][round];
        DualLoad dual = dual_load(fields, load_cases[k], input.responses[r],
                                  fields.inputs.response_directions[r]);
        loads[k] = std::move(dual.load);
        force[k] = dual.force;
        any = true;
      }
    }
    if (!any) {
      return errors;
    }
    const ElasticSolution duals = model.solve(fields.mesh, loads);
    if (duals.failure) {
      errors.failure = duals.failure;
      return errors;
    }
    for (std::size_t k = 0; k < load_cases.size(); ++k) {
      if (round < needed[k].size()) {
        errors.responses[static_cast<Eigen::Index>(needed[k][round])] =
            dual_weighted(fields, k, primals[k], duals.displacements[k]) /
            force[k];
      }
    }
  }
}

}  // namespace meniscus
