#include "tests/support/delaunay_curves.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include <gtest/gtest.h>

namespace meniscus::delaunay_curves_test {
namespace {

using std::numbers::pi;

constexpr double kTabulated = 1e-9;    // tables give ten digits or more
constexpr double kIntegrated = 1e-11;  // 4000 steps of order 4, length 1

TEST(ClosedForms, AgreeWithTheTables) {
  EXPECT_NEAR(test_films::sphere_of_volume(1.0).radius, 0.620350490899,
              kTabulated);
  EXPECT_NEAR(test_films::sphere_of_volume(1.0).area, 4.83597586204941,
              kTabulated);
  EXPECT_NEAR(test_films::catenoid(1.0, 1.0).waist, 0.848338, 1e-6);
  EXPECT_NEAR(test_films::catenoid(1.0, 1.0).area, 5.99179697580228,
              kTabulated);
  EXPECT_NEAR(test_films::thin_catenoid(1.0, 1.0).waist, 0.2350, 1e-4);
  EXPECT_NEAR(test_films::triple_disk().waist, 0.6386863468, kTabulated);
  EXPECT_NEAR(test_films::triple_disk().disk_radius, 0.7374914685, kTabulated);
  EXPECT_NEAR(test_films::triple_disk().area, 6.03860031878515, kTabulated);
  EXPECT_NEAR(test_films::kTetrahedralFrameArea, 6.0 * std::sqrt(2.0),
              kTabulated);
  EXPECT_THROW(test_films::catenoid(1.0, 1.3255), std::domain_error);
  EXPECT_NO_THROW(test_films::catenoid(1.0, 1.3254));
}

TEST(ClosedForms, CapAtARightAngleIsAHalfSphere) {
  const test_films::SessileCap half = test_films::sessile_cap(0.5, pi / 2.0);
  EXPECT_NEAR(half.radius, test_films::sphere_of_volume(1.0).radius,
              kTabulated);
  EXPECT_NEAR(half.energy, 0.5 * test_films::sphere_of_volume(1.0).area,
              kTabulated);
}

// dE/dV = dp for the family of one angle, all of one shape: 3 V dp = 2 E.
TEST(ClosedForms, EnergyFollowsPressure) {
  for (const double angle : {0.5, 1.0, 2.0, 2.8}) {
    const test_films::SessileCap cap = test_films::sessile_cap(0.7, angle);
    EXPECT_NEAR(3.0 * 0.7 * cap.pressure, 2.0 * cap.energy, kTabulated);
  }
  const test_films::DoubleBubble bubble = test_films::double_bubble(0.7);
  EXPECT_NEAR(3.0 * 1.4 * bubble.pressure, 2.0 * bubble.area, kTabulated);
}

TEST(Delaunay, SphereCylinderAndCatenoid) {
  const test_films::Meridian sphere =
      test_films::delaunay_meridian(0.5, 4.0, 0.7);
  EXPECT_NEAR(sphere.rim().r, 0.5 * std::cos(1.4), kIntegrated);
  EXPECT_NEAR(sphere.rim().z, 0.5 * std::sin(1.4), kIntegrated);
  const test_films::Meridian cylinder =
      test_films::delaunay_meridian(0.5, 2.0, 1.5);
  EXPECT_NEAR(cylinder.rim().r, 0.5, kIntegrated);
  EXPECT_NEAR(cylinder.area, 3.0 * pi, kIntegrated);
  EXPECT_NEAR(cylinder.volume, 0.75 * pi, kIntegrated);
  const test_films::Catenoid exact = test_films::catenoid(1.0, 1.0);
  const test_films::Meridian catenoid = test_films::delaunay_meridian(
      exact.waist, 0.0, exact.waist * std::sinh(0.5 / exact.waist));
  EXPECT_NEAR(catenoid.rim().r, 1.0, kIntegrated);
  EXPECT_NEAR(catenoid.rim().z, 0.5, kIntegrated);
  EXPECT_NEAR(catenoid.area, exact.area, kIntegrated);
}

double first_integral(const test_films::Meridian& m,
                      const test_films::Meridian::Place& p) {
  return p.r * std::cos(p.psi) - 0.5 * m.pressure * p.r * p.r;
}

TEST(Delaunay, FirstIntegralStays) {
  for (const test_films::Meridian& m :
       {test_films::unduloid(), test_films::nodoid()}) {
    const double at_start = first_integral(m, m.places.front());
    for (const test_films::Meridian::Place& p : m.places) {
      EXPECT_NEAR(first_integral(m, p), at_start, kIntegrated);
    }
  }
  const test_films::Meridian unduloid = test_films::unduloid();
  EXPECT_GT(first_integral(unduloid, unduloid.rim()), 0.0);
  const test_films::Meridian nodoid = test_films::nodoid();
  EXPECT_LT(first_integral(nodoid, nodoid.rim()), 0.0);
}

TEST(Delaunay, NodoidTurnsBack) {
  const test_films::Meridian nodoid =
      test_films::delaunay_meridian(1.0, 2.6, 1.0);
  const auto top =
      std::max_element(nodoid.places.begin(), nodoid.places.end(),
                       [](const auto& a, const auto& b) { return a.z < b.z; });
  EXPECT_GT(top->z, nodoid.rim().z + 0.01);
  EXPECT_GT(top->z, test_films::nodoid().rim().z);
}

TEST(Delaunay, ConvergesAtOrderFour) {
  constexpr double kAsymptotic = 0.3;  // of the order, at 20 to 80 steps
  const test_films::Meridian exact =
      test_films::delaunay_meridian(1.0, 2.6, 1.0, 8000);
  std::vector<double> errors;
  for (const int steps : {20, 40, 80}) {
    const test_films::Meridian m =
        test_films::delaunay_meridian(1.0, 2.6, 1.0, steps);
    errors.push_back(
        std::abs(m.area - exact.area) + std::abs(m.volume - exact.volume) +
        std::hypot(m.rim().r - exact.rim().r, m.rim().z - exact.rim().z));
  }
  EXPECT_NEAR(std::log2(errors[0] / errors[1]), 4.0, kAsymptotic);
  EXPECT_NEAR(std::log2(errors[1] / errors[2]), 4.0, kAsymptotic);
}

TEST(Delaunay, DistanceIsNormalOffset) {
  const test_films::Meridian m = test_films::nodoid();
  const test_films::Meridian::Place& p = m.places[1234];
  const double off = 1e-3;
  EXPECT_NEAR(
      m.distance(p.r + off * std::cos(p.psi), -(p.z - off * std::sin(p.psi))),
      off, 1e-8);
  const test_films::Meridian::Place& q = m.places[1235];
  // A chord of length s is s^2 / 8 x curvature off its arc at most.
  EXPECT_LT(m.distance(0.5 * (p.r + q.r), 0.5 * (p.z + q.z)), m.step * m.step);
}

}  // namespace
}  // namespace meniscus::delaunay_curves_test
