#include "core/geometry/facet_pairs.h"

#include <algorithm>
#include <cmath>
#include <optional>

#include <Eigen/Geometry>

#include "core/geometry/facet_tree.h"

namespace meniscus {

namespace {

using Corners = std::array<Vec3, 3>;
using Vec3L = Eigen::Matrix<long double, 3, 1>;

Corners corners_of(const SurfaceMesh& mesh, int facet) {
  const Triangle& t = mesh.facets[facet];
  return {mesh.points[t[0]], mesh.points[t[1]], mesh.points[t[2]]};
}

// Sign of the volume of (a, b, c, d): double behind a bound of its rounding
// error, else extended precision; 0 where even that cannot tell.
int orientation(const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& d) {
  const Vec3 u = b - a;
  const Vec3 v = c - a;
  const Vec3 w = d - a;
  const double size = u.cwiseAbs().maxCoeff() * v.cwiseAbs().maxCoeff() *
                      w.cwiseAbs().maxCoeff();
  const double det = u.cross(v).dot(w);
  if (std::abs(det) > 1e-14 * size) {
    return det > 0.0 ? 1 : -1;
  }
  const Vec3L al = a.cast<long double>();
  const Vec3L ul = b.cast<long double>() - al;
  const Vec3L vl = c.cast<long double>() - al;
  const Vec3L wl = d.cast<long double>() - al;
  const long double fine = ul.cross(vl).dot(wl);
  if (std::abs(fine) > 1e-17L * static_cast<long double>(size)) {
    return fine > 0.0L ? 1 : -1;
  }
  return 0;
}

// Where the segment p q passes through the triangle, its ends off the plane.
std::optional<Vec3> pierce(const Vec3& p, const Vec3& q, const Corners& t) {
  const int side_p = orientation(t[0], t[1], t[2], p);
  const int side_q = orientation(t[0], t[1], t[2], q);
  if (side_p * side_q >= 0) {
    return std::nullopt;
  }
  int positive = 0;
  int negative = 0;
  for (int k = 0; k < 3; ++k) {
    const int side = orientation(p, q, t[k], t[(k + 1) % 3]);
    positive += side > 0 ? 1 : 0;
    negative += side < 0 ? 1 : 0;
  }
  if ((positive == 0) == (negative == 0)) {
    return std::nullopt;
  }
  const Vec3 n = (t[1] - t[0]).cross(t[2] - t[0]);
  const double height_p = std::abs(n.dot(p - t[0]));
  const double height_q = std::abs(n.dot(q - t[0]));
  const double sum = height_p + height_q;
  return sum > 0.0 ? Vec3(p + height_p / sum * (q - p)) : p;
}

double point_segment2(const Vec3& p, const Vec3& a, const Vec3& b) {
  const Vec3 ab = b - a;
  const double t =
      std::clamp(ab.dot(p - a) / std::max(ab.squaredNorm(), 1e-300), 0.0, 1.0);
  return (p - a - t * ab).squaredNorm();
}

double point_triangle2(const Vec3& p, const Corners& t) {
  const Vec3 n = (t[1] - t[0]).cross(t[2] - t[0]);
  bool inside = true;
  double least = 1e300;
  for (int k = 0; k < 3; ++k) {
    const Vec3& a = t[k];
    const Vec3& b = t[(k + 1) % 3];
    inside = inside && n.cross(b - a).dot(p - a) >= 0.0;
    least = std::min(least, point_segment2(p, a, b));
  }
  if (inside) {
    const double h = n.dot(p - t[0]);
    least = std::min(least, h * h / n.squaredNorm());
  }
  return least;
}

double segment_segment2(const Vec3& p, const Vec3& q, const Vec3& a,
                        const Vec3& b) {
  const Vec3 d = q - p;
  const Vec3 e = b - a;
  const Vec3 r = p - a;
  const double dd = d.squaredNorm();
  const double ee = e.squaredNorm();
  const double de = d.dot(e);
  const double denominator = dd * ee - de * de;
  double least = std::min({point_segment2(p, a, b), point_segment2(q, a, b),
                           point_segment2(a, p, q), point_segment2(b, p, q)});
  if (denominator > 1e-14 * dd * ee) {
    const double s = (de * e.dot(r) - ee * d.dot(r)) / denominator;
    const double t = (dd * e.dot(r) - de * d.dot(r)) / denominator;
    if (s > 0.0 && s < 1.0 && t > 0.0 && t < 1.0) {
      least = std::min(least, (r + s * d - t * e).squaredNorm());
    }
  }
  return least;
}

double distance2(const Corners& s, const Corners& t) {
  double least = 1e300;
  for (int i = 0; i < 3; ++i) {
    least =
        std::min({least, point_triangle2(s[i], t), point_triangle2(t[i], s)});
    for (int j = 0; j < 3; ++j) {
      least = std::min(
          least, segment_segment2(s[i], s[(i + 1) % 3], t[j], t[(j + 1) % 3]));
    }
  }
  return least;
}

// Is `other` beyond the plane of t, or beyond one of its edges seen along its
// normal, by more than `gap`? Corners flagged in `shared` are left out (they
// lie on t); then an edge through that corner separates with no gap.
bool separated(const Corners& t, const Corners& other,
               const std::array<bool, 3>& shared, double gap) {
  const Vec3 n = (t[1] - t[0]).cross(t[2] - t[0]).normalized();
  const auto beyond = [&](const Vec3& axis, const Vec3& origin, double least) {
    for (int k = 0; k < 3; ++k) {
      if (!shared[k] && !(axis.dot(other[k] - origin) > least)) {
        return false;
      }
    }
    return true;
  };
  if (beyond(n, t[0], gap) || beyond(-n, t[0], gap)) {
    return true;
  }
  const bool common = shared[0] || shared[1] || shared[2];
  for (int k = 0; k < 3; ++k) {
    const Vec3 outward = (t[(k + 1) % 3] - t[k]).cross(n).normalized();
    bool touches = true;  // the shared corner lies on this edge
    if (common) {
      const Vec3& corner = other[shared[0] ? 0 : shared[1] ? 1 : 2];
      touches = corner == t[k] || corner == t[(k + 1) % 3];
    }
    if (touches && beyond(outward, t[k], common ? -gap : gap)) {
      return true;
    }
  }
  return false;
}

// Facets with a common edge: folded flat onto each other?
bool folded(const Corners& s, const Corners& t, int apex_s, int apex_t,
            double gap) {
  const Vec3& a = s[(apex_s + 1) % 3];
  const Vec3 along = (s[(apex_s + 2) % 3] - a).normalized();
  const auto off = [&](const Vec3& p) {
    return Vec3(p - a - along * along.dot(p - a));
  };
  const Vec3 u = off(s[apex_s]);
  const Vec3 v = off(t[apex_t]);
  const double height = std::min(u.norm(), v.norm());
  return u.dot(v) > 0.0 &&
         u.normalized().cross(v.normalized()).norm() * height < gap;
}

struct Shared {
  std::array<bool, 3> s{};
  std::array<bool, 3> t{};
  int count = 0;
};

Shared shared_corners(const Triangle& f, const Triangle& g) {
  Shared shared;
  for (int i = 0; i < 3; ++i) {
    for (int j = 0; j < 3; ++j) {
      if (f[i] == g[j]) {
        shared.s[i] = shared.t[j] = true;
        ++shared.count;
      }
    }
  }
  return shared;
}

std::optional<Vec3> find_crossing(const Corners& s, const Corners& t,
                                  const Shared& shared) {
  for (int k = 0; k < 3; ++k) {
    const int next = (k + 1) % 3;
    if (!shared.s[k] && !shared.s[next]) {
      if (const auto at = pierce(s[k], s[next], t)) {
        return at;
      }
    }
    if (!shared.t[k] && !shared.t[next]) {
      if (const auto at = pierce(t[k], t[next], s)) {
        return at;
      }
    }
  }
  return std::nullopt;
}

// Facets with one common corner that no plane separates. In one plane they
// overlap around it; a corner on the other facet makes a fold without crossing.
bool overlap_at_corner(const Corners& s, const Corners& t, const Shared& shared,
                       double rounding) {
  const Vec3 n = (t[1] - t[0]).cross(t[2] - t[0]).normalized();
  bool touching = std::all_of(s.begin(), s.end(), [&](const Vec3& p) {
    return std::abs(n.dot(p - t[0])) <= rounding;
  });
  const double reach = rounding * rounding;
  for (int k = 0; k < 3; ++k) {
    touching = touching ||
               (!shared.s[k] && point_triangle2(s[k], t) <= reach) ||
               (!shared.t[k] && point_triangle2(t[k], s) <= reach);
  }
  return touching;
}

}  // namespace

PairVerdict classify_pair(const SurfaceMesh& mesh, int f, int g,
                          double tolerance) {
  const Corners s = corners_of(mesh, f);
  const Corners t = corners_of(mesh, g);
  const Shared shared = shared_corners(mesh.facets[f], mesh.facets[g]);
  PairVerdict verdict;
  verdict.position = (s[0] + s[1] + s[2] + t[0] + t[1] + t[2]) / 6.0;
  // Neighbours touch by right: a thousandth of the tolerance is rounding.
  const double rounding = 1e-3 * tolerance;
  const auto crossing_if = [&](bool crosses) {
    verdict.state = crosses ? PairState::Crossing : PairState::Apart;
    return verdict;
  };
  if (shared.count >= 3) {
    return verdict;  // a duplicate, found elsewhere
  }
  if (shared.count == 2) {
    const auto apex = [](const std::array<bool, 3>& common) {
      return !common[0] ? 0 : !common[1] ? 1 : 2;
    };
    return crossing_if(folded(s, t, apex(shared.s), apex(shared.t), rounding));
  }
  const double gap = shared.count == 0 ? tolerance : rounding;
  if (separated(s, t, shared.t, gap) || separated(t, s, shared.s, gap)) {
    return verdict;
  }
  if (const auto at = find_crossing(s, t, shared)) {
    verdict.position = *at;
    return crossing_if(true);
  }
  if (shared.count == 1) {
    return crossing_if(overlap_at_corner(s, t, shared, rounding));
  }
  const double gap2 = distance2(s, t);
  if (gap2 > rounding * rounding && gap2 < tolerance * tolerance) {
    verdict.state = PairState::TooClose;
    return verdict;
  }
  return crossing_if(gap2 <= rounding * rounding);
}

bool for_each_near_pair(const SurfaceMesh& mesh, const std::vector<int>& facets,
                        double tolerance,
                        const std::function<bool(int, int)>& visit,
                        std::int64_t most_steps) {
  return FacetTree(mesh, facets, tolerance).visit_pairs(visit, most_steps);
}

}  // namespace meniscus
