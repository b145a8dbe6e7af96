// The gap of two films: the least of corners to facets and edges to edges.
#include "evolve/frozen/gap_between.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <random>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/error.h"
#include "core/geometry/facet_pairs.h"

namespace meniscus::gap_between_test {
namespace {

void add_facet(SurfaceMesh& mesh, int label, const std::array<Vec3, 3>& t) {
  const int first = static_cast<int>(mesh.points.size());
  mesh.points.insert(mesh.points.end(), t.begin(), t.end());
  mesh.facets.push_back({first, first + 1, first + 2});
  mesh.facet_label.push_back(label);
}

/// Two roofs whose ridges cross `apart` above each other: the lower one's runs
/// along x at z = 0, the upper one's, upside down, along `way` in the plane.
/// All corners are `reach` from the middle.
SurfaceMesh crossed_ridges(double apart, double reach, double angle) {
  SurfaceMesh mesh;
  mesh.labels = {"lower", "upper"};
  const auto roof = [&](int label, const Vec3& along, double ridge,
                        double down) {
    const Vec3 side = Vec3::UnitZ().cross(along);
    const int first = static_cast<int>(mesh.points.size());
    for (const double s : {-reach, reach}) {
      mesh.points.emplace_back(s * along + ridge * Vec3::UnitZ());
    }
    for (const double s : {-reach, reach}) {
      mesh.points.emplace_back(s * side + (ridge + down) * Vec3::UnitZ());
    }
    mesh.facets.push_back({first, first + 1, first + 3});
    mesh.facets.push_back({first + 1, first, first + 2});
    mesh.facet_label.insert(mesh.facet_label.end(), 2, label);
  };
  roof(0, Vec3::UnitX(), 0.0, -reach);
  roof(1, {std::cos(angle), std::sin(angle), 0.0}, apart, reach);
  return mesh;
}

TEST(GapOfEdges, IsThatOfRidgesThatCross) {
  constexpr double kReach = 1.0;
  for (const double angle : {1.5707963267948966, 0.8, 0.2}) {
    for (const double apart : {0.5, 0.1, 1e-3}) {
      const double smoothing = 1e-3 * apart;
      const frozen::FilmResponse gap = frozen::gap_between(
          crossed_ridges(apart, kReach, angle), 0, 1, smoothing);
      EXPECT_LE(gap.value, apart * (1.0 + 1e-12)) << angle;
      // The two ridges alone are so near.
      EXPECT_GE(gap.value, apart - smoothing * std::log(2.001)) << angle;
      // Lifting the upper one by its ridge lifts the gap as much.
      const double lifted = gap.by.points[4].z() + gap.by.points[5].z();
      EXPECT_NEAR(lifted, 1.0, 1e-9) << angle;
    }
  }
}

TEST(GapOfEdges, OfRidgesThatPassThroughEachOtherIsRefused) {
  for (const double apart : {-1e-6, 0.0}) {
    EXPECT_THROW(
        frozen::gap_between(crossed_ridges(apart, 1.0, 1.2), 0, 1, 0.01),
        InvalidInput)
        << apart;
  }
}

double value_at(SurfaceMesh mesh, const Points& way, double step,
                double smoothing) {
  for (std::size_t v = 0; v < way.size(); ++v) {
    mesh.points[v] += step * way[v];
  }
  return frozen::gap_between(mesh, 0, 1, smoothing).value;
}

/// Central differences, one step of Richardson's.
double differences(const SurfaceMesh& mesh, const Points& way,
                   double smoothing) {
  constexpr double kStep = 1e-5;
  const auto slope = [&](double step) {
    return (value_at(mesh, way, step, smoothing) -
            value_at(mesh, way, -step, smoothing)) /
           (2.0 * step);
  };
  return (4.0 * slope(0.5 * kStep) - slope(kStep)) / 3.0;
}

/// So many random facets a film, the films side by side along z.
SurfaceMesh soup(std::mt19937& random, int count) {
  std::uniform_real_distribution<double> in(-1.0, 1.0);
  SurfaceMesh mesh;
  mesh.labels = {"lower", "upper"};
  for (int f = 0; f < 2 * count; ++f) {
    const Vec3 up = (f % 2) * 1.1 * Vec3::UnitZ();
    std::array<Vec3, 3> t;
    for (Vec3& x : t) {
      x = up + Vec3(in(random), in(random), 0.5 * in(random));
    }
    add_facet(mesh, f % 2, t);
  }
  return mesh;
}

bool crosses(const SurfaceMesh& mesh) {
  for (int f = 0; f < static_cast<int>(mesh.facets.size()); ++f) {
    for (int g = 0; g < f; ++g) {
      if (mesh.facet_label[f] != mesh.facet_label[g] &&
          classify_pair(mesh, f, g, 0.0).state == PairState::Crossing) {
        return true;
      }
    }
  }
  return false;
}

/// Least distance of two facets by minimising over both by turns: the nearest
/// point of one to that of the other, from several starts. An upper bound that
/// is the least for convex sets.
double least_by_projections(const SurfaceMesh& mesh) {
  double least = std::numeric_limits<double>::infinity();
  const auto corners = [&](int f) {
    const Triangle& t = mesh.facets[f];
    return std::array{mesh.points[t[0]], mesh.points[t[1]], mesh.points[t[2]]};
  };
  for (int f = 0; f < static_cast<int>(mesh.facets.size()); ++f) {
    for (int g = 0; g < f; ++g) {
      if (mesh.facet_label[f] == mesh.facet_label[g]) {
        continue;
      }
      // Closest points of two triangles by a grid, then finer ones around it.
      std::array<double, 4> middle = {1.0 / 3, 1.0 / 3, 1.0 / 3, 1.0 / 3};
      double width = 1.0;
      double best = std::numeric_limits<double>::infinity();
      const auto s = corners(f);
      const auto t = corners(g);
      for (int round = 0; round < 24; ++round) {
        std::array<double, 4> found = middle;
        for (int i = 0; i < 625; ++i) {
          std::array<double, 4> w = middle;
          for (int k = 0, rest = i; k < 4; ++k, rest /= 5) {
            w[k] =
                std::clamp(middle[k] + 0.25 * width * (rest % 5 - 2), 0.0, 1.0);
          }
          for (int k = 0; k < 4; k += 2) {
            const double sum = std::max(1.0, w[k] + w[k + 1]);
            w[k] /= sum;
            w[k + 1] /= sum;
          }
          const Vec3 x = s[0] + w[0] * (s[1] - s[0]) + w[1] * (s[2] - s[0]);
          const Vec3 y = t[0] + w[2] * (t[1] - t[0]) + w[3] * (t[2] - t[0]);
          if ((x - y).norm() < best) {
            best = (x - y).norm();
            found = w;
          }
        }
        middle = found;
        width *= 0.6;
      }
      least = std::min(least, best);
    }
  }
  return least;
}

// Any facets at all: between the least of all pairs and the smoothing below it.
TEST(GapOfEdges, IsTheLeastOfAllPairsOfRandomFacets) {
  std::mt19937 random(5);
  constexpr int kFacets = 3;
  constexpr double kSmoothing = 1e-4;
  int seen = 0;
  for (int n = 0; n < 60 && seen < 10; ++n) {
    const SurfaceMesh mesh = soup(random, kFacets);
    if (crosses(mesh)) {
      continue;
    }
    ++seen;
    const double least = least_by_projections(mesh);
    const double gap = frozen::gap_between(mesh, 0, 1, kSmoothing).value;
    EXPECT_LE(gap, least + 1e-12) << n;
    // The grids end within 1e-4 of the least.
    EXPECT_GE(gap, least - 1e-4 - kSmoothing * std::log(18.0)) << n;
  }
  EXPECT_EQ(seen, 10);
}

TEST(GapOfEdges, HasTheDerivativeOfItsDifferencesOnRandomFacets) {
  std::mt19937 random(6);
  std::normal_distribution<double> normal;
  constexpr double kSmoothing = 0.02;
  int seen = 0;
  for (int n = 0; n < 200 && seen < 40; ++n) {
    const SurfaceMesh mesh = soup(random, 4);
    if (crosses(mesh)) {
      continue;
    }
    const frozen::FilmResponse gap =
        frozen::gap_between(mesh, 0, 1, kSmoothing);
    if (gap.value < 0.05) {
      continue;  // the step would be no small one
    }
    ++seen;
    Points way;
    double exact = 0.0;
    for (const Vec3& by : gap.by.points) {
      way.emplace_back(normal(random), normal(random), normal(random));
      exact += by.dot(way.back());
    }
    EXPECT_NEAR(differences(mesh, way, kSmoothing), exact, 1e-6) << n;
  }
  EXPECT_EQ(seen, 40);
}

// Moving both films alike changes nothing; moving them apart, their distance.
TEST(GapOfEdges, DoesNotChangeWhereBothMoveAlike) {
  std::mt19937 random(9);
  for (int n = 0; n < 50; ++n) {
    const SurfaceMesh mesh = soup(random, 6);
    if (crosses(mesh)) {
      continue;
    }
    const frozen::FilmResponse gap = frozen::gap_between(mesh, 0, 1, 0.01);
    Vec3 sum = Vec3::Zero();
    Vec3 turn = Vec3::Zero();
    for (std::size_t v = 0; v < mesh.points.size(); ++v) {
      sum += gap.by.points[v];
      turn += mesh.points[v].cross(gap.by.points[v]);
    }
    EXPECT_LT(sum.norm(), 1e-12) << n;
    EXPECT_LT(turn.norm(), 1e-12) << n;
  }
}

// A ridge's lowest point slides along its own edge: no kink on the way, and the
// gap's slope is that of its differences all along.
TEST(GapOfEdges, IsSmoothWhileRidgesSlidePastEachOther) {
  constexpr double kSmoothing = 0.01;
  double last = 0.0;
  for (int i = 0; i <= 40; ++i) {
    SurfaceMesh mesh = crossed_ridges(0.3, 1.0, 0.9);
    const double at = -0.5 + i / 40.0;
    for (std::size_t v = 4; v < 8; ++v) {
      mesh.points[v] += Vec3(at, 0.7 * at, 0.1 * at * at);
    }
    const frozen::FilmResponse gap =
        frozen::gap_between(mesh, 0, 1, kSmoothing);
    Points way(mesh.points.size(), Vec3::Zero());
    double exact = 0.0;
    for (std::size_t v = 4; v < 8; ++v) {
      way[v] = Vec3(1.0, 0.7, 0.2 * at);
      exact += gap.by.points[v].dot(way[v]);
    }
    EXPECT_NEAR(differences(mesh, way, kSmoothing), exact, 1e-8) << i;
    if (i > 0) {
      EXPECT_LT(std::abs(exact - last), 0.02) << i;
    }
    last = exact;
  }
}

}  // namespace
}  // namespace meniscus::gap_between_test
