#include "core/math/union_find.h"

#include <algorithm>
#include <random>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

namespace meniscus {
namespace {

TEST(UnionFind, ThingsStartAlone) {
  UnionFind sets(2);
  EXPECT_EQ(sets.add(), 2);
  EXPECT_EQ(sets.size(), 3U);
  EXPECT_EQ(sets.roots(), (std::vector<int>{0, 1, 2}));
}

TEST(UnionFind, TheSmallestMemberIsTheRoot) {
  UnionFind sets(6);
  EXPECT_TRUE(sets.join(5, 3));
  EXPECT_TRUE(sets.join(3, 1));
  EXPECT_TRUE(sets.join(4, 2));
  EXPECT_FALSE(sets.join(1, 5));
  EXPECT_TRUE(sets.same(5, 1));
  EXPECT_FALSE(sets.same(4, 1));
  EXPECT_EQ(sets.roots(), (std::vector<int>{0, 1, 2, 1, 2, 1}));
  int count = 0;
  EXPECT_EQ(sets.numbers(count), (std::vector<int>{0, 1, 2, 1, 2, 1}));
  EXPECT_EQ(count, 3);
}

TEST(UnionFind, NumbersHaveNoGaps) {
  UnionFind sets(5);
  sets.join(0, 2);
  sets.join(3, 2);
  int count = 0;
  EXPECT_EQ(sets.numbers(count), (std::vector<int>{0, 1, 0, 0, 2}));
  EXPECT_EQ(count, 3);
}

TEST(UnionFind, TheRootThatIsToStayDoes) {
  UnionFind sets(4);
  EXPECT_TRUE(sets.join_to(3, 0));
  EXPECT_TRUE(sets.join_to(3, 1));
  EXPECT_FALSE(sets.join_to(0, 1));
  EXPECT_EQ(sets.roots(), (std::vector<int>{3, 3, 2, 3}));
}

// A peer: the labels of the smaller number spread until nothing changes.
TEST(UnionFind, AgreesWithSpreadingLabels) {
  constexpr int kThings = 40;
  std::mt19937 random(7);
  std::vector<std::pair<int, int>> links;
  for (int k = 0; k < 25; ++k) {
    const int i = static_cast<int>(random() % kThings);
    links.emplace_back(i, static_cast<int>(random() % kThings));
  }
  UnionFind sets(kThings);
  std::vector<int> label = sets.roots();
  for (const auto& [i, j] : links) {
    sets.join(i, j);
  }
  for (int round = 0; round < kThings; ++round) {
    for (const auto& [i, j] : links) {
      label[i] = label[j] = std::min(label[i], label[j]);
    }
  }
  EXPECT_EQ(sets.roots(), label);
}

}  // namespace
}  // namespace meniscus
