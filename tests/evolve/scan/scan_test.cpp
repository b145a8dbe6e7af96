// Scans: distances of films to them, and the rims that they propose.
#include "evolve/scan/scan.h"

#include <cmath>
#include <numbers>
#include <random>

#include <Eigen/Geometry>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/error.h"
#include "evolve/scan/scan_rims.h"
#include "evolve/start/closed_line.h"
#include "tests/support/shapes.h"

namespace meniscus::scan_test {
namespace {

constexpr double kPi = std::numbers::pi;

TEST(FacetTree, FindsTheNearestPointOfAll) {
  const SurfaceMesh sphere = shapes::sphere(1.0, 2);
  std::vector<int> facets(sphere.facets.size());
  for (std::size_t f = 0; f < facets.size(); ++f) {
    facets[f] = static_cast<int>(f);
  }
  const FacetTree tree(sphere, facets);
  std::mt19937 random(7);
  std::uniform_real_distribution<double> within(-1.5, 1.5);
  for (int trial = 0; trial < 200; ++trial) {
    const Vec3 at(within(random), within(random), within(random));
    double least = 1e9;
    for (const Triangle& t : sphere.facets) {
      least =
          std::min(least, nearest_in({sphere.points[t[0]], sphere.points[t[1]],
                                      sphere.points[t[2]]},
                                     at)
                              .distance);
    }
    const NearestPoint found = *tree.nearest(at);
    EXPECT_EQ(found.distance, least);
    EXPECT_NEAR((found.point - at).norm(), least, 1e-14);
    EXPECT_NEAR(found.weights[0] + found.weights[1] + found.weights[2], 1.0,
                1e-14);
  }
  EXPECT_FALSE(FacetTree(sphere, {}).nearest(Vec3::Zero()));
}

TEST(Scan, HasSignedDistancesAndTheirDirections) {
  const scan::Scan scan(shapes::box({2, 2, 2}, 3));
  const scan::ScanPlace above = scan.nearest({0.9, 0.7, 2.5});
  EXPECT_NEAR(above.distance, 0.5, 1e-15);
  EXPECT_NEAR((above.direction - Vec3::UnitZ()).norm(), 0.0, 1e-15);
  EXPECT_NEAR(scan.nearest({0.9, 0.7, 1.9}).distance, -0.1, 1e-15);
  // Beyond a corner: along the way from it.
  const scan::ScanPlace beyond = scan.nearest({3, 3, 3});
  EXPECT_NEAR(beyond.distance, std::sqrt(3.0), 1e-15);
  EXPECT_NEAR((beyond.direction - Vec3::Ones().normalized()).norm(), 0.0,
              1e-15);
  // On it: the facet's normal.
  EXPECT_NEAR((scan.nearest({0.9, 0.7, 2.0}).direction - Vec3::UnitZ()).norm(),
              0.0, 1e-15);
}

TEST(Scan, IsRefusedWithoutFacetsOrWithBadOnes) {
  EXPECT_THROW(scan::Scan(SurfaceMesh{}), MeshError);
  SurfaceMesh bad = shapes::box({1, 1, 1}, 1);
  bad.points[3].x() = std::nan("");
  EXPECT_THROW(scan::Scan{bad}, MeshError);
}

// A sphere of radius 1.1 against one of radius 1: every distance is 0.1 but
// for flat facets.
TEST(Scan, MeasuresAgreeWhereAllDistancesAreAlike) {
  const scan::Scan scan(shapes::sphere(1.0, 4));
  const SurfaceMesh film = shapes::sphere(1.1, 3);
  const scan::ScanDistances distances = scan::distances_to(scan, film, {0});
  EXPECT_EQ(distances.vertices.size(), film.points.size());
  for (const scan::ScanMeasure of :
       {scan::ScanMeasure::Rms, scan::ScanMeasure::Mean, scan::ScanMeasure::P95,
        scan::ScanMeasure::Largest}) {
    EXPECT_NEAR(scan::measure(distances, of, film.points.size()).value, 0.1,
                2e-3);
  }
  EXPECT_TRUE(scan::distances_to(scan, film, {}).vertices.empty());
}

TEST(Scan, MeasuresAreInOrderAndHaveTheDerivativesOfDifferences) {
  const scan::Scan scan(shapes::sphere(1.0, 3));
  SurfaceMesh film = shapes::sphere(1.05, 2);
  // Turned, so that no vertex is as near to several facets.
  const Mat3 turned =
      Eigen::AngleAxisd(0.3, Vec3(1, 2, 3).normalized()).toRotationMatrix();
  for (std::size_t v = 0; v < film.points.size(); ++v) {
    film.points[v] = (1.0 + 0.1 * std::sin(3.0 * static_cast<double>(v))) *
                     (turned * film.points[v]);
  }
  const auto value = [&](scan::ScanMeasure of, double s) {
    SurfaceMesh moved = film;
    for (std::size_t v = 0; v < film.points.size(); ++v) {
      const auto t = static_cast<double>(v);
      moved.points[v] +=
          s * Vec3(std::sin(1.3 * t), std::cos(0.7 * t), std::sin(2.9 * t));
    }
    return scan::measure(scan::distances_to(scan, moved, {0}), of,
                         film.points.size());
  };
  double last = 0.0;
  for (const scan::ScanMeasure of :
       {scan::ScanMeasure::Mean, scan::ScanMeasure::Rms, scan::ScanMeasure::P95,
        scan::ScanMeasure::Largest}) {
    const frozen::FilmResponse at = value(of, 0.0);
    EXPECT_GT(at.value, last);
    last = at.value;
    double exact = 0.0;
    for (std::size_t v = 0; v < film.points.size(); ++v) {
      const auto t = static_cast<double>(v);
      exact += at.by.points[v].dot(
          Vec3(std::sin(1.3 * t), std::cos(0.7 * t), std::sin(2.9 * t)));
    }
    constexpr double kStep = 1e-6;
    EXPECT_NEAR(
        (value(of, kStep).value - value(of, -kStep).value) / (2.0 * kStep),
        exact, 1e-5 * (1.0 + std::abs(exact)));
  }
}

/// A tube of radius `r` and length `h` with flat ends, its points moved by
/// normal noise of `noise`.
SurfaceMesh noisy_tube(double r, double h, int around, double noise) {
  const int rows = static_cast<int>(std::lround(h / (2.0 * kPi * r / around)));
  const int rings = std::max(3, around / 6);
  SurfaceMesh mesh;
  mesh.labels = {"scan"};
  const auto ring = [&](double radius, double z) {
    for (int i = 0; i < around; ++i) {
      const double a = 2.0 * kPi * i / around;
      mesh.points.emplace_back(radius * std::cos(a), radius * std::sin(a), z);
    }
  };
  for (int k = 1; k <= rings; ++k) {
    ring(r * k / rings, 0.0);
  }
  for (int k = 1; k <= rows; ++k) {
    ring(r, h * k / rows);
  }
  for (int k = rings - 1; k >= 1; --k) {
    ring(r * k / rings, h);
  }
  const int count = static_cast<int>(mesh.points.size()) / around;
  for (int k = 0; k + 1 < count; ++k) {
    for (int i = 0; i < around; ++i) {
      const int a = k * around + i;
      const int b = k * around + (i + 1) % around;
      mesh.facets.push_back({a, b, b + around});
      mesh.facets.push_back({a, b + around, a + around});
    }
  }
  const int low = static_cast<int>(mesh.points.size());
  mesh.points.emplace_back(0, 0, 0);
  mesh.points.emplace_back(0, 0, h);
  const int last = (count - 1) * around;
  for (int i = 0; i < around; ++i) {
    mesh.facets.push_back({(i + 1) % around, i, low});
    mesh.facets.push_back({last + i, last + (i + 1) % around, low + 1});
  }
  mesh.facet_label.assign(mesh.facets.size(), 0);
  std::mt19937 random(11);
  std::normal_distribution<double> spread(0.0, noise);
  for (Vec3& p : mesh.points) {
    p += Vec3(spread(random), spread(random), spread(random));
  }
  return mesh;
}

TEST(ScanRims, OfATubeAreItsTwoEnds) {
  constexpr double kRadius = 20.0;
  constexpr double kLength = 60.0;
  for (const double noise : {0.0, 0.3}) {
    const scan::ScanRimReport report =
        scan::find_rims(noisy_tube(kRadius, kLength, 60, noise));
    ASSERT_EQ(report.rims.size(), 2U) << "noise " << noise;
    EXPECT_EQ(report.parts, 3);
    for (const scan::ScanRim& rim : report.rims) {
      EXPECT_NEAR(rim.radius, kRadius, 0.02 * kRadius);
      EXPECT_NEAR(std::abs(rim.normal.z()), 1.0, 1e-3);
      EXPECT_NEAR(std::min(rim.center.z(), kLength - rim.center.z()), 0.0,
                  0.5 + noise);
      EXPECT_LE(rim.points.size(), 24U);
      EXPECT_GT(rim.turn, 45.0);
    }
  }
}

TEST(ScanRims, OfASphereAreNone) {
  const scan::ScanRimReport report = scan::find_rims(shapes::sphere(10.0, 4));
  EXPECT_TRUE(report.rims.empty());
  EXPECT_EQ(report.parts, 1);
}

TEST(ScanRims, OfABoxBoundEachFace) {
  const scan::ScanRimReport report =
      scan::find_rims(shapes::box({3, 3, 3}, 12));
  EXPECT_EQ(report.parts, 6);
  EXPECT_EQ(report.rims.size(), 6U);
}

TEST(ScanRims, RefuseOptionsOutOfRange) {
  const SurfaceMesh sphere = shapes::sphere(1.0, 2);
  EXPECT_THROW(scan::find_rims(sphere, {.angle = 0.0}), InvalidInput);
  EXPECT_THROW(scan::find_rims(sphere, {.radius = -1.0}), InvalidInput);
  EXPECT_THROW(scan::find_rims(sphere, {.points = 3}), InvalidInput);
  EXPECT_THROW(scan::find_rims(SurfaceMesh{}), MeshError);
}

TEST(ClosedLine, OfACircleKeepsItWithSixPoints) {
  Points circle;
  for (int i = 0; i < 200; ++i) {
    const double a = 2.0 * kPi * i / 200;
    circle.emplace_back(5.0 * std::cos(a), 5.0 * std::sin(a), 1.0);
  }
  const start::ClosedLine line(circle);
  EXPECT_NEAR(line.length(), 10.0 * kPi, 0.01);
  const Points few = line.smoothed(6);
  EXPECT_EQ(few.size(), 6U);
  EXPECT_LT(line.deviation(few), 0.05);
  const start::MeanPlane plane = start::mean_plane(few);
  EXPECT_NEAR(plane.normal.z(), 1.0, 1e-12);
  EXPECT_NEAR(plane.off, 0.0, 1e-6);
}

}  // namespace
}  // namespace meniscus::scan_test
