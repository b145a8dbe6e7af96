#include "fea/functionals/nodal_peak.h"

#include <cmath>
#include <omp.h>
#include <random>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/error.h"
#include "fea/functionals/stress_criteria.h"
#include "fea/loads/body_loads.h"
#include "fea/stress/averaged_stress.h"
#include "fea/stress/peak_stress.h"
#include "tests/support/derivatives.h"
#include "tests/support/gradient_parts.h"

namespace meniscus::nodal_peak_test {
namespace {

using derivatives::expect_derivative;
using derivatives::expect_partials;
using derivatives::wave;
using functionals::Endurance;
using functionals::NodalPeak;
using functionals::NodeCriterion;

/// A sharp bound's higher derivatives are large: differences over small steps
/// stop a little short.
constexpr double kSharp = 1e-6;
constexpr double kStep = 1e-4;
constexpr double kRounding = 1e-12;

const std::vector<double> kAllowable = {40.0, 25.0};
const std::vector<Endurance> kEndurance = {
    {.limit = 30.0, .tensile = 70.0, .torsion = 20.0},
    {.limit = 20.0, .tensile = 50.0, .torsion = 14.0}};

class NodalPeaks : public testing::TestWithParam<int> {
 protected:
  NodalPeaks()
      : excluded_(stress::excluded_by(
            mesh_, {stress::ExclusionZone{.surface = "x0",
                                          .distance = 0.2,
                                          .box = std::nullopt,
                                          .ball = std::nullopt}})) {}

  functionals::NodalPeakInput input(
      std::vector<functionals::StressState> states,
      double excess = 0.02) const {
    return {mesh_, materials_, std::move(states), excluded_, excess};
  }
  functionals::NodalPeakInput one(double excess = 0.02) const {
    return input({{load_case_, u_}}, excess);
  }

  /// Of state `which` alone, the others held.
  element::Functional functional(const TetMesh& mesh, const VectorX& u,
                                 const NodeCriterion& criterion,
                                 std::size_t states, std::size_t which,
                                 double excess) const {
    std::vector<functionals::StressState> all;
    for (std::size_t s = 0; s < states; ++s) {
      all.push_back(
          {s == 0 ? load_case_ : other_, s == which ? u : (s == 0 ? u_ : v_)});
    }
    NodalPeak peak = functionals::nodal_peak(
        {mesh, materials_, std::move(all), excluded_, excess}, criterion);
    return {.value = peak.value,
            .by_nodes = std::move(peak.by_nodes),
            .by_displacement = std::move(peak.states[which].by_displacement),
            .by_temperature = std::move(peak.states[which].by_temperature),
            .by_modulus = std::move(peak.by_modulus)};
  }

  void expect_derivatives(const NodeCriterion& criterion, std::size_t states,
                          double excess) const {
    for (std::size_t which = 0; which < states; ++which) {
      SCOPED_TRACE(which);
      expect_partials(mesh_, which == 0 ? u_ : v_,
                      [&](const TetMesh& mesh, const VectorX& u) {
                        return functional(mesh, u, criterion, states, which,
                                          excess);
                      },
                      {.step = excess * kStep, .tolerance = kSharp});
    }
  }

