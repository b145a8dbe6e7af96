#include "fea/stress/error_estimate.h"

#include <cmath>

#include "fea/element/elastic_law.h"
#include "fea/stress/stress_difference.h"

namespace meniscus::stress {

double EnergyError::relative() const {
  const double whole = std::hypot(energy_norm, error);
  return whole > 0.0 ? error / whole : 0.0;
}

EnergyError estimate_error(const TetMesh& mesh,
                           const std::vector<element::Material>& materials,
                           const StressedSolution& solution) {
  const StressDifference difference(mesh, materials, solution);
  const std::vector<element::ElasticLaw> laws =
      element::elastic_laws(materials);
  const int count = mesh.element_count();
  std::vector<double> energy(count);
  EnergyError result;
  result.element.resize(count);
#pragma omp parallel for schedule(static)
  for (int e = 0; e < count; ++e) {
    const PointDifferences d = difference.of(e);
    const element::ElasticLaw& law = laws[mesh.element_region[e]];
    double error = 0.0;
    double whole = 0.0;
    for (std::size_t q = 0; q < d.volume.size(); ++q) {
      const element::Stress& s = d.recovered_minus_computed[q];
      error += d.volume[q] * element::complementary_product(s, s, law);
      whole += d.volume[q] * element::complementary_product(d.computed[q],
                                                            d.computed[q], law);
    }
    result.element[e] = std::sqrt(error);
    energy[e] = whole;
  }
  double squares = 0.0;
  double norm = 0.0;
  for (int e = 0; e < count; ++e) {
    squares += result.element[e] * result.element[e];
    norm += energy[e];
  }
  result.error = std::sqrt(squares);
  result.energy_norm = std::sqrt(norm);
  return result;
}

ResponseError response_error(const TetMesh& mesh,
                             const std::vector<element::Material>& materials,
                             const StressedSolution& primal,
                             const StressedSolution& dual) {
  const StressDifference first(mesh, materials, primal);
  const StressDifference second(mesh, materials, dual);
  const std::vector<element::ElasticLaw> laws =
      element::elastic_laws(materials);
  const int count = mesh.element_count();
  ResponseError result;
  result.element.resize(count);
#pragma omp parallel for schedule(static)
  for (int e = 0; e < count; ++e) {
    const PointDifferences p = first.of(e);
    const PointDifferences d = second.of(e);
    const element::ElasticLaw& law = laws[mesh.element_region[e]];
    double sum = 0.0;
    for (std::size_t q = 0; q < p.volume.size(); ++q) {
      sum += p.volume[q] *
             element::complementary_product(p.recovered_minus_computed[q],
                                            d.recovered_minus_computed[q], law);
    }
    result.element[e] = sum;
  }
  for (const double part : result.element) {
    result.value += part;
    result.bound += std::abs(part);
  }
  return result;
}

}  // namespace meniscus::stress
