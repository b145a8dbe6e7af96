#include "evolve/films/wall_development.h"

#include <cmath>

#include <Eigen/Geometry>

namespace meniscus::films {

Vec3 from_about_axis(const BentWall& wall, const Vec3& about) {
  const Vec3 x = first_axis(wall);
  return wall.at + about.x() * x + about.y() * wall.axis.cross(x) +
         about.z() * wall.axis;
}

Vec3 at_angle(const BentWall& wall, double angle, double z) {
  const double out =
      wall.kind == WallKind::Cone ? z * std::tan(wall.half_angle) : wall.radius;
  return from_about_axis(wall,
                         {out * std::cos(angle), out * std::sin(angle), z});
}

std::vector<double> angles_along(const BentWall& wall, const Points& loop) {
  const Vec3 first = about_axis(wall, loop.front());
  std::vector<double> result = {std::atan2(first.y(), first.x())};
  for (std::size_t k = 0; k < loop.size(); ++k) {
    const Vec3 a = about_axis(wall, loop[k]);
    const Vec3 b = about_axis(wall, loop[(k + 1) % loop.size()]);
    result.push_back(result.back() + std::atan2(a.x() * b.y() - a.y() * b.x(),
                                                a.x() * b.x() + a.y() * b.y()));
  }
  return result;
}

Vec3 WallDevelopment::to_plane(double angle, double z) const {
  if (wall.kind != WallKind::Cone) {
    return {wall.radius * (angle - zero), z, 0.0};
  }
  const double turn = std::sin(wall.half_angle) * (angle - zero);
  const double line = z / std::cos(wall.half_angle);
  return {line * std::cos(turn), line * std::sin(turn), 0.0};
}

Vec3 WallDevelopment::from_plane(const Vec3& q) const {
  if (wall.kind != WallKind::Cone) {
    return at_angle(wall, zero + q.x() / wall.radius, q.y());
  }
  return at_angle(wall,
                  zero + std::atan2(q.y(), q.x()) / std::sin(wall.half_angle),
                  std::cos(wall.half_angle) * q.norm());
}

}  // namespace meniscus::films
