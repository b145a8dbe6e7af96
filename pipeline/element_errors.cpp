#include "pipeline/element_errors.h"

#include <algorithm>
#include <cmath>
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

ResponseError dual_weighted(const EvaluationFields& fields,
                            std::size_t load_case, const VectorX& dual) {
  const auto& materials = fields.inputs.materials;
  const PartStress& primal = fields.stresses[load_case];
  const RecoveredStress stress = recover_by_patches(
      fields.mesh, point_stress(fields.mesh, materials, dual));
  return response_error(fields.mesh, materials,
                        {fields.solution.displacements[load_case],
                         primal.recovered, primal.temperature_change},
                        {dual, stress, {}});
}

/// Sums shares of errors that have different units.
class Shares {
 public:
  explicit Shares(int elements)
      : share_(static_cast<std::size_t>(elements), 0.0) {}

  /// `part(e)`: not negative.
  template <class Part>
  void add(const Part& part) {
    double sum = 0.0;
    for (std::size_t e = 0; e < share_.size(); ++e) {
      sum += part(e);
    }
    if (!(sum > 0.0)) {
      return;
    }
    for (std::size_t e = 0; e < share_.size(); ++e) {
      share_[e] += part(e) / sum;
    }
    ++count_;
  }

  std::vector<double> mean() const {
    std::vector<double> mean = share_;
    for (double& s : mean) {
      s /= std::max(count_, 1);
    }
    return mean;
  }

 private:
  std::vector<double> share_;
  int count_ = 0;
};

bool has_dual_load(const ResponseEntry& response) {
  return response.kind == ResponseKind::MeanDisplacement && !response.weight;
}

/// The elements' part of the error is known: by a dual solution, or 0.
bool is_known(const ResponseEntry& response) {
  switch (response.kind) {
    case ResponseKind::MeanDisplacement:
      return has_dual_load(response);
    case ResponseKind::StrainEnergy:
    case ResponseKind::Mass:
    case ResponseKind::Volume:
    case ResponseKind::CentreOfMass:
    case ResponseKind::FilmArea:
    case ResponseKind::FilmEnergy:
    case ResponseKind::Pressure:
    case ResponseKind::CollapseMargin:
    case ResponseKind::Radius:
      return true;
    default:
      return false;
  }
}

/// Responses that need a dual solution, by load case.
std::vector<std::vector<std::size_t>> duals_needed(const Case& input,
                                                   std::size_t load_cases) {
  std::vector<std::vector<std::size_t>> needed(load_cases);
  for (std::size_t r = 0; r < input.responses.size(); ++r) {
    if (has_dual_load(input.responses[r])) {
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
  const std::vector<PartStress>& primals = fields.stresses;
  Shares shares(fields.mesh.element_count());
  for (std::size_t k = 0; k < load_cases.size(); ++k) {
    errors.energy = std::max(errors.energy, primals[k].error.relative());
    const std::vector<double>& e = primals[k].error.element;
    shares.add([&](std::size_t i) { return e[i] * e[i]; });
  }
  for (std::size_t r = 0; r < input.responses.size(); ++r) {
    const ResponseEntry& response = input.responses[r];
    const auto k = static_cast<std::size_t>(response.load_case);
    double& error = errors.responses[static_cast<Eigen::Index>(r)];
    if (response.kind == ResponseKind::StrainEnergy) {
      error = 0.5 * primals[k].error.error * primals[k].error.error;
    } else if (!is_known(response)) {
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
                                  fields.inputs.responses[r].direction);
        loads[k] = std::move(dual.load);
        force[k] = dual.force;
        any = true;
      }
    }
    if (!any) {
      errors.share = shares.mean();
      return errors;
    }
    const ElasticSolution duals = model.solve(fields.mesh, loads);
    if (duals.failure) {
      errors.failure = duals.failure;
      return errors;
    }
    for (std::size_t k = 0; k < load_cases.size(); ++k) {
      if (round < needed[k].size()) {
        const ResponseError error =
            dual_weighted(fields, k, duals.displacements[k]);
        errors.responses[static_cast<Eigen::Index>(needed[k][round])] =
            error.value / force[k];
        shares.add([&](std::size_t i) { return std::abs(error.element[i]); });
      }
    }
  }
}

}  // namespace meniscus
