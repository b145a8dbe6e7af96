#include "evolve/walls/fillet_arc.h"

#include <algorithm>
#include <cmath>

#include <Eigen/Geometry>

#include "evolve/walls/wall_offset.h"

namespace meniscus::walls {

namespace {

constexpr double kConvex = 0.05;   // sine of the sector; less: no fillet
constexpr double kLongest = 20.0;  // of (offset + radius): where it begins

}  // namespace

double FilletArc::slide() const { return std::max(begins - length(), 0.0); }

double FilletArc::ends() const { return std::max(begins, slide() + excess); }

Vec3 FilletArc::lift(double way) const {
  if (radius == 0.0) {
    return std::max(excess - std::max(way - slide(), 0.0), 0.0) * normal;
  }
  const double l = std::max(way - begins + length(), 0.0);
  if (l >= length()) {
    return Vec3::Zero();
  }
  const double turn = angle * (1.0 - l / length());
  const Vec3 on_arc =
      center - radius * (std::cos(turn) * normal + std::sin(turn) * inward);
  return on_arc - (begins - length() + l) * inward - offset * normal;
}

FilletArc fillet_arc(const Vec3& along, const LineSide& own,
                     const LineSide& other) {
  const Vec3 line = along.normalized();
  const auto across = [&](const Vec3& n) {
    return Vec3((n - line * line.dot(n)).normalized());
  };
  FilletArc arc;
  arc.normal = across(own.normal);
  arc.inward = across(own.inward);
  arc.inward =
      (arc.inward - arc.normal * arc.normal.dot(arc.inward)).normalized();
  const Vec3 facing = across(other.normal);
  arc.offset = own.offset;
  arc.angle = 0.5 * std::acos(std::clamp(arc.normal.dot(facing), -1.0, 1.0));
  // The other film lies behind the own side where the sector is convex.
  if (arc.normal.dot(across(other.inward)) > kConvex) {
    arc.radius = own.fillet;
  }
  const auto corner = [&](double more) {
    return offset_corner(
        {{arc.normal, own.offset + more}, {facing, other.offset + more}});
  };
  OffsetCorner ball = corner(arc.radius);
  arc.lift_wall = own.fillet_wall;
  if (ball.on[0] == 0 || ball.on[1] == 0) {
    arc.radius = 0.0;
    arc.lift_wall = other.wall;
    ball = corner(0.0);
  }
  arc.center = ball.point;
  const double most =
      kLongest * (std::max(own.offset, other.offset) + arc.radius);
  arc.begins = std::min(arc.center.dot(arc.inward), most);
  arc.excess = arc.center.dot(arc.normal) - arc.offset - arc.radius;

  const auto part_of = [&](int i, const Vec3& n, double h) {
    return ball.on[i] != 0 ? (ball.inverse * n * h).dot(arc.inward) : 0.0;
  };
  const double all = arc.center.dot(arc.inward) - arc.length();
  const double by_own = part_of(0, arc.normal, own.offset);
  const double by_other = part_of(1, facing, other.offset);
  arc.parts = {std::pair(own.wall, by_own), std::pair(other.wall, by_other),
               std::pair(own.fillet_wall, all - by_own - by_other)};
  for (auto& [wall, by] : arc.parts) {
    by *= all > 0.0 ? arc.slide() / all : 0.0;
  }
  return arc;
}

}  // namespace meniscus::walls
