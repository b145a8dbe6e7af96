/// Shared small types. A point is a column of three coordinates; lists of
/// points own their storage and lie contiguously (x0 y0 z0 x1 y1 z1 ...).
#pragma once

#include <array>
#include <string>
#include <vector>

#include <Eigen/Core>

namespace meniscus {

using Vec3 = Eigen::Vector3d;
using Mat3 = Eigen::Matrix3d;
using RowMat3 = Eigen::Matrix<double, 3, 3, Eigen::RowMajor>;
using VectorX = Eigen::VectorXd;
using Points = std::vector<Vec3>;  // [length]
using Triangle = std::array<int, 3>;
using Edge = std::array<int, 2>;

/// The coordinates of `points` as one vector of 3 n entries, not copied.
inline Eigen::Map<const VectorX> flat(const Points& points) {
  return {points.empty() ? nullptr : points.front().data(),
          static_cast<Eigen::Index>(3 * points.size())};
}
inline Eigen::Map<VectorX> flat(Points& points) {
  return {points.empty() ? nullptr : points.front().data(),
          static_cast<Eigen::Index>(3 * points.size())};
}

}  // namespace meniscus
