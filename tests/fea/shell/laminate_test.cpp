#include "fea/shell/laminate.h"

#include <cmath>
#include <numbers>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/error.h"

namespace meniscus::shell_laminate_test {
namespace {

using namespace shell;  // NOLINT: the room under test

constexpr double kRounding = 1e-13;

element::Material fiber() {
  element::Material m{"fiber", 0.0, 0.0, 1.6, {}};
  m.orthotropic = element::Orthotropic{
      {181.0, 10.3, 10.3}, {0.28, 0.28, 0.4}, {7.17, 7.17, 3.0}, {}};
  m.thermal_expansion = {1e-8, 2e-5, 2e-5};
  return m;
}

TEST(ShellLaminate, OneIsotropicPlyIsAPlate) {
  const element::Material steel{"steel", 210.0, 0.3, 1.0, {}};
  const double t = 0.7;
  const LaminateStiffness plate =
      laminate_stiffness(laminate_law({{{steel, 1.0, 0.8}}}), t);
  const double A = 210.0 * t / (1.0 - 0.09);
  EXPECT_NEAR(plate.A(0, 0), A, kRounding * A);
  EXPECT_NEAR(plate.A(0, 1), 0.3 * A, kRounding * A);
  EXPECT_NEAR(plate.A(2, 2), 0.35 * A, kRounding * A);
  EXPECT_LT(plate.B.norm(), kRounding * A * t);
  EXPECT_LT((plate.D - plate.A * t * t / 12.0).norm(), kRounding * A);
  EXPECT_NEAR(plate.S(0, 0), 5.0 / 6.0 * 0.35 * A, kRounding * A);
}

/// T300/5208, Tsai and Hahn, Introduction to composite materials, 1980: moduli
/// of a ply at 0 and 45 degrees [GPa].
TEST(ShellLaminate, PliesTurn) {
  const PlyLaw along = laminate_law({{{fiber()}}}).plies[0];
  EXPECT_NEAR(along.plane(0, 0), 181.8, 0.05);
  EXPECT_NEAR(along.plane(1, 1), 10.34, 0.01);
  EXPECT_NEAR(along.plane(0, 1), 2.897, 0.0005);
  const double quarter = std::numbers::pi / 4.0;
  const PlyLaw turned = laminate_law({{{fiber(), 1.0, quarter}}}).plies[0];
  EXPECT_NEAR(turned.plane(0, 0), 56.66, 0.01);
  EXPECT_NEAR(turned.plane(0, 1), 42.32, 0.01);
  EXPECT_NEAR(turned.plane(2, 2), 46.59, 0.01);
  EXPECT_NEAR(turned.plane(0, 2), 42.87, 0.01);
  EXPECT_NEAR(turned.expansion[0], 0.5 * (1e-8 + 2e-5), 1e-12);
  EXPECT_NEAR(turned.expansion[2], 1e-8 - 2e-5, 1e-12);
}

TEST(ShellLaminate, StacksBalance) {
  const double angle = 0.6;
  const auto stiffness = [&](const std::vector<double>& angles) {
    Laminate stack;
    for (const double a : angles) {
      stack.plies.push_back({fiber(), 1.0, a});
    }
    return laminate_stiffness(laminate_law(stack), 2.0);
  };
  const LaminateStiffness symmetric = stiffness({angle, -angle, -angle, angle});
  EXPECT_LT(symmetric.B.norm(), kRounding * symmetric.A.norm());
  EXPECT_LT(std::abs(symmetric.A(0, 2)), kRounding * symmetric.A.norm());
  EXPECT_GT(std::abs(symmetric.D(0, 2)), 1e-2 * symmetric.D.norm());
  const LaminateStiffness turned = stiffness({angle, -angle});
  EXPECT_GT(std::abs(turned.B(0, 2)), 1e-2 * turned.A.norm());
  EXPECT_LT(std::abs(turned.B(0, 0)), kRounding * turned.A.norm());
}

TEST(ShellLaminate, RefusesWhatIsNone) {
  EXPECT_THROW(laminate_law({}), InvalidInput);
  EXPECT_THROW(laminate_law({{{fiber(), 0.0, 0.0}}}), InvalidInput);
  EXPECT_THROW(laminate_law({{{fiber()}}, 0.0}), InvalidInput);
}

}  // namespace
}  // namespace meniscus::shell_laminate_test
