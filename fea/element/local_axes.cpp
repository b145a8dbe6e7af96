#include "fea/element/local_axes.h"

#include <cmath>

#include <Eigen/Geometry>

namespace meniscus::element {

bool span_a_plane(const LocalAxes& axes) {
  constexpr double kParallel = 1e-6;  // sine between two axes
  const double sine = axes.first.cross(axes.second).norm();
  return std::isfinite(sine) &&
         sine > kParallel * axes.first.norm() * axes.second.norm();
}

Mat3 unit_axes(const LocalAxes& axes) {
  Mat3 R;
  R.col(0) = axes.first.normalized();
  R.col(2) = R.col(0).cross(axes.second).normalized();
  R.col(1) = R.col(2).cross(R.col(0));
  return R;
}

}  // namespace meniscus::element
