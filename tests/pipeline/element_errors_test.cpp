#include "pipeline/element_errors.h"

#include <cmath>

#include <gtest/gtest.h>

#include "tests/fea/parts.h"
#include "tests/support/mapped_shapes.h"

namespace meniscus {
namespace {

/// A plate with a hole, pulled along x and along y in two load cases; responses
/// of every kind that elements err in. Smooth: no singular edges.
struct Part {
  Case input;
  EvaluationFields fields;
  std::optional<ElasticModel> model;
};

ResponseEntry response(ResponseKind kind, const std::string& surface,
                       int load_case) {
  return {
      .name = "r", .kind = kind, .surface = surface, .load_case = load_case};
}

Part part(int n) {
  Part p;
  p.fields.mesh = shapes::quarter_ring(1.0, 3.0, 0.5, 2 * n, 2 * n, n);
  p.fields.inputs.materials = {parts::steel()};
  LoadCase along;
  along.name = "along";
  along.supports = {{"x0", true, false, false},
                    {"y0", false, true, false},
                    {"z0", false, false, true}};
  along.forces = {{"outer", {100.0, 0.0, 0.0}}};
  LoadCase across = along;
  across.name = "across";
  across.forces = {{"outer", {0.0, 50.0, 0.0}}};
  p.fields.inputs.load_cases = {along, across};
  p.input.responses = {response(ResponseKind::MeanDisplacement, "outer", 0),
                       response(ResponseKind::MeanDisplacement, "outer", 1),
                       response(ResponseKind::MeanDisplacement, "inner", 1),
                       response(ResponseKind::StrainEnergy, "", 0),
                       response(ResponseKind::MaxVonMises, "", 0),
                       response(ResponseKind::Volume, "", 0)};
  p.fields.inputs.responses.resize(6);
  p.fields.inputs.responses[0].direction = {2.0, 0.0, 0.0};
  p.fields.inputs.responses[1].direction = Vec3::UnitX();
  p.fields.inputs.responses[2].direction = Vec3::UnitY();
  p.model.emplace(p.fields.mesh, p.fields.inputs.materials,
                  p.fields.inputs.load_cases);
  p.fields.solution = p.model->base_solution();
  p.fields.stresses =
      part_stresses(p.fields.mesh, p.fields.inputs, p.fields.solution);
  return p;
}

double value(const Part& p, std::size_t r) {
  const ResponseEntry& entry = p.input.responses[r];
  const auto k = static_cast<std::size_t>(entry.load_case);
  const VectorX& u = p.fields.solution.displacements[k];
  return entry.kind == ResponseKind::StrainEnergy
             ? 0.5 * nodal_forces(p.fields.mesh, p.fields.inputs.load_cases[k])
                         .dot(u)
             : mean_displacement(p.fields.mesh, entry.surface,
                                 p.fields.inputs.responses[r].direction, u);
}

TEST(ElementErrors, DoNotDependOnTheSizeOfTheLoad) {
  Part p = part(2);
  const ElementErrors errors =
      estimate_element_errors(p.input, p.fields, *p.model);
  constexpr double kLarge = 1e6;  // far from a dual's unit force
  for (LoadCase& load_case : p.fields.inputs.load_cases) {
    load_case.forces.front().total *= kLarge;
  }
  p.model.emplace(p.fields.mesh, p.fields.inputs.materials,
                  p.fields.inputs.load_cases);
  p.fields.solution = p.model->base_solution();
  p.fields.stresses =
      part_stresses(p.fields.mesh, p.fields.inputs, p.fields.solution);
  const ElementErrors large =
      estimate_element_errors(p.input, p.fields, *p.model);
  ASSERT_FALSE(large.failure);
  for (Eigen::Index r = 0; r < 3; ++r) {
    EXPECT_NEAR(large.responses[r], kLarge * errors.responses[r],
                1e-5 * std::abs(kLarge * errors.responses[r]));
  }
}

TEST(ElementErrors, PredictWhatAFinerMeshGives) {
  const Part coarse = part(3);
  const Part fine = part(7);
  const auto errors =
      estimate_element_errors(coarse.input, coarse.fields, *coarse.model);
  ASSERT_FALSE(errors.failure);
  EXPECT_GT(errors.energy, 0.001);
  EXPECT_LT(errors.energy, 0.2);
  for (std::size_t r = 0; r < 4; ++r) {
    const double change = value(fine, r) - value(coarse, r);
    const double estimate = errors.responses[static_cast<Eigen::Index>(r)];
    EXPECT_GT(estimate / change, 0.5) << r;
    EXPECT_LT(estimate / change, 2.0) << r;
  }
  EXPECT_TRUE(std::isnan(errors.responses[4]));
  EXPECT_EQ(errors.responses[5], 0.0);
}

}  // namespace
}  // namespace meniscus
