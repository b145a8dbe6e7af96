#include "optimize/samples/family_tree.h"

#include <limits>
#include <numeric>

#include <gmock/gmock.h>

#include "core/error.h"
#include "optimize/samples/sampling.h"
#include "tests/support/standard_problems.h"

namespace meniscus::family_tree_test {
namespace {

using tests::vector_of;

TEST(FamilyTree, JoinsEachMemberToItsNearest) {
  // Lengths 100, 400, 110, 390 at one load: two pairs, joined by 110 - 390.
  const auto steps =
      samples::family_tree({vector_of({100.0, 5.0}), vector_of({400.0, 5.0}),
                            vector_of({110.0, 5.0}), vector_of({390.0, 5.0})});
  ASSERT_EQ(steps.size(), 4U);
  EXPECT_EQ(steps[0].member, 0);
  EXPECT_FALSE(steps[0].parent);
  EXPECT_EQ(steps[1].member, 2);
  EXPECT_EQ(steps[1].parent, 0);
  EXPECT_EQ(steps[2].member, 3);
  EXPECT_EQ(steps[2].parent, 2);
  EXPECT_EQ(steps[3].member, 1);
  EXPECT_EQ(steps[3].parent, 3);
  EXPECT_EQ(steps[3].depth, 3);
  EXPECT_NEAR(steps[3].distance, 10.0 / 300.0, 1e-15);
}

// Rows are added to a family that is sized: whatever they are, those before
// keep their parents, and a new one joins the nearest.
TEST(FamilyTree, GrowsOnWhatIsThere) {
  const std::vector<VectorX> all = samples::latin_hypercube_samples(2, 30, 9);
  const std::vector<VectorX> first(all.begin(), all.begin() + 20);
  std::map<int, int> kept;
  for (const samples::FamilyStep& step : samples::family_tree(first)) {
    kept[step.member] = step.parent.value_or(-1);
  }
  const auto grown = samples::family_tree(all, kept);
  ASSERT_EQ(grown.size(), all.size());
  std::vector<int> depth(all.size(), -1);
  for (std::size_t k = 0; k < grown.size(); ++k) {
    const samples::FamilyStep& step = grown[k];
    EXPECT_EQ(depth[static_cast<std::size_t>(step.member)], -1);
    const int parent = step.parent.value_or(-1);
    if (k < first.size()) {
      EXPECT_EQ(parent, kept.at(step.member));
    } else {
      EXPECT_GE(step.member, 20);
      ASSERT_GE(parent, 0);
    }
    depth[static_cast<std::size_t>(step.member)] = step.depth;
    EXPECT_EQ(step.depth,
              parent < 0 ? 0 : depth[static_cast<std::size_t>(parent)] + 1);
  }
  // All anew is one of them: the tree of a family that was never sized.
  const auto anew = samples::family_tree(all, {});
  const auto plain = samples::family_tree(all);
  for (std::size_t k = 0; k < anew.size(); ++k) {
    EXPECT_EQ(anew[k].member, plain[k].member);
    EXPECT_EQ(anew[k].parent, plain[k].parent);
  }
  EXPECT_THROW(samples::family_tree(all, {{0, 1}}), InvalidInput);
  EXPECT_THROW(samples::family_tree(all, {{0, 1}, {1, 0}}), InvalidInput);
}

TEST(FamilyTree, DoesNotDependOnUnits) {
  std::vector<VectorX> metres = samples::latin_hypercube_samples(3, 20, 5);
  std::vector<VectorX> other = metres;
  for (VectorX& member : other) {
    member = member.cwiseProduct(vector_of({1024.0, 0.5, 4096.0}));
  }
  const auto a = samples::family_tree(metres);
  const auto b = samples::family_tree(other);
  for (std::size_t i = 0; i < a.size(); ++i) {
    EXPECT_EQ(a[i].member, b[i].member);
    EXPECT_EQ(a[i].parent, b[i].parent);
  }
}

TEST(FamilyTree, IsNoLongerThanAnyOther) {
  // Every spanning tree of four members is a Pruefer pair: all 16.
  const std::vector<VectorX> members = {
      vector_of({0.0, 0.0}), vector_of({1.0, 0.2}), vector_of({0.4, 1.0}),
      vector_of({0.7, 0.6})};
  double length = 0.0;
  for (const samples::FamilyStep& step : samples::family_tree(members)) {
    length += step.distance;
  }
  for (int a = 0; a < 4; ++a) {
    for (int b = 0; b < 4; ++b) {
      std::vector<int> degree(4, 1);
      ++degree[static_cast<std::size_t>(a)];
      ++degree[static_cast<std::size_t>(b)];
      double other = 0.0;
      const auto join = [&](int from, int to) {
        other += (members[static_cast<std::size_t>(from)] -
                  members[static_cast<std::size_t>(to)])
                     .norm();
        --degree[static_cast<std::size_t>(from)];
        --degree[static_cast<std::size_t>(to)];
      };
      const auto leaf = [&](int after) {
        int k = after;
        while (degree[static_cast<std::size_t>(k)] != 1) {
          ++k;
        }
        return k;
      };
      for (const int node : {a, b}) {
        join(leaf(0), node);
      }
      const int last = leaf(0);
      join(last, leaf(last + 1));
      EXPECT_LE(length, other + 1e-12);
    }
  }
}

TEST(FamilyTree, ParentsComeFirstAndWavesHoldEveryone) {
  const auto steps =
      samples::family_tree(samples::latin_hypercube_samples(4, 30, 3));
  std::vector<bool> seen(30, false);
  for (const samples::FamilyStep& step : steps) {
    EXPECT_TRUE(!step.parent || seen[static_cast<std::size_t>(*step.parent)]);
    seen[static_cast<std::size_t>(step.member)] = true;
  }
  std::size_t count = 0;
  for (const auto& wave : samples::family_waves(steps)) {
    EXPECT_FALSE(wave.empty());
    count += wave.size();
  }
  EXPECT_EQ(count, 30U);
}

TEST(FamilyTree, EqualMembersAndEmptyFamilies) {
  EXPECT_TRUE(samples::family_tree({}).empty());
  EXPECT_TRUE(samples::family_waves({}).empty());
  const auto steps =
      samples::family_tree(std::vector<VectorX>(3, vector_of({2.0})));
  EXPECT_EQ(steps[2].parent, 0);
  EXPECT_EQ(steps[2].distance, 0.0);
  EXPECT_THROW(samples::family_tree({vector_of({1.0}), vector_of({1.0, 2.0})}),
               InvalidInput);
  constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();
  EXPECT_THROW(samples::family_tree({vector_of({1.0}), vector_of({kNaN})}),
               InvalidInput);
}

}  // namespace
}  // namespace meniscus::family_tree_test
