#include "pipeline/forward/element_errors.h"

#include <cmath>

#include <gtest/gtest.h>

#include "pipeline/responses/responses.h"
#include "tests/support/mapped_shapes.h"
#include "tests/support/parts.h"

namespace meniscus::element_errors_test {
namespace {

/// A plate with a hole, pulled along x and along y in two load cases; responses
/// of every kind that elements err in. Smooth: no singular edges.
struct Part {
  case_data::Case input;
  forward::EvaluationFields fields;
  std::optional<elastic::ElasticModel> model;
};

case_data::ResponseEntry response(const char* name,
                                  case_data::ResponseKind kind,
                                  const std::string& surface, int load_case) {
  return {
      .name = name, .kind = kind, .surface = surface, .load_case = load_case};
}

constexpr Eigen::Index kKnown = 11;  // responses before volume and peak

Part part(int n) {
  Part p;
  p.fields.mesh = shapes::quarter_ring(1.0, 3.0, 0.5, 2 * n, 2 * n, n);
  p.fields.inputs.materials = {parts::steel()};
  loads::LoadCase along;
  along.name = "along";
  along.supports = {{"x0", true, false, false},
                    {"y0", false, true, false},
                    {"z0", false, false, true}};
  along.forces = {{"outer", {100.0, 0.0, 0.0}}};
  loads::LoadCase across = along;
  across.name = "across";
  across.forces = {{"outer", {0.0, 50.0, 0.0}}};
  p.fields.inputs.load_cases = {along, across};
  using Kind = case_data::ResponseKind;
  p.input.responses = {response("along", Kind::MeanDisplacement, "outer", 0),
                       response("across", Kind::MeanDisplacement, "outer", 1),
                       response("hole", Kind::MeanDisplacement, "inner", 1),
                       response("energy", Kind::StrainEnergy, "", 0),
                       response("work", Kind::Compliance, "", 1),
                       response("far", Kind::DisplacementNorm, "outer", 1),
                       response("turn", Kind::Rotation, "outer", 0),
                       response("norm", Kind::VonMisesNorm, "", 0),
                       response("spread", Kind::Uniformity, "", 0),
                       response("dense", Kind::EnergyUniformity, "", 1),
                       response("sum", Kind::Expression, "", 0),
                       response("size", Kind::Volume, "", 0),
                       response("peak", Kind::MaxVonMises, "", 0),
                       response("ks", Kind::VonMisesKs, "", 1)};
  p.input.responses[13].scale = 100.0;
  p.input.responses[10].value.expression = Expression::parse(
      "norm * along + turn", case_data::response_names(p.input));
  p.fields.inputs.responses.resize(p.input.responses.size());
  p.fields.inputs.responses[0].direction = {2.0, 0.0, 0.0};
  p.fields.inputs.responses[1].direction = Vec3::UnitX();
  p.fields.inputs.responses[2].direction = Vec3::UnitY();
  p.fields.inputs.responses[5].direction = Vec3::UnitY();
  p.fields.inputs.responses[6].direction = Vec3::UnitZ();
  p.model.emplace(p.fields.mesh, p.fields.inputs.materials,
                  p.fields.inputs.load_cases);
  p.fields.solution = p.model->base_solution();
  p.fields.stresses =
      forward::part_stresses(p.fields.mesh, p.fields.inputs, p.fields.solution);
  return p;
}

VectorX values(const Part& p) {
  return responses::respond(p.input,
                            {p.fields.inputs, p.fields.mesh, p.fields.solution,
                             p.fields.exclusion.what});
}

TEST(ElementErrors, DoNotDependOnTheSizeOfTheLoad) {
  Part p = part(2);
  const forward::ElementErrors errors =
      forward::estimate_element_errors(p.input, p.fields, values(p), *p.model);
  constexpr double kLarge = 1e6;  // far from a dual's unit force
  for (loads::LoadCase& load_case : p.fields.inputs.load_cases) {
    load_case.forces.front().total *= kLarge;
  }
  p.model.emplace(p.fields.mesh, p.fields.inputs.materials,
                  p.fields.inputs.load_cases);
  p.fields.solution = p.model->base_solution();
  p.fields.stresses =
      forward::part_stresses(p.fields.mesh, p.fields.inputs, p.fields.solution);
  const forward::ElementErrors large =
      forward::estimate_element_errors(p.input, p.fields, values(p), *p.model);
  ASSERT_FALSE(large.failure);
  for (Eigen::Index r = 0; r < 3; ++r) {
    EXPECT_NEAR(large.responses[r], kLarge * errors.responses[r],
                1e-5 * std::abs(kLarge * errors.responses[r]));
  }
}

// So coarse a mesh shows recovery only a part of the error: 0.32 of it for the
// spread of energy, 0.45 for the work, half and more for the others.
constexpr double kLeastOfChange = 0.25;

TEST(ElementErrors, PredictWhatAFinerMeshGives) {
  const Part coarse = part(3);
  const Part fine = part(7);
  const auto errors = forward::estimate_element_errors(
      coarse.input, coarse.fields, values(coarse), *coarse.model);
  ASSERT_FALSE(errors.failure);
  EXPECT_GT(errors.energy, 0.001);
  EXPECT_LT(errors.energy, 0.2);
  const VectorX change = values(fine) - values(coarse);
  for (Eigen::Index r = 0; r < kKnown; ++r) {
    const double estimate = errors.responses[r];
    EXPECT_GT(estimate / change[r], kLeastOfChange)
        << coarse.input.responses[r].name;
    EXPECT_LT(estimate / change[r], 2.0) << coarse.input.responses[r].name;
  }
  EXPECT_EQ(errors.responses[kKnown], 0.0);      // volume
  EXPECT_GE(errors.responses[kKnown + 1], 0.0);  // a peak: by its readings
  EXPECT_TRUE(std::isnan(errors.responses[kKnown + 2]));
}

/// The ring on a rigid pin that is pulled in one load case, and drawn apart by
/// an enforced displacement alone in the other.
Part moved_part(int n) {
  Part p = part(n);
  std::vector<loads::LoadCase>& cases = p.fields.inputs.load_cases;
  cases[0].forces.clear();
  cases[0].pins = {{.surfaces = "inner"}};
  cases[0].supports = {{"outer", true, true, true}};
  cases[0].remote_loads = {{.surfaces = "inner",
                            .point = {0.5, 0.5, 0.2},
                            .force = {80.0, 20.0, 0}}};
  cases[1].forces.clear();
  cases[1].supports = {{"inner", true, false, false},
                       {"y0", false, true, false},
                       {"z0", false, false, true},
                       {.surface = "outer",
                        .fix_x = true,
                        .displacement = Vec3(1e-3, 0.0, 0.0)}};
  p.input.responses[6].surface = "inner";
  p.model.emplace(p.fields.mesh, p.fields.inputs.materials, cases);
  p.fields.solution = p.model->base_solution();
  p.fields.stresses =
      forward::part_stresses(p.fields.mesh, p.fields.inputs, p.fields.solution);
  return p;
}

TEST(ElementErrors, KnowRigidPinsAndEnforcedDisplacements) {
  const Part coarse = moved_part(3);
  const Part fine = moved_part(5);
  ASSERT_FALSE(coarse.fields.solution.failure);
  const auto errors = forward::estimate_element_errors(
      coarse.input, coarse.fields, values(coarse), *coarse.model);
  ASSERT_FALSE(errors.failure);
  const VectorX change = values(fine) - values(coarse);
  // A mesh that is 5/3 finer shows two thirds of the error.
  constexpr double kMostOfChange = 2.5;
  // How the hole moves where the ring is drawn apart; of the pin the strain
  // energy and the norm of stress. (Its turn is off by 0.04 %, in which parts
  // of the estimate, 0.4 %, cancel.)
  for (const Eigen::Index r : {2, 3, 7}) {
    EXPECT_GT(errors.responses[r] / change[r], kLeastOfChange)
        << coarse.input.responses[r].name;
    EXPECT_LT(errors.responses[r] / change[r], kMostOfChange)
        << coarse.input.responses[r].name;
  }
  EXPECT_LT(std::abs(errors.responses[6]), 0.01 * std::abs(values(coarse)[6]));
  // The work of no load is 0, and so is its error.
  EXPECT_EQ(values(coarse)[4], 0.0);
  EXPECT_EQ(errors.responses[4], 0.0);
}

// Of all fields that have the displacements the part's own has the least.
TEST(ElementErrors, OfTheEnergyOfEnforcedDisplacementsAreBelowZero) {
  const auto energy_of = [](int n) {
    Part p = moved_part(n);
    p.input.responses = {
        response("energy", case_data::ResponseKind::StrainEnergy, "", 1)};
    p.fields.inputs.responses.resize(1);
    return p;
  };
  const Part coarse = energy_of(3);
  const Part fine = energy_of(7);
  const auto errors = forward::estimate_element_errors(
      coarse.input, coarse.fields, values(coarse), *coarse.model);
  ASSERT_FALSE(errors.failure) << errors.failure->message;
  const double change = values(fine)[0] - values(coarse)[0];
  EXPECT_LT(change, 0.0);
  EXPECT_GT(errors.responses[0] / change, kLeastOfChange);
  EXPECT_LT(errors.responses[0] / change, 2.0);
}

}  // namespace
}  // namespace meniscus::element_errors_test
