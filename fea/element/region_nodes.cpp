#include "fea/element/region_nodes.h"

#include <algorithm>
#include <cstdint>
#include <map>
#include <numeric>

namespace meniscus::element {

namespace {

/// Steele, Lea and Flood's splitmix64: fixed pseudo-random words.
std::uint64_t scramble(std::uint64_t x) {
  x += 0x9e3779b97f4a7c15U;
  x = (x ^ (x >> 30U)) * 0xbf58476d1ce4e5b9U;
  x = (x ^ (x >> 27U)) * 0x94d049bb133111ebU;
  return x ^ (x >> 31U);
}

/// A number for the directed edge a -> b; the opposite direction has its
/// negative (modulo 2^64), other edges share it with negligible probability.
struct NodeWords {
  std::uint64_t r, s;
};
std::uint64_t passage(const NodeWords& a, const NodeWords& b) {
  return a.r * b.s - b.r * a.s;
}

}  // namespace

RegionNodes region_nodes(const TetMesh& mesh) {
  RegionNodes result;
  result.nodes_per_element = mesh.nodes_per_element();
  result.elements = mesh.elements;
  result.node.resize(mesh.nodes.size());
  std::iota(result.node.begin(), result.node.end(), 0);
  const auto& region = mesh.element_region;
  if (std::adjacent_find(region.begin(), region.end(), std::not_equal_to<>()) ==
      region.end()) {
    return result;
  }
  const int highest = *std::max_element(region.begin(), region.end());
  std::vector<int> lowest(mesh.nodes.size(), highest);
  for (int e = 0; e < mesh.element_count(); ++e) {
    for (const int node : mesh.element(e)) {
      lowest[node] = std::min(lowest[node], region[e]);
    }
  }
  std::map<std::pair<int, int>, int> copies;  // of (node, region)
  for (std::size_t k = 0; k < result.elements.size(); ++k) {
    const int node = mesh.elements[k];
    const int here = region[k / result.nodes_per_element];
    if (here != lowest[node]) {
      const auto [at, added] =
          copies.emplace(std::pair{node, here}, result.count());
      if (added) {
        result.node.push_back(node);
      }
      result.elements[k] = at->second;
    }
  }
  return result;
}

std::vector<char> surrounded_corners(const RegionNodes& nodes) {
  std::vector<NodeWords> words(nodes.count());
  for (std::size_t i = 0; i < words.size(); ++i) {
    words[i] = {scramble(2 * i), scramble(2 * i + 1)};
  }
  std::vector<std::uint64_t> open(words.size(), 0);
  std::vector<char> is_corner(words.size(), 0);
  const int count =
      static_cast<int>(nodes.elements.size()) / nodes.nodes_per_element;
  // The triangles opposite the four corners, all seen from the corner alike.
  constexpr std::array<Triangle, 4> kOpposite = {
      {{1, 2, 3}, {0, 3, 2}, {0, 1, 3}, {0, 2, 1}}};
  for (int e = 0; e < count; ++e) {
    const auto ids = nodes.element(e);
    for (int c = 0; c < 4; ++c) {
      const auto [i, j, k] = kOpposite[c];
      const NodeWords& a = words[ids[i]];
      const NodeWords& b = words[ids[j]];
      const NodeWords& d = words[ids[k]];
      open[ids[c]] += passage(a, b) + passage(b, d) + passage(d, a);
      is_corner[ids[c]] = 1;
    }
  }
  for (std::size_t i = 0; i < open.size(); ++i) {
    is_corner[i] = static_cast<char>(is_corner[i] != 0 && open[i] == 0);
  }
  return is_corner;
}

}  // namespace meniscus::element
