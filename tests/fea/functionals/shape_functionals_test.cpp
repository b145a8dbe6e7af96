/// Moments of inertia, overhangs and drafts against closed forms and
/// differences.
#include <cmath>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/error.h"
#include "fea/functionals/facing_area.h"
#include "fea/functionals/inertia.h"
#include "tests/support/derivatives.h"
#include "tests/support/gradient_parts.h"
#include "tests/support/mapped_shapes.h"

namespace meniscus::shape_functionals_test {
namespace {

using derivatives::expect_derivative;
using derivatives::expect_partials;
using functionals::FacingLimits;

constexpr double kRounding = 1e-12;
constexpr double kPi = 3.14159265358979323846;
constexpr double kDegree = kPi / 180.0;

class ShapeFunctionals : public testing::TestWithParam<int> {
 protected:
  TetMesh box(const Vec3& size) const {
    const TetMesh mesh = shapes::brick(size, 2, 2, 3);
    return GetParam() == 2 ? shapes::straight_quadratic(mesh) : mesh;
  }
  TetMesh mesh_ = gradient_parts::block(GetParam());
  std::vector<element::Material> materials_ = gradient_parts::materials();
};

TEST_P(ShapeFunctionals, InertiaOfABox) {
  const Vec3 size(2.0, 1.0, 3.0);
  const std::vector<element::Material> steel = {parts::steel()};
  const TetMesh mesh = box(size);
  const double mass = steel[0].density * size.prod();
  const Vec3 main = mass / 12.0 *
                    Vec3(size.y() * size.y() + size.z() * size.z(),
                         size.z() * size.z() + size.x() * size.x(),
                         size.x() * size.x() + size.y() * size.y());
  const auto about = [&](const Vec3& axis, std::optional<Vec3> point) {
    return functionals::inertia_functional(mesh, steel, axis, point).value;
  };
  for (int k = 0; k < 3; ++k) {
    EXPECT_NEAR(about(2.0 * Vec3::Unit(k), {}), main[k], kRounding * mass);
  }
  // About any axis through the middle by the principal moments.
  const Vec3 n = Vec3(1.0, -2.0, 0.5).normalized();
  EXPECT_NEAR(about(n, {}), n.cwiseAbs2().dot(main), kRounding * mass);
  // By Steiner's theorem about an edge.
  EXPECT_NEAR(
      about(Vec3::UnitZ(), Vec3::Zero()),
      main.z() + 0.25 * mass * (size.x() * size.x() + size.y() * size.y()),
      10.0 * kRounding * mass);
  // The product about the corner: - int x y.
  EXPECT_NEAR(about({1.0, 1.0, 0.0}, Vec3::Zero()) -
                  0.5 * (about(Vec3::UnitX(), Vec3::Zero()) +
                         about(Vec3::UnitY(), Vec3::Zero())),
              -0.25 * mass * size.x() * size.y(), 10.0 * kRounding * mass);
}

TEST_P(ShapeFunctionals, InertiaByNodesDensityAxisAndPoint) {
  const Vec3 axis(0.5, 1.0, -0.4);
  for (const std::optional<Vec3>& point :
       {std::optional<Vec3>(), std::optional<Vec3>({0.3, -1.0, 2.0})}) {
    const auto value = [&](const TetMesh& mesh, const Vec3& along,
                           const std::optional<Vec3>& through) {
      return functionals::inertia_functional(mesh, materials_, along, through);
    };
    expect_partials(
        mesh_, derivatives::wave(mesh_, 1.0),
        [&](const TetMesh& mesh, const VectorX&) {
          return static_cast<element::Functional>(value(mesh, axis, point));
        });
    const functionals::InertiaFunctional here = value(mesh_, axis, point);
    const Vec3 turn(0.2, -0.7, 0.6);
    expect_derivative(
        {.exact = here.by_axis.dot(turn), .scale = here.value},
        [&](double t) { return value(mesh_, axis + t * turn, point).value; });
    const double density = materials_[1].density;
    expect_derivative({.exact = here.by_density[1], .scale = here.value},
                      [&](double t) {
                        materials_[1].density = density + t;
                        const double there = value(mesh_, axis, point).value;
                        materials_[1].density = density;
                        return there;
                      });
    if (point) {
      expect_derivative(
          {.exact = here.by_point.dot(turn), .scale = here.value},
          [&](double t) {
            return value(mesh_, axis, Vec3(*point + t * turn)).value;
          });
    }
  }
}

TEST_P(ShapeFunctionals, OverhangAndDraftByNodesAndDirection) {
  const Vec3 direction(0.6, 0.8, -1.1);
  // Curved faces enter the switch's ends at quadrature points one by one.
  const derivatives::Check check{.step = 1e-4, .tolerance = 1e-6};
  const FacingLimits wide{.angle = 50.0 * kDegree, .width = 20.0 * kDegree};
  const auto expect_both = [&](const auto& functional) {
    expect_partials(
        mesh_, derivatives::wave(mesh_, 1.0),
        [&](const TetMesh& mesh, const VectorX&) {
          return static_cast<element::Functional>(functional(mesh, direction));
        },
        check);
    const element::DirectedFunctional here = functional(mesh_, direction);
    EXPECT_GT(here.value, 0.0);
    const Vec3 turn(0.2, -0.7, 0.6);
    expect_derivative({.exact = here.by_direction.dot(turn),
                       .scale = here.value,
                       .step = 1e-4,
                       .tolerance = 1e-6},
                      [&](double t) {
                        return functional(mesh_, direction + t * turn).value;
                      });
  };
  expect_both([&](const TetMesh& mesh, const Vec3& along) {
    return functionals::overhang_functional(mesh, along, wide, {"z1"});
  });
  expect_both([&](const TetMesh& mesh, const Vec3& along) {
    return functionals::draft_functional(mesh, along, wide, "");
  });
  expect_both([&](const TetMesh& mesh, const Vec3& along) {
    return functionals::draft_functional(mesh, along, wide, "x1");
  });
}

TEST_P(ShapeFunctionals, FacesOfABoxCountWholeOrNot) {
  const TetMesh mesh = box({2.0, 1.0, 3.0});
  const FacingLimits limits{.angle = 45.0 * kDegree, .width = 5.0 * kDegree};
  const auto overhang = [&](const Vec3& up, std::vector<std::string> base) {
    return functionals::overhang_functional(mesh, up, limits, base).value;
  };
  EXPECT_NEAR(overhang({0.0, 0.0, 5.0}, {}), 2.0, kRounding);
  EXPECT_NEAR(overhang({0.0, 0.0, 5.0}, {"z0"}), 0.0, kRounding);
  EXPECT_NEAR(overhang({-1.0, 0.0, 0.0}, {}), 3.0, kRounding);
  // Its sides have no draft, its ends have; one end looks back.
  const FacingLimits draft{.angle = 2.0 * kDegree, .width = 1.0 * kDegree};
  const auto lacking = [&](const std::string& on) {
    return functionals::draft_functional(mesh, Vec3::UnitZ(), draft, on).value;
  };
  EXPECT_NEAR(lacking(""), 2.0 * (2.0 + 1.0) * 3.0, kRounding);
  EXPECT_NEAR(lacking("z1"), 0.0, kRounding);
  EXPECT_NEAR(lacking("z0"), 2.0, kRounding);
  EXPECT_NEAR(lacking("x0"), 3.0, kRounding);
}

TEST_P(ShapeFunctionals, RefuseNonsense) {
  const FacingLimits good{.angle = 0.5, .width = 0.1};
  EXPECT_THROW(functionals::overhang_functional(mesh_, Vec3::Zero(), good, {}),
               InvalidInput);
  EXPECT_THROW(
      functionals::overhang_functional(mesh_, Vec3::UnitX(), good, {"nowhere"}),
      InvalidInput);
  EXPECT_THROW(functionals::draft_functional(mesh_, Vec3::UnitX(),
                                             {.angle = 0.5, .width = 0.6}, ""),
               InvalidInput);
  EXPECT_THROW(functionals::inertia_functional(mesh_, materials_, Vec3::Zero(),
                                               std::nullopt),
               InvalidInput);
  materials_[0].density = 0.0;
  materials_[1].density = 0.0;
  EXPECT_THROW(functionals::inertia_functional(mesh_, materials_, Vec3::UnitX(),
                                               std::nullopt),
               InvalidInput);
}

INSTANTIATE_TEST_SUITE_P(Orders, ShapeFunctionals, testing::Values(1, 2));

/// A quarter of a tube, 1 <= r <= 2: of the whole, m (1 + 4) / 2 about its
/// axis.
TEST(Inertia, OfATubeIsTheClosedFormToTheFourthOrder) {
  const double exact = parts::steel().density * 0.25 * kPi * (4.0 - 1.0) * 0.6 *
                       0.5 * (1.0 + 4.0);
  std::vector<double> errors;
  for (const int n : {2, 4, 8}) {
    errors.push_back(std::abs(functionals::inertia_functional(
                                  parts::quarter_tube(n, 0.6), {parts::steel()},
                                  Vec3::UnitZ(), Vec3::Zero())
                                  .value -
                              exact));
  }
  EXPECT_GT(std::log2(errors[0] / errors[1]), 3.7);
  EXPECT_GT(std::log2(errors[1] / errors[2]), 3.7);
  EXPECT_LT(errors[2], 1e-5 * exact);
}

/// An eighth of a sphere of radius 2, with a hole of radius 1 that looks the
/// other way: caps and bands of spheres by Archimedes.
TEST(FacingArea, OfSpheresAreCapsAndBands) {
  const FacingLimits limits{.angle = 45.0 * kDegree, .width = 6.0 * kDegree};
  const double cap = 0.5 * kPi * 4.0 * (1.0 - std::cos(limits.angle));
  const FacingLimits steep{.angle = 30.0 * kDegree, .width = 10.0 * kDegree};
  const double band = 0.5 * kPi * (4.0 + 1.0) * std::sin(steep.angle);
  std::vector<double> of_cap;
  std::vector<double> of_band;
  for (const int n : {4, 8, 16}) {
    const TetMesh mesh = shapes::octant_shell(1.0, 2.0, n, 1);
    of_cap.push_back(std::abs(
        functionals::overhang_functional(mesh, {0.0, 0.0, -3.0}, limits, {})
            .value -
        cap));
    // Both spheres; the planes x0, y0 lie along the direction, z0 across.
    const double planes = 2.0 * 0.25 * kPi * (4.0 - 1.0);
    of_band.push_back(std::abs(
        functionals::draft_functional(mesh, Vec3::UnitZ(), steep, "").value -
        band - planes));
  }
  EXPECT_LT(of_cap[1], of_cap[0]);
  EXPECT_LT(of_cap[2], 1e-3 * cap);
  EXPECT_LT(of_cap[2], 0.25 * of_cap[0]);
  EXPECT_LT(of_band[2], 1e-3 * band);
  EXPECT_LT(of_band[2], 0.25 * of_band[0]);
}

}  // namespace
}  // namespace meniscus::shape_functionals_test
