// The directions of a FilmSpace by the points that make them, backwards and
// forwards.
#include <algorithm>

#include "core/error.h"
#include "evolve/energy/facet_terms.h"
#include "evolve/energy/film_space.h"

namespace meniscus::energy {

namespace {

/// From a gradient by unit(v) that by v; none where v is zero.
Vec3 through_unit(const Vec3& v, const Vec3& by_unit) {
  const double length = v.norm();
  if (!(length > 0.0)) {
    return Vec3::Zero();
  }
  const Vec3 unit = v / length;
  return (by_unit - unit.dot(by_unit) * unit) / length;
}

/// From gradients by the two normals of a line to that by the way along it:
///   t = unit(way), n0 = unit(t x e), n1 = t x n0, e an axis.
Vec3 through_normals(const Vec3& way, const Vec3& by_first,
                     const Vec3& by_second) {
  if (way.isZero(0.0)) {
    return Vec3::Zero();
  }
  const Vec3 t = way.normalized();
  const Vec3 axis = line_axis(t);
  const Vec3 c = t.cross(axis);
  const Vec3 n0 = c.normalized();
  const Vec3 by_c = through_unit(c, by_first + by_second.cross(t));
  return through_unit(way, n0.cross(by_second) + axis.cross(by_c));
}

/// How fast unit(v) turns when v changes at `rate`; zero where v is zero.
Vec3 unit_rate(const Vec3& v, const Vec3& rate) {
  return through_unit(v, rate);  // symmetric
}

[[noreturn]] void refuse_wall() {
  throw InvalidInput(
      "a film that slides on curves or on walls of a formula has no exact "
      "gradient: hold its rim on a curve, or let it slide on a plane, "
      "cylinder, sphere or cone");
}

}  // namespace

Vec3 line_axis(const Vec3& t) {
  Eigen::Index least = 0;
  t.cwiseAbs().minCoeff(&least);
  return Vec3::Unit(least);
}

/// Where two planes meet, the way along both is the same for all films, and so
/// are the two ways of a line's end within one plane.
bool FilmSpace::runs_along_planes(int k, const Points& points) const {
  const Wall& wall = walls_[k];
  const bool in_plane = wall.level_sets.size() == 1 && rank(walled_[k]) == 2;
  return wall.curve < 0 && (wall.level_sets.size() == 2 || in_plane) &&
         std::all_of(
             wall.level_sets.begin(), wall.level_sets.end(), [&](int level) {
               return jet_at(level_sets_[level].formula, points[walled_[k]])
                   .hessian.isZero(0.0);
             });
}

/// The way of a film's edge on a plane wall, as wall_directions() goes, before
/// it is made unit length.
FilmSpace::WallWay FilmSpace::wall_way(int k, const Points& points,
                                       const Vec3& normal2) const {
  const int v = walled_[k];
  const Wall& wall = walls_[k];
  if (wall.curve >= 0 || wall.level_sets.size() != 1 || rank(v) != 1) {
    refuse_wall();
  }
  const PlaceJet jet =
      jet_at(level_sets_[wall.level_sets[0]].formula, points[v]);
  WallWay result;
  result.normal = jet.gradient.normalized();
  const Vec3& n = result.normal;
  if (!jet.hessian.isZero(0.0)) {
    if (bent_wall(wall) == nullptr) {
      refuse_wall();
    }
    // d(g / |g|) = (I - n n') H dx / |g|
    result.turn =
        (jet.hessian - n * (n.transpose() * jet.hessian)) / jet.gradient.norm();
  }
  result.way = normal2 - normal2.dot(n) * n;
  if (const Edge& ends = line_ends(v); ends[0] >= 0) {
    const Vec3 across = n.cross(points[ends[1]] - points[ends[0]]);
    result.across = turns_across(result.way.normalized(), across.normalized());
    if (result.across) {
      result.way = across;
    }
  }
  return result;
}

void FilmSpace::transpose_directions(const Points& points,
                                     const Points& by_directions,
                                     Points& sum) const {
  // Area-weighted normals at the vertices, before they are made unit length.
  Points normal2(points.size(), Vec3::Zero());
  for (std::size_t f = 0; f < facets_.size(); ++f) {
    if (film_[f] != 0) {
      const Triangle& t = facets_[f];
      const FacetFrame frame(points[t[0]], points[t[1]], points[t[2]]);
      for (const int v : t) {
        normal2[v] += turn(static_cast<int>(f)) * frame.area2 * frame.normal;
      }
    }
  }
  // Backwards through the unit normals of films and the pairs of normals of
  // lines; the latter depend on the ends of the line alone.
  Points by_normal2(points.size(), Vec3::Zero());
  for (int v = 0; v < vertex_count(); ++v) {
    const int at = first_[v];
    if (rank(v) > 0 && !wall_of_.empty() && wall_of_[v] >= 0) {
      if (runs_along_planes(wall_of_[v], points)) {
        continue;
      }
      const WallWay way = wall_way(wall_of_[v], points, normal2[v]);
      const Vec3 by_way = through_unit(way.way, by_directions[at]);
      const Vec3& n = way.normal;
      const Edge& ends = line_ends(v);
      if (way.across) {  // n x t
        sum[ends[1]] += by_way.cross(n);
        sum[ends[0]] -= by_way.cross(n);
        sum[v] += way.turn.transpose() *
                  (points[ends[1]] - points[ends[0]]).cross(by_way);
      } else {  // N - (N . n) n
        by_normal2[v] = by_way - n.dot(by_way) * n;
        sum[v] -= way.turn.transpose() *
                  (n.dot(by_way) * normal2[v] + normal2[v].dot(n) * by_way);
      }
    } else if (rank(v) == 1) {
      by_normal2[v] = through_unit(normal2[v], by_directions[at]);
    } else if (rank(v) == 2) {
      const Edge& ends = line_ends(v);
      const Vec3 by_way =
          through_normals(points[ends[1]] - points[ends[0]], by_directions[at],
                          by_directions[at + 1]);
      sum[ends[1]] += by_way;
      sum[ends[0]] -= by_way;
    }
  }
  // Backwards through the facets' area vectors N, which add to the normals of
  // all three corners.
  for (std::size_t f = 0; f < facets_.size(); ++f) {
    if (film_[f] == 0) {
      continue;
    }
    const Triangle& t = facets_[f];
    const Vec3 by = turn(static_cast<int>(f)) *
                    (by_normal2[t[0]] + by_normal2[t[1]] + by_normal2[t[2]]);
    for (int i = 0; i < 3; ++i) {
      // dN = e_i x dx_i
      const Vec3 opposite = points[t[(i + 2) % 3]] - points[t[(i + 1) % 3]];
      sum[t[i]] += by.cross(opposite);
    }
  }
}

Points FilmSpace::direction_rates(const Points& points,
                                  const Points& motion) const {
  // Area-weighted normals and their rates: N = b x c, dN = db x c + b x dc.
  Points normal2(points.size(), Vec3::Zero());
  Points rate2(points.size(), Vec3::Zero());
  for (std::size_t f = 0; f < facets_.size(); ++f) {
    if (film_[f] == 0) {
      continue;
    }
    const Triangle& t = facets_[f];
    const double turned = turn(static_cast<int>(f));
    const Vec3 b = points[t[1]] - points[t[0]];
    const Vec3 c = points[t[2]] - points[t[0]];
    const Vec3 area2 = turned * b.cross(c);
    const Vec3 rate = turned * ((motion[t[1]] - motion[t[0]]).cross(c) +
                                b.cross(motion[t[2]] - motion[t[0]]));
    for (const int v : t) {
      normal2[v] += area2;
      rate2[v] += rate;
    }
  }
  // Through the unit length, dn = (I - n n') dN / |N|.
  Points result(vertex_.size(), Vec3::Zero());
  for (int v = 0; v < vertex_count(); ++v) {
    const int at = first_[v];
    if (rank(v) > 0 && !wall_of_.empty() && wall_of_[v] >= 0) {
      if (runs_along_planes(wall_of_[v], points)) {
        continue;
      }
      const WallWay way = wall_way(wall_of_[v], points, normal2[v]);
      const Vec3& n = way.normal;
      const Edge& ends = line_ends(v);
      const Vec3 turned = way.turn * motion[v];
      result[at] = unit_rate(
          way.way,
          way.across
              ? Vec3(n.cross(motion[ends[1]] - motion[ends[0]]) +
                     turned.cross(points[ends[1]] - points[ends[0]]))
              : Vec3(rate2[v] - n.dot(rate2[v]) * n -
                     turned.dot(normal2[v]) * n - n.dot(normal2[v]) * turned));
    } else if (rank(v) == 1) {
      result[at] = unit_rate(normal2[v], rate2[v]);
    } else if (rank(v) == 2) {
      const Edge& ends = line_ends(v);
      const Vec3 way = points[ends[1]] - points[ends[0]];
      if (!way.isZero(0.0)) {
        // A line has n0 = unit(t x e) and n1 = t x n0, e a fixed axis, so that
        // dn1 = dt x n0 + t x dn0.
        const Vec3 t = way.normalized();
        const Vec3 turned = unit_rate(way, motion[ends[1]] - motion[ends[0]]);
        const Vec3 axis = line_axis(t);
        const Vec3 c = t.cross(axis);
        result[at] = unit_rate(c, turned.cross(axis));
        result[at + 1] = turned.cross(c.normalized()) + t.cross(result[at]);
      }
    }
  }
  return result;
}

}  // namespace meniscus::energy
