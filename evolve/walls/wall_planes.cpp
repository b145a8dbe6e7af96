#include "evolve/walls/wall_planes.h"

#include <algorithm>

#include <Eigen/Geometry>

namespace meniscus::walls {

namespace {

constexpr double kParallel = 1e-6;  // sine between normals

}  // namespace

std::optional<Mat3> WallPlanes::along(int point) const {
  if (at.empty() || at[point].empty()) {
    return std::nullopt;
  }
  Mat3 left = Mat3::Identity();
  for (const int p : at[point]) {
    const Vec3 normal = left * planes[p].normal;
    if (normal.norm() > kParallel) {
      const Vec3 unit = normal.normalized();
      left -= unit * unit.transpose();
    }
  }
  return left;
}

int WallPlanes::common(int a, int b) const {
  if (!at.empty()) {
    for (const int p : at[a]) {
      if (std::find(at[b].begin(), at[b].end(), p) != at[b].end()) {
        return p;
      }
    }
  }
  return -1;
}

Vec3 in_planes(const Mat3& along, const Vec3& normal, const Vec3& w) {
  const Vec3 within = along * normal;
  const Vec3 out = normal - within;
  return along * w + within * (out.dot(w) / within.squaredNorm());
}

// d = P w + s b with b = P n, a = n - b, s = a . w / b . b.
InPlanesGradient transpose_in_planes(const Mat3& along, const Vec3& normal,
                                     const Vec3& w, const Vec3& by) {
  const Vec3 b = along * normal;
  const Vec3 a = normal - b;
  const double size = b.squaredNorm();
  const double s = a.dot(w) / size;
  const double by_s = b.dot(by) / size;  // dJ/d(a . w)
  return {along * by + by_s * a,
          along * (s * by - 2.0 * s * by_s * b) + by_s * (w - along * w)};
}

}  // namespace meniscus::walls
