/// Bounds of things in a tree, so that a question in space is put to few of
/// them. What is asked is the asker's: it walks the nodes.
#pragma once

#include <limits>
#include <vector>

#include "core/types.h"

namespace meniscus {

/// A box along the axes; of nothing at first.
struct AxisBox {
  Vec3 low = Vec3::Constant(std::numeric_limits<double>::infinity());
  Vec3 high = Vec3::Constant(-std::numeric_limits<double>::infinity());

  void add(const Vec3& point) {
    low = low.cwiseMin(point);
    high = high.cwiseMax(point);
  }
  void add(const AxisBox& other) {
    low = low.cwiseMin(other.low);
    high = high.cwiseMax(other.high);
  }
  bool meets(const AxisBox& other) const {
    return (low.array() <= other.high.array()).all() &&
           (other.low.array() <= high.array()).all();
  }
  /// Distance to a place or to other bounds [length]; 0 where they meet.
  double to(const Vec3& place) const {
    return (low - place).cwiseMax(place - high).cwiseMax(0.0).norm();
  }
  double to(const AxisBox& other) const {
    return (low - other.high).cwiseMax(other.low - high).cwiseMax(0.0).norm();
  }
};

/// Halved at the median along the longest axis of the bounds down to four
/// things; O(n log n). The same things in the same order make the same tree.
class BoxTree {
 public:
  struct Item {
    int id = 0;
    AxisBox bounds;
    Vec3 center = Vec3::Zero();  // for the median, equals by id; in any unit
  };
  struct Node {
    AxisBox bounds;
    int first = 0;  // of items()[first .. last - 1]
    int last = 0;
    int second_child = -1;  // -1: a leaf; the first child is the next node
    int axis = 0;           // along which the children lie
    bool is_leaf() const { return second_child < 0; }
    int count() const { return last - first; }
  };

  /// Bounds and centers must be finite, ids distinct.
  explicit BoxTree(std::vector<Item> items);

  /// The root first; none for no things.
  const std::vector<Node>& nodes() const { return nodes_; }
  /// Those of a node stand together.
  const std::vector<Item>& items() const { return items_; }

 private:
  int build(int first, int last);

  std::vector<Item> items_;
  std::vector<Node> nodes_;
};

/// A facet of these corners for the tree, its center their sum.
BoxTree::Item facet_item(int id, const Triangle& facet, const Points& points);

/// All of the facets, or those with these ids.
std::vector<BoxTree::Item> facet_items(const std::vector<Triangle>& facets,
                                       const Points& points);
std::vector<BoxTree::Item> facet_items(const std::vector<Triangle>& facets,
                                       const Points& points,
                                       const std::vector<int>& ids);

}  // namespace meniscus
