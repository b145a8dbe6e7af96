#include "fea/functionals/stress_criteria.h"

#include <cmath>
#include <utility>

#include <fmt/format.h>

#include "core/error.h"
#include "fea/element/point_covector.h"
#include "fea/element/stress_measures.h"

namespace meniscus::functionals {

namespace {

using element::Stress;

void require_positive(double value, const char* what, std::size_t region) {
  if (!(value > 0.0) || !std::isfinite(value)) {
    throw InvalidInput(
        fmt::format("stress criterion: {} of region {} is {}; it must be above "
                    "0",
                    what, region, value));
  }
}

void require_positive(const std::vector<double>& values, const char* what) {
  for (std::size_t k = 0; k < values.size(); ++k) {
    require_positive(values[k], what, k);
  }
}

/// Von Mises stress times `factor`, added to `by` with its derivative; none
/// where it is 0.
double add_von_mises(const Stress& s, double factor, Stress* by) {
  const double value = element::von_mises(s);
  if (by != nullptr && value > 0.0) {
    const double mean = (s[0] + s[1] + s[2]) / 3.0;
    for (int k = 0; k < 3; ++k) {
      (*by)[k] += factor * 1.5 * (s[k] - mean) / value;
      (*by)[k + 3] += factor * 3.0 * s[k + 3] / value;
    }
  }
  return factor * value;
}

/// a : b with a : a the square of the von Mises stress.
double von_mises_product(const Stress& a, const Stress& b) {
  double sum = 0.0;
  for (int k = 0; k < 3; ++k) {
    const int next = (k + 1) % 3;
    sum +=
        0.5 * (a[k] - a[next]) * (b[k] - b[next]) + 3.0 * a[k + 3] * b[k + 3];
  }
  return sum;
}

/// sqrt(x^2 + round^2), and its slope: |x|, above it by no more than `round`.
std::pair<double, double> smooth_size(double x, double round) {
  const double size = std::hypot(x, round);
  return {size, x / size};
}

double trace(const Stress& s) { return s[0] + s[1] + s[2]; }

void add_to_trace(double factor, Stress& by) {
  for (int k = 0; k < 3; ++k) {
    by[k] += factor;
  }
}

Stress half_sum(const Stress& a, const Stress& b, double sign) {
  Stress result{};
  element::add_scaled(0.5, a, result);
  element::add_scaled(0.5 * sign, b, result);
  return result;
}

/// (sum of positive parts to the power p)^(1/p) of the principal stresses.
double tension(const Stress& s, double power, double factor, Stress* by) {
  const element::PrincipalFrame frame = element::principal_frame(s);
  const double largest = frame.stress[0];
  if (!(largest > 0.0)) {
    return 0.0;
  }
  double sum = 0.0;
  for (int k = 0; k < 3 && frame.stress[k] > 0.0; ++k) {
    sum += std::pow(frame.stress[k] / largest, power);
  }
  const double value = largest * std::pow(sum, 1.0 / power);
  for (int k = 0; by != nullptr && k < 3 && frame.stress[k] > 0.0; ++k) {
    const double weight =
        factor * std::pow(frame.stress[k] / value, power - 1.0);
    const Vec3 n = frame.direction.col(k);
    element::add_scaled(
        weight,
        {n[0] * n[0], n[1] * n[1], n[2] * n[2], 2.0 * n[0] * n[1],
         2.0 * n[1] * n[2], 2.0 * n[2] * n[0]},
        *by);
  }
  return factor * value;
}

}  // namespace

NodeCriterion von_mises_ratio(std::vector<double> allowable) {
  require_positive(allowable, "the allowable stress");
  return {.value = [allowable = std::move(allowable)](
                       int region, double /*power*/,
                       std::span<const Stress> stress, std::span<Stress> by) {
    return add_von_mises(stress[0], 1.0 / allowable[region],
                         by.empty() ? nullptr : by.data());
  }};
}

Vec3 worst_stress_direction(std::span<const Stress> stress, const Cone& cone) {
  Mat3 Q;
  for (int i = 0; i < 3; ++i) {
    for (int j = 0; j <= i; ++j) {
      Q(i, j) = Q(j, i) = von_mises_product(stress[i], stress[j]);
    }
  }
  return worst_of_quadratic(Q, cone).direction;
}

NodeCriterion worst_von_mises_ratio(std::vector<double> allowable,
                                    const Cone& cone) {
  require_positive(allowable, "the allowable stress");
  return {.value = [allowable = std::move(allowable), cone](
                       int region, double /*power*/,
                       std::span<const Stress> stress, std::span<Stress> by) {
    const Vec3 d = worst_stress_direction(stress, cone);
    Stress sum{};
    Stress by_sum{};
    for (int k = 0; k < 3; ++k) {
      element::add_scaled(d[k], stress[k], sum);
    }
    const double value = add_von_mises(sum, 1.0 / allowable[region],
                                       by.empty() ? nullptr : &by_sum);
    // The direction is the best: what it changes by does not count.
    for (int k = 0; k < 3 && !by.empty(); ++k) {
      element::add_scaled(d[k], by_sum, by[k]);
    }
    return value;
  }};
}

NodeCriterion tension_ratio(std::vector<double> allowable) {
  require_positive(allowable, "the allowable stress");
  return {.value =
              [allowable = std::move(allowable)](int region, double power,
                                                 std::span<const Stress> stress,
                                                 std::span<Stress> by) {
                return tension(stress[0], power, 1.0 / allowable[region],
                               by.empty() ? nullptr : by.data());
              },
          .terms = 3};
}

NodeCriterion goodman_ratio(std::vector<Endurance> endurance) {
  for (std::size_t k = 0; k < endurance.size(); ++k) {
    require_positive(endurance[k].limit, "the endurance limit", k);
    require_positive(endurance[k].tensile, "the tensile strength", k);
  }
  return {.value = [endurance = std::move(endurance)](
                       int region, double /*power*/,
                       std::span<const Stress> stress, std::span<Stress> by) {
    const Endurance& material = endurance[region];
    Stress swing{};
    double value =
        add_von_mises(half_sum(stress[0], stress[1], -1.0),
                      1.0 / material.limit, by.empty() ? nullptr : &swing);
    // max(0, m) = (m + |m|) / 2.
    const double mean =
        0.5 * (trace(stress[0]) + trace(stress[1])) / material.tensile;
    const auto [size, slope] = smooth_size(mean, 2.0 * kGoodmanRound);
    value += 0.5 * (mean + size);
    if (!by.empty()) {
      const double by_trace = 0.25 * (1.0 + slope) / material.tensile;
      element::add_scaled(0.5, swing, by[0]);
      element::add_scaled(-0.5, swing, by[1]);
      add_to_trace(by_trace, by[0]);
      add_to_trace(by_trace, by[1]);
    }
    return value;
  }};
}

NodeCriterion crossland_ratio(std::vector<Endurance> endurance) {
  const double root = std::sqrt(3.0);
  for (std::size_t k = 0; k < endurance.size(); ++k) {
    require_positive(endurance[k].limit, "the endurance limit", k);
    require_positive(endurance[k].torsion, "the endurance limit of torsion", k);
    if (root * endurance[k].torsion < endurance[k].limit) {
      throw InvalidInput(fmt::format(
          "stress criterion: the endurance limit of torsion of region {} is "
          "{:g}, below {:g}, that of tension over the root of 3: Crossland's "
          "criterion is of ductile materials, which have more",
          k, endurance[k].torsion, endurance[k].limit / root));
    }
  }
  return {.value = [endurance = std::move(endurance), root](
                       int region, double /*power*/,
                       std::span<const Stress> stress, std::span<Stress> by) {
    const Endurance& material = endurance[region];
    const double alpha = 3.0 * material.torsion / material.limit - root;
    Stress swing{};
    double value = add_von_mises(half_sum(stress[0], stress[1], -1.0),
                                 1.0 / (root * material.torsion),
                                 by.empty() ? nullptr : &swing);
    // The larger of two is their mean and half of what they are apart.
    const double part = alpha / (3.0 * material.torsion);
    const double a = part * trace(stress[0]);
    const double b = part * trace(stress[1]);
    const auto [size, slope] = smooth_size(0.5 * (a - b), kCrosslandRound);
    value += 0.5 * (a + b) + size;
    if (!by.empty()) {
      element::add_scaled(0.5, swing, by[0]);
      element::add_scaled(-0.5, swing, by[1]);
      add_to_trace(0.5 * part * (1.0 + slope), by[0]);
      add_to_trace(0.5 * part * (1.0 - slope), by[1]);
    }
    return value;
  }};
}

}  // namespace meniscus::functionals
