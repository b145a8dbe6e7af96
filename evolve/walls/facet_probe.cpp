#include "evolve/walls/facet_probe.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include <Eigen/Geometry>

namespace meniscus::walls {

FacetProbe::FacetProbe(const Points& points,
                       const std::vector<Triangle>& facets)
    : points_(points), facets_(facets), tree_(facet_items(facets, points)) {
  planes_.reserve(facets.size());
  for (const BoxTree::Item& item : tree_.items()) {
    const auto& [a, b, c] = facets[item.id];
    const Vec3 n = (points[b] - points[a]).cross(points[c] - points[a]);
    const double length = n.norm();
    const Vec3 unit = length > 0.0 ? Vec3(n / length) : Vec3::Zero();
    planes_.push_back({unit, unit.dot(points[a])});
  }
}

// By the regions of the triangle (Ericson, Real-Time Collision Detection,
// 2005, section 5.1.5).
Vec3 FacetProbe::nearest_on(int facet, const Vec3& p) const {
  const Triangle& t = facets_[facet];
  const Vec3& a = points_[t[0]];
  const Vec3 ab = points_[t[1]] - a;
  const Vec3 ac = points_[t[2]] - a;
  const Vec3 ap = p - a;
  const double d1 = ab.dot(ap);
  const double d2 = ac.dot(ap);
  const double aa = ab.squaredNorm();
  const double cc = ac.squaredNorm();
  const double ac_ab = ab.dot(ac);
  const double d3 = d1 - aa;  // of p - b
  const double d4 = d2 - ac_ab;
  const double d5 = d1 - ac_ab;  // of p - c
  const double d6 = d2 - cc;
  const double va = d3 * d6 - d5 * d4;
  const double vb = d5 * d2 - d1 * d6;
  const double vc = d1 * d4 - d3 * d2;
  const double sum = va + vb + vc;
  if (va > 0.0 && vb > 0.0 && vc > 0.0 && sum > 0.0) {
    return a + ab * (vb / sum) + ac * (vc / sum);
  }
  const auto part = [](double along, double whole) {
    return whole > 0.0 ? std::clamp(along / whole, 0.0, 1.0) : 0.0;
  };
  const double s = part(d1, aa);
  const double r = part(d2, cc);
  const double w = part(d4 - d3, aa + cc - 2.0 * ac_ab);
  // Squared distances to the three sides, less that to a.
  const double on_ab = s * (s * aa - 2.0 * d1);
  const double on_ac = r * (r * cc - 2.0 * d2);
  const Vec3 bc = ab + w * (ac - ab);
  const double on_bc = bc.squaredNorm() - 2.0 * bc.dot(ap);
  if (on_bc < on_ab && on_bc < on_ac) {
    return a + bc;
  }
  return on_ab <= on_ac ? Vec3(a + s * ab) : Vec3(a + r * ac);
}

FacetProbe::Hit FacetProbe::nearest(const Vec3& p, double bound) const {
  Hit hit;
  hit.distance = bound;
  const std::vector<BoxTree::Node>& nodes = tree_.nodes();
  if (nodes.empty()) {
    return hit;
  }
  std::array<std::pair<int, double>, 64> stack;
  int top = 0;
  stack[top++] = {0, 0.0};
  while (top > 0) {
    // Branch and bound: a box farther off than the best so far is skipped.
    const auto [id, least] = stack[--top];
    if (least >= hit.distance) {
      continue;
    }
    const BoxTree::Node& node = nodes[id];
    if (node.is_leaf()) {
      for (int k = node.first; k < node.last; ++k) {
        // Boxes of tilted facets reach far beyond them, planes do not.
        const Plane& plane = planes_[k];
        if (std::abs(plane.normal.dot(p) - plane.offset) >= hit.distance) {
          continue;
        }
        const int f = tree_.items()[k].id;
        const Vec3 q = nearest_on(f, p);
        const double distance = (q - p).norm();
        if (distance < hit.distance) {
          hit = {f, q, distance};
        }
      }
      continue;
    }
    // The nearer child is pushed last and so searched first, which tightens the
    // bound early.
    const int second = node.second_child;
    const double left = nodes[id + 1].bounds.to(p);
    const double right = nodes[second].bounds.to(p);
    if (left <= right) {
      stack[top++] = {second, right};
      stack[top++] = {id + 1, left};
    } else {
      stack[top++] = {id + 1, left};
      stack[top++] = {second, right};
    }
  }
  return hit;
}

// The ball through p, tangent to `normal`'s plane there, and through q.
bool FacetProbe::shrink(int facet, const Vec3& p, const Vec3& normal,
                        const Vec3& q, Ball& ball) const {
  const Vec3 chord = q - p;
  const double height = normal.dot(chord);
  const double length2 = chord.squaredNorm();
  if (height <= 0.0 || height * height < kCone * kCone * length2) {
    return false;
  }
  const double radius = 0.5 * length2 / height;
  if (!(radius < ball.radius * (1.0 - kSlack))) {
    return false;
  }
  ball = {facet, q, radius};
  return true;
}

void FacetProbe::shrink(int facet, const Vec3& p, const Vec3& normal,
                        double limit, Ball& ball) const {
  const Triangle& t = facets_[facet];
  bool shrunk = true;
  while (shrunk) {
    const double radius = std::min(ball.radius, limit);
    shrunk =
        shrink(facet, p, normal, nearest_on(facet, p + radius * normal), ball);
  }
  // The nearest point may lie outside the cone where others lie inside.
  shrink(facet, p, normal,
         (points_[t[0]] + points_[t[1]] + points_[t[2]]) / 3.0, ball);
  for (const int v : t) {
    shrink(facet, p, normal, points_[v], ball);
  }
}

FacetProbe::Ball FacetProbe::tangent_ball(const Vec3& p, const Vec3& normal,
                                          double limit,
                                          const Home& home) const {
  Ball ball;
  const std::vector<BoxTree::Node>& nodes = tree_.nodes();
  if (nodes.empty()) {
    return ball;
  }
  std::array<int, 64> stack;
  int top = 0;
  stack[top++] = 0;
  // The shrinking ball (Ma, Bae, Choi 2012): start at the limit and shrink the
  // ball about the tangent point until nothing lies inside.
  ball.radius = limit / (1.0 - kSlack);
  while (top > 0) {
    const int at = stack[--top];
    const BoxTree::Node& node = nodes[at];
    const Vec3 center = p + ball.radius * normal;
    // A box that the ball does not reach cannot shrink it. The ball only
    // shrinks, so what was skipped stays outside.
    if (node.bounds.to(center) >= ball.radius * (1.0 - kSlack)) {
      continue;
    }
    if (node.is_leaf()) {
      for (int k = node.first; k < node.last; ++k) {
        const int f = tree_.items()[k].id;
        const Triangle& t = facets_[f];
        // Facets at the tangent point itself always touch the ball.
        const bool at_home =
            f == home.facet ||
            std::find(t.begin(), t.end(), home.vertex) != t.end();
        if (!at_home) {
          shrink(f, p, normal, limit, ball);
        }
      }
      continue;
    }
    // Nearest to the ray first: there the ball shrinks fastest.
    const auto away = [&](int id) {
      const Vec3 c = 0.5 * (nodes[id].bounds.low + nodes[id].bounds.high) - p;
      return c.squaredNorm() - 2.0 * ball.radius * std::max(0.0, normal.dot(c));
    };
    const bool first = away(at + 1) <= away(node.second_child);
    stack[top++] = first ? node.second_child : at + 1;
    stack[top++] = first ? at + 1 : node.second_child;
  }
  if (ball.facet < 0) {
    ball.radius = std::numeric_limits<double>::infinity();
  }
  return ball;
}

}  // namespace meniscus::walls
