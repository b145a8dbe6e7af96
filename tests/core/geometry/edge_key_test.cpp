#include "core/geometry/edge_key.h"

#include <set>
#include <unordered_set>
#include <vector>

#include <gtest/gtest.h>

namespace meniscus {
namespace {

TEST(EdgeKey, IsTheSameFromEitherEnd) {
  EXPECT_EQ(edge_key(7, 3), (Edge{3, 7}));
  EXPECT_EQ(edge_key(3, 7), (Edge{3, 7}));
  EXPECT_EQ(edge_key(5, 5), (Edge{5, 5}));
}

TEST(EdgeKey, SortsByTheFirstIdThenTheSecond) {
  const std::set<Edge> edges = {edge_key(9, 1), edge_key(2, 3), edge_key(1, 4)};
  EXPECT_EQ(std::vector<Edge>(edges.begin(), edges.end()),
            (std::vector<Edge>{{1, 4}, {1, 9}, {2, 3}}));
}

TEST(EdgeKey, HashesKeepDirectedEdgesApart) {
  constexpr int kPoints = 20;
  std::unordered_set<Edge, EdgeHash> edges;
  std::set<std::size_t> hashes;
  for (int a = 0; a < kPoints; ++a) {
    for (int b = 0; b < kPoints; ++b) {
      edges.insert({a, b});
      hashes.insert(EdgeHash()({a, b}));
    }
  }
  EXPECT_EQ(edges.size(), static_cast<std::size_t>(kPoints * kPoints));
  EXPECT_EQ(hashes.size(), edges.size());
  EXPECT_TRUE(edges.contains({3, 4}));
}

}  // namespace
}  // namespace meniscus
