// The directions of a FilmSpace by the points that make them, backwards.
#include "core/error.h"
#include "evolve/facet_terms.h"
#include "evolve/film_space.h"

namespace meniscus {

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

}  // namespace

Vec3 line_axis(const Vec3& t) {
  Eigen::Index least = 0;
  t.cwiseAbs().minCoeff(&least);
  return Vec3::Unit(least);
}

void FilmSpace::transpose_directions(const Points& points,
                                     const Points& by_directions,
                                     Points& sum) const {
  if (has_walls()) {
    throw InvalidInput(
        "a film that slides on walls has no exact gradient: hold its rim on a "
        "curve");
  }
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
  Points by_normal2(points.size(), Vec3::Zero());
  for (int v = 0; v < vertex_count(); ++v) {
    const int at = first_[v];
    if (rank(v) == 1) {
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

}  // namespace meniscus
