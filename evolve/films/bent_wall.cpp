#include "evolve/films/bent_wall.h"

#include <cmath>
#include <string>

#include <Eigen/Geometry>
#include <fmt/format.h>

#include "core/math/dual.h"

namespace meniscus::films {

namespace {

using std::sqrt;

constexpr double kSameAxis = 1e-14;  // of the points that tell it

template <class Scalar>
using Place = std::array<Scalar, 3>;

template <class Scalar>
Scalar dot(const Vec3& a, const Place<Scalar>& b) {
  return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

/// Along rays from the center, across the axis, or across a cone's lines.
template <class Scalar>
Place<Scalar> nearest(const BentWall& wall, const Place<Scalar>& place) {
  Place<Scalar> from;
  for (int k = 0; k < 3; ++k) {
    from[k] = place[k] - wall.at[k];
  }
  const Scalar z =
      wall.kind == WallKind::Sphere ? Scalar(0.0) : dot(wall.axis, from);
  Place<Scalar> across;
  for (int k = 0; k < 3; ++k) {
    across[k] = from[k] - z * wall.axis[k];
  }
  const Scalar reach = sqrt(across[0] * across[0] + across[1] * across[1] +
                            across[2] * across[2]);
  Scalar along = z;
  Scalar out = wall.radius;
  if (wall.kind == WallKind::Cone) {
    const double c = std::cos(wall.half_angle);
    const double s = std::sin(wall.half_angle);
    const Scalar line = c * z + s * reach;
    along = c * line;
    out = s * line;
  }
  Place<Scalar> result;
  for (int k = 0; k < 3; ++k) {
    result[k] = wall.at[k] + along * wall.axis[k] + out / reach * across[k];
  }
  return result;
}

}  // namespace

BentWall with_origin_beside(BentWall wall, const Vec3& place) {
  if (wall.kind == WallKind::Cylinder) {
    wall.at += wall.axis.dot(place - wall.at) * wall.axis;
  }
  return wall;
}

bool is_same(const BentWall& a, const BentWall& b) {
  if (a.kind != b.kind || a.radius != b.radius ||
      a.half_angle != b.half_angle || a.axis != b.axis) {
    return false;
  }
  const double off = (with_origin_beside(a, b.at).at - b.at).norm();
  return off <= kSameAxis * (a.at.norm() + b.at.norm());
}

double distance_outside(const BentWall& wall, const Vec3& place) {
  const Vec3 from = place - wall.at;
  if (wall.kind == WallKind::Sphere) {
    return from.norm() - wall.radius;
  }
  const double z = wall.axis.dot(from);
  const double reach = (from - z * wall.axis).norm();
  return wall.kind == WallKind::Cone
             ? reach * std::cos(wall.half_angle) - z * std::sin(wall.half_angle)
             : reach - wall.radius;
}

Expression wall_formula(const BentWall& wall) {
  std::string square;
  std::string along;
  for (int k = 0; k < 3; ++k) {
    const std::string from =
        fmt::format("({}-({:.17g}))", "xyz"[k], wall.at[k]);
    square += fmt::format("{}{}^2", k > 0 ? "+" : "", from);
    along +=
        fmt::format("{}({:.17g})*{}", k > 0 ? "+" : "", wall.axis[k], from);
  }
  std::string text;
  if (wall.kind == WallKind::Sphere) {
    text = fmt::format("sqrt({})-({:.17g})", square, wall.radius);
  } else if (wall.kind == WallKind::Cylinder) {
    text = fmt::format("sqrt({}-({})^2)-({:.17g})", square, along, wall.radius);
  } else {
    text = fmt::format("({:.17g})*sqrt({}-({})^2)-({:.17g})*({})",
                       std::cos(wall.half_angle), square, along,
                       std::sin(wall.half_angle), along);
  }
  return Expression::parse(text, {"x", "y", "z"});
}

Vec3 onto_wall(const BentWall& wall, const Vec3& place) {
  const Place<double> found =
      nearest<double>(wall, {place.x(), place.y(), place.z()});
  const Vec3 result(found[0], found[1], found[2]);
  if (wall.kind == WallKind::Cone && !(wall.axis.dot(result - wall.at) > 0.0)) {
    return Vec3::Constant(std::nan(""));
  }
  return result;
}

OntoWall onto_wall_jet(const BentWall& wall, const Vec3& place) {
  const Place<Dual3> found = nearest<Dual3>(
      wall, {Dual3::variable(place.x(), 0), Dual3::variable(place.y(), 1),
             Dual3::variable(place.z(), 2)});
  OntoWall result;
  for (int k = 0; k < 3; ++k) {
    result.point[k] = found[k].value;
    result.slope.row(k) = found[k].gradient.transpose();
    result.bend[k] = found[k].hessian;
  }
  return result;
}

Eigen::Matrix3d OntoWall::bend_along(const Vec3& way) const {
  Eigen::Matrix3d result;
  for (int k = 0; k < 3; ++k) {
    result.row(k) = (bend[k] * way).transpose();
  }
  return result;
}

Eigen::Matrix3d bend_slope(const BentWall& wall, const Vec3& place,
                           const Vec3& way) {
  const Vec3 from = place - wall.at;
  const double step =
      1e-3 *
      (wall.kind == WallKind::Sphere ? from : wall.axis.cross(from)).norm();
  const auto bends = [&](const Vec3& at) {
    const OntoWall onto = onto_wall_jet(wall, at);
    Vec3 result;
    for (int k = 0; k < 3; ++k) {
      result[k] = way.dot(onto.bend[k] * way);
    }
    return result;
  };
  Eigen::Matrix3d result;
  for (int k = 0; k < 3; ++k) {
    const Vec3 h = step * Vec3::Unit(k);
    result.col(k) = (8.0 * (bends(place + h) - bends(place - h)) -
                     (bends(place + 2.0 * h) - bends(place - 2.0 * h))) /
                    (12.0 * step);
  }
  return result;
}

Vec3 first_axis(const BentWall& wall) {
  Eigen::Index least = 0;
  wall.axis.cwiseAbs().minCoeff(&least);
  return wall.axis.cross(Vec3::Unit(least)).normalized();
}

Vec3 about_axis(const BentWall& wall, const Vec3& place) {
  const Vec3 from = place - wall.at;
  const Vec3 x = first_axis(wall);
  return {x.dot(from), wall.axis.cross(x).dot(from), wall.axis.dot(from)};
}

}  // namespace meniscus::films
