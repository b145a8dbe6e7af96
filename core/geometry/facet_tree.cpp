#include "core/geometry/facet_tree.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include <Eigen/Geometry>

namespace meniscus {

namespace {

constexpr double kNever = std::numeric_limits<double>::infinity();

/// Where the ray meets the facet, or kNever.
double meet(const SurfaceMesh& mesh, int facet, const Vec3& origin,
            const Vec3& direction) {
  const Triangle& t = mesh.facets[facet];
  const Vec3 a = mesh.points[t[0]] - origin;
  const Vec3 b = mesh.points[t[1]] - origin;
  const Vec3 c = mesh.points[t[2]] - origin;
  const double u = direction.dot(b.cross(c));
  const double v = direction.dot(c.cross(a));
  const double w = direction.dot(a.cross(b));
  const bool inside =
      (u >= 0 && v >= 0 && w >= 0) || (u <= 0 && v <= 0 && w <= 0);
  const double sum = u + v + w;
  if (!inside || sum == 0.0) {
    return kNever;
  }
  const double at =
      (u * a + v * b + w * c).dot(direction) / sum / direction.squaredNorm();
  return at > 0.0 ? at : kNever;
}

NearestPoint weighted(const std::array<Vec3, 3>& t, const Vec3& place, double b,
                      double c) {
  NearestPoint result{.weights = {1.0 - b - c, b, c}};
  result.point = t[0] + b * (t[1] - t[0]) + c * (t[2] - t[0]);
  result.distance = (place - result.point).norm();
  return result;
}

std::vector<BoxTree::Item> boxes_of(const SurfaceMesh& mesh,
                                    const std::vector<int>& facets,
                                    double tolerance) {
  auto items = facet_items(mesh.facets, mesh.points, facets);
  const Vec3 margin = Vec3::Constant(0.5 * tolerance);
  for (BoxTree::Item& item : items) {
    item.bounds = {item.bounds.low - margin, item.bounds.high + margin};
    item.center = item.bounds.low + item.bounds.high;
  }
  return items;
}

/// Where the ray enters the box; kNever when it misses it.
double reach(const AxisBox& box, const Vec3& origin, const Vec3& inverse) {
  double enter = 0.0;
  double leave = kNever;
  for (int k = 0; k < 3; ++k) {
    const double low = (box.low[k] - origin[k]) * inverse[k];
    const double high = (box.high[k] - origin[k]) * inverse[k];
    enter = std::max(enter, std::min(low, high));
    leave = std::min(leave, std::max(low, high));
  }
  // Rounding of the bounds must not lose a facet in a flat box.
  return enter <= leave * (1.0 + 1e-12) ? enter * (1.0 - 1e-12) : kNever;
}

}  // namespace

NearestPoint nearest_in(const std::array<Vec3, 3>& t, const Vec3& p) {
  const Vec3 ab = t[1] - t[0];
  const Vec3 ac = t[2] - t[0];
  const double d1 = ab.dot(p - t[0]);
  const double d2 = ac.dot(p - t[0]);
  if (d1 <= 0.0 && d2 <= 0.0) {
    return weighted(t, p, 0.0, 0.0);
  }
  const double d3 = ab.dot(p - t[1]);
  const double d4 = ac.dot(p - t[1]);
  if (d3 >= 0.0 && d4 <= d3) {
    return weighted(t, p, 1.0, 0.0);
  }
  const double vc = d1 * d4 - d3 * d2;
  if (vc <= 0.0 && d1 >= 0.0 && d3 <= 0.0) {
    return weighted(t, p, d1 / (d1 - d3), 0.0);
  }
  const double d5 = ab.dot(p - t[2]);
  const double d6 = ac.dot(p - t[2]);
  if (d6 >= 0.0 && d5 <= d6) {
    return weighted(t, p, 0.0, 1.0);
  }
  const double vb = d5 * d2 - d1 * d6;
  if (vb <= 0.0 && d2 >= 0.0 && d6 <= 0.0) {
    return weighted(t, p, 0.0, d2 / (d2 - d6));
  }
  const double va = d3 * d6 - d5 * d4;
  if (va <= 0.0 && d4 - d3 >= 0.0 && d5 - d6 >= 0.0) {
    const double w = (d4 - d3) / ((d4 - d3) + (d5 - d6));
    return weighted(t, p, 1.0 - w, w);
  }
  const double sum = va + vb + vc;
  return weighted(t, p, vb / sum, vc / sum);
}

namespace {

void keep_nearer(NearestLine found, NearestLine& best) {
  if (found.to.distance < best.to.distance) {
    best = std::move(found);
  }
}

/// The edge p q against edge k of the facet; nothing where they are parallel,
/// whose ends say it.
void edge_to_edge(const std::array<Vec3, 3>& t, std::size_t k, const Vec3& p,
                  const Vec3& q, NearestLine& best) {
  const std::size_t next = (k + 1) % 3;
  const Vec3 d = q - p;
  const Vec3 e = t[next] - t[k];
  const Vec3 r = p - t[k];
  const double dd = d.squaredNorm();
  const double ee = e.squaredNorm();
  const double de = d.dot(e);
  const double denominator = dd * ee - de * de;
  if (!(denominator > 0.0)) {
    return;
  }
  double u =
      std::clamp((de * e.dot(r) - ee * d.dot(r)) / denominator, 0.0, 1.0);
  double v = (de * u + e.dot(r)) / ee;
  if (v < 0.0 || v > 1.0) {
    v = std::clamp(v, 0.0, 1.0);
    u = std::clamp((de * v - d.dot(r)) / dd, 0.0, 1.0);
  }
  NearestLine found{.along = u, .from = p + u * d, .to = {}};
  found.to.weights[k] = 1.0 - v;
  found.to.weights[next] = v;
  found.to.point = t[k] + v * e;
  found.to.distance = (found.from - found.to.point).norm();
  keep_nearer(std::move(found), best);
}

}  // namespace

NearestLine nearest_in(const std::array<Vec3, 3>& t, const Vec3& p,
                       const Vec3& q) {
  NearestLine best{.along = 0.0, .from = p, .to = nearest_in(t, p)};
  keep_nearer({.along = 1.0, .from = q, .to = nearest_in(t, q)}, best);
  for (std::size_t k = 0; k < 3; ++k) {
    edge_to_edge(t, k, p, q, best);
  }
  return best;
}

FacetTree::FacetTree(const SurfaceMesh& mesh, const std::vector<int>& facets,
                     double tolerance)
    : mesh_(mesh), tree_(boxes_of(mesh, facets, tolerance)) {}

std::optional<RayHit> FacetTree::first_hit(const Vec3& origin,
                                           const Vec3& direction,
                                           const std::vector<int>& part_of,
                                           int part) const {
  RayHit best{-1, kNever};
  const Vec3 inverse = direction.cwiseInverse();
  const std::vector<BoxTree::Node>& nodes = tree_.nodes();
  std::vector<int> stack;
  if (!nodes.empty()) {
    stack.push_back(0);
  }
  // Depth first through the boxes, those beyond the best hit left out.
  while (!stack.empty()) {
    const int id = stack.back();
    stack.pop_back();
    const BoxTree::Node& node = nodes[id];
    const double enter = reach(node.bounds, origin, inverse);
    if (enter == kNever || enter > best.distance) {
      continue;
    }
    if (!node.is_leaf()) {
      // The nearer child goes on top: its hits prune the other one.
      const double near = reach(nodes[id + 1].bounds, origin, inverse);
      const double far =
          reach(nodes[node.second_child].bounds, origin, inverse);
      stack.push_back(near <= far ? node.second_child : id + 1);
      stack.push_back(near <= far ? id + 1 : node.second_child);
      continue;
    }
    for (int i = node.first; i < node.last; ++i) {
      const int f = tree_.items()[i].id;
      if (part_of[f] == part) {
        continue;
      }
      // Equal distances go to the lower facet, whatever the order of the tree.
      const double at = meet(mesh_, f, origin, direction);
      if (at < best.distance ||
          (at == best.distance && at < kNever && f < best.facet)) {
        best = {f, at};
      }
    }
  }
  if (best.facet < 0) {
    return std::nullopt;
  }
  return best;
}

/// Calls visit(facet, corners) for the facets of all boxes whose away(bounds)
/// is not above `most`, then what visit() returned last; nearer boxes first.
template <class Away, class Visit>
void FacetTree::visit_near(double most, const Away& away,
                           const Visit& visit) const {
  const std::vector<BoxTree::Node>& nodes = tree_.nodes();
  std::vector<int> stack;
  if (!nodes.empty()) {
    stack.push_back(0);
  }
  while (!stack.empty()) {
    const int id = stack.back();
    stack.pop_back();
    const BoxTree::Node& node = nodes[id];
    if (away(node.bounds) > most) {
      continue;
    }
    if (!node.is_leaf()) {
      const bool first =
          away(nodes[id + 1].bounds) <= away(nodes[node.second_child].bounds);
      stack.push_back(first ? node.second_child : id + 1);
      stack.push_back(first ? id + 1 : node.second_child);
      continue;
    }
    for (int i = node.first; i < node.last; ++i) {
      const int f = tree_.items()[i].id;
      const Triangle& t = mesh_.facets[f];
      most =
          visit(f, std::array<Vec3, 3>{mesh_.points[t[0]], mesh_.points[t[1]],
                                       mesh_.points[t[2]]});
    }
  }
}

std::optional<NearestPoint> FacetTree::nearest(const Vec3& place) const {
  NearestPoint best{.distance = kNever};
  visit_near(
      kNever, [&](const AxisBox& box) { return box.to(place); },
      [&](int f, const std::array<Vec3, 3>& corners) {
        NearestPoint found = nearest_in(corners, place);
        found.facet = f;
        if (found.distance < best.distance ||
            (found.distance == best.distance && f < best.facet)) {
          best = found;
        }
        return best.distance;
      });
  return best.facet < 0 ? std::nullopt : std::optional(best);
}

std::optional<NearestLine> FacetTree::nearest(const Vec3& p, const Vec3& q,
                                              double most) const {
  AxisBox edge;
  edge.add(p);
  edge.add(q);
  NearestLine best;
  best.to.distance = most;
  visit_near(
      most, [&](const AxisBox& box) { return box.to(edge); },
      [&](int f, const std::array<Vec3, 3>& corners) {
        NearestLine found = nearest_in(corners, p, q);
        found.to.facet = f;
        if (found.to.distance < best.to.distance ||
            (found.to.distance == best.to.distance && f < best.to.facet)) {
          best = found;
        }
        return best.to.distance;
      });
  return best.to.facet < 0 ? std::nullopt : std::optional(best);
}

}  // namespace meniscus
