#include "fea/stress/stress_uniformity.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include <fmt/format.h>

#include "core/error.h"
#include "fea/element/elastic_law.h"

namespace meniscus::stress {

namespace {

void check_values(const std::vector<double>& values,
                  const std::vector<double>& volumes) {
  if (values.empty() || values.size() != volumes.size()) {
    throw InvalidInput(
        fmt::format("uniformity: {} values with {} volumes; is the whole part "
                    "excluded?",
                    values.size(), volumes.size()));
  }
  for (std::size_t i = 0; i < values.size(); ++i) {
    if (!(values[i] >= 0.0) || !std::isfinite(values[i]) ||
        !(volumes[i] > 0.0)) {
      throw InvalidInput(
          fmt::format("uniformity: value {} is {} with volume {}", i, values[i],
                      volumes[i]));
    }
  }
}

/// a / b; 1 where both are 0: nothing is as even as nothing.
double ratio(double a, double b) { return b > 0.0 ? a / b : 1.0; }

}  // namespace

Uniformity uniformity(const std::vector<double>& values,
                      const std::vector<double>& volumes) {
  check_values(values, volumes);
  std::vector<int> order(values.size());
  std::iota(order.begin(), order.end(), 0);
  std::sort(order.begin(), order.end(), [&](int a, int b) {
    return values[a] != values[b] ? values[a] < values[b] : a < b;
  });
  Uniformity u;
  double total = 0.0;
  for (const int i : order) {
    u.volume += volumes[i];
    total += volumes[i] * values[i];
  }
  u.mean = total / u.volume;
  u.peak = values[order.back()];
  u.histogram.assign(kHistogramSteps, 0.0);
  double below = 0.0;   // volume so far
  double sum = 0.0;     // of values times volume so far
  double lorenz = 0.0;  // twice the area under Lorenz's curve, not yet scaled
  double squares = 0.0;
  for (const int i : order) {
    const double w = volumes[i];
    const double x = values[i];
    for (const auto& [share, value] :
         {std::pair{0.05, &u.p05}, {0.5, &u.p50}, {0.95, &u.p95}}) {
      if (below < share * u.volume) {
        *value = x;
      }
    }
    lorenz += w * (2.0 * sum + w * x);
    sum += w * x;
    below += w;
    squares += w * (x - u.mean) * (x - u.mean);
    const int step = u.peak > 0.0
                         ? static_cast<int>(kHistogramSteps * x / u.peak)
                         : kHistogramSteps;
    u.histogram[std::min(step, kHistogramSteps - 1)] += w / u.volume;
  }
  u.coefficient_of_variation =
      total > 0.0 ? std::sqrt(squares / u.volume) / u.mean : 0.0;
  u.gini = total > 0.0 ? 1.0 - lorenz / (u.volume * total) : 0.0;
  u.p95_over_p50 = ratio(u.p95, u.p50);
  u.peak_over_mean = ratio(u.peak, u.mean);
  return u;
}

StressUniformity stress_uniformity(
    const TetMesh& mesh, const std::vector<element::Material>& materials,
    const element::PointStress& points, const std::vector<char>& excluded) {
  element::check_materials(mesh, materials);
  const std::vector<element::ElasticLaw> laws =
      element::elastic_laws(materials);
  std::vector<double> mises;
  std::vector<double> energy;
  std::vector<double> volumes;
  for (int e = 0; e < mesh.element_count(); ++e) {
    if (!excluded.empty() && excluded[e] != 0) {
      continue;
    }
    for (int q = 0; q < points.points_per_element; ++q) {
      const std::size_t at = points.index(e, q);
      mises.push_back(element::von_mises(points.stress[at]));
      const element::Stress& s = points.stress[at];
      energy.push_back(0.5 * element::complementary_product(
                                 s, s, laws[mesh.element_region[e]]));
      volumes.push_back(points.volume[at]);
    }
  }
  return {uniformity(mises, volumes), uniformity(energy, volumes)};
}

}  // namespace meniscus::stress
