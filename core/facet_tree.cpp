#include <algorithm>
#include <array>
#include <utility>

#include "core/facet_pairs.h"

namespace meniscus {

namespace {

struct Box {
  Vec3 low;
  Vec3 high;
};

bool overlap(const Box& a, const Box& b) {
  return (a.low.array() <= b.high.array()).all() &&
         (b.low.array() <= a.high.array()).all();
}

constexpr int kLeafSize = 4;

// Facets first .. last - 1 of the tree's order; inner nodes have children.
struct Node {
  Box box;
  int first = 0;
  int last = 0;
  std::array<int, 2> child = {-1, -1};
};

class Tree {
 public:
  Tree(const SurfaceMesh& mesh, std::vector<int> facets, double tolerance)
      : facets_(std::move(facets)) {
    boxes_.resize(mesh.facets.size());
    const Vec3 margin = Vec3::Constant(0.5 * tolerance);
    for (const int f : facets_) {
      const Triangle& t = mesh.facets[f];
      const Vec3& a = mesh.points[t[0]];
      const Vec3& b = mesh.points[t[1]];
      const Vec3& c = mesh.points[t[2]];
      boxes_[f] = {a.cwiseMin(b).cwiseMin(c) - margin,
                   a.cwiseMax(b).cwiseMax(c) + margin};
    }
    if (!facets_.empty()) {
      build(0, static_cast<int>(facets_.size()));
    }
  }

  void visit_pairs(const std::function<bool(int, int)>& visit) const {
    if (nodes_.empty()) {
      return;
    }
    std::vector<std::array<int, 2>> stack = {{0, 0}};
    while (!stack.empty()) {
      const auto [i, j] = stack.back();
      stack.pop_back();
      const Node& a = nodes_[i];
      const Node& b = nodes_[j];
      if (i != j && !overlap(a.box, b.box)) {
        continue;
      }
      const bool leaf_a = a.child[0] < 0;
      const bool leaf_b = b.child[0] < 0;
      if (leaf_a && leaf_b) {
        if (!visit_leaves(a, b, i == j, visit)) {
          return;
        }
      } else if (i == j) {
        stack.push_back({a.child[0], a.child[0]});
        stack.push_back({a.child[1], a.child[1]});
        stack.push_back({a.child[0], a.child[1]});
      } else if (leaf_b || (!leaf_a && a.last - a.first >= b.last - b.first)) {
        stack.push_back({a.child[0], j});
        stack.push_back({a.child[1], j});
      } else {
        stack.push_back({i, b.child[0]});
        stack.push_back({i, b.child[1]});
      }
    }
  }

 private:
  bool visit_leaves(const Node& a, const Node& b, bool same,
                    const std::function<bool(int, int)>& visit) const {
    for (int i = a.first; i < a.last; ++i) {
      for (int j = same ? i + 1 : b.first; j < b.last; ++j) {
        const int f = facets_[i];
        const int g = facets_[j];
        if (overlap(boxes_[f], boxes_[g]) &&
            !visit(std::min(f, g), std::max(f, g))) {
          return false;
        }
      }
    }
    return true;
  }

  int build(int first, int last) {
    const int id = static_cast<int>(nodes_.size());
    Node node{boxes_[facets_[first]], first, last, {-1, -1}};
    for (int i = first + 1; i < last; ++i) {
      const Box& box = boxes_[facets_[i]];
      node.box.low = node.box.low.cwiseMin(box.low);
      node.box.high = node.box.high.cwiseMax(box.high);
    }
    nodes_.push_back(node);
    if (last - first > kLeafSize) {
      int axis = 0;
      (node.box.high - node.box.low).maxCoeff(&axis);
      const int middle = (first + last) / 2;
      const auto key = [&](int f) {
        return std::pair{boxes_[f].low[axis] + boxes_[f].high[axis], f};
      };
      std::nth_element(facets_.begin() + first, facets_.begin() + middle,
                       facets_.begin() + last,
                       [&](int f, int g) { return key(f) < key(g); });
      const int low = build(first, middle);
      const int high = build(middle, last);
      nodes_[id].child = {low, high};
    }
    return id;
  }

  std::vector<int> facets_;
  std::vector<Box> boxes_;
  std::vector<Node> nodes_;
};

}  // namespace

void for_each_near_pair(const SurfaceMesh& mesh, std::vector<int> facets,
                        double tolerance,
                        const std::function<bool(int, int)>& visit) {
  Tree(mesh, std::move(facets), tolerance).visit_pairs(visit);
}

}  // namespace meniscus
