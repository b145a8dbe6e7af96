#include "fea/functionals/stress_functionals.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "core/error.h"
#include "fea/element/elastic_law.h"
#include "fea/element/point_stress.h"
#include "fea/functionals/point_chain.h"
#include "fea/loads/body_loads.h"

namespace meniscus::functionals {

namespace {

enum class Measure { VonMises, EnergyDensity };

/// The measure at every integration point, and where it counts.
struct Sample {
  element::PointStress points;
  std::vector<double> value;
  std::vector<char> counts;  // per element
  double volume = 0.0;
  double largest = 0.0;
};

Sample sample(const StressFunctionalInput& in, Measure measure) {
  Sample s;
  // Stresses at the points of the stiffness rule, expansion taken out.
  s.points =
      element::point_stress(in.mesh, in.materials, in.displacement,
                            loads::temperature_change(in.mesh, in.load_case));
  const int elements = in.mesh.element_count();
  if (!in.excluded.empty() &&
      static_cast<int>(in.excluded.size()) != elements) {
    throw InvalidInput(
        fmt::format("stress functional: exclusion marks {} of {} elements",
                    in.excluded.size(), elements));
  }
  const std::vector<element::ElasticLaw> laws =
      element::elastic_laws(in.materials);
  // Von Mises stress, or energy density s : C^-1 : s / 2.
  s.value.assign(s.points.stress.size(), 0.0);
  s.counts.assign(static_cast<std::size_t>(elements), 1);
#pragma omp parallel for schedule(static)
  for (int e = 0; e < elements; ++e) {
    if (!in.excluded.empty() && in.excluded[e] != 0) {
      s.counts[e] = 0;
      continue;
    }
    for (int q = 0; q < s.points.points_per_element; ++q) {
      const std::size_t at = s.points.index(e, q);
      const element::Stress& stress = s.points.stress[at];
      s.value[at] =
          measure == Measure::VonMises
              ? element::von_mises(stress)
              : 0.5 * element::complementary_product(
                          stress, stress, laws[in.mesh.element_region[e]]);
    }
  }
  // Volume and peak in one order, whatever the threads.
  for (int e = 0; e < elements; ++e) {
    for (int q = 0; s.counts[e] != 0 && q < s.points.points_per_element; ++q) {
      const std::size_t at = s.points.index(e, q);
      s.volume += s.points.volume[at];
      s.largest = std::max(s.largest, s.value[at]);
    }
  }
  if (!(s.volume > 0.0)) {
    throw InvalidInput(
        "stress functional: no element counts; the exclusion zones cover the "
        "whole part");
  }
  return s;
}

/// Mean over the volume that counts of term(value).
template <class Term>
double sample_mean(const Sample& s, const Term& term) {
  double sum = 0.0;
  for (std::size_t e = 0; e < s.counts.size(); ++e) {
    for (int q = 0; s.counts[e] != 0 && q < s.points.points_per_element; ++q) {
      const std::size_t at = s.points.index(static_cast<int>(e), q);
      sum += s.points.volume[at] * term(s.value[at]);
    }
  }
  return sum / s.volume;
}

/// What a point changes the functional by: per volume of its own, and per
/// volume by its value.
struct Weight {
  double by_volume = 0.0;
  double by_value = 0.0;
};

/// The strain A that stress changes the measure by: its derivative by stress.
Mat3 by_stress(Measure measure, const element::Stress& stress, double value,
               const element::ElasticLaw& law) {
  if (measure == Measure::EnergyDensity) {
    const element::Strain e = element::strain_of(stress, law);
    Mat3 A;
    A << e[0], e[3], e[5], e[3], e[1], e[4], e[5], e[4], e[2];
    return A;
  }
  if (value == 0.0) {  // no derivative: as well none as any
    return Mat3::Zero();
  }
  Mat3 A =
      element::stress_tensor(Eigen::Map<const element::Vec6>(stress.data()));
  A.diagonal().array() -= A.trace() / 3.0;
  return 1.5 / value * A;
}

/// At a given strain both measures are in proportion to Young's modulus.
template <class OfValue>
std::vector<double> by_modulus(const StressFunctionalInput& in, const Sample& s,
                               const OfValue& weight) {
  std::vector<double> result(in.materials.size(), 0.0);
  for (std::size_t e = 0; e < s.counts.size(); ++e) {
    const int region = in.mesh.element_region[e];
    const element::Material& material = in.materials[region];
    for (int q = 0; s.counts[e] != 0 && !material.orthotropic &&
                    q < s.points.points_per_element;
         ++q) {
      const std::size_t at = s.points.index(static_cast<int>(e), q);
      result[region] += s.points.volume[at] * weight(s.value[at]).by_value *
                        s.value[at] / material.youngs_modulus;
    }
  }
  return result;
}

/// Adds the derivatives, `weight`(value of a point) given.
template <class OfValue>
void differentiate(const StressFunctionalInput& in, Measure measure,
                   const Sample& s, const OfValue& weight,
                   element::Functional& result) {
  const std::vector<element::ElasticLaw> laws =
      element::elastic_laws(in.materials);
  chain_points(
      in.mesh, in.materials, {in.load_case, in.displacement},
      [&](int e, int q) -> PointSlope {
        if (s.counts[e] == 0) {
          return {};
        }
        const std::size_t at = s.points.index(e, q);
        const Weight w = weight(s.value[at]);
        return {.stress = s.points.volume[at] * w.by_value *
                          by_stress(measure, s.points.stress[at], s.value[at],
                                    laws[in.mesh.element_region[e]]),
                .volume = w.by_volume,
                .is_zero = false};
      },
      result);
  // The modulus scales all values.
  result.by_modulus = by_modulus(in, s, weight);
}

element::Functional variation(const StressFunctionalInput& in,
                              Measure measure) {
  const Sample s = sample(in, measure);
  const double mean = sample_mean(s, [](double x) { return x; });
  const double variance =
      sample_mean(s, [mean](double x) { return (x - mean) * (x - mean); });
  const double deviation = std::sqrt(variance);
  element::Functional result{.value = mean > 0.0 ? deviation / mean : 0.0};
  if (in.derivatives == element::Derivatives::All) {
    // An even distribution is a minimum without a derivative: as well none.
    const bool smooth = mean > 0.0 && deviation > 0.0;
    const double by_variance = smooth ? 0.5 / (deviation * mean) : 0.0;
    const double by_mean = smooth ? -deviation / (mean * mean) : 0.0;
    differentiate(
        in, measure, s,
        [&](double x) -> Weight {
          const double d = x - mean;
          return {(by_variance * (d * d - variance) + by_mean * d) / s.volume,
                  (2.0 * by_variance * d + by_mean) / s.volume};
        },
        result);
  }
  return result;
}

}  // namespace

element::Functional von_mises_norm_functional(const StressFunctionalInput& in,
                                              double power) {
  if (!(power >= 1.0) || !std::isfinite(power)) {
    throw InvalidInput(fmt::format(
        "stress functional: the power of the norm is {}; it must be 1 or above",
        power));
  }
  const Sample s = sample(in, Measure::VonMises);
  const double unit = s.largest > 0.0 ? s.largest : 1.0;
  const double mean =
      sample_mean(s, [&](double x) { return std::pow(x / unit, power); });
  element::Functional result{.value = unit * std::pow(mean, 1.0 / power)};
  if (in.derivatives == element::Derivatives::All) {
    const double factor =
        mean > 0.0 ? result.value / (power * mean * s.volume) : 0.0;
    differentiate(
        in, Measure::VonMises, s,
        [&](double x) -> Weight {
          const double low = std::pow(x / unit, power - 1.0);
          return {factor * (low * x / unit - mean),
                  factor * power * low / unit};
        },
        result);
  }
  return result;
}

element::Functional von_mises_ks_functional(const StressFunctionalInput& in,
                                            const KsOptions& options) {
  if (!(options.sharpness > 0.0) || !std::isfinite(options.sharpness) ||
      !(options.scale > 0.0) || !std::isfinite(options.scale)) {
    throw InvalidInput(fmt::format(
        "stress functional: sharpness {} and scale {} of the smooth maximum; "
        "both must be above 0",
        options.sharpness, options.scale));
  }
  const Sample s = sample(in, Measure::VonMises);
  const double k = options.sharpness / options.scale;
  const double mean =
      sample_mean(s, [&](double x) { return std::exp(k * (x - s.largest)); });
  element::Functional result{.value = s.largest + std::log(mean) / k};
  if (in.derivatives == element::Derivatives::All) {
    differentiate(
        in, Measure::VonMises, s,
        [&](double x) -> Weight {
          const double share =
              std::exp(k * (x - s.largest)) / (mean * s.volume);
          return {(share - 1.0 / s.volume) / k, share};
        },
        result);
  }
  return result;
}

element::Functional von_mises_variation_functional(
    const StressFunctionalInput& input) {
  return variation(input, Measure::VonMises);
}

element::Functional energy_density_variation_functional(
    const StressFunctionalInput& input) {
  return variation(input, Measure::EnergyDensity);
}

}  // namespace meniscus::functionals
