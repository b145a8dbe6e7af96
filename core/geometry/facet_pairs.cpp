#include "core/geometry/facet_pairs.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

#include <Eigen/Geometry>

#include "core/geometry/facet_tree.h"
#include "core/geometry/orientation.h"

namespace meniscus {

namespace {

using Corners = std::array<Vec3, 3>;

Corners corners_of(const SurfaceMesh& mesh, int facet) {
  const Triangle& t = mesh.facets[facet];
  return {mesh.points[t[0]], mesh.points[t[1]], mesh.points[t[2]]};
}

// Does the closed segment p q meet the closed segment r s of one plane, seen
// along an axis along which the plane is no line?
bool segments_meet(int along, const Vec3& p, const Vec3& q, const Vec3& r,
                   const Vec3& s) {
  const int side_p = orientation_along(along, r, s, p);
  const int side_q = orientation_along(along, r, s, q);
  const int side_r = orientation_along(along, p, q, r);
  const int side_s = orientation_along(along, p, q, s);
  if (side_p != 0 || side_q != 0 || side_r != 0 || side_s != 0) {
    return side_p * side_q <= 0 && side_r * side_s <= 0;
  }
  for (int k = 0; k < 3; ++k) {  // on one line: by their extents
    if (k != along && (std::max(p[k], q[k]) < std::min(r[k], s[k]) ||
                       std::max(r[k], s[k]) < std::min(p[k], q[k]))) {
      return false;
    }
  }
  return true;
}

// An axis along which the triangle is seen as one, and which way it turns.
struct View {
  int along = 0;
  int turn = 0;
};

View view_of(const Corners& t) {
  View view;
  (t[1] - t[0]).cross(t[2] - t[0]).cwiseAbs().maxCoeff(&view.along);
  view.turn = orientation_along(view.along, t[0], t[1], t[2]);
  for (int more = 0; view.turn == 0 && more < 2; ++more) {  // n is rounded
    view.along = (view.along + 1) % 3;
    view.turn = orientation_along(view.along, t[0], t[1], t[2]);
  }
  return view;
}

// Does the segment p q meet the triangle, both in one plane?
bool meets_in_plane(const Vec3& p, const Vec3& q, const Corners& t) {
  const auto [along, turn] = view_of(t);
  bool inside = true;
  for (int k = 0; k < 3; ++k) {
    const Vec3& a = t[k];
    const Vec3& b = t[(k + 1) % 3];
    if (segments_meet(along, p, q, a, b)) {
      return true;
    }
    inside = inside && orientation_along(along, a, b, p) * turn > 0;
  }
  return inside;
}

// Where the segment p q meets the triangle, both with their ends and edges: by
// exact signs; the place is rounded.
std::optional<Vec3> pierce(const Vec3& p, const Vec3& q, const Corners& t) {
  const int side_p = orientation(t[0], t[1], t[2], p);
  const int side_q = orientation(t[0], t[1], t[2], q);
  if (side_p * side_q > 0) {
    return std::nullopt;
  }
  if (side_p == 0 && side_q == 0) {
    return meets_in_plane(p, q, t) ? std::optional<Vec3>(0.5 * (p + q))
                                   : std::nullopt;
  }
  int positive = 0;
  int negative = 0;
  for (int k = 0; k < 3; ++k) {
    const int side = orientation(p, q, t[k], t[(k + 1) % 3]);
    positive += side > 0 ? 1 : 0;
    negative += side < 0 ? 1 : 0;
  }
  if (positive > 0 && negative > 0) {
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

// Rounding of a coordinate along an axis of length 1.
double axis_rounding(const Corners& s, const Corners& t) {
  double largest = 0.0;
  for (int k = 0; k < 3; ++k) {
    largest = std::max(
        {largest, s[k].cwiseAbs().maxCoeff(), t[k].cwiseAbs().maxCoeff()});
  }
  return 64.0 * std::numeric_limits<double>::epsilon() * largest;
}

// Is `other` beyond the plane of t, or beyond one of its edges seen along its
// normal, by more than `gap`? Corners flagged in `shared` are left out (they
// lie on t); then an edge through that corner separates with no gap. Never
// where rounding may have made the gap.
bool separated(const Corners& t, const Corners& other,
               const std::array<bool, 3>& shared, double gap, double rounding) {
  const Vec3 n = (t[1] - t[0]).cross(t[2] - t[0]).normalized();
  const auto beyond = [&](const Vec3& axis, const Vec3& origin, double least) {
    for (int k = 0; k < 3; ++k) {
      if (!shared[k] && !(axis.dot(other[k] - origin) > least + rounding)) {
        return false;
      }
    }
    // The axis is rounded, too: a thin facet may reach beyond its own plane.
    return std::all_of(t.begin(), t.end(), [&](const Vec3& p) {
      return axis.dot(p - origin) <= 0.25 * rounding;
    });
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

// Facets with a common edge: folded flat onto each other? Without a gap exactly
// so.
bool folded(const Corners& s, const Corners& t, int apex_s, int apex_t,
            double gap) {
  if (!(gap > 0.0)) {
    const Vec3& from = s[(apex_s + 1) % 3];
    const Vec3& to = s[(apex_s + 2) % 3];
    const View view = view_of(s);
    return orientation(s[0], s[1], s[2], t[apex_t]) == 0 &&
           orientation_along(view.along, from, to, t[apex_t]) == view.turn;
  }
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
  const double of_axes = axis_rounding(s, t);
  if (separated(s, t, shared.t, gap, of_axes) ||
      separated(t, s, shared.s, gap, of_axes)) {
    return verdict;
  }
  if (const auto at = find_crossing(s, t, shared)) {
    verdict.position = *at;
    return crossing_if(true);
  }
  if (!(tolerance > 0.0)) {
    return verdict;  // exactly apart; distances are rounded
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
