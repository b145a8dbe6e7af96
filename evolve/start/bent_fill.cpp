#include "evolve/start/bent_fill.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <numbers>
#include <numeric>

#include <Eigen/Geometry>

#include "core/error.h"
#include "evolve/start/cap_faces.h"
#include "evolve/start/disk_fill.h"

namespace meniscus::start {

namespace {

constexpr double kPi = std::numbers::pi;
constexpr double kMostTurn = kPi / 6.0;  // of an edge around a wall

double angle_of(const Vec3& about) { return std::atan2(about.y(), about.x()); }

/// How far a loop turns about the axis: 0, or a full turn either way.
double turn_of(const films::BentWall& wall, const Points& loop) {
  double sum = 0.0;
  for (std::size_t k = 0; k < loop.size(); ++k) {
    const Vec3 a = films::about_axis(wall, loop[k]);
    const Vec3 b = films::about_axis(wall, loop[(k + 1) % loop.size()]);
    sum += std::atan2(a.x() * b.y() - a.y() * b.x(),
                      a.x() * b.x() + a.y() * b.y());
  }
  return sum;
}

/// A wall, or what a face needs of it, laid into the plane z = 0 with angles
/// kept.
struct Map {
  std::function<Vec3(const Vec3&)> to_plane;
  std::function<Vec3(const Vec3&)> from_plane;
  /// Length in the plane over that on the wall; empty: 1.
  std::function<double(const Vec3&)> scale;
  bool has_apex = false;  // a cone's, at the origin within the face
};

Vec3 at_about(const films::BentWall& wall, const Vec3& about) {
  const Vec3 x = films::first_axis(wall);
  return wall.at + about.x() * x + about.y() * wall.axis.cross(x) +
         about.z() * wall.axis;
}

/// Where the wall is so far along its axis, at an angle.
Vec3 at_angle(const films::BentWall& wall, double angle, double z) {
  const double out = wall.kind == films::WallKind::Cone
                         ? z * std::tan(wall.half_angle)
                         : wall.radius;
  return at_about(wall, {out * std::cos(angle), out * std::sin(angle), z});
}

/// Unrolled, for faces that do not go around the axis.
Map unrolled(const films::BentWall& wall, const std::vector<Points>& loops) {
  Vec3 middle = Vec3::Zero();
  for (const Points& loop : loops) {
    for (const Vec3& p : loop) {
      middle += films::about_axis(wall, p);
    }
  }
  const double zero = angle_of(middle);
  const auto from_middle = [wall, zero](const Vec3& about) {
    return std::remainder(angle_of(about) - zero, 2.0 * kPi);
  };
  if (wall.kind == films::WallKind::Cylinder) {
    return {[=](const Vec3& p) {
              const Vec3 about = films::about_axis(wall, p);
              return Vec3(wall.radius * from_middle(about), about.z(), 0.0);
            },
            [=](const Vec3& q) {
              return at_angle(wall, zero + q.x() / wall.radius, q.y());
            },
            {}};
  }
  const double s = std::sin(wall.half_angle);
  const double c = std::cos(wall.half_angle);
  return {[=](const Vec3& p) {
            const Vec3 about = films::about_axis(wall, p);
            const double turn = s * from_middle(about);
            const double line = about.z() / c;
            return Vec3(line * std::cos(turn), line * std::sin(turn), 0.0);
          },
          [=](const Vec3& q) {
            return at_angle(wall, zero + angle_of(q) / s, c * q.norm());
          },
          {}};
}

/// Around the origin: exp(z / R) of a cylinder, a power of the distance from a
/// cone's apex.
Map around(const films::BentWall& wall, const std::vector<Points>& loops,
           double edge) {
  double middle = 0.0;
  std::size_t count = 0;
  for (const Points& loop : loops) {
    for (const Vec3& p : loop) {
      middle += films::about_axis(wall, p).z();
      ++count;
    }
  }
  middle /= static_cast<double>(count);
  const bool cone = wall.kind == films::WallKind::Cone;
  const double power = cone ? 1.0 / std::sin(wall.half_angle) : 1.0;
  const double unit = cone ? middle * std::tan(wall.half_angle) : wall.radius;
  const auto radius = [=](double z) {
    return unit * (cone ? std::pow(std::max(z, 0.0) / middle, power)
                        : std::exp((z - middle) / unit));
  };
  const auto along = [=](double r) {
    return cone ? middle * std::pow(r / unit, 1.0 / power)
                : middle + unit * std::log(r / unit);
  };
  // Edges across an apex are no shorter than elsewhere.
  const double least =
      cone ? radius(0.5 * edge * std::cos(wall.half_angle)) : 0.0;
  return {[=](const Vec3& p) {
            const Vec3 about = films::about_axis(wall, p);
            const double r = radius(about.z());
            const double angle = angle_of(about);
            return Vec3(r * std::cos(angle), r * std::sin(angle), 0.0);
          },
          [=](const Vec3& q) {
            return at_angle(wall, angle_of(q), along(q.norm()));
          },
          [=](const Vec3& q) {
            const double r = std::max(q.norm(), least);
            const double out =
                cone ? along(r) * std::tan(wall.half_angle) : wall.radius;
            return r / out;
          }};
}

/// Stereographic, from opposite the pole.
Map seen_from(const films::BentWall& sphere, const Vec3& pole) {
  const films::BentWall wall{.kind = films::WallKind::Sphere,
                             .at = sphere.at,
                             .axis = pole,
                             .radius = sphere.radius};
  const double r = sphere.radius;
  return {[=](const Vec3& p) {
            const Vec3 about = films::about_axis(wall, p);
            const double times = 2.0 * r / (r + about.z());
            return Vec3(times * about.x(), times * about.y(), 0.0);
          },
          [=](const Vec3& q) {
            const double far = q.squaredNorm() / (4.0 * r * r);
            const double times = 1.0 / (1.0 + far);
            return at_about(
                wall, {times * q.x(), times * q.y(), r * (1.0 - far) * times});
          },
          [=](const Vec3& q) { return 1.0 + q.squaredNorm() / (4.0 * r * r); }};
}

Map map_of(const films::BentWall& wall, const std::vector<Points>& loops,
           double side, double edge) {
  if (wall.kind == films::WallKind::Sphere) {
    return seen_from(wall, pole_of_face(wall, loops, side));
  }
  const auto turns = std::count_if(
      loops.begin(), loops.end(),
      [&](const Points& loop) { return std::abs(turn_of(wall, loop)) > kPi; });
  if (turns == 0) {
    return unrolled(wall, loops);
  }
  const bool apex = wall.kind == films::WallKind::Cone && turns == 1;
  if (!apex && turns != 2) {
    throw InvalidInput(
        "a face around a cylinder needs two curves around it, and one around a "
        "cone one or two; name them with 'curve' and 'holes'");
  }
  Map map = around(wall, loops, edge);
  map.has_apex = apex;
  return map;
}

/// The inner vertex that is nearest to a cone's apex goes there.
void put_on_apex(std::size_t first, const Vec3& apex, SurfaceMesh& flat) {
  const auto nearest = std::min_element(
      flat.points.begin() + static_cast<std::ptrdiff_t>(first),
      flat.points.end(), [&](const Vec3& a, const Vec3& b) {
        return (a - apex).squaredNorm() < (b - apex).squaredNorm();
      });
  if (nearest != flat.points.end()) {
    *nearest = apex;
  }
}

}  // namespace

Vec3 pole_of_face(const films::BentWall& sphere,
                  const std::vector<Points>& loops, double side) {
  std::size_t largest = 0;
  std::vector<Vec3> across;
  std::vector<Vec3> middle;
  for (const Points& loop : loops) {
    across.push_back(polygon_area_vector(loop));
    middle.push_back(
        std::accumulate(loop.begin(), loop.end(), Vec3(Vec3::Zero())) /
            static_cast<double>(loop.size()) -
        sphere.at);
    if (across.back().norm() > across[largest].norm()) {
      largest = across.size() - 1;
    }
  }
  const Vec3 pole = across[largest].normalized();
  if (side != 0.0) {
    return side * pole;
  }
  if (loops.size() == 1) {
    return pole.dot(middle[0]) < 0.0 ? Vec3(-pole) : pole;
  }
  double others = 0.0;
  for (std::size_t k = 0; k < loops.size(); ++k) {
    others += pole.dot(middle[k] - middle[largest]);
  }
  return others < 0.0 ? Vec3(-pole) : pole;
}

SurfaceMesh fill_bent_face(const films::BentWall& wall,
                           const std::vector<Points>& loops, double side,
                           double edge) {
  const Map map = map_of(wall, loops, side, edge);
  std::vector<Points> flat;
  for (const Points& loop : loops) {
    Points& places = flat.emplace_back();
    for (const Vec3& p : loop) {
      places.push_back(map.to_plane(p));
    }
  }
  const double longest = wall.kind == films::WallKind::Cone
                             ? edge
                             : std::min(edge, kMostTurn * wall.radius);
  const auto wanted = [&](const Vec3& q) {
    return map.scale ? longest * map.scale(q) : longest;
  };
  SurfaceMesh result;
  // The loops' points keep their numbers; each part's own follow.
  std::vector<int> first_of;
  for (const Points& loop : loops) {
    first_of.push_back(static_cast<int>(result.points.size()));
    result.points.insert(result.points.end(), loop.begin(), loop.end());
  }
  for (const std::vector<int>& part : faces_with_holes(flat)) {
    std::vector<Points> holes;
    std::vector<int> ids;
    for (const int k : part) {
      if (k != part[0]) {
        holes.push_back(flat[k]);
      }
      for (std::size_t v = 0; v < flat[k].size(); ++v) {
        ids.push_back(first_of[k] + static_cast<int>(v));
      }
    }
    SurfaceMesh filling = fill_disk(flat[part[0]], holes, longest, wanted);
    if (map.has_apex) {
      put_on_apex(ids.size(), map.to_plane(wall.at), filling);
    }
    for (std::size_t v = ids.size(); v < filling.points.size(); ++v) {
      ids.push_back(static_cast<int>(result.points.size()));
      result.points.push_back(map.from_plane(filling.points[v]));
    }
    for (const Triangle& t : filling.facets) {
      result.facets.push_back({ids[t[0]], ids[t[1]], ids[t[2]]});
    }
  }
  return result;
}

}  // namespace meniscus::start
