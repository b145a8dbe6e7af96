#include "fea/solver/node_order.h"

#include <algorithm>
#include <array>
#include <cstdint>
#include <numeric>

namespace meniscus::solver {

namespace {

constexpr int kBits = 21;  // three coordinates fill 63 bits

/// Chunks of nodes: small enough that several threads share a colour evenly,
/// large enough that few of their neighbours lie outside.
constexpr int kWantedChunks = 512;
constexpr int kLeastChunk = 128;
constexpr int kLargestChunk = 1024;

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

/// Mesh nodes along the curve.
std::vector<int> along_curve(const TetMesh& mesh) {
  const std::vector<std::uint64_t> codes = morton_codes(mesh.nodes);
  std::vector<std::pair<std::uint64_t, int>> keys;
  keys.reserve(codes.size());
  for (std::size_t i = 0; i < codes.size(); ++i) {
    keys.emplace_back(codes[i], static_cast<int>(i));
  }
  std::sort(keys.begin(), keys.end());
  std::vector<int> order;
  order.reserve(keys.size());
  for (const auto& key : keys) {
    order.push_back(key.second);
  }
  return order;
}

/// For every chunk, the others that must not share its colour: those which
/// some node neighbours as well.
std::vector<std::vector<int>> conflicts(const TetMesh& mesh,
                                        const std::vector<int>& chunk_of,
                                        int chunks) {
  // Only elements across chunks matter; a node's own chunk is in all of its.
  std::vector<std::pair<int, int>> reached;  // node, chunk
  for (int e = 0; e < mesh.element_count(); ++e) {
    const auto ids = mesh.element(e);
    const int first = chunk_of[ids[0]];
    if (std::all_of(ids.begin(), ids.end(),
                    [&](int node) { return chunk_of[node] == first; })) {
      continue;
    }
    std::array<int, 10> met{};
    const auto end = std::transform(ids.begin(), ids.end(), met.begin(),
                                    [&](int node) { return chunk_of[node]; });
    std::sort(met.begin(), end);
    const auto last = std::unique(met.begin(), end);
    for (const int node : ids) {
      for (auto c = met.begin(); c != last; ++c) {
        reached.emplace_back(node, *c);
      }
    }
  }
  std::sort(reached.begin(), reached.end());
  reached.erase(std::unique(reached.begin(), reached.end()), reached.end());
  std::vector<std::vector<int>> result(chunks);
  for (std::size_t first = 0, last = 0; first < reached.size(); first = last) {
    while (last < reached.size() &&
           reached[last].first == reached[first].first) {
      ++last;
    }
    for (std::size_t a = first; a < last; ++a) {
      for (std::size_t b = first; b < last; ++b) {
        if (a != b) {
          result[reached[a].second].push_back(reached[b].second);
        }
      }
    }
  }
  for (std::vector<int>& others : result) {
    std::sort(others.begin(), others.end());
    others.erase(std::unique(others.begin(), others.end()), others.end());
  }
  return result;
}

/// The lowest colour that no conflicting chunk before has.
std::vector<int> colour_chunks(const std::vector<std::vector<int>>& conflict) {
  std::vector<int> colour(conflict.size(), -1);
  for (std::size_t c = 0; c < conflict.size(); ++c) {
    std::vector<char> taken(conflict[c].size() + 1, 0);
    for (const int other : conflict[c]) {
      if (colour[other] >= 0 &&
          colour[other] < static_cast<int>(taken.size())) {
        taken[colour[other]] = 1;
      }
    }
    colour[c] = static_cast<int>(std::find(taken.begin(), taken.end(), 0) -
                                 taken.begin());
  }
  return colour;
}

void order_nodes(const TetMesh& mesh, NodeOrder& order) {
  const std::vector<int> curve = along_curve(mesh);
  const int nodes = static_cast<int>(curve.size());
  const int size =
      std::clamp(nodes / kWantedChunks, kLeastChunk, kLargestChunk);
  const int chunks = (nodes + size - 1) / size;
  std::vector<int> chunk_of(nodes);
  for (int k = 0; k < nodes; ++k) {
    chunk_of[curve[k]] = k / size;
  }
  const std::vector<int> colour =
      colour_chunks(conflicts(mesh, chunk_of, chunks));
  std::vector<int> sequence(chunks);
  std::iota(sequence.begin(), sequence.end(), 0);
  std::stable_sort(sequence.begin(), sequence.end(),
                   [&](int a, int b) { return colour[a] < colour[b]; });
  for (int k = 0; k < chunks; ++k) {
    const int c = sequence[k];
    order.to_mesh.insert(order.to_mesh.end(), curve.begin() + c * size,
                         curve.begin() + std::min(nodes, (c + 1) * size));
    order.chunks.first.push_back(static_cast<int>(order.to_mesh.size()));
    if (k + 1 == chunks || colour[sequence[k + 1]] != colour[c]) {
      order.chunks.colour.push_back(k + 1);
    }
  }
}

/// The rest, once order.to_mesh is known.
void order_elements(const TetMesh& mesh, NodeOrder& order) {
  order.to_solver.resize(order.to_mesh.size());
  for (std::size_t k = 0; k < order.to_mesh.size(); ++k) {
    order.to_solver[order.to_mesh[k]] = static_cast<int>(k);
  }
  // Counted into place: elements by their lowest node.
  std::vector<int> start(order.to_mesh.size() + 1, 0);
  std::vector<int> lowest(mesh.element_count());
  for (int e = 0; e < mesh.element_count(); ++e) {
    int low = order.to_solver[mesh.element(e)[0]];
    for (const int node : mesh.element(e)) {
      low = std::min(low, order.to_solver[node]);
    }
    lowest[e] = low;
    ++start[low + 1];
  }
  std::partial_sum(start.begin(), start.end(), start.begin());
  order.element.resize(lowest.size());
  for (int e = 0; e < mesh.element_count(); ++e) {
    order.element[start[lowest[e]]++] = e;
  }
}

}  // namespace

NodeOrder chunked_order(const TetMesh& mesh) {
  NodeOrder order;
  order_nodes(mesh, order);
  order_elements(mesh, order);
  return order;
}

NodeOrder curve_order(const TetMesh& mesh) {
  NodeOrder order;
  order.to_mesh = along_curve(mesh);
  order.chunks = one_chunk(static_cast<int>(order.to_mesh.size()));
  order_elements(mesh, order);
  return order;
}

}  // namespace meniscus::solver
