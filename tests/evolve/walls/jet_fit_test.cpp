#include "evolve/walls/jet_fit.h"

#include <algorithm>
#include <array>
#include <cmath>

#include <gtest/gtest.h>

#include "tests/support/shapes.h"
#include "tests/support/sheet_shapes.h"

namespace meniscus::jet_fit_test {
namespace {

// Curvatures are of order 2 where rings surround a vertex, on irregular sheets
// observed a little less; the largest error sits at rims, whose one-sided
// rings cost up to one order.
constexpr double kRimOrder = 0.9;
constexpr double kInnerOrder = 1.7;

struct Errors {
  double normal = 0.0;
  double curvature = 0.0;
};

template <typename Exact>
Errors errors(const SurfaceMesh& film, const Exact& exact) {
  const std::vector<walls::Jet> jets = walls::fit_jets(walls::make_sheet(film));
  Errors worst;
  for (std::size_t v = 0; v < jets.size(); ++v) {
    const walls::Jet right = exact(film.points[v]);
    worst.normal =
        std::max(worst.normal, (jets[v].normal - right.normal).norm());
    worst.curvature =
        std::max({worst.curvature, std::abs(jets[v].k1 - right.k1),
                  std::abs(jets[v].k2 - right.k2)});
  }
  return worst;
}

template <typename Make, typename Exact>
void expect_order(const Make& make, const Exact& exact, double order) {
  std::array<Errors, 3> at;
  for (int i = 0; i < 3; ++i) {
    at[i] = errors(make(i), exact);
  }
  EXPECT_GT(std::log2(at[1].curvature / at[2].curvature), order)
      << at[1].curvature << " " << at[2].curvature;
  EXPECT_GT(std::log2(at[1].normal / at[2].normal), order + 0.5)
      << at[1].normal << " " << at[2].normal;
}

TEST(JetFit, Sphere) {
  expect_order([](int i) { return shapes::sphere(2.0, 2 + i); },
               [](const Vec3& p) -> walls::Jet {
                 return {p.normalized(), 0.5, 0.5};
               },
               kInnerOrder);
}

TEST(JetFit, Cylinder) {
  expect_order(
      [](int i) {
        const int n = 24 << i;
        return shapes::cylinder_sheet(
            1.0, 1.5, {.rows = n / 4, .columns = n, .around = true});
      },
      [](const Vec3& p) -> walls::Jet {
        return {Vec3(p.x(), p.y(), 0.0).normalized(), 1.0, 0.0};
      },
      kRimOrder);
}

TEST(JetFit, Catenoid) {
  expect_order(
      [](int i) {
        const int n = 24 << i;
        return shapes::catenoid_sheet(
            0.6, {.rows = n / 4, .columns = n, .around = true});
      },
      [](const Vec3& p) -> walls::Jet {
        const double c = std::cosh(p.z());
        const Vec3 normal =
            Vec3(p.x() / c, p.y() / c, -std::sinh(p.z())).normalized();
        return {normal, 1.0 / (c * c), -1.0 / (c * c)};
      },
      kRimOrder);
}

TEST(JetFit, SaddleIsExactAtItsCentre) {
  // z = (x^2 - 2 y^2) / 2 is a jet of its own at the origin.
  const SurfaceMesh film = shapes::patch(
      [](double u, double v) -> Vec3 {
        const double x = u - 0.5;
        const double y = v - 0.5;
        return {x, y, 0.5 * (x * x - 2.0 * y * y)};
      },
      {.jitter = 0.0});
  const walls::Jet jet = walls::fit_jets(walls::make_sheet(film))[40];
  EXPECT_NEAR(jet.normal.z(), 1.0, 1e-12);
  EXPECT_NEAR(jet.k1, 2.0, 1e-12);
  EXPECT_NEAR(jet.k2, -1.0, 1e-12);
}

}  // namespace
}  // namespace meniscus::jet_fit_test
