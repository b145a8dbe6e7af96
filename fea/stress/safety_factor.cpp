#include "fea/stress/safety_factor.h"

#include <algorithm>
#include <limits>

#include "fea/stress/stress.h"

namespace meniscus::stress {

namespace {

bool counts(const std::vector<char>& excluded, int element) {
  return excluded.empty() || excluded[element] == 0;
}

}  // namespace

SafetyFactor safety_factor(const TetMesh& mesh,
                           const std::vector<element::Material>& materials,
                           const RecoveredStress& recovered,
                           const element::PointStress& points,
                           const std::vector<char>& excluded) {
  element::check_materials(mesh, materials);
  SafetyFactor result{.smallest = std::numeric_limits<double>::infinity()};
  const auto keep_least = [&](double strength, double von_mises, int region,
                              const Vec3& position) {
    if (von_mises > 0.0 && strength / von_mises < result.smallest) {
      result = {strength / von_mises, position, region, von_mises};
    }
  };
  for (int e = 0; e < mesh.element_count(); ++e) {
    const int region = mesh.element_region[e];
    const std::optional<double>& strength = materials[region].yield_strength;
    if (!strength || !counts(excluded, e)) {
      continue;
    }
    for (const int copy : recovered.nodes.element(e)) {
      keep_least(*strength, element::von_mises(recovered.value[copy]), region,
                 mesh.nodes[recovered.nodes.node[copy]]);
    }
    for (int q = 0; q < points.points_per_element; ++q) {
      const std::size_t at = points.index(e, q);
      keep_least(*strength, element::von_mises(points.stress[at]), region,
                 points.position[at]);
    }
  }
  return result;
}

PeakReadings peak_readings(const TetMesh& mesh,
                           const RecoveredStress& recovered,
                           const element::PointStress& points,
                           const std::vector<char>& excluded) {
  PeakReadings peaks;
  StressField averaged = average_stress(mesh, points);
  find_peak(averaged);
  if (!excluded.empty()) {
    find_peak(mesh, excluded, averaged);
  }
  peaks.averaged = averaged.max_von_mises;
  for (int e = 0; e < mesh.element_count(); ++e) {
    if (!counts(excluded, e)) {
      continue;
    }
    for (const int copy : recovered.nodes.element(e)) {
      peaks.recovered =
          std::max(peaks.recovered, element::von_mises(recovered.value[copy]));
    }
    for (int q = 0; q < points.points_per_element; ++q) {
      peaks.points = std::max(
          peaks.points, element::von_mises(points.stress[points.index(e, q)]));
    }
  }
  return peaks;
}

}  // namespace meniscus::stress
