/// The polynomial of one patch of elements.
#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <vector>

#include <Eigen/Core>

#include "fea/element/point_stress.h"

namespace meniscus::stress {

/// Stress as a polynomial of at most degree two in (x - centre) / size.
struct StressPatch {
  static constexpr int kTerms = 10;  // 1 x y z xx yy zz xy yz zx
  Eigen::Matrix<double, kTerms, 6> coefficient;
  Vec3 centre = Vec3::Zero();
  double size = 1.0;

  element::Stress at(const Vec3& x) const;
};

/// What a number changes by a patch's value at x, `by_value`, as changes by its
/// coefficients, by x and by its centre; its size counts as held, for no value
/// depends on it.
struct PatchValueCovector {
  Eigen::Matrix<double, StressPatch::kTerms, 6> coefficient;
  Vec3 x = Vec3::Zero();  // the centre's is the negative of it
};
PatchValueCovector transpose_value(const StressPatch& patch, const Vec3& x,
                                   const element::Stress& by_value);

struct PatchOptions {
  int degree = 2;  // 1 or 2
  /// A sample weighs (1 - (distance / reach)^2)^4 within the reach [length], so
  /// that none enters with a jump; all weigh the same when empty.
  std::optional<double> reach;
};

/// Least squares over the points of `elements`, of the highest degree up to
/// that asked which twice as many points as terms determine well; the plain
/// mean if none (for a single ten-node element the exact linear fit).
/// `elements` must not be empty.
StressPatch fit_patch(const element::PointStress& points,
                      std::span<const int> elements, const Vec3& centre,
                      const PatchOptions& options);

/// What a number changes by what one patch is fitted to.
struct FitCovector {
  struct Sample {
    std::size_t point = 0;  // its index
    element::Stress stress{};
    Vec3 position = Vec3::Zero();
  };
  std::vector<Sample> samples;
  Vec3 centre = Vec3::Zero();
  double reach = 0.0;
};

/// The transpose of fit_patch() with its derivative: `patch` is what it gave
/// for the same points; `by_coefficient`: what the number changes by its
/// coefficients. Exact but where a point enters or leaves the samples that
/// decide the degree (docs/theory.md).
FitCovector transpose_fit(
    const element::PointStress& points, std::span<const int> elements,
    const StressPatch& patch, const PatchOptions& options,
    const Eigen::Matrix<double, StressPatch::kTerms, 6>& by_coefficient);

}  // namespace meniscus::stress
