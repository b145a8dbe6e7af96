#include "pipeline/forward/part_warnings.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "tests/support/parts.h"

namespace meniscus::part_warnings_test {
namespace {

using testing::AllOf;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;

/// A bar of two materials pulled to a stress of 100; region 1 is its far half.
forward::EvaluationFields pulled_bar(double near_yield, double far_yield,
                                     double modulus) {
  forward::EvaluationFields fields;
  fields.mesh =
      shapes::straight_quadratic(shapes::brick({4.0, 1.0, 1.0}, 4, 2, 2));
  for (int e = 0; e < fields.mesh.element_count(); ++e) {
    double x = 0.0;
    for (const int node : fields.mesh.element(e).first<4>()) {
      x += 0.25 * fields.mesh.nodes[node].x();
    }
    fields.mesh.element_region[e] = x < 2.0 ? 0 : 1;
  }
  fields.inputs.materials = {{"near", modulus, 0.3, 1.0, near_yield},
                             {"far", modulus, 0.3, 1.0, far_yield}};
  loads::LoadCase pull;
  pull.name = "pull";
  pull.supports = {{"x0", true, false, false},
                   {"y0", false, true, false},
                   {"z0", false, false, true}};
  pull.forces = {{"x1", {100.0, 0.0, 0.0}}};
  fields.inputs.load_cases = {pull};
  fields.solution =
      elastic::ElasticModel(fields.mesh, fields.inputs.materials, {pull})
          .base_solution();
  fields.stresses =
      forward::part_stresses(fields.mesh, fields.inputs, fields.solution);
  return fields;
}

case_data::Case in_newtons() {
  case_data::Case input;
  input.units.pressure = "MPa";
  input.units.length = "mm";
  return input;
}

std::vector<std::string> warnings_of(const forward::EvaluationFields& fields) {
  return forward::part_warnings(in_newtons(), fields,
                                forward::stress_figures(fields));
}

TEST(PartWarnings, AreNoneForASoundPart) {
  EXPECT_THAT(warnings_of(pulled_bar(101.0, 200.0, 2e5)), IsEmpty());
}

TEST(PartWarnings, HoldEachBodyAgainstItsOwnYieldStrength) {
  EXPECT_THAT(
      warnings_of(pulled_bar(200.0, 80.0, 2e5)),
      ElementsAre(AllOf(HasSubstr("stress above yield: load case 'pull'"),
                        HasSubstr("reaches 100 MPa"),
                        HasSubstr("'far' yields at 80 MPa"),
                        HasSubstr("safety factor 0.8"))));
}

/// A drop between two circles of radius 10 at a distance of 40: with three
/// cylinders of liquid it stands upright, with eight it hangs to a side that
/// edges of 4, 4.5 and 5 choose differently.
TEST(FilmWarnings, TellOfDropsThatHangToASide) {
  settle::FilmReport film;
  film.tension = 1.0;
  film.area = 6.9e3;
  film.min_eigenvalue = 2.17e-3;
  EXPECT_THAT(forward::film_warnings(in_newtons(), film), IsEmpty());
  film.area = 1.0e4;
  film.min_eigenvalue = 2.58e-6;
  EXPECT_THAT(forward::film_warnings(in_newtons(), film),
              ElementsAre(AllOf(HasSubstr("can move almost freely"),
                                HasSubstr("2.6e-06"), HasSubstr("0.026 of"))));
  // Forces, and with them eigenvalues, are by the tension.
  film.tension = 1e-3;
  EXPECT_THAT(forward::film_warnings(in_newtons(), film), IsEmpty());
  // An unstable one fails; a part without films has no modes.
  film.index = 1;
  film.tension = 1.0;
  EXPECT_THAT(forward::film_warnings(in_newtons(), film), IsEmpty());
  EXPECT_THAT(forward::film_warnings(in_newtons(), {}), IsEmpty());
}

TEST(PartWarnings, TellOfDeflectionsThatAreNotSmall) {
  EXPECT_THAT(warnings_of(pulled_bar(200.0, 200.0, 1e3)),
              ElementsAre(HasSubstr("deflection not small")));
}

TEST(StressFigures, TellThePeakItsPlaceAndHowEvenThePartIs) {
  const forward::EvaluationFields fields = pulled_bar(200.0, 80.0, 2e5);
  const std::vector<forward::StressFigures> figures =
      forward::stress_figures(fields);
  ASSERT_EQ(figures.size(), 1U);
  constexpr double kSolver = 1e-6;
  EXPECT_EQ(figures[0].load_case, "pull");
  EXPECT_NEAR(figures[0].max_von_mises, 100.0, kSolver);
  ASSERT_TRUE(figures[0].safety);
  EXPECT_NEAR(figures[0].safety->factor, 0.8, kSolver);
  EXPECT_EQ(figures[0].safety->material, "far");
  EXPECT_GE(figures[0].safety->position.x(), 2.0 - kSolver);
  EXPECT_NEAR(figures[0].uniformity->von_mises.gini, 0.0, kSolver);
  EXPECT_NEAR(figures[0].uniformity->von_mises.volume, 4.0, kSolver);
  const nlohmann::ordered_json json = forward::stress_json(figures);
  EXPECT_NEAR(json["pull"]["safety_factor"]["smallest"].get<double>(), 0.8,
              kSolver);
  EXPECT_EQ(json["pull"]["von_mises"]["histogram"].size(), 50U);
}

TEST(StressFigures, KnowNoSafetyWithoutAYieldStrength) {
  forward::EvaluationFields fields = pulled_bar(200.0, 80.0, 2e5);
  for (element::Material& material : fields.inputs.materials) {
    material.yield_strength.reset();
  }
  const std::vector<forward::StressFigures> figures =
      forward::stress_figures(fields);
  EXPECT_FALSE(figures[0].safety);
  EXPECT_FALSE(forward::stress_json(figures)["pull"].contains("safety_factor"));
}

}  // namespace
}  // namespace meniscus::part_warnings_test
