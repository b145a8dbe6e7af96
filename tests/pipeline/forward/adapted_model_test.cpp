/// A model that was adapted when it froze is as much a pure and smooth function
/// of the design as any.
#include <gtest/gtest.h>

#include "core/geometry/mesh_checks.h"
#include "mesh_tet/tet_quality.h"
#include "pipeline/forward/adaptation.h"
#include "pipeline/forward/forward_model.h"
#include "tests/support/case_text.h"

namespace meniscus::adapted_model_test {
namespace {

case_data::Case adaptive_strut() {
  const std::string text =
      changed(strut(), "fea = 6.0\nfilm = 3.0", "fea = 12.0\nfilm = 6.0") +
      "[analysis]\nadapt = true\n";
  return *reader::read_case_text(text, "case.toml").input;
}

VectorX at(double foot) { return VectorX::Constant(1, foot); }

TEST(AdaptedModel, ErrsLessAndStartsWhereItSays) {
  const case_data::Case input = adaptive_strut();
  const forward::ForwardModel model(input);
  ASSERT_FALSE(model.failure()) << model.failure()->message;
  const forward::Adaptation& round = *model.adaptation();
  EXPECT_GT(round.after.tet.elements, round.before.tet.elements);
  EXPECT_LT(round.after.tet.elements, 8 * round.before.tet.elements);
  EXPECT_LT(round.after.errors.energy, 0.8 * round.before.errors.energy);
  EXPECT_LT(std::abs(round.after.errors.responses[0]),
            std::abs(round.before.errors.responses[0]));
  forward::EvaluationFields fields;
  const forward::Evaluation start =
      model.evaluate(case_data::initial_design(input), &fields);
  ASSERT_FALSE(start.failure);
  EXPECT_EQ(start.tet.elements, round.after.tet.elements);
  constexpr double kSolver = 1e-8;
  EXPECT_NEAR(start.responses[0], round.after.responses[0],
              kSolver * std::abs(start.responses[0]));
  EXPECT_TRUE(check_surface(fields.surface.base).empty());
}

TEST(AdaptedModel, PutsHalvedFacetsOnTheFilm) {
  const case_data::Case input = adaptive_strut();
  const forward::ForwardModel model(input);
  forward::EvaluationFields fields;
  model.evaluate(at(27.0), &fields);
  // Corners and mid-sides of the film are vertices of its finest mesh.
  int curved = 0;
  for (std::size_t e = 0; e < fields.surface.edges.size(); ++e) {
    const Vec3& m = fields.surface.mid[e];
    const Vec3 half =
        0.5 * (fields.surface.base.points[fields.surface.edges[e][0]] +
               fields.surface.base.points[fields.surface.edges[e][1]]);
    curved += m != half ? 1 : 0;
    if (m != half) {
      EXPECT_NE(
          std::find(fields.film.points.begin(), fields.film.points.end(), m),
          fields.film.points.end());
    }
  }
  EXPECT_GT(curved, 100);
  EXPECT_EQ(mesh_tet::tet_quality(fields.mesh).min_dihedral_deg > 5.0, true);
}

TEST(AdaptedModel, IsAPureAndSmoothFunctionOfTheDesign) {
  const case_data::Case input = adaptive_strut();
  const forward::ForwardModel model(input);
  const forward::ForwardModel same(input);
  const auto sway = [](const forward::ForwardModel& of, double foot) {
    return of.evaluate(at(foot)).responses[0];
  };
  const double first = sway(model, 26.0);
  const double other = sway(model, 22.0);
  EXPECT_EQ(sway(model, 26.0), first);  // whatever came between
  EXPECT_EQ(sway(same, 22.0), other);   // and whoever froze it
  // Differences at two steps tell the same slope: no noise of remeshing.
  const auto slope = [&](double step) {
    return (sway(model, 26.0 + step) - sway(model, 26.0 - step)) / (2.0 * step);
  };
  constexpr double kSmooth = 1e-3;
  EXPECT_NEAR(slope(0.01) / slope(0.1), 1.0, kSmooth);
}

}  // namespace
}  // namespace meniscus::adapted_model_test
