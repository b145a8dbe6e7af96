#include "core/geometry/box_tree.h"

#include <algorithm>
#include <utility>

namespace meniscus {

namespace {

constexpr int kLeafSize = 4;

}  // namespace

BoxTree::BoxTree(std::vector<Item> items) : items_(std::move(items)) {
  if (!items_.empty()) {
    nodes_.reserve(items_.size());
    build(0, static_cast<int>(items_.size()));
  }
}

int BoxTree::build(int first, int last) {
  const int id = static_cast<int>(nodes_.size());
  Node node;
  node.first = first;
  node.last = last;
  for (int i = first; i < last; ++i) {
    node.bounds.add(items_[i].bounds);
  }
  (node.bounds.high - node.bounds.low).maxCoeff(&node.axis);
  nodes_.push_back(node);
  if (last - first > kLeafSize) {
    const int middle = (first + last) / 2;
    const auto key = [&](const Item& item) {
      return std::pair{item.center[node.axis], item.id};
    };
    std::nth_element(
        items_.begin() + first, items_.begin() + middle, items_.begin() + last,
        [&](const Item& a, const Item& b) { return key(a) < key(b); });
    build(first, middle);
    nodes_[id].second_child = build(middle, last);
  }
  return id;
}

BoxTree::Item facet_item(int id, const Triangle& facet, const Points& points) {
  const Vec3& a = points[facet[0]];
  const Vec3& b = points[facet[1]];
  const Vec3& c = points[facet[2]];
  return {.id = id,
          .bounds = {a.cwiseMin(b).cwiseMin(c), a.cwiseMax(b).cwiseMax(c)},
          .center = a + b + c};
}

std::vector<BoxTree::Item> facet_items(const std::vector<Triangle>& facets,
                                       const Points& points) {
  std::vector<BoxTree::Item> items;
  items.reserve(facets.size());
  for (const Triangle& t : facets) {
    items.push_back(facet_item(static_cast<int>(items.size()), t, points));
  }
  return items;
}

std::vector<BoxTree::Item> facet_items(const std::vector<Triangle>& facets,
                                       const Points& points,
                                       const std::vector<int>& ids) {
  std::vector<BoxTree::Item> items;
  items.reserve(ids.size());
  for (const int f : ids) {
    items.push_back(facet_item(f, facets[f], points));
  }
  return items;
}

}  // namespace meniscus
