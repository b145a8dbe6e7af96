/// Bounding boxes of facets in a tree: which facets are near each other, what a
/// ray meets first, and what is nearest to a place.
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <optional>
#include <vector>

#include "core/geometry/box_tree.h"
#include "core/geometry/surface_mesh.h"

namespace meniscus {

/// Where a ray meets a facet.
struct RayHit {
  int facet = -1;
  double distance = 0.0;  // in lengths of the ray's direction, above 0
};

/// The nearest point of a facet.
struct NearestPoint {
  int facet = -1;
  std::array<double, 3> weights = {};  // of its corners, >= 0, sum 1
  Vec3 point = Vec3::Zero();
  double distance = 0.0;  // [length]
};

/// By the regions of corners and edges (Ericson, Real-Time Collision Detection,
/// 2005, 5.1.5). `facet` of the result is -1.
NearestPoint nearest_in(const std::array<Vec3, 3>& corners, const Vec3& place);

/// The shortest line between a straight edge and a facet.
struct NearestLine {
  double along = 0.0;  // where on the edge, from 0 to 1
  Vec3 from = Vec3::Zero();
  NearestPoint to;
};

/// Of the edge p q to a facet that it does not cross: the least of its ends to
/// the facet and of edge to edge (Ericson, 5.1.9). `to.facet` is -1.
NearestLine nearest_in(const std::array<Vec3, 3>& corners, const Vec3& p,
                       const Vec3& q);

/// Built in O(n log n); keeps a reference to the mesh.
class FacetTree {
 public:
  /// Of the given facets, which have finite, sound corners. Boxes grow by half
  /// of `tolerance` [length], so that they meet when facets are within it.
  FacetTree(const SurfaceMesh& mesh, const std::vector<int>& facets,
            double tolerance = 0.0);

  /// Calls visit(f, g), f < g, once for every pair of facets whose boxes meet,
  /// in a fixed order, until it returns false or `most_steps` pairs of boxes
  /// were compared. Returns false only for the latter.
  template <class Visit>
  bool visit_pairs(Visit visit, std::int64_t most_steps) const;

  /// The nearest facet that `origin` + t `direction`, t > 0, meets, among
  /// those whose number in `part_of` is not `part`; the lowest id of equals.
  std::optional<RayHit> first_hit(const Vec3& origin, const Vec3& direction,
                                  const std::vector<int>& part_of,
                                  int part) const;

  /// The point of all facets nearest to `place`, the lowest id of equals;
  /// nothing for no facets.
  std::optional<NearestPoint> nearest(const Vec3& place) const;

  /// The shortest line from the edge p q, which crosses no facet, to all
  /// facets, the lowest id of equals; nothing where it is not below `most`.
  std::optional<NearestLine> nearest(const Vec3& p, const Vec3& q,
                                     double most) const;

 private:
  template <class Away, class Visit>
  void visit_near(double most, const Away& away, const Visit& visit) const;

  const SurfaceMesh& mesh_;
  BoxTree tree_;
};

template <class Visit>
bool FacetTree::visit_pairs(Visit visit, std::int64_t most_steps) const {
  const std::vector<BoxTree::Node>& nodes = tree_.nodes();
  const std::vector<BoxTree::Item>& items = tree_.items();
  if (nodes.empty()) {
    return true;
  }
  std::int64_t steps = 0;
  std::vector<std::array<int, 2>> stack = {{0, 0}};
  while (!stack.empty()) {
    const auto [i, j] = stack.back();
    stack.pop_back();
    const BoxTree::Node& a = nodes[i];
    const BoxTree::Node& b = nodes[j];
    if (++steps > most_steps) {
      return false;
    }
    if (i != j && !a.bounds.meets(b.bounds)) {
      continue;
    }
    if (a.is_leaf() && b.is_leaf()) {
      for (int p = a.first; p < a.last; ++p) {
        for (int q = i == j ? p + 1 : b.first; q < b.last; ++q) {
          steps += 1;
          const auto [f, g] = std::minmax(items[p].id, items[q].id);
          if (items[p].bounds.meets(items[q].bounds) && !visit(f, g)) {
            return true;
          }
        }
      }
    } else if (i == j) {
      stack.push_back({i + 1, i + 1});
      stack.push_back({a.second_child, a.second_child});
      stack.push_back({i + 1, a.second_child});
    } else if (b.is_leaf() || (!a.is_leaf() && a.count() >= b.count())) {
      stack.push_back({i + 1, j});
      stack.push_back({a.second_child, j});
    } else {
      stack.push_back({i, j + 1});
      stack.push_back({i, b.second_child});
    }
  }
  return true;
}

}  // namespace meniscus
