#include "core/math/worst_direction.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include <Eigen/Geometry>

#include "core/math/dense.h"

namespace meniscus {

namespace {

using Vec2 = Eigen::Vector2d;

/// The unit y with the largest sum of a_k y_k^2 + 2 g_k y_k, a_0 >= a_1. At it
/// (a_k - l) y_k = -g_k with l = a_0 + t, t >= 0 (More and Sorensen): the root
/// of |y(t)| = 1, which falls with t.
Vec2 best_on_circle(const Vec2& a, const Vec2& g) {
  const double apart = a[0] - a[1];
  const double size = g.norm();
  const auto at = [&](double t) { return Vec2(g[0] / t, g[1] / (t + apart)); };
  double low = std::max(std::abs(g[0]), std::abs(g[1]) - apart);
  double high = size;
  if (!(low > 0.0)) {
    // No pull along the first: it takes what the second leaves, either sign.
    const double second = apart > 0.0 ? g[1] / apart : 0.0;
    return {std::sqrt(std::max(0.0, 1.0 - second * second)), second};
  }
  double t = low;
  constexpr int kMost = 100;
  for (int k = 0; k < kMost; ++k) {
    const Vec2 y = at(t);
    const double length = y.norm();
    (length > 1.0 ? low : high) = t;
    // Newton's step on 1 / |y(t)|, which is nearly straight.
    const double slope =
        (y[0] * y[0] / t + y[1] * y[1] / (t + apart)) / (length * length);
    double next = t + (length - 1.0) / slope;
    if (!(next > low) || !(next < high)) {
      next = 0.5 * (low + high);
    }
    if (std::abs(next - t) <= std::numeric_limits<double>::epsilon() * t ||
        next == low || next == high) {
      break;
    }
    t = next;
  }
  return at(t).normalized();
}

/// The best of the directions at the half-angle itself.
Vec3 best_on_rim(const Mat3& Q, const Cone& cone) {
  const double c = std::cos(cone.half_angle);
  const double s = std::sin(cone.half_angle);
  Eigen::Matrix<double, 3, 2> across;
  across.col(0) = cone.axis.unitOrthogonal();
  across.col(1) = cone.axis.cross(across.col(0));
  const Eigen::Matrix2d M = across.transpose() * Q * across;
  const Vec2 b = across.transpose() * (Q * cone.axis);
  // Principal directions of M, the larger value first.
  const double turn = 0.5 * std::atan2(2.0 * M(0, 1), M(0, 0) - M(1, 1));
  Eigen::Matrix2d V;
  V << std::cos(turn), -std::sin(turn), std::sin(turn), std::cos(turn);
  const Vec2 values(V.col(0).dot(M * V.col(0)), V.col(1).dot(M * V.col(1)));
  const Vec2 y =
      V * best_on_circle(s * s * values, s * c * (V.transpose() * b));
  return (c * cone.axis + s * (across * y)).normalized();
}

}  // namespace

WorstDirection worst_of_linear(const Vec3& m, const Cone& cone) {
  const double along = m.dot(cone.axis);
  const Vec3 rest = m - along * cone.axis;
  const double across = rest.norm();
  Vec3 direction = cone.axis;
  if (m.norm() > 0.0 && std::atan2(across, along) <= cone.half_angle) {
    direction = m.normalized();
  } else if (m.norm() > 0.0) {
    const Vec3 aside =
        across > 0.0 ? Vec3(rest / across) : Vec3(cone.axis.unitOrthogonal());
    direction = std::cos(cone.half_angle) * cone.axis +
                std::sin(cone.half_angle) * aside;
  }
  return {m.dot(direction), direction};
}

WorstDirection worst_of_quadratic(const Mat3& Q, const Cone& cone) {
  const SymmetricEigen<3> eigen = symmetric_eigen(Q);
  Vec3 direction = eigen.vectors.col(2);
  if (direction.dot(cone.axis) < 0.0) {
    direction = -direction;
  }
  const double across = direction.cross(cone.axis).norm();
  if (std::atan2(across, direction.dot(cone.axis)) > cone.half_angle) {
    direction = best_on_rim(Q, cone);
  }
  return {direction.dot(Q * direction), direction};
}

}  // namespace meniscus
