#include "fea/stress/safety_factor.h"

#include <limits>

namespace meniscus::stress {

SafetyFactors safety_factors(const TetMesh& mesh,
                             const std::vector<element::Material>& materials,
                             const RecoveredStress& stress,
                             const std::vector<char>& excluded) {
  element::check_materials(mesh, materials);
  constexpr double kNever = std::numeric_limits<double>::infinity();
  SafetyFactors result;
  result.nodal.assign(mesh.nodes.size(), kNever);
  result.smallest = kNever;
  std::vector<int> region(stress.value.size(), -1);
  for (int e = 0; e < mesh.element_count(); ++e) {
    if (!excluded.empty() && excluded[e] != 0) {
      continue;
    }
    for (const int copy : stress.nodes.element(e)) {
      region[copy] = mesh.element_region[e];
    }
  }
  for (std::size_t copy = 0; copy < stress.value.size(); ++copy) {
    if (region[copy] < 0 || !materials[region[copy]].yield_strength) {
      continue;
    }
    const double s = element::von_mises(stress.value[copy]);
    const int node = stress.nodes.node[copy];
    const double factor =
        s > 0.0 ? *materials[region[copy]].yield_strength / s : kNever;
    result.nodal[node] = std::min(result.nodal[node], factor);
    if (factor < result.smallest) {
      result.smallest = factor;
      result.node = node;
      result.region = region[copy];
      result.von_mises = s;
    }
  }
  return result;
}

}  // namespace meniscus::stress
