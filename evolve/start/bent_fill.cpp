#include "evolve/start/bent_fill.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <iterator>
#include <numbers>
#include <numeric>

#include <Eigen/Geometry>

#include "core/error.h"
#include "evolve/films/tube_strip.h"
#include "evolve/films/wall_development.h"
#include "evolve/start/cap_faces.h"
#include "evolve/start/disk_fill.h"

namespace meniscus::start {

namespace {

constexpr double kPi = std::numbers::pi;
constexpr double kMostTurn = kPi / 6.0;  // of an edge around a wall

double angle_of(const Vec3& about) { return std::atan2(about.y(), about.x()); }

/// How far a loop turns about the axis: 0, or a full turn either way.
double turn_of(const std::vector<double>& angles) {
  return angles.back() - angles.front();
}

/// A wall's loops laid into the plane z = 0 with angles kept, and the way back.
struct Map {
  std::vector<Points> loops;
  std::function<Vec3(const Vec3&)> from_plane;
  /// Length in the plane over that on the wall; empty: 1.
  std::function<double(const Vec3&)> scale;
  bool has_apex = false;  // a cone's, at the origin within the face
};

template <class ToPlane>
std::vector<Points> laid_flat(const std::vector<Points>& loops,
                              const ToPlane& to_plane) {
  std::vector<Points> result;
  for (const Points& loop : loops) {
    Points& places = result.emplace_back();
    std::transform(loop.begin(), loop.end(), std::back_inserter(places),
                   to_plane);
  }
  return result;
}

/// For faces that do not go around the axis. The loop around the others is the
/// one that reaches over most angles.
Map unrolled(const films::BentWall& wall, const std::vector<Points>& loops) {
  films::WallDevelopment plane{wall};
  std::vector<std::vector<double>> angles;
  std::vector<double> middles;
  double most = 0.0;
  for (const Points& loop : loops) {
    angles.push_back(films::angles_along(wall, loop));
    const auto [low, high] =
        std::minmax_element(angles.back().begin(), angles.back().end());
    middles.push_back(0.5 * (*low + *high));
    if (angles.size() == 1 || *high - *low > most) {
      most = *high - *low;
      plane.zero = middles.back();
    }
  }
  Map result;
  for (std::size_t k = 0; k < loops.size(); ++k) {
    const double turns =
        2.0 * kPi * std::round((middles[k] - plane.zero) / (2.0 * kPi));
    Points& places = result.loops.emplace_back();
    for (std::size_t i = 0; i < loops[k].size(); ++i) {
      places.push_back(plane.to_plane(
          angles[k][i] - turns, films::about_axis(wall, loops[k][i]).z()));
    }
  }
  result.from_plane = [plane](const Vec3& q) { return plane.from_plane(q); };
  return result;
}

/// Around the origin, by a power of the distance from a cone's apex.
Map around(const films::BentWall& cone, const std::vector<Points>& loops,
           double edge) {
  double middle = 0.0;
  std::size_t count = 0;
  for (const Points& loop : loops) {
    for (const Vec3& p : loop) {
      middle += films::about_axis(cone, p).z();
      ++count;
    }
  }
  middle /= static_cast<double>(count);
  const double power = 1.0 / std::sin(cone.half_angle);
  const double out = std::tan(cone.half_angle);
  const double unit = middle * out;
  const auto radius = [=](double z) {
    return unit * std::pow(std::max(z, 0.0) / middle, power);
  };
  const auto along = [=](double r) {
    return middle * std::pow(r / unit, 1.0 / power);
  };
  // Edges across an apex are no shorter than elsewhere.
  const double least = radius(0.5 * edge * std::cos(cone.half_angle));
  Map result;
  result.loops = laid_flat(loops, [&](const Vec3& p) {
    const Vec3 about = films::about_axis(cone, p);
    const double r = radius(about.z());
    const double angle = angle_of(about);
    return Vec3(r * std::cos(angle), r * std::sin(angle), 0.0);
  });
  result.from_plane = [=](const Vec3& q) {
    return films::at_angle(cone, angle_of(q), along(q.norm()));
  };
  result.scale = [=](const Vec3& q) {
    const double r = std::max(q.norm(), least);
    return r / (along(r) * out);
  };
  return result;
}

/// Stereographic, from opposite the pole.
Map seen_from(const films::BentWall& sphere, const Vec3& pole,
              const std::vector<Points>& loops) {
  const films::BentWall wall{.kind = films::WallKind::Sphere,
                             .at = sphere.at,
                             .axis = pole,
                             .radius = sphere.radius};
  const double r = sphere.radius;
  Map result;
  result.loops = laid_flat(loops, [&](const Vec3& p) {
    const Vec3 about = films::about_axis(wall, p);
    const double times = 2.0 * r / (r + about.z());
    return Vec3(times * about.x(), times * about.y(), 0.0);
  });
  result.from_plane = [=](const Vec3& q) {
    const double far = q.squaredNorm() / (4.0 * r * r);
    const double times = 1.0 / (1.0 + far);
    return films::from_about_axis(
        wall, {times * q.x(), times * q.y(), r * (1.0 - far) * times});
  };
  result.scale = [=](const Vec3& q) {
    return 1.0 + q.squaredNorm() / (4.0 * r * r);
  };
  return result;
}

/// Which loops go around the axis.
std::vector<std::size_t> loops_around(const films::BentWall& wall,
                                      const std::vector<Points>& loops) {
  std::vector<std::size_t> result;
  for (std::size_t k = 0; k < loops.size(); ++k) {
    if (wall.kind != films::WallKind::Sphere &&
        std::abs(turn_of(films::angles_along(wall, loops[k]))) > kPi) {
      result.push_back(k);
    }
  }
  const bool cone = wall.kind == films::WallKind::Cone;
  if (result.size() > 2 || (result.size() == 1 && !cone)) {
    throw InvalidInput(
        "a face around a cylinder needs two curves around it, and one around a "
        "cone one or two; name them with 'curve' and 'holes'");
  }
  return result;
}

Map map_of(const films::BentWall& wall, const std::vector<Points>& loops,
           std::size_t around_axis, double side, double edge) {
  if (wall.kind == films::WallKind::Sphere) {
    return seen_from(wall, pole_of_face(wall, loops, side), loops);
  }
  if (around_axis == 0) {
    return unrolled(wall, loops);
  }
  Map map = around(wall, loops, edge);
  map.has_apex = around_axis == 1;
  return map;
}

bool runs_along(const SurfaceMesh& flat, const Triangle& t, double turn) {
  const Vec3& a = flat.points[t[0]];
  return turn * (flat.points[t[1]] - a).cross(flat.points[t[2]] - a).z() > 0.0;
}

/// The inner vertex that is nearest to a cone's apex, the origin, goes there;
/// where there is none, one is made, with a facet behind each edge of the rim.
void put_on_apex(const Points& rim, std::size_t inner, SurfaceMesh& flat) {
  const auto nearest =
      std::min_element(flat.points.begin() + static_cast<std::ptrdiff_t>(inner),
                       flat.points.end(), [](const Vec3& a, const Vec3& b) {
                         return a.squaredNorm() < b.squaredNorm();
                       });
  if (nearest != flat.points.end()) {
    nearest->setZero();
    return;
  }
  const double turn = polygon_area_vector(rim).z();
  const auto count = static_cast<int>(rim.size());
  flat.facets.clear();
  flat.points.emplace_back(Vec3::Zero());
  for (int k = 0; k < count; ++k) {
    const Triangle facet = {k, (k + 1) % count, count};
    if (inner != rim.size() || !runs_along(flat, facet, turn)) {
      throw MeshError(
          "a face about a cone's apex has no room for a vertex there; take "
          "shorter edges");
    }
    flat.facets.push_back(facet);
  }
}

/// Facets filled in the plane, of which the first points are `ids` of `mesh`;
/// the others are added where the wall has them.
template <class FromPlane>
void add_from_plane(const SurfaceMesh& filling, std::vector<int> ids,
                    const FromPlane& from_plane, SurfaceMesh& mesh) {
  for (std::size_t v = ids.size(); v < filling.points.size(); ++v) {
    ids.push_back(static_cast<int>(mesh.points.size()));
    mesh.points.push_back(from_plane(filling.points[v]));
  }
  for (const Triangle& t : filling.facets) {
    mesh.facets.push_back({ids[t[0]], ids[t[1]], ids[t[2]]});
  }
}

/// The band between the two loops around a cylinder, filled along itself.
SurfaceMesh fill_strip(const films::BentWall& wall,
                       const std::vector<Points>& loops,
                       const std::vector<std::size_t>& ends, double edge) {
  const films::TubeStrip strip =
      films::cut_open(wall, loops, {ends[0], ends[1]}, edge);
  SurfaceMesh result;
  for (const Points& loop : loops) {
    result.points.insert(result.points.end(), loop.begin(), loop.end());
  }
  const films::WallDevelopment plane{wall};
  for (const Vec3& q : strip.seam) {
    result.points.push_back(plane.from_plane(q));
  }
  const SurfaceMesh flat = fill_disk(strip.rim, strip.holes, edge);
  add_from_plane(
      flat, strip.ids, [&](const Vec3& q) { return plane.from_plane(q); },
      result);
  return result;
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
  const std::vector<std::size_t> around_axis = loops_around(wall, loops);
  const double longest = wall.kind == films::WallKind::Cone
                             ? edge
                             : std::min(edge, kMostTurn * wall.radius);
  if (wall.kind == films::WallKind::Cylinder && !around_axis.empty()) {
    return fill_strip(wall, loops, around_axis, longest);
  }
  const Map map = map_of(wall, loops, around_axis.size(), side, edge);
  const std::vector<Points>& flat = map.loops;
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
      put_on_apex(flat[part[0]], ids.size(), filling);
    }
    add_from_plane(filling, std::move(ids), map.from_plane, result);
  }
  return result;
}

}  // namespace meniscus::start
