#include "optimize/samples/spread.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "core/error.h"
#include "optimize/samples/sampling.h"

namespace meniscus::samples {
namespace {

constexpr double kInside = 0x1p-33;

void check_deviations(const VectorX& deviations, Eigen::Index expected) {
  if (deviations.size() != expected || !deviations.allFinite() ||
      (deviations.array() < 0.0).any()) {
    throw InvalidInput(
        fmt::format("tolerances: {} standard deviations for {} variables; "
                    "expected one finite number >= 0 each",
                    deviations.size(), expected));
  }
}

}  // namespace

LinearSpread linear_spread(const Eigen::MatrixXd& jacobian,
                           const VectorX& deviations) {
  check_deviations(deviations, jacobian.cols());
  LinearSpread spread;
  spread.shares =
      (jacobian * deviations.asDiagonal()).array().square().matrix();
  const VectorX variance = spread.shares.rowwise().sum();
  spread.deviation = variance.cwiseSqrt();
  for (Eigen::Index i = 0; i < variance.size(); ++i) {
    if (variance[i] > 0.0) {
      spread.shares.row(i) /= variance[i];
    }
  }
  return spread;
}

std::vector<VectorX> normal_designs(const VectorX& mean,
                                    const VectorX& deviations,
                                    const std::vector<VectorX>& unit) {
  check_deviations(deviations, mean.size());
  std::vector<VectorX> designs;
  designs.reserve(unit.size());
  for (const VectorX& t : unit) {
    if (t.size() != mean.size()) {
      throw InvalidInput(
          fmt::format("tolerances: a sample of {} numbers for {} variables",
                      t.size(), mean.size()));
    }
    VectorX x = mean;
    for (Eigen::Index j = 0; j < x.size(); ++j) {
      const double p = std::clamp(t[j], kInside, 1.0 - kInside);
      x[j] += deviations[j] * normal_quantile(p);
    }
    designs.push_back(std::move(x));
  }
  return designs;
}

SampledSpread sampled_spread(const std::vector<VectorX>& values) {
  SampledSpread spread;
  spread.count = static_cast<int>(values.size());
  if (spread.count < 2) {
    throw InvalidInput(fmt::format(
        "tolerances: {} answers; a spread needs at least two", spread.count));
  }
  const double n = spread.count;
  spread.mean = VectorX::Zero(values[0].size());
  spread.least = values[0];
  spread.largest = values[0];
  for (const VectorX& value : values) {
    if (value.size() != spread.mean.size()) {
      throw InvalidInput(
          fmt::format("tolerances: answers of {} and {} responses",
                      spread.mean.size(), value.size()));
    }
    spread.mean += value / n;
    spread.least = spread.least.cwiseMin(value);
    spread.largest = spread.largest.cwiseMax(value);
  }
  // Central moments in a second pass, which cancels nothing.
  VectorX second = VectorX::Zero(spread.mean.size());
  VectorX fourth = second;
  for (const VectorX& value : values) {
    const VectorX square = (value - spread.mean).cwiseAbs2();
    second += square / n;
    fourth += square.cwiseAbs2() / n;
  }
  // Unbiased variance (n - 1), and the standard error of the mean.
  spread.deviation = (second * (n / (n - 1.0))).cwiseSqrt();
  spread.mean_error = spread.deviation / std::sqrt(n);
  // Var(s^2) is about (m4 - m2^2) / n, and ds = d(s^2) / (2 s).
  spread.deviation_error = VectorX::Zero(second.size());
  for (Eigen::Index i = 0; i < second.size(); ++i) {
    if (second[i] > 0.0) {
      spread.deviation_error[i] =
          std::sqrt(std::max(fourth[i] - second[i] * second[i], 0.0) / n) /
          (2.0 * spread.deviation[i]);
    }
  }
  return spread;
}

}  // namespace meniscus::samples
