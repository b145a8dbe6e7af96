#include "fea/solver/node_clusters.h"

#include <numeric>

namespace meniscus::solver {

FullRows::FullRows(const BlockPattern& p) : start(p.nodes + 1, 0) {
  for (int i = 0; i < p.nodes; ++i) {
    start[i + 1] += p.start[i + 1] - p.start[i];
    for (int k = p.start[i]; k < p.start[i + 1]; ++k) {
      ++start[p.column[k] + 1];
    }
  }
  std::partial_sum(start.begin(), start.end(), start.begin());
  node.resize(start.back());
  block.resize(start.back());
  std::vector<int> next(start.begin(), start.end() - 1);
  for (int i = 0; i < p.nodes; ++i) {
    // Row i's own columns come first: rows above have not come by yet.
    for (int k = p.start[i]; k < p.start[i + 1]; ++k) {
      node[next[i]] = p.column[k];
      block[next[i]++] = k;
    }
    for (int k = p.start[i]; k < p.start[i + 1]; ++k) {
      const int j = p.column[k];
      node[next[j]] = i;
      block[next[j]++] = k;
    }
  }
}

Clusters cluster(const FullRows& rows, const std::vector<char>& active) {
  const int n = static_cast<int>(active.size());
  Clusters c{std::vector<int>(n, -1), 0};
  const auto any = [&](int i, const auto& test) {
    for (int k = rows.start[i]; k < rows.start[i + 1]; ++k) {
      if (test(rows.node[k])) {
        return true;
      }
    }
    return false;
  };
  const auto take_around = [&](int i) {
    c.of[i] = c.count;
    for (int k = rows.start[i]; k < rows.start[i + 1]; ++k) {
      const int j = rows.node[k];
      if (active[j] != 0 && c.of[j] < 0) {
        c.of[j] = c.count;
      }
    }
    ++c.count;
  };
  // Greedy aggregation in three passes (Vanek, Mandel, Brezina 1996). First
  // whole neighbourhoods that touch no cluster.
  for (int i = 0; i < n; ++i) {
    if (active[i] != 0 && c.of[i] < 0 &&
        !any(i, [&](int j) { return c.of[j] >= 0; })) {
      take_around(i);
    }
  }
  // What is left over joins a cluster of the first pass next to it: by a copy,
  // so that clusters do not grow in chains.
  const std::vector<int> roots = c.of;
  for (int i = 0; i < n; ++i) {
    if (active[i] != 0 && c.of[i] < 0) {
      any(i, [&](int j) {
        c.of[i] = roots[j];
        return roots[j] >= 0;
      });
    }
  }
  // The rest, far from all of those, forms clusters of its own.
  for (int i = 0; i < n; ++i) {
    if (active[i] != 0 && c.of[i] < 0) {
      take_around(i);
    }
  }
  return c;
}

Members::Members(const Clusters& c) : start(c.count + 1, 0) {
  for (const int a : c.of) {
    if (a >= 0) {
      ++start[a + 1];
    }
  }
  std::partial_sum(start.begin(), start.end(), start.begin());
  node.resize(start.back());
  std::vector<int> next(start.begin(), start.end() - 1);
  for (std::size_t i = 0; i < c.of.size(); ++i) {
    if (c.of[i] >= 0) {
      node[next[c.of[i]]++] = static_cast<int>(i);
    }
  }
}

}  // namespace meniscus::solver
