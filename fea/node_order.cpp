#include "fea/node_order.h"

#include <algorithm>
#include <cstdint>
#include <numeric>

namespace meniscus {

namespace {

constexpr int kBits = 21;  // three coordinates fill 63 bits

/// Puts two zero bits between the bits of `v`.
std::uint64_t spread(std::uint64_t v) {
  v &= 0x1fffff;
  v = (v | (v << 32)) & 0x1f00000000ffffULL;
  v = (v | (v << 16)) & 0x1f0000ff0000ffULL;
  v = (v | (v << 8)) & 0x100f00f00f00f00fULL;
  v = (v | (v << 4)) & 0x10c30c30c30c30c3ULL;
  v = (v | (v << 2)) & 0x1249249249249249ULL;
  return v;
}

std::vector<std::uint64_t> morton_codes(const Points& nodes) {
  Vec3 low = nodes.front();
  Vec3 high = nodes.front();
  for (const Vec3& x : nodes) {
    low = low.cwiseMin(x);
    high = high.cwiseMax(x);
  }
  const double side = std::max((high - low).maxCoeff(), 1e-300);
  const double scale = ((1 << kBits) - 1) / side;
  std::vector<std::uint64_t> codes;
  codes.reserve(nodes.size());
  for (const Vec3& x : nodes) {
    std::uint64_t code = 0;
    for (int k = 0; k < 3; ++k) {
      code |= spread(static_cast<std::uint64_t>((x[k] - low[k]) * scale)) << k;
    }
    codes.push_back(code);
  }
  return codes;
}

}  // namespace

NodeOrder morton_order(const TetMesh& mesh) {
  const std::vector<std::uint64_t> codes = morton_codes(mesh.nodes);
  NodeOrder order;
  order.to_mesh.resize(codes.size());
  std::iota(order.to_mesh.begin(), order.to_mesh.end(), 0);
  std::sort(order.to_mesh.begin(), order.to_mesh.end(), [&](int a, int b) {
    return codes[a] != codes[b] ? codes[a] < codes[b] : a < b;
  });
  order.to_solver.resize(codes.size());
  for (std::size_t k = 0; k < codes.size(); ++k) {
    order.to_solver[order.to_mesh[k]] = static_cast<int>(k);
  }
  std::vector<int> lowest(mesh.element_count());
  for (int e = 0; e < mesh.element_count(); ++e) {
    int low = order.to_solver[mesh.element(e)[0]];
    for (const int node : mesh.element(e)) {
      low = std::min(low, order.to_solver[node]);
    }
    lowest[e] = low;
  }
  order.element.resize(lowest.size());
  std::iota(order.element.begin(), order.element.end(), 0);
  std::sort(order.element.begin(), order.element.end(), [&](int a, int b) {
    return lowest[a] != lowest[b] ? lowest[a] < lowest[b] : a < b;
  });
  return order;
}

}  // namespace meniscus
