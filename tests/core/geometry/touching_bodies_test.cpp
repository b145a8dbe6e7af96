/// Closed bodies found in surfaces that were read as one.
#include "core/geometry/touching_bodies.h"

#include <array>
#include <cmath>
#include <functional>
#include <map>
#include <set>

#include <gtest/gtest.h>

#include "core/geometry/mesh_checks.h"

namespace meniscus::touching_bodies_test {
namespace {

using Cell = std::array<int, 3>;
using BodyAt = std::function<int(const Cell&)>;  // -1: nothing

constexpr double kRounding = 1e-12;

/// Cells of size 1 of a grid of `n`: each body closed by facets of its own.
class Blocks {
 public:
  Blocks(const Cell& n, const BodyAt& body) {
    for (int i = 0; i < n[0]; ++i) {
      for (int j = 0; j < n[1]; ++j) {
        for (int k = 0; k < n[2]; ++k) {
          add_cell({i, j, k}, n, body);
        }
      }
    }
  }

  SurfaceMesh mesh = {.labels = {"all"}};

 private:
  int point(const Cell& at) {
    const auto [found, is_new] =
        points_.try_emplace(at, static_cast<int>(mesh.points.size()));
    if (is_new) {
      mesh.points.emplace_back(at[0], at[1], at[2]);
    }
    return found->second;
  }

  void add_cell(const Cell& cell, const Cell& n, const BodyAt& body) {
    for (int axis = 0; axis < 3; ++axis) {
      for (const int step : {-1, 1}) {
        Cell next = cell;
        next[axis] += step;
        const bool outside = next[axis] < 0 || next[axis] == n[axis];
        if (body(cell) >= 0 && (outside || body(next) != body(cell))) {
          add_side(cell, axis, step);
        }
      }
    }
  }

  /// Both cells of a joint cut their common side along the same diagonal.
  void add_side(const Cell& cell, int axis, int step) {
    const int u = (axis + 1) % 3;
    const int v = (axis + 2) % 3;
    Cell corner = cell;
    corner[axis] += step > 0 ? 1 : 0;
    std::array<int, 4> ids{};
    for (int c = 0; c < 4; ++c) {
      Cell at = corner;
      at[u] += c == 1 || c == 2 ? 1 : 0;
      at[v] += c >= 2 ? 1 : 0;
      ids[c] = point(at);
    }
    for (Triangle t :
         {Triangle{ids[0], ids[1], ids[2]}, Triangle{ids[0], ids[2], ids[3]}}) {
      if (step < 0) {
        std::swap(t[1], t[2]);
      }
      mesh.facets.push_back(t);
      mesh.facet_label.push_back(0);
    }
  }

  std::map<Cell, int> points_;
};

/// Two flanges, and a web of two plates end to end.
int h_of_plates(const Cell& cell) {
  if (cell[0] == 0 || cell[0] == 3) {
    return cell[0] == 0 ? 0 : 1;
  }
  return cell[1] != 1 ? -1 : (cell[0] == 1 ? 2 : 3);
}

TEST(TouchingBodies, AnHOfFourPlatesIsFour) {
  const SurfaceMesh read = Blocks({4, 3, 1}, h_of_plates).mesh;
  EXPECT_FALSE(check_surface(read).empty());
  const SurfaceMesh found = with_own_bodies(read);
  EXPECT_EQ(body_count(found), 4);
  EXPECT_EQ(found.facets.size(), read.facets.size() - 6);  // three joints
  EXPECT_NEAR(enclosed_volume(found), 8.0, kRounding);
  EXPECT_TRUE(check_surface(found).empty()) << summary(check_surface(found));
  std::set<std::pair<int, int>> joints;
  for (const FacetBodies& side : found.facet_bodies) {
    if (side.front >= 0) {
      joints.insert(std::minmax(side.behind, side.front));
    }
  }
  EXPECT_EQ(joints.size(), 3U);
  // Once more is the same.
  EXPECT_EQ(body_count(with_own_bodies(found)), 4);
}

TEST(TouchingBodies, OneOfOnePieceStaysAsItIs) {
  const SurfaceMesh fused = Blocks({4, 3, 1}, [](const Cell& cell) {
                              return h_of_plates(cell) < 0 ? -1 : 0;
                            }).mesh;
  const SurfaceMesh found = with_own_bodies(fused);
  EXPECT_TRUE(found.facet_bodies.empty());
  EXPECT_EQ(found.facets, fused.facets);
}

TEST(TouchingBodies, ApartAreTwo) {
  const SurfaceMesh found =
      with_own_bodies(Blocks({3, 1, 1}, [](const Cell& cell) {
                        return cell[0] == 1 ? -1 : 0;
                      }).mesh);
  EXPECT_EQ(body_count(found), 2);
  EXPECT_TRUE(check_surface(found).empty());
}

// Along an edge: two bodies, though one closed surface goes through both.
TEST(TouchingBodies, ThatShareAnEdgeAreTwo) {
  const SurfaceMesh found =
      with_own_bodies(Blocks({2, 2, 1}, [](const Cell& cell) {
                        return cell[0] == cell[1] ? 0 : -1;
                      }).mesh);
  EXPECT_EQ(body_count(found), 2);
  EXPECT_TRUE(check_surface(found).empty()) << summary(check_surface(found));
}

// A hollow block beside a solid one: the hollow's wall is of the first.
TEST(TouchingBodies, ACavityIsNoBody) {
  const SurfaceMesh found =
      with_own_bodies(Blocks({4, 3, 3}, [](const Cell& cell) {
                        return cell == Cell{1, 1, 1} ? -1 : cell[0] / 3;
                      }).mesh);
  EXPECT_EQ(body_count(found), 2);
  EXPECT_NEAR(enclosed_volume(found), 35.0, kRounding);
  EXPECT_TRUE(check_surface(found).empty()) << summary(check_surface(found));
}

TEST(TouchingBodies, WhatClosesNothingStaysAsItIs) {
  SurfaceMesh open = Blocks({4, 3, 1}, h_of_plates).mesh;
  open.facets.erase(open.facets.begin());
  open.facet_label.pop_back();
  EXPECT_FALSE(check_surface(with_own_bodies(open)).empty());
  EXPECT_TRUE(with_own_bodies(SurfaceMesh()).facets.empty());
}

}  // namespace
}  // namespace meniscus::touching_bodies_test
