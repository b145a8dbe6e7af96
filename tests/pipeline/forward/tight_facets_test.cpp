/// Facets that span much of the film's curvature are halved at the freeze.
#include <algorithm>

#include <gtest/gtest.h>

#include "core/geometry/mesh_checks.h"
#include "pipeline/forward/forward_model.h"
#include "tests/support/case_text.h"

namespace meniscus::tight_facets_test {
namespace {

/// The strut as a fat drop between small pads, by edges twice as long as its
/// rims' radii.
case_data::Case fat_drop(const std::string& more = "") {
  std::string text =
      changed(strut(), "fea = 6.0\nfilm = 3.0", "fea = 22.0\nfilm = 11.0");
  text = changed(text, "initial = 25.0\nbounds = [20.0, 32.0]",
                 "initial = 11.0\nbounds = [9.0, 14.0]");
  text = changed(text, "radius = 20", "radius = 11");
  text = changed(text, "length = 60.0", "length = 30.0");
  text = changed(text, "volume = 9e4", "volume = 3e4");
  return *reader::read_case_text(text + more, "case.toml").input;
}

double largest_rise(const QuadraticSurface& surface) {
  double largest = 0.0;
  for (std::size_t i = 0; i < surface.edges.size(); ++i) {
    const Vec3& a = surface.base.points[surface.edges[i][0]];
    const Vec3& b = surface.base.points[surface.edges[i][1]];
    largest = std::max(
        largest, (surface.mid[i] - 0.5 * (a + b)).norm() / (b - a).norm());
  }
  return largest;
}

forward::EvaluationFields fields_at(const forward::ForwardModel& model,
                                    double foot) {
  forward::EvaluationFields fields;
  const forward::Evaluation evaluation =
      model.evaluate(VectorX::Constant(1, foot), &fields);
  EXPECT_FALSE(evaluation.failure) << evaluation.failure->message;
  return fields;
}

TEST(TightFacets, AreHalvedWhereTheFilmTurns) {
  constexpr double kRise = 0.11;  // docs/theory.md
  case_data::Case input = fat_drop();
  const forward::ForwardModel model(input);
  ASSERT_FALSE(model.failure()) << model.failure()->message;
  const QuadraticSurface surface = fields_at(model, 11.0).surface;
  EXPECT_TRUE(check_surface(surface.base).empty());
  EXPECT_LT(largest_rise(surface), kRise);
  // Without the film's refinement nothing is known of its curvature: facets
  // are as they come, and fewer.
  input.resolution.refinements = 0;
  const forward::ForwardModel plain(input);
  ASSERT_FALSE(plain.failure()) << plain.failure()->message;
  EXPECT_LT(fields_at(plain, 11.0).surface.base.facets.size(),
            surface.base.facets.size());
}

TEST(TightFacets, LetTheDesignMove) {
  const forward::ForwardModel model(fat_drop());
  ASSERT_FALSE(model.failure()) << model.failure()->message;
  for (const double foot : {10.0, 10.5, 11.5, 12.0}) {
    fields_at(model, foot);
  }
}

TEST(TightFacets, AreHalvedWithThoseThatErr) {
  const forward::ForwardModel model(fat_drop("[analysis]\nadapt = true\n"));
  ASSERT_FALSE(model.failure()) << model.failure()->message;
  ASSERT_TRUE(model.adaptation());
  EXPECT_LT(largest_rise(fields_at(model, 11.0).surface), 0.11);
}

}  // namespace
}  // namespace meniscus::tight_facets_test
