/// The polynomial of one patch of elements.
#pragma once

#include <optional>
#include <span>

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

}  // namespace meniscus::stress
