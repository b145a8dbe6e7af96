#include "pipeline/part_warnings.h"

#include <algorithm>

#include <fmt/format.h>

#include "fea/body_loads.h"
#include "fea/safety_factor.h"

namespace meniscus {

namespace {

// Beyond this part of the part's size, rotations are no longer small.
constexpr double kLargeDisplacement = 0.05;

/// The least safety factor of the part under a load case.
SafetyFactors weakest(const EvaluationFields& fields, std::size_t load_case) {
  const auto& materials = fields.inputs.materials;
  const VectorX& u = fields.solution.displacements[load_case];
  const VectorX heat =
      temperature_change(fields.mesh, fields.inputs.load_cases[load_case]);
  return safety_factors(
      fields.mesh, materials,
      recover_by_patches(fields.mesh,
                         point_stress(fields.mesh, materials, u, heat)));
}

double largest_displacement(const VectorX& u) {
  double largest = 0.0;
  for (Eigen::Index k = 0; k + 2 < u.size(); k += 3) {
    largest = std::max(largest, u.segment<3>(k).norm());
  }
  return largest;
}

}  // namespace

std::vector<std::string> part_warnings(const Case& input,
                                       const EvaluationFields& fields) {
  std::vector<std::string> warnings;
  const auto& materials = fields.inputs.materials;
  const bool may_yield = std::any_of(
      materials.begin(), materials.end(),
      [](const Material& m) { return m.yield_strength.has_value(); });
  const double size = bounding_diagonal(fields.mesh.nodes);
  for (std::size_t k = 0; k < fields.inputs.load_cases.size(); ++k) {
    const std::string& name = fields.inputs.load_cases[k].name;
    const VectorX& u = fields.solution.displacements[k];
    const SafetyFactors safety =
        may_yield ? weakest(fields, k) : SafetyFactors{.smallest = 1.0};
    if (safety.smallest < 1.0) {
      const Vec3& x = fields.mesh.nodes[static_cast<std::size_t>(safety.node)];
      const Material& material =
          materials[static_cast<std::size_t>(safety.region)];
      warnings.push_back(fmt::format(
          "stress above yield: load case '{}' reaches {:.4g} {} at ({:.4g}, "
          "{:.4g}, {:.4g}), '{}' yields at {:.4g} {} (safety factor {:.3g}); a "
          "linear analysis does not hold there (at a clamped edge the value "
          "grows with every refinement)",
          name, safety.von_mises, input.units.pressure, x.x(), x.y(), x.z(),
          material.name, *material.yield_strength, input.units.pressure,
          safety.smallest));
    }
    const double largest = largest_displacement(u);
    if (largest > kLargeDisplacement * size) {
      warnings.push_back(fmt::format(
          "deflection not small: load case '{}' moves a point by {:.4g} {}, "
          "{:.1f} % of the part's size; a linear analysis does not hold",
          name, largest, input.units.length, 100.0 * largest / size));
    }
  }
  return warnings;
}

}  // namespace meniscus