  TetMesh mesh_ = gradient_parts::block(GetParam());
  VectorX u_ = 0.1 * wave(mesh_, 1.0);
  VectorX v_ = 0.1 * wave(mesh_, 2.5);
  std::vector<element::Material> materials_ = gradient_parts::materials();
  loads::LoadCase load_case_ = gradient_parts::warm();
  loads::LoadCase other_ = gradient_parts::held("cold");
  stress::Excluded excluded_;
};

TEST_P(NodalPeaks, BoundLiesAboveBothReadingsByLittle) {
  const element::PointStress points = element::point_stress(
      mesh_, materials_, u_, loads::temperature_change(mesh_, load_case_));
  const std::vector<double> same = {3.0, 3.0};
  for (const stress::Excluded& excluded : {excluded_, stress::Excluded{}}) {
    const double recovered =
        stress::peak_of(mesh_, stress::recover_by_patches(mesh_, points),
                        excluded)
            .von_mises;
    const double averaged =
        stress::peak_of(mesh_, stress::average_extrapolations(mesh_, points),
                        excluded)
            .von_mises;
    const double peak = std::max(recovered, averaged) / 3.0;
    for (const double excess : {0.1, 0.02, 0.001}) {
      const double bound =
          functionals::nodal_peak(
              {mesh_, materials_, {{load_case_, u_}}, excluded, excess},
              functionals::von_mises_ratio(same))
              .value;
      EXPECT_GE(bound, peak);
      EXPECT_LE(bound, (1.0 + excess) * peak);
    }
  }
}

TEST_P(NodalPeaks, VonMisesByDisplacementAndNodes) {
  for (const double excess : {0.3, 0.02}) {
    SCOPED_TRACE(excess);
    expect_derivatives(functionals::von_mises_ratio(kAllowable), 1, excess);
  }
}

TEST_P(NodalPeaks, TensionByDisplacementAndNodes) {
  for (const double excess : {0.3, 0.02}) {
    SCOPED_TRACE(excess);
    expect_derivatives(functionals::tension_ratio(kAllowable), 1, excess);
  }
}

TEST_P(NodalPeaks, FatigueByBothStatesAndNodes) {
  for (const double excess : {0.3, 0.02}) {
    SCOPED_TRACE(excess);
    expect_derivatives(functionals::goodman_ratio(kEndurance), 2, excess);
    expect_derivatives(functionals::crossland_ratio(kEndurance), 2, excess);
  }
}

TEST_P(NodalPeaks, WorstDirectionByAllStatesAndNodes) {
  for (const double half_angle : {0.0, 0.4, 3.141592653589793}) {
    SCOPED_TRACE(half_angle);
    expect_derivatives(functionals::worst_von_mises_ratio(
                           kAllowable, {Vec3(0.6, 0.0, 0.8), half_angle}),
                       3, 0.3);
  }
}

/// Of random stresses no direction is worse than the one told.
TEST(WorstStress, NoSampleOfTheConeIsWorse) {
  constexpr double kAlike = 1e-12;
  std::mt19937 random(9);
  std::normal_distribution<double> normal;
  const NodeCriterion plain = functionals::von_mises_ratio({2.0});
  for (const double half_angle : {0.3, 1.0, 3.141592653589793}) {
    const Cone cone{Vec3(0.48, -0.64, 0.6), half_angle};
    std::vector<element::Stress> states(3);
    for (element::Stress& stress : states) {
      for (double& s : stress) {
        s = normal(random);
      }
    }
    const auto at = [&](const Vec3& d) {
      element::Stress sum{};
      for (int k = 0; k < 3; ++k) {
        for (int c = 0; c < 6; ++c) {
          sum[c] += d[k] * states[k][c];
        }
      }
      return plain.value(0, 0.0, {&sum, 1}, {});
    };
    const double worst = functionals::worst_von_mises_ratio({2.0}, cone)
                             .value(0, 0.0, states, {});
    EXPECT_NEAR(at(functionals::worst_stress_direction(states, cone)), worst,
                kAlike * worst);
    for (int s = 0; s < 10000; ++s) {
      const Vec3 d =
          Vec3(normal(random), normal(random), normal(random)).normalized();
      if (d.dot(cone.axis) >= std::cos(half_angle)) {
        EXPECT_LE(at(d), worst * (1.0 + kAlike));
      }
    }
  }
}

TEST_P(NodalPeaks, ByTemperatureAndModulus) {
  const NodeCriterion criterion = functionals::von_mises_ratio(kAllowable);
  const NodalPeak here = functionals::nodal_peak(one(), criterion);
  // A rise by t (1 + x) everywhere.
  double exact = 0.0;
  double scale = 0.0;
  for (std::size_t i = 0; i < mesh_.nodes.size(); ++i) {
    const double part =
        here.states[0].by_temperature[static_cast<Eigen::Index>(i)] *
        (1.0 + mesh_.nodes[i].x());
    exact += part;
    scale += std::abs(part);
  }
  const auto field = load_case_.temperature->field;
  expect_derivative({.exact = exact, .scale = scale, .tolerance = kSharp},
                    [&](double t) {
                      load_case_.temperature->field = [&](const Vec3& x) {
                        return field(x) + t * (1.0 + x.x());
                      };
                      return functionals::nodal_peak(one(), criterion).value;
                    });
  load_case_.temperature->field = field;
  const double modulus = materials_[0].youngs_modulus;
  expect_derivative({.exact = here.by_modulus[0],
                     .scale = std::abs(here.value / modulus),
                     .step = 1e-3 * modulus,
                     .tolerance = kSharp},
                    [&](double t) {
                      materials_[0].youngs_modulus = modulus + t;
                      return functionals::nodal_peak(one(), criterion).value;
                    });
  EXPECT_EQ(here.by_modulus[1], 0.0);  // orthotropic
}

TEST_P(NodalPeaks, TheSameBitsOnTwoThreads) {
  std::vector<Points> gradients;
  for (const int threads : {1, 2}) {
    omp_set_num_threads(threads);
    gradients.push_back(
        functionals::nodal_peak(one(), functionals::von_mises_ratio(kAllowable))
            .by_nodes);
  }
  omp_set_num_threads(omp_get_num_procs());
  EXPECT_EQ(gradients[0], gradients[1]);
}

TEST_P(NodalPeaks, NothingStressedIsZeroWithoutDerivative) {
  u_.setZero();
  for (const NodeCriterion& criterion :
       {functionals::von_mises_ratio(kAllowable),
        functionals::tension_ratio(kAllowable)}) {
    const NodalPeak peak =
        functionals::nodal_peak(input({{other_, u_}}), criterion);
    EXPECT_EQ(peak.value, 0.0);
    EXPECT_TRUE(flat(peak.by_nodes).isZero(0.0));
    EXPECT_TRUE(peak.states[0].by_displacement.isZero(0.0));
  }
}

TEST_P(NodalPeaks, RefusesNonsense) {
  const NodeCriterion criterion = functionals::von_mises_ratio(kAllowable);
  EXPECT_THROW(functionals::nodal_peak(one(0.0), criterion), InvalidInput);
  EXPECT_THROW(functionals::nodal_peak(one(1.0), criterion), InvalidInput);
  std::fill(excluded_.element.begin(), excluded_.element.end(), 1);
  EXPECT_THROW(functionals::nodal_peak(one(), criterion), InvalidInput);
  EXPECT_THROW(functionals::von_mises_ratio({40.0, 0.0}), InvalidInput);
  EXPECT_THROW(functionals::crossland_ratio(
                   {{.limit = 30.0, .tensile = 0.0, .torsion = 17.0}}),
               InvalidInput);
}

INSTANTIATE_TEST_SUITE_P(Orders, NodalPeaks, testing::Values(1, 2));

/// Homogeneous stress in one isotropic block: every node has the same value,
/// which the bound exceeds by all of its excess.
class Homogeneous : public testing::Test {
 protected:
  Homogeneous() {
    std::fill(mesh_.element_region.begin(), mesh_.element_region.end(), 0);
  }

