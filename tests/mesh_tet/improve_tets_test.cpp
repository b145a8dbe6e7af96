#include "mesh_tet/improve_tets.h"

#include <algorithm>
#include <cmath>
#include <random>
#include <set>

#include <gtest/gtest.h>

#include "mesh_tet/tet_quality.h"
#include "mesh_tet/tetrahedralize.h"
#include "tests/support/shapes.h"

namespace meniscus::improve_tets_test {

namespace {

TEST(ImproveTets, MovesADisplacedNodeBack) {
  TetMesh mesh = shapes::brick(Vec3::Ones(), 2, 2, 2);
  const Points before = mesh.nodes;
  int inner = -1;
  for (std::size_t n = 0; n < mesh.nodes.size(); ++n) {
    if (mesh.nodes[n] == Vec3(0.5, 0.5, 0.5)) {
      inner = static_cast<int>(n);
    }
  }
  ASSERT_GE(inner, 0);
  // The only free node must be the last: exchange it with the last one.
  const int last = static_cast<int>(mesh.nodes.size()) - 1;
  const auto exchange = [&](std::vector<int>& ids) {
    for (int& id : ids) {
      id = id == inner ? last : id == last ? inner : id;
    }
  };
  exchange(mesh.elements);
  exchange(mesh.faces);
  std::swap(mesh.nodes[inner], mesh.nodes[last]);
  const Points straight = mesh.nodes;
  mesh.nodes[last] = Vec3(0.95, 0.93, 0.9);
  const double poor = mesh_tet::tet_quality(mesh).min_dihedral_deg;
  mesh_tet::improve_tets(mesh, last, {.below_deg = 30.0, .rounds = 1});
  EXPECT_GT(mesh_tet::tet_quality(mesh).min_dihedral_deg, 2.0 * poor);
  for (int n = 0; n < last; ++n) {
    EXPECT_EQ(mesh.nodes[n], straight[n]);
  }
}

/// A brick of cells whose inner nodes, numbered last, are moved by up to
/// `amount` x a cell.
TetMesh shaken_brick(int cells, double amount, unsigned seed, int& fixed) {
  TetMesh mesh = shapes::brick(Vec3::Ones(), cells, cells, cells);
  std::vector<int> order;
  for (const bool inner : {false, true}) {
    for (std::size_t n = 0; n < mesh.nodes.size(); ++n) {
      const Vec3& p = mesh.nodes[n];
      const bool inside = p.minCoeff() > 1e-9 && p.maxCoeff() < 1.0 - 1e-9;
      if (inside == inner) {
        order.push_back(static_cast<int>(n));
      }
    }
    fixed = inner ? fixed : static_cast<int>(order.size());
  }
  std::vector<int> number(order.size());
  Points nodes(order.size());
  for (std::size_t k = 0; k < order.size(); ++k) {
    number[order[k]] = static_cast<int>(k);
    nodes[k] = mesh.nodes[order[k]];
  }
  for (std::vector<int>* ids : {&mesh.elements, &mesh.faces}) {
    for (int& id : *ids) {
      id = number[id];
    }
  }
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> move(-amount / cells, amount / cells);
  for (std::size_t k = fixed; k < nodes.size(); ++k) {
    nodes[k] += Vec3(move(random), move(random), move(random));
  }
  mesh.nodes = nodes;
  return mesh;
}

// Elements turned inside out come from rounding; whatever is exchanged for
// them, elements stay elements and fill the same space.
TEST(ImproveTets, ElementsWithoutVolumeAreNotMultiplied) {
  for (unsigned seed = 0; seed < 24; ++seed) {
    int fixed = 0;
    TetMesh mesh = shaken_brick(3 + seed % 2, 0.6 + 0.02 * seed, seed, fixed);
    int inverted = 0;
    for (int e = 0; e < mesh.element_count(); ++e) {
      inverted += corner_volume(mesh, e) <= 0.0 ? 1 : 0;
    }
    ASSERT_GT(inverted, 0) << seed;
    mesh_tet::improve_tets(mesh, fixed, {.below_deg = 15.0});
    double volume = 0.0;
    std::set<std::array<int, 4>> seen;
    for (int e = 0; e < mesh.element_count(); ++e) {
      const auto ids = mesh.element(e);
      std::array<int, 4> sorted = {ids[0], ids[1], ids[2], ids[3]};
      std::sort(sorted.begin(), sorted.end());
      ASSERT_EQ(std::adjacent_find(sorted.begin(), sorted.end()), sorted.end())
          << seed;
      ASSERT_TRUE(seen.insert(sorted).second) << seed;
      volume += corner_volume(mesh, e);
    }
    // Nodes of overlapping elements may go far: sums of large volumes.
    EXPECT_NEAR(volume, 1.0, 1e-6) << seed;
  }
}

/// A smooth part, longer than wide, bent by a few waves.
SurfaceMesh random_part(unsigned seed) {
  std::mt19937 random(seed);
  const auto between = [&](double low, double high) {
    return std::uniform_real_distribution<double>(low, high)(random);
  };
  SurfaceMesh mesh = seed % 3 == 0 ? shapes::box(Vec3::Ones(), 4 + seed % 5)
                                   : shapes::sphere(0.7, 2 + seed % 2);
  const auto vector = [&](double size) {
    return Vec3(between(-size, size), between(-size, size),
                between(-size, size));
  };
  const Vec3 stretch(between(1.0, 2.0), between(0.8, 1.2), between(0.6, 1.0));
  std::array<std::array<Vec3, 2>, 5> waves;
  for (auto& [wave, shift] : waves) {
    wave = vector(2.5);
    shift = vector(0.06);
  }
  for (Vec3& p : mesh.points) {
    Vec3 moved = stretch.cwiseProduct(p);
    for (const auto& [wave, shift] : waves) {
      moved += shift * std::sin(wave.dot(p));
    }
    p = moved;
  }
  return mesh;
}

TEST(ImproveTets, RandomPartsHaveNoBadElements) {
  constexpr int kParts = 60;
  constexpr double kLeast = 8.0;  // TetGen alone: 1 degree for the worst part
  constexpr double kMost = 171.0;
  int better = 0;
  double least = 180.0;
  double least_raw = 180.0;
  for (int i = 0; i < kParts; ++i) {
    SCOPED_TRACE(i);
    const SurfaceMesh surface = random_part(static_cast<unsigned>(i));
    const auto result = mesh_tet::tetrahedralize(surface);
    ASSERT_FALSE(result.failure) << result.failure->message;
    EXPECT_GE(result.quality.min_dihedral_deg, kLeast);
    EXPECT_LE(result.quality.max_dihedral_deg, kMost);
    const auto raw =
        mesh_tet::tetrahedralize(surface, {.improve_below_deg = 0.0,
                                           .bounds = {.min_dihedral_deg = 0.0,
                                                      .max_dihedral_deg = 180.0,
                                                      .max_radius_edge = 1e300,
                                                      .max_aspect = 1e300}});
    ASSERT_FALSE(raw.failure) << raw.failure->message;
    EXPECT_GE(result.quality.min_dihedral_deg, raw.quality.min_dihedral_deg);
    better += result.quality.min_dihedral_deg > raw.quality.min_dihedral_deg;
    least = std::min(least, result.quality.min_dihedral_deg);
    least_raw = std::min(least_raw, raw.quality.min_dihedral_deg);
  }
  RecordProperty("better", better);
  RecordProperty("least", std::to_string(least));
  RecordProperty("least_raw", std::to_string(least_raw));
}

TEST(ImproveTets, StretchedSurfaceBecomesUsable) {
  // TetGen alone leaves angles of 0.4 degrees between surface points here.
  SurfaceMesh surface = shapes::sphere(1.0, 3);
  for (Vec3& p : surface.points) {
    const double arm = 0.6 + 0.8 * p.x() * p.x();
    p = Vec3(150 * p.x(), 45 * arm * p.y(),
             35 * arm * p.z() + 72 * p.x() * p.x());
  }
  const auto result = mesh_tet::tetrahedralize(surface);
  ASSERT_FALSE(result.failure) << result.failure->message;
  // Refused without improvement, or worse.
  const auto raw =
      mesh_tet::tetrahedralize(surface, {.improve_below_deg = 0.0});
  if (!raw.failure) {
    EXPECT_GT(result.quality.min_dihedral_deg,
              1.5 * raw.quality.min_dihedral_deg);
  }
  const double volume = enclosed_volume(surface);
  double sum = 0.0;
  for (int e = 0; e < result.mesh.element_count(); ++e) {
    sum += corner_volume(result.mesh, e);
  }
  EXPECT_NEAR(sum, volume, 1e-12 * volume);
}

}  // namespace

}  // namespace meniscus::improve_tets_test
