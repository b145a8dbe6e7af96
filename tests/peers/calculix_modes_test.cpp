/// Our natural frequencies and buckling factors against CalculiX's (*FREQUENCY,
/// *BUCKLE; ARPACK over SPOOLES) on the same mesh.
#include <cmath>
#include <numbers>

#include <gtest/gtest.h>

#include "fea/modes/buckling.h"
#include "fea/modes/modes.h"
#include "pipeline/results/calculix_export.h"
#include "tests/support/calculix.h"
#include "tests/support/not_here.h"
#include "tests/support/shapes.h"

namespace meniscus::calculix_modes_test {
namespace {

// CalculiX prints seven digits.
constexpr double kFactor = 1e-5;

element::Material aluminium() {
  return {"aluminium", 71700.0, 0.33, 2.8e-9, {}};
}

element::Material laminate() {
  element::Material m{"laminate", 0.0, 0.0, 1.6e-9, {}};
  m.orthotropic = element::Orthotropic{{120000.0, 9000.0, 7000.0},
                                       {0.3, 0.25, 0.4},
                                       {4500.0, 4000.0, 3000.0},
                                       {{1.0, 0.4, 0.2}, {-0.3, 1.0, 0.5}}};
  return m;
}

/// A strut of 60 x 6 x 4, or the same bent around a quarter of a circle.
TetMesh part(int order, bool bent) {
  TetMesh mesh = shapes::brick({60.0, 6.0, 4.0}, 14, 3, 2);
  if (order == 2) {
    mesh = shapes::straight_quadratic(mesh);
  }
  if (bent) {
    const double radius = 120.0 / std::numbers::pi;
    for (Vec3& x : mesh.nodes) {
      const double angle = x.x() / radius;
      const double r = radius + x.z();
      x = Vec3(r * std::sin(angle), x.y(), r * std::cos(angle) - radius);
    }
  }
  return mesh;
}

struct Job {
  const char* name;
  int order;
  bool bent;
  bool orthotropic;
  bool pinned = false;  // pushed by a rigid pin that turns about y alone
};

class EigenvaluesInCalculix : public testing::TestWithParam<Job> {
 protected:
  void SetUp() override {
    if (!have_calculix()) {
      MENISCUS_NOT_HERE("ccx (Debian package calculix-ccx) is not installed");
    }
  }

  std::string deck() const {
    io::CalculixDeck result =
        results::calculix_deck_of({material_}, cases_, mesh_);
    result.output = io::DeckOutput::Nothing;
    return io::calculix_deck(mesh_, result);
  }

  static loads::LoadCase pushed() {
    loads::LoadCase load_case;
    load_case.name = "push";
    load_case.supports = {{"x0", true, true, true}};
    if (!GetParam().pinned) {
      load_case.forces = {{"x1", {-500.0, 30.0, 0.0}}};
      return load_case;
    }
    load_case.pins = {{.surfaces = "x1",
                       .fix_rotation = {true, false, true},
                       .point = {61.0, 2.0, 3.0}}};
    load_case.remote_loads = {{.surfaces = "x1",
                               .point = {60.0, 3.0, 2.0},
                               .force = {-500.0, 30.0, 0.0}}};
    return load_case;
  }

  TetMesh mesh_ = part(GetParam().order, GetParam().bent);
  element::Material material_ =
      GetParam().orthotropic ? laminate() : aluminium();
  std::vector<loads::LoadCase> cases_ = {pushed()};
};

TEST_P(EigenvaluesInCalculix, FrequenciesAreTheSame) {
  const auto theirs = run_calculix_eigenvalues(deck(), "*FREQUENCY\n6");
  ASSERT_EQ(theirs.size(), 6U);
  const elastic::ElasticModel model(mesh_, {material_}, cases_);
  const modes::NaturalModes ours = modes::natural_modes(
      model, mesh_, cases_, 0,
      {.count = 6, .mass = solver::MassRule::StiffnessPoints});
  ASSERT_EQ(ours.frequencies.size(), 6U);
  for (std::size_t k = 0; k < 6; ++k) {
    const double square =
        std::pow(2.0 * std::numbers::pi * ours.frequencies[k], 2);
    EXPECT_NEAR(square / theirs[k], 1.0, kFactor) << k;
  }
}

TEST_P(EigenvaluesInCalculix, BucklingFactorsAreTheSame) {
  const auto theirs =
      run_calculix_eigenvalues(deck(), "*BUCKLE\n2,1e-8,20,1000");
  ASSERT_EQ(theirs.size(), 2U);
  const elastic::ElasticModel model(mesh_, {material_}, cases_);
  const modes::BucklingModes ours = modes::buckling_modes(
      model, mesh_, cases_, 0, model.base_solution().displacements[0],
      {.count = 2});
  ASSERT_EQ(ours.factors.size(), 2U);
  for (std::size_t k = 0; k < 2; ++k) {
    EXPECT_NEAR(ours.factors[k] / theirs[k], 1.0, kFactor) << k;
  }
}

INSTANTIATE_TEST_SUITE_P(
    Parts, EigenvaluesInCalculix,
    testing::Values(Job{"StrutTet4", 1, false, false},
                    Job{"StrutTet10", 2, false, false},
                    Job{"BentTet10", 2, true, false},
                    Job{"BentTet4Orthotropic", 1, true, true},
                    Job{"StrutTet10Orthotropic", 2, false, true},
                    Job{"PinnedTet4", 1, false, true, true},
                    Job{"PinnedTet10", 2, false, false, true}),
    [](const auto& job) { return job.param.name; });

}  // namespace
}  // namespace meniscus::calculix_modes_test