  /// u = strain x of the stress.
  VectorX under(const element::Stress& stress) const {
    const element::Strain e =
        element::strain_of(stress, element::lame(materials_[0]));
    Mat3 strain;
    strain << e[0], e[3], e[5], e[3], e[1], e[4], e[5], e[4], e[2];
    VectorX u(static_cast<Eigen::Index>(3 * mesh_.nodes.size()));
    for (std::size_t i = 0; i < mesh_.nodes.size(); ++i) {
      u.segment<3>(static_cast<Eigen::Index>(3 * i)) = strain * mesh_.nodes[i];
    }
    return u;
  }

  double ratio(const NodeCriterion& criterion, const element::Stress& a,
               const element::Stress& b) const {
    const VectorX ua = under(a);
    const VectorX ub = under(b);
    return functionals::nodal_peak({mesh_,
                                    materials_,
                                    {{load_case_, ua}, {load_case_, ub}},
                                    excluded_,
                                    kExcess,
                                    element::Derivatives::None},
                                   criterion)
               .value /
           (1.0 + kExcess);
  }

  static constexpr double kExcess = 1e-3;
  static constexpr double kHomogeneous = 1e-9;
  TetMesh mesh_ = gradient_parts::block(2);
  std::vector<element::Material> materials_ = {gradient_parts::materials()[0]};
  loads::LoadCase load_case_ = gradient_parts::held("cold");
  stress::Excluded excluded_;
};

element::Stress pull(double stress) {
  return {0.0, stress, 0.0, 0.0, 0.0, 0.0};
}
element::Stress shear(double stress) {
  return {0.0, 0.0, 0.0, 0.0, stress, 0.0};
}

TEST_F(Homogeneous, GoodmanOfABarByHand) {
  const NodeCriterion goodman = functionals::goodman_ratio(
      {{.limit = 200.0, .tensile = 500.0, .torsion = 0.0}});
  const double round = functionals::kGoodmanRound;
  // From 150 to 50: amplitude 50, mean 100: 50 / 200 + 100 / 500.
  EXPECT_NEAR(ratio(goodman, pull(150.0), pull(50.0)), 0.45, 0.01 * round);
  // Between 0 and 250: 125 / 200 + 125 / 500.
  EXPECT_NEAR(ratio(goodman, pull(0.0), pull(250.0)), 0.875, 0.01 * round);
  // Reversed, and reversed torsion: no mean, where the maximum is round.
  EXPECT_NEAR(ratio(goodman, pull(-100.0), pull(100.0)), 0.5 + round,
              kHomogeneous);
  EXPECT_NEAR(ratio(goodman, shear(-60.0), shear(60.0)),
              std::sqrt(3.0) * 60.0 / 200.0 + round, kHomogeneous);
  // A mean in compression helps nothing.
  EXPECT_NEAR(ratio(goodman, pull(-250.0), pull(-150.0)), 0.25, 0.01 * round);
  // The order of the two does not count.
  EXPECT_NEAR(ratio(goodman, pull(10.0), pull(90.0)),
              ratio(goodman, pull(90.0), pull(10.0)), kHomogeneous);
}

TEST_F(Homogeneous, CrosslandOfTensionAndTorsionByHand) {
  const double limit = 200.0;
  const double torsion = 130.0;
  const NodeCriterion crossland = functionals::crossland_ratio(
      {{.limit = limit, .tensile = 0.0, .torsion = torsion}});
  const double round = functionals::kCrosslandRound;
  EXPECT_NEAR(ratio(crossland, shear(-torsion), shear(torsion)), 1.0 + round,
              kHomogeneous);
  EXPECT_NEAR(ratio(crossland, pull(-limit), pull(limit)), 1.0, 0.1 * round);
  // Between 0 and 160: sqrt(J2) = 80 / sqrt(3), largest hydrostatic 160 / 3.
  const double alpha = 3.0 * torsion / limit - std::sqrt(3.0);
  EXPECT_NEAR(ratio(crossland, pull(0.0), pull(160.0)),
              (80.0 / std::sqrt(3.0) + alpha * 160.0 / 3.0) / torsion,
              0.1 * round);
}

/// Two equal principal stresses: the largest has a kink there, its bound none.
TEST_F(Homogeneous, TensionIsSmoothWherePrincipalStressesAreEqual) {
  const NodeCriterion tension = functionals::tension_ratio({100.0});
  const VectorX even = under({30.0, 30.0, -10.0, 0.0, 0.0, 0.0});
  const VectorX turn = under({20.0, -10.0, 0.0, 15.0, 0.0, 5.0});
  const auto value = [&](double t) {
    const VectorX u = even + t * turn;
    return functionals::nodal_peak(
        {mesh_, materials_, {{load_case_, u}}, excluded_, 0.3}, tension);
  };
  const NodalPeak here = value(0.0);
  EXPECT_NEAR(here.value, 0.3, 0.3 * 0.3);
  EXPECT_GE(here.value, 0.3);
  expect_derivative({.exact = here.states[0].by_displacement.dot(turn),
                     .scale = here.value,
                     .tolerance = kSharp},
                    [&](double t) { return value(t).value; });
}

TEST_F(Homogeneous, PressureAloneIsNoTension) {
  EXPECT_EQ(ratio(functionals::tension_ratio({100.0}),
                  {-5.0, -7.0, -9.0, 0.0, 0.0, 0.0}, pull(0.0)),
            0.0);
}

}  // namespace
}  // namespace meniscus::nodal_peak_test
