#include "fea/shell/laminate.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <random>

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

/// Rates of a ply's law meet central differences.
TEST(ShellLaminate, RatesMeetDifferences) {
  const auto expect_rate = [](const PlyLaw& rate, const PlyLaw& more,
                              const PlyLaw& less, double step) {
    const double tolerance = 1e-8;
    const auto near = [&](const auto& exact, const auto& a, const auto& b) {
      const double size = std::max(a.norm(), exact.norm());
      EXPECT_LE(((a - b) / (2.0 * step) - exact).norm(), tolerance * size);
    };
    near(rate.plane, more.plane, less.plane);
    near(rate.across, more.across, less.across);
    near(rate.expansion, more.expansion, less.expansion);
    near(rate.squeeze, more.squeeze, less.squeeze);
  };
  const auto law_of = [](const element::Material& m, double angle) {
    return laminate_law({{{m, 1.0, angle}}});
  };
  const double h = 1e-5;
  const element::Material steel{"steel", 2.1, 0.3, 1.0, {}};
  for (const double angle : {0.0, 0.4, -1.3, 2.0}) {
    expect_rate(law_of(fiber(), angle).rates[0].by_angle.ply,
                law_of(fiber(), angle + h).plies[0],
                law_of(fiber(), angle - h).plies[0], h);
    const auto scaled = [&](double factor) {
      element::Material m = fiber();
      m.orthotropic->youngs_moduli *= factor;
      m.orthotropic->shear_moduli *= factor;
      return law_of(m, angle).plies[0];
    };
    expect_rate(law_of(fiber(), angle).rates[0].by_modulus.ply, scaled(1.0 + h),
                scaled(1.0 - h), h);
    const auto stiffer = [&](double by) {
      element::Material m = steel;
      m.youngs_modulus += by;
      return law_of(m, angle).plies[0];
    };
    expect_rate(law_of(steel, angle).rates[0].by_modulus.ply, stiffer(h),
                stiffer(-h), h);
  }
}

/// Transverse shear of any laminate by each ply's modulus and angle.
TEST(ShellLaminate, ShearRatesMeetDifferences) {
  const double h = 1e-5;
  const element::Material foam{"foam", 0.07, 0.3, 0.1, {}};
  const auto law_of = [&](int changed, double factor, double turn) {
    Laminate stack{
        {{fiber(), 1.0, 0.3}, {foam, 4.0, 0.0}, {fiber(), 2.0, 1.2}}};
    Ply& ply = stack.plies[changed];
    ply.angle += turn;
    if (ply.material.orthotropic) {
      ply.material.orthotropic->youngs_moduli *= factor;
      ply.material.orthotropic->shear_moduli *= factor;
    } else {
      ply.material.youngs_modulus *= factor;
    }
    return laminate_law(stack);
  };
  const LaminateLaw here = law_of(0, 1.0, 0.0);
  for (int p = 0; p < 3; ++p) {
    const double unit = p == 1 ? foam.youngs_modulus : 1.0;
    const Eigen::Matrix2d by_modulus =
        (law_of(p, 1.0 + h, 0.0).across - law_of(p, 1.0 - h, 0.0).across) /
        (2.0 * h);
    const Eigen::Matrix2d by_angle =
        (law_of(p, 1.0, h).across - law_of(p, 1.0, -h).across) / (2.0 * h);
    EXPECT_LT((by_modulus - unit * here.rates[p].by_modulus.across).norm(),
              1e-8 * here.across.norm());
    EXPECT_LT((by_angle - here.rates[p].by_angle.across).norm(),
              1e-8 * here.across.norm());
  }
}

/// Thin stiff faces on a soft core: the core alone shears, over the distance
/// of the faces' middles squared by its thickness (Allen, Analysis and design
/// of structural sandwich panels, 1969).
TEST(ShellLaminate, ASandwichShearsByItsCore) {
  const element::Material face{"face", 70e3, 0.3, 1.0, {}};
  const element::Material core{"core", 1e-3, 0.3, 1.0, {}};
  const double share = 1e-3;
  const LaminateLaw law =
      laminate_law({{{face, share}, {core, 1.0 - 2.0 * share}, {face, share}}});
  const double apart = 1.0 - share;
  const double G = 0.5 * 1e-3 / 1.3;
  EXPECT_NEAR(law.across(0, 0) / (G * apart * apart / (1.0 - 2.0 * share)), 1.0,
              1e-5);
}

/// Turning all plies turns A, B, D: N = A e in axes that turn with them.
TEST(ShellLaminate, TurnsAsOneAtRandom) {
  std::mt19937 random(7);
  std::uniform_real_distribution<double> draw(-1.5, 1.5);
  for (int k = 0; k < 20; ++k) {
    Laminate stack;
    Laminate turned;
    const double turn = draw(random);
    for (int p = 0; p < 1 + k % 5; ++p) {
      const double angle = draw(random);
      const double share = 0.2 + std::abs(draw(random));
      stack.plies.push_back({fiber(), share, angle});
      turned.plies.push_back({fiber(), share, angle + turn});
    }
    const double c = std::cos(turn);
    const double s = std::sin(turn);
    Mat3 T;  // strains in the turned axes from those in the first
    T << c * c, s * s, c * s, s * s, c * c, -c * s, -2.0 * c * s, 2.0 * c * s,
        c * c - s * s;
    const LaminateStiffness a = laminate_stiffness(laminate_law(stack), 0.3);
    const LaminateStiffness b = laminate_stiffness(laminate_law(turned), 0.3);
    EXPECT_LT((T.transpose() * a.A * T - b.A).norm(), 1e-12 * a.A.norm());
    EXPECT_LT((T.transpose() * a.B * T - b.B).norm(), 1e-12 * a.A.norm());
    EXPECT_LT((T.transpose() * a.D * T - b.D).norm(), 1e-12 * a.D.norm());
    Eigen::Matrix2d R;
    R << c, s, -s, c;
    EXPECT_LT((R.transpose() * a.S * R - b.S).norm(), 1e-12 * a.S.norm());
  }
}

TEST(ShellLaminate, RefusesWhatIsNone) {
  EXPECT_THROW(laminate_law({}), InvalidInput);
  EXPECT_THROW(laminate_law({{{fiber(), 0.0, 0.0}}}), InvalidInput);
}

}  // namespace
}  // namespace meniscus::shell_laminate_test
