/// How evenly a part carries its load.
#pragma once

#include <vector>

#include "fea/element/point_stress.h"

namespace meniscus::stress {

/// Distribution over volume of a quantity that is not negative. A percentile
/// p is the least value that p % of the volume do not exceed. All ratios are
/// free of units and 0 or 1 for an even distribution.
struct Uniformity {
  double volume = 0.0;  // that counts [length^3]
  double mean = 0.0;
  double coefficient_of_variation = 0.0;  // standard deviation / mean
  double gini = 0.0;  // mean difference of two random places / (2 mean)
  double p05 = 0.0, p50 = 0.0, p95 = 0.0;
  double p95_over_p50 = 0.0;
  double peak = 0.0;
  double peak_over_mean = 0.0;
  std::vector<double> histogram;  // share of the volume in equal steps of
                                  // the value from 0 to peak
};

inline constexpr int kHistogramSteps = 50;

/// `volumes` > 0, one per value. Throws InvalidInput when there is no value,
/// or one that is negative or not finite.
Uniformity uniformity(const std::vector<double>& values,
                      const std::vector<double>& volumes);

/// Of the values at the integration points of elements that are not excluded
/// (`excluded`: one char per element, or empty).
struct StressUniformity {
  Uniformity von_mises;       // [pressure]
  Uniformity energy_density;  // [pressure]
};
StressUniformity stress_uniformity(
    const TetMesh& mesh, const std::vector<element::Material>& materials,
    const element::PointStress& points, const std::vector<char>& excluded = {});

}  // namespace meniscus::stress
