#include "evolve/films/film_gap.h"

#include <algorithm>
#include <limits>
#include <utility>

#include <Eigen/Geometry>

#include "core/geometry/box_tree.h"
#include "core/geometry/facet_tree.h"

namespace meniscus::films {

namespace {

constexpr double kFar = std::numeric_limits<double>::infinity();

struct GapTree {
  const SurfaceMesh& mesh;
  BoxTree boxes;

  GapTree(const SurfaceMesh& of, const std::vector<int>& facets)
      : mesh(of), boxes(facet_items(of.facets, of.points, facets)) {}

  std::array<Vec3, 3> corners(int i) const {
    const Triangle& t = mesh.facets[boxes.items()[i].id];
    return {mesh.points[t[0]], mesh.points[t[1]], mesh.points[t[2]]};
  }
};

void search(const GapTree& a, int i, const GapTree& b, int j,
            ShortestLine& best) {
  const std::vector<BoxTree::Node>& of_a = a.boxes.nodes();
  const std::vector<BoxTree::Node>& of_b = b.boxes.nodes();
  const BoxTree::Node& m = of_a[i];
  const BoxTree::Node& n = of_b[j];
  if (m.is_leaf() && n.is_leaf()) {
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
  const bool split_m = n.is_leaf() || (!m.is_leaf() && m.count() >= n.count());
  const std::array<int, 2> child = split_m ? std::array{i + 1, m.second_child}
                                           : std::array{j + 1, n.second_child};
  std::array<std::array<int, 2>, 2> next{};
  std::array<double, 2> away{};
  for (int k = 0; k < 2; ++k) {
    next[k] = split_m ? std::array{child[k], j} : std::array{i, child[k]};
    away[k] = of_a[next[k][0]].bounds.to(of_b[next[k][1]].bounds);
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
  // Each edge of one against the other, ends and inside.
  ShortestLine best{kFar, {}, {}};
  for (int i = 0; i < 3; ++i) {
    const NearestLine there = nearest_in(b, a[i], a[(i + 1) % 3]);
    if (there.to.distance < best.length) {
      best = {there.to.distance, there.from, there.to.point};
    }
    const NearestLine back = nearest_in(a, b[i], b[(i + 1) % 3]);
    if (back.to.distance < best.length) {
      best = {back.to.distance, back.to.point, back.from};
    }
  }
  return best;
}

ShortestLine shortest_line(const SurfaceMesh& mesh,
                           const std::vector<int>& from,
                           const std::vector<int>& to) {
  ShortestLine best{kFar, {}, {}};
  if (!from.empty() && !to.empty()) {
    search(GapTree(mesh, from), 0, GapTree(mesh, to), 0, best);
  }
  return best;
}

}  // namespace meniscus::films
