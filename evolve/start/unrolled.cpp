#include "evolve/start/unrolled.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include <Eigen/Geometry>

#include "core/error.h"
#include "core/geometry/exact_points.h"
#include "core/geometry/plane_points.h"

namespace meniscus::start {

namespace {

constexpr double kQuarter = 0.5 * std::numbers::pi;
constexpr double kTwelfth = std::numbers::pi / 6.0;  // of a turn
constexpr double kStraight = 1e-3;                   // [rad] in all
constexpr double kAtPole = 1e-6;                     // [rad] of latitude
constexpr int kLengthSteps = 64;   // of a line whose length is summed
constexpr double kTouches = 1e-9;  // [rad] a plane's angle of a whole turn

/// Length to parameter along `axis` through the middle of the box.
double scale_along(const ExactSurface& surface, const Eigen::AlignedBox2d& box,
                   int axis) {
  Vec2 place = box.center();
  place[axis] = box.min()[axis];
  Vec3 last = point_on(surface, place);
  double sum = 0.0;
  const double range = box.max()[axis] - box.min()[axis];
  for (int k = 1; k <= kLengthSteps; ++k) {
    place[axis] = box.min()[axis] + range * k / kLengthSteps;
    const Vec3 next = point_on(surface, place);
    sum += (next - last).norm();
    last = next;
  }
  return range > 0.0 && sum > 0.0 ? sum / range : 1.0;
}

/// Of the surface at a place, by differences; zero where it has none.
Vec3 normal_at(const ExactSurface& surface, const Vec2& place,
               const Vec2& size) {
  constexpr double kStep = 1e-5;  // of the piece
  const Vec2 a(kStep * size[0], 0.0);
  const Vec2 b(0.0, kStep * size[1]);
  return (point_on(surface, place + a) - point_on(surface, place - a))
      .cross(point_on(surface, place + b) - point_on(surface, place - b))
      .normalized();
}

/// Longest edge along `axis` through the middle of the box.
double longest_along(const ExactSurface& surface,
                     const Eigen::AlignedBox2d& box, int axis) {
  const Vec2 size = box.max() - box.min();
  Vec2 place = box.center();
  double turn = 0.0;
  Vec3 last = Vec3::Zero();
  for (int k = 0; k < kLengthSteps; ++k) {
    place[axis] = box.min()[axis] + size[axis] * (k + 0.5) / kLengthSteps;
    const Vec3 normal = normal_at(surface, place, size);
    turn +=
        k == 0 ? 0.0 : std::atan2(last.cross(normal).norm(), last.dot(normal));
    last = normal;
  }
  const double length = scale_along(surface, box, axis) * size[axis];
  return turn > kStraight ? length * kTwelfth / turn
                          : std::numeric_limits<double>::infinity();
}

}  // namespace

Unrolled::Unrolled(const ExactSurface& surface,
                   const std::vector<std::vector<Vec2>>& around) {
  Eigen::AlignedBox2d box;
  for (const std::vector<Vec2>& loop : around) {
    box.extend(box_of(loop));
  }
  const Vec2 middle = box.center();
  zero_ = middle[0];
  longest_edge_ =
      std::min(longest_along(surface, box, 0), longest_along(surface, box, 1));
  if (const auto* cone = std::get_if<ExactCone>(&surface)) {
    about_apex_ = true;
    apex_ = -cone->radius / std::sin(cone->angle);
    side_ = middle[1] > apex_ ? 1.0 : -1.0;
    turn_ = std::abs(std::sin(cone->angle));
    return;
  }
  if (const auto* sphere = std::get_if<ExactSphere>(&surface)) {
    const bool north = box.max()[1] > kQuarter - kAtPole;
    const bool south = box.min()[1] < -kQuarter + kAtPole;
    if (north && south) {
      throw InvalidInput(
          "a face that is a sphere from pole to pole is not meshed; cut it in "
          "two in its CAD program");
    }
    if (north || south) {
      about_apex_ = true;
      apex_ = north ? kQuarter : -kQuarter;
      side_ = north ? -1.0 : 1.0;
      scale_[1] = sphere->radius;
      const double reach = north ? apex_ - box.min()[1] : box.max()[1] - apex_;
      turn_ = std::min(std::sin(reach) / reach, 1.0 - kTouches);
      turn_ = std::max(turn_, 0.3);  // beyond the equator
      return;
    }
  }
  scale_ = {scale_along(surface, box, 0), scale_along(surface, box, 1)};
}

Vec3 Unrolled::to_plane(const Vec2& place) const {
  if (!about_apex_) {
    return {scale_[0] * place[0], scale_[1] * place[1], 0.0};
  }
  const double away = scale_[1] * side_ * (place[1] - apex_);
  const double angle = turn_ * (place[0] - zero_);
  return {away * std::cos(angle), away * std::sin(angle), 0.0};
}

Vec2 Unrolled::from_plane(const Vec3& at) const {
  if (!about_apex_) {
    return {at.x() / scale_[0], at.y() / scale_[1]};
  }
  return {zero_ + std::atan2(at.y(), at.x()) / turn_,
          apex_ + side_ * std::hypot(at.x(), at.y()) / scale_[1]};
}

}  // namespace meniscus::start
