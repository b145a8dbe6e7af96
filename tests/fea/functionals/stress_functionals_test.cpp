#include "fea/functionals/stress_functionals.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/error.h"
#include "fea/element/point_stress.h"
#include "fea/loads/body_loads.h"
#include "fea/stress/stress_uniformity.h"
#include "tests/support/derivatives.h"
#include "tests/support/gradient_parts.h"

namespace meniscus::stress_functionals_test {
namespace {

using derivatives::expect_partials;

constexpr double kFunctionalRounding = 1e-12;
/// Von Mises stresses have kinks where they are 0: near them the differences'
/// higher terms are large, and the extrapolation stops short.
constexpr double kKinks = 1e-7;

class StressFunctionals : public testing::TestWithParam<int> {
 protected:
  /// Some elements out, the load case warm.
  StressFunctionals() : excluded_(mesh_.element_count(), 0) {
    for (std::size_t e = 0; e < excluded_.size(); e += 7) {
      excluded_[e] = 1;
    }
  }

  functionals::StressFunctionalInput input() const {
    return {mesh_, materials_, load_case_, u_, excluded_};
  }

  template <class OfInput>
  void expect_derivatives(const OfInput& functional) const {
    expect_partials(mesh_, u_,
                    [&](const TetMesh& mesh, const VectorX& u) {
                      return functional(functionals::StressFunctionalInput{
                          mesh, materials_, load_case_, u, excluded_});
                    },
                    {.step = 2e-4, .tolerance = kKinks});
    const functionals::StressFunctionalInput value{
        mesh_, materials_, load_case_,
        u_,    excluded_,  element::Derivatives::None};
    EXPECT_EQ(functional(value).value, functional(input()).value);
    EXPECT_TRUE(functional(value).by_nodes.empty());
  }

  double peak() const {
    const element::PointStress points = element::point_stress(
        mesh_, materials_, u_, loads::temperature_change(mesh_, load_case_));
    double largest = 0.0;
    for (int e = 0; e < mesh_.element_count(); ++e) {
      for (int q = 0; excluded_[e] == 0 && q < points.points_per_element; ++q) {
        largest = std::max(
            largest, element::von_mises(points.stress[points.index(e, q)]));
      }
    }
    return largest;
  }

  TetMesh mesh_ = gradient_parts::block(GetParam());
  VectorX u_ = 0.1 * derivatives::wave(mesh_, 1.0);
  std::vector<element::Material> materials_ = gradient_parts::materials();
  loads::LoadCase load_case_ = gradient_parts::warm();
  std::vector<char> excluded_;
};

TEST_P(StressFunctionals, NormOfVonMises) {
  for (const double power : {1.0, 2.0, 12.0}) {
    SCOPED_TRACE(power);
    expect_derivatives([power](const functionals::StressFunctionalInput& in) {
      return functionals::von_mises_norm_functional(in, power);
    });
  }
}

TEST_P(StressFunctionals, NormAndSmoothMaximumRiseToThePeak) {
  const double top = peak();
  double norm = 0.0;
  double smooth = 0.0;
  for (const double sharpness : {1.0, 10.0, 100.0, 1000.0}) {
    const double next =
        functionals::von_mises_norm_functional(input(), sharpness).value;
    const double ks = functionals::von_mises_ks_functional(
                          input(), {.sharpness = sharpness, .scale = top})
                          .value;
    EXPECT_GT(next, norm);
    EXPECT_GT(ks, smooth);
    norm = next;
    smooth = ks;
  }
  EXPECT_LE(norm, top);
  EXPECT_GE(norm, 0.98 * top);
  EXPECT_LE(smooth, top);
  EXPECT_GE(smooth, 0.98 * top);
}

TEST_P(StressFunctionals, SmoothMaximum) {
  const double scale = peak();
  expect_derivatives([scale](const functionals::StressFunctionalInput& in) {
    return functionals::von_mises_ks_functional(
        in, {.sharpness = 20.0, .scale = scale});
  });
}

TEST_P(StressFunctionals, VariationIsThatOfUniformity) {
  const stress::StressUniformity uniformity = stress::stress_uniformity(
      mesh_, materials_,
      element::point_stress(mesh_, materials_, u_,
                            loads::temperature_change(mesh_, load_case_)),
      excluded_);
  EXPECT_NEAR(functionals::von_mises_variation_functional(input()).value,
              uniformity.von_mises.coefficient_of_variation,
              kFunctionalRounding);
  EXPECT_NEAR(functionals::energy_density_variation_functional(input()).value,
              uniformity.energy_density.coefficient_of_variation,
              kFunctionalRounding);
  expect_derivatives(functionals::von_mises_variation_functional);
  expect_derivatives(functionals::energy_density_variation_functional);
}

TEST_P(StressFunctionals, NothingStressedHasNoDerivative) {
  u_.setZero();
  load_case_ = gradient_parts::held("cold");
  for (const element::Functional& f :
       {functionals::von_mises_norm_functional(input(), 8.0),
        functionals::von_mises_ks_functional(input(),
                                             {.sharpness = 5.0, .scale = 1.0}),
        functionals::von_mises_variation_functional(input()),
        functionals::energy_density_variation_functional(input())}) {
    EXPECT_NEAR(f.value, 0.0, kFunctionalRounding);
    EXPECT_TRUE(flat(f.by_nodes).allFinite());
    EXPECT_TRUE(f.by_displacement.allFinite());
  }
}

TEST_P(StressFunctionals, RefusesNonsense) {
  EXPECT_THROW(functionals::von_mises_norm_functional(input(), 0.5),
               InvalidInput);
  EXPECT_THROW(
      functionals::von_mises_ks_functional(input(), {.sharpness = 0.0}),
      InvalidInput);
  std::fill(excluded_.begin(), excluded_.end(), 1);
  EXPECT_THROW(functionals::von_mises_norm_functional(input(), 8.0),
               InvalidInput);
  excluded_.pop_back();
  EXPECT_THROW(functionals::von_mises_variation_functional(input()),
               InvalidInput);
}

INSTANTIATE_TEST_SUITE_P(Orders, StressFunctionals, testing::Values(1, 2));

}  // namespace
}  // namespace meniscus::stress_functionals_test
