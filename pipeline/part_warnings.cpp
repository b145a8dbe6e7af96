#include "pipeline/part_warnings.h"

#include <algorithm>

#include <fmt/format.h>

#include "pipeline/responses.h"

namespace meniscus {

namespace {

// Beyond this part of the part's size, rotations are no longer small.
constexpr double kLargeDisplacement = 0.05;

/// The lowest yield strength of all bodies, if any is given.
std::optional<double> lowest_yield(const EvaluatedCase& numbers) {
  std::optional<double> lowest;
  for (const Material& material : numbers.materials) {
    if (material.yield_strength) {
      lowest = std::min(lowest.value_or(*material.yield_strength),
                        *material.yield_strength);
    }
  }
  return lowest;
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
  const std::optional<double> yield = lowest_yield(fields.inputs);
  const double size = bounding_diagonal(fields.mesh.nodes);
  for (std::size_t k = 0; k < fields.inputs.load_cases.size(); ++k) {
    const std::string& name = fields.inputs.load_cases[k].name;
    const VectorX& u = fields.solution.displacements[k];
    const StressField other =
        k == 0 ? StressField{}
               : load_case_stress(fields.mesh, fields.inputs, k, u);
    const StressField& stress = k == 0 ? fields.stress : other;
    if (yield && stress.max_von_mises > *yield) {
      const Vec3& x =
          fields.mesh.nodes[static_cast<std::size_t>(stress.max_node)];
      warnings.push_back(fmt::format(
          "stress above yield: load case '{}' reaches {:.4g} {} at ({:.4g}, "
          "{:.4g}, {:.4g}), the material yields at {:.4g} {}; a linear "
          "analysis does not hold there (at a clamped edge the value grows "
          "with every refinement)",
          name, stress.max_von_mises, input.units.pressure, x.x(), x.y(), x.z(),
          *yield, input.units.pressure));
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
