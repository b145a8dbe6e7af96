#include "evolve/films/film_gap.h"

#include <algorithm>
#include <limits>
#include <utility>

#include <Eigen/Geometry>

#include "core/geometry/facet_tree.h"

namespace meniscus {

namespace {

constexpr double kFar = std::numeric_limits<double>::infinity();
constexpr int kLeafSize = 4;

void keep_shorter(ShortestLine& best, const Vec3& from, const Vec3& to) {
  const double length = (to - from).norm();
  if (length < best.length) {
    best = {length, from, to};
  }
}

/// Closest points of the segments p-q and r-s (Ericson 5.1.9), neither of
/// length 0.
void edge_to_edge(const Vec3& p, const Vec3& q, const Vec3& r, const Vec3& s,
                  ShortestLine& best) {
  const Vec3 d1 = q - p;
  const Vec3 d2 = s - r;
  const double a = d1.squaredNorm();
  const double e = d2.squaredNorm();
  const double b = d1.dot(d2);
  const double c = d1.dot(p - r);
  const double f = d2.dot(p - r);
  const double denominator = a * e - b * b;
  if (!(a > 0.0) || !(e > 0.0)) {
    return;  // corners cover points
  }
  double u = denominator > 0.0
                 ? std::clamp((b * f - c * e) / denominator, 0.0, 1.0)
                 : 0.0;
  double v = (b * u + f) / e;
  if (v < 0.0 || v > 1.0) {
    v = std::clamp(v, 0.0, 1.0);
    u = std::clamp((b * v - c) / a, 0.0, 1.0);
  }
  keep_shorter(best, p + u * d1, r + v * d2);
}

struct Box {
  Vec3 low = Vec3::Constant(kFar);
  Vec3 high = Vec3::Constant(-kFar);

  void add(const Vec3& p) {
    low = low.cwiseMin(p);
    high = high.cwiseMax(p);
  }
  double to(const Box& other) const {
    return (low - other.high).cwiseMax(other.low - high).cwiseMax(0.0).norm();
  }
};

struct Node {
  Box box;
  int first = 0;
  int last = 0;
  std::array<int, 2> child = {-1, -1};
};

struct Tree {
  const SurfaceMesh& mesh;
  std::vector<int> facets;
  std::vector<Node> nodes;

  Tree(const SurfaceMesh& of, std::vector<int> which)
      : mesh(of), facets(std::move(which)) {
    build(0, static_cast<int>(facets.size()));
  }

  std::array<Vec3, 3> corners(int i) const {
    const Triangle& t = mesh.facets[facets[i]];
    return {mesh.points[t[0]], mesh.points[t[1]], mesh.points[t[2]]};
  }

  int build(int first, int last) {
    const int id = static_cast<int>(nodes.size());
    Node node;
    node.first = first;
    node.last = last;
    for (int i = first; i < last; ++i) {
      for (const Vec3& p : corners(i)) {
        node.box.add(p);
      }
    }
    nodes.push_back(node);
    if (last - first > kLeafSize) {
      int axis = 0;
      (node.box.high - node.box.low).maxCoeff(&axis);
      const int middle = (first + last) / 2;
      const auto key = [&](int f) {
        const Triangle& t = mesh.facets[f];
        return std::pair{mesh.points[t[0]][axis] + mesh.points[t[1]][axis] +
                             mesh.points[t[2]][axis],
                         f};
      };
      std::nth_element(facets.begin() + first, facets.begin() + middle,
                       facets.begin() + last,
                       [&](int f, int g) { return key(f) < key(g); });
      const int low = build(first, middle);
      const int high = build(middle, last);
      nodes[id].child = {low, high};
    }
    return id;
  }
};

void search(const Tree& a, int i, const Tree& b, int j, ShortestLine& best) {
  const Node& m = a.nodes[i];
  const Node& n = b.nodes[j];
  const bool leaf_m = m.child[0] < 0;
  const bool leaf_n = n.child[0] < 0;
  if (leaf_m && leaf_n) {
    for (int f = m.first; f < m.last; ++f) {
      for (int g = n.first; g < n.last; ++g) {
        const ShortestLine line = shortest_line(a.corners(f), b.corners(g));
        if (line.length < best.length) {
          best = line;
        }
      }
    }
    return;
  }
  const bool split_m =
      leaf_n || (!leaf_m && m.last - m.first >= n.last - n.first);
  std::array<std::array<int, 2>, 2> next{};
  std::array<double, 2> away{};
  for (int k = 0; k < 2; ++k) {
    next[k] = split_m ? std::array{m.child[k], j} : std::array{i, n.child[k]};
    away[k] = a.nodes[next[k][0]].box.to(b.nodes[next[k][1]].box);
  }
  const int nearer = away[0] <= away[1] ? 0 : 1;
  for (const int k : {nearer, 1 - nearer}) {
    if (away[k] < best.length) {
      search(a, next[k][0], b, next[k][1], best);
    }
  }
}

}  // namespace

ShortestLine shortest_line(const std::array<Vec3, 3>& a,
                           const std::array<Vec3, 3>& b) {
  ShortestLine best{kFar, {}, {}};
  for (int i = 0; i < 3; ++i) {
    keep_shorter(best, a[i], nearest_in(b, a[i]).point);
    keep_shorter(best, nearest_in(a, b[i]).point, b[i]);
    for (int j = 0; j < 3; ++j) {
      edge_to_edge(a[i], a[(i + 1) % 3], b[j], b[(j + 1) % 3], best);
    }
  }
  return best;
}

ShortestLine shortest_line(const SurfaceMesh& mesh,
                           const std::vector<int>& from,
                           const std::vector<int>& to) {
  ShortestLine best{kFar, {}, {}};
  const Tree a(mesh, from);
  const Tree b(mesh, to);
  search(a, 0, b, 0, best);
  return best;
}

}  // namespace meniscus
