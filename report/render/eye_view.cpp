#include "report/render/eye_view.h"

#include <algorithm>
#include <cmath>

#include <Eigen/Geometry>

#include "core/geometry/surface_mesh.h"

namespace meniscus::render {

namespace {

double half_height() {  // of the view, at distance 1
  return std::tan(0.5 * EyeView::kAngle * EIGEN_PI / 180.0);
}

/// Points that lie farthest in some direction across the view. The others
/// hardly bear on what must be seen: less than a thousandth of the picture.
Points outermost(const Points& points, const Vec3& right, const Vec3& up,
                 const Vec3& back) {
  constexpr std::size_t kFew = 2000;
  constexpr int kTurns = 48;
  constexpr std::array<double, 3> kTilts = {-0.4, 0.0, 0.4};
  if (points.size() <= kFew) {
    return points;
  }
  Eigen::Map<const Eigen::Matrix3Xd> all(
      points.front().data(), 3, static_cast<Eigen::Index>(points.size()));
  Points chosen;
  for (int k = 0; k < kTurns; ++k) {
    const double angle = 2.0 * EIGEN_PI * k / kTurns;
    for (const double tilt : kTilts) {
      const Vec3 along =
          std::cos(angle) * right + std::sin(angle) * up + tilt * back;
      Eigen::Index at = 0;
      (along.transpose() * all).maxCoeff(&at);
      chosen.push_back(points[static_cast<std::size_t>(at)]);
    }
  }
  return chosen;
}

/// z up, or y where the eye looks along z.
EyeView upright(const Vec3& view) {
  EyeView fitted;
  fitted.back = view.normalized();
  const Vec3 up_hint =
      std::abs(fitted.back.z()) < 0.99 ? Vec3(0, 0, 1) : Vec3(0, 1, 0);
  fitted.right = up_hint.cross(fitted.back).normalized();
  fitted.up = fitted.back.cross(fitted.right);
  return fitted;
}

}  // namespace

Eigen::Vector2d EyeView::project(const Vec3& p) const {
  const Vec3 at = seen(p);
  const double scale = 0.5 * height / (-at.z() * half_height());
  return {0.5 * width + scale * at.x(), 0.5 * height + scale * at.y()};
}

double EyeView::pixel_at(const Vec3& p) const {
  return std::abs(seen(p).z()) * half_height() * 2.0 / height;
}

EyeView fit_view(const Points& shown, const Vec3& view, const Box& box,
                 double width, double height) {
  EyeView fitted = upright(view);
  fitted.width = width;
  fitted.height = height;
  if (shown.empty()) {
    fitted.eye = fitted.back;
    return fitted;
  }
  const Points points = outermost(shown, fitted.right, fitted.up, fitted.back);
  const double half = half_height();
  const double aspect = width / height;
  Vec3 focus = Vec3::Zero();
  for (const Vec3& p : points) {
    focus += p / static_cast<double>(points.size());
  }
  double distance = std::max(bounding_diagonal(points), 1e-30) / half;
  const double middle_x = box.left + box.right - 1.0;  // in -1..1
  const double middle_y = box.bottom + box.top - 1.0;
  constexpr int kRounds = 30;  // a contraction: perspective is mild
  for (int round = 0; round < kRounds; ++round) {
    Eigen::Array2d low(1e300, 1e300), high(-1e300, -1e300);
    for (const Vec3& p : points) {
      const Vec3 d = p - focus;
      const double depth = half * (distance - fitted.back.dot(d));
      const Eigen::Array2d at(fitted.right.dot(d) / depth / aspect,
                              fitted.up.dot(d) / depth);
      low = low.min(at);
      high = high.max(at);
    }
    const double grow =
        std::max((high.x() - low.x()) / (2 * (box.right - box.left)),
                 (high.y() - low.y()) / (2 * (box.top - box.bottom)));
    focus += fitted.right * ((0.5 * (low.x() + high.x()) - middle_x * grow) *
                             distance * half * aspect) +
             fitted.up * ((0.5 * (low.y() + high.y()) - middle_y * grow) *
                          distance * half);
    distance *= grow;
  }
  fitted.eye = focus + distance * fitted.back;
  return fitted;
}

double seen_aspect(const Points& shown, const Vec3& view) {
  const EyeView far = upright(view);
  Eigen::Array2d low(1e300, 1e300), high(-1e300, -1e300);
  for (const Vec3& p : shown) {
    const Eigen::Array2d at(far.right.dot(p), far.up.dot(p));
    low = low.min(at);
    high = high.max(at);
  }
  const Eigen::Array2d size = high - low;
  return size.x() > 0.0 ? size.y() / size.x() : 1.0;
}

}  // namespace meniscus::render
