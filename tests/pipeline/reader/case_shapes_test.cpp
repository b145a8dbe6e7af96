// Shapes of fields, and what of a film may follow the design by them.
#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/support/case_text.h"

namespace meniscus::case_shapes_test {
namespace {

using testing::Contains;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::SizeIs;

/// strut() with tables before its resolution, and a tension.
std::string strut_with(const std::string& more,
                       const std::string& tension = "\"skin_t\"") {
  return changed(changed(strut(), "[resolution]", more + "\n[resolution]"),
                 "curves = [\"base\", \"head\"]\n",
                 "curves = [\"base\", \"head\"]\ntension = " + tension + "\n");
}

const char* const kVector = R"([design.t]
shape = [4, 3]
initial = 1.2
bounds = [0.5, 2]
)";

std::string axis(const std::string& more = "coefficients = \"t\"") {
  return std::string(kVector) + R"([shapes.skin_t]
kind = "axis"
from = [0, 0, 0]
to = [0, 0, "length"]
)" + more +
         "\n";
}

std::string rims(const std::string& curves) {
  return fmt::format(
      "[shapes.skin_t]\nkind = \"rims\"\ncurves = [{}]\ncoefficients = 1\n",
      curves);
}

case_data::EvaluatedCase numbers_of(const std::string& text) {
  const reader::CaseReading reading = reader::read_case_text(text, "case.toml");
  EXPECT_THAT(reading.problems, IsEmpty());
  EXPECT_THAT(reading.warnings, IsEmpty());
  return case_data::evaluate(*reading.input,
                             case_data::initial_design(*reading.input));
}

TEST(CaseShapes, TakeTheirCountsFromTheirVector) {
  const case_data::EvaluatedCase inputs = numbers_of(strut_with(axis()));
  const std::optional<PlaceField>& field =
      inputs.film_system.films[0].tension_field;
  ASSERT_TRUE(field);
  ASSERT_THAT(field->shapes, SizeIs(1));
  EXPECT_EQ(field->shapes[0]->coefficients(), 12);
  EXPECT_THAT(field->numbers, SizeIs(12));
  EXPECT_THAT(field->names, IsEmpty());
  EXPECT_NEAR(value_at(*field, field->own(), {20, 3, 11}), 1.2, 1e-14);
}

TEST(CaseShapes, StandInExpressionsBesideNamesAndPlaces) {
  const case_data::EvaluatedCase inputs =
      numbers_of(strut_with(axis(), "\"1 + t[2,1]*skin_t*z/length + foot*0\""));
  const PlaceField& field = *inputs.film_system.films[0].tension_field;
  EXPECT_THAT(field.names, SizeIs(2));  // foot and an element
  EXPECT_THAT(field.numbers, SizeIs(14));
  EXPECT_NEAR(value_at(field, field.own(), {20, 3, 30}), 1.0 + 1.44 / 2, 1e-14);
}

TEST(CaseShapes, HaveCoefficientsOfNumbersAndExpressions) {
  const case_data::EvaluatedCase inputs = numbers_of(strut_with(
      "[shapes.skin_t]\nkind = \"radial\"\npoints = [[0, 0, 0], [0, 0, 60]]\n"
      "coefficients = [1.5, \"foot/20\"]\n[shapes.room]\nkind = \"box\"\n"
      "from = [-30, -30, 0]\nto = [30, 30, 60]\ncounts = [1, 1, 3]\n"
      "coefficients = 0.25\n[shapes.line]\nkind = \"radial\"\ncounts = 5\n"
      "points = [[0, 0, 0], [0, 0, 20], [0, 0, 60]]\n"
      "coefficients = [1, 2, 3, 4, 5]\n",
      "\"skin_t + room + 0.1*line\""));
  const PlaceField& field = *inputs.film_system.films[0].tension_field;
  ASSERT_THAT(field.shapes, SizeIs(3));
  EXPECT_THAT(field.numbers, SizeIs(2 + 3 + 5));
  // Half way both points count alike, and of the five those on either side.
  EXPECT_NEAR(value_at(field, field.own(), {3, 1, 30}), 1.375 + 0.25 + 0.3,
              1e-12);
}

TEST(CaseShapes, MoveThicknessesAndPressures) {
  const case_data::EvaluatedCase inputs = numbers_of(changed(
      strut_with(axis() + "[fields.gas]\nkind = \"pressure\"\nbody = \"part\"\n"
                          "pressure = \"0.001*skin_t*z\"\n"),
      "[resolution]",
      "[walls.shell]\nfilms = [\"skin\"]\nthickness = \"2*skin_t\"\n"
      "[resolution]"));
  EXPECT_THAT(inputs.film_system.pressures[0].pressure.numbers, SizeIs(12));
  EXPECT_THAT(inputs.walls[0].thickness.numbers, SizeIs(12));
}

// Elements have names of their own in formulas, unlike any of the case.
TEST(CaseShapes, KeepNamesApart) {
  const std::string vectors =
      "[design.t]\nshape = [2, 3]\ninitial = 2\nbounds = [1, 4]\n"
      "[design.t_2]\nshape = 3\ninitial = 0.5\nbounds = [0.1, 1]\n"
      "[design.n0]\ninitial = 0.25\nbounds = [0.1, 1]\n";
  for (const std::string name : {"t_2_3_", "n1", "n2", "other"}) {
    const case_data::Case input = case_of(strut_with(
        fmt::format("{}[shapes.{}]\nkind = \"radial\"\npoints = [[0, 0, 0]]\n"
                    "coefficients = 7\n",
                    vectors, name),
        fmt::format("\"{} + 10*t[2,3] + 100*t_2[3] + n0 + 0*z\"", name)));
    const PlaceField field =
        *case_data::evaluate(input, case_data::initial_design(input))
             .film_system.films[0]
             .tension_field;
    EXPECT_DOUBLE_EQ(value_at(field, field.own(), {3, 1, 30}), 77.25) << name;
  }
}

TEST(CaseShapes, ThatNothingUsesAreTold) {
  const reader::CaseReading reading =
      reader::read_case_text(strut_with(axis(), "\"1 + 0*z\""), "case.toml");
  EXPECT_THAT(reading.warnings,
              Contains(HasSubstr("shapes.skin_t is not used")));
  EXPECT_THAT(reading.warnings, Contains(HasSubstr("'t' is not used")));
}

struct Mistake {
  const char* name;
  std::string text;
  const char* message;
};

class ShapeMistake : public testing::TestWithParam<Mistake> {};

TEST_P(ShapeMistake, IsToldWithItsLine) {
  const std::vector<std::string> problems = problems_of(GetParam().text);
  EXPECT_THAT(problems, Contains(HasSubstr(GetParam().message)));
}

INSTANTIATE_TEST_SUITE_P(
    CaseShapes, ShapeMistake,
    testing::Values(
        Mistake{"Kind", strut_with("[shapes.skin_t]\nkind = \"boxes\"\n"),
                "expected one of box, axis, radial, rims"},
        Mistake{"Counts", strut_with(axis("coefficients = [1, 2]")),
                "shapes.skin_t.coefficients has 2; the shape takes 1"},
        Mistake{"TooManyCounts",
                strut_with(axis("coefficients = 1\ncounts = [2, 2, 2]")),
                "shapes.skin_t has counts [2, 2, 2]; this kind takes 2"},
        Mistake{"NoCounts", strut_with(axis("coefficients = 1\ncounts = 0")),
                "shapes.skin_t.counts is"},
        Mistake{"Name",
                strut_with(changed(axis(), "shapes.skin_t", "shapes.foot")),
                "'foot' is a name that expressions know already"},
        Mistake{"VectorsName",
                strut_with(changed(axis(), "shapes.skin_t", "shapes.t")),
                "'t' is a name that expressions know already"},
        Mistake{"Place",
                strut_with(changed(axis(), "to = [0, 0, \"length\"]",
                                   "to = [0, 0, \"foot\"]")),
                "depends on 'foot', which a design variable moves"},
        Mistake{"IndexOfRepeat",
                strut_with(changed(axis(), "shapes.skin_t", "shapes.i")),
                "'i' is a name that expressions know already"},
        Mistake{"CountsOfAnotherVector",
                strut_with(axis("coefficients = \"t\"\ncounts = [3, 4]")),
                "shapes.skin_t.counts are [3, 4], and 't' has the shape "
                "[4, 3]"},
        Mistake{"BelowZeroAtItsBounds",
                strut_with(changed(axis(), "bounds = [0.5, 2]",
                                   "bounds = [-0.5, 2]")),
                "with all of 't' at the lower ends of their bounds"},
        Mistake{"NoLength",
                strut_with(changed(axis(), "to = [0, 0, \"length\"]",
                                   "to = [0, 0, 0]")),
                "shapes.skin_t: splines around an axis: it has no length"},
        Mistake{"Box",
                strut_with("[shapes.skin_t]\nkind = \"box\"\nfrom = [0, 0, 9]\n"
                           "to = [1, 1, 3]\ncounts = [2, 2, 2]\n"
                           "coefficients = 1\n"),
                "it runs from 9 to 3 along z"},
        Mistake{"OfOtherKind", strut_with(axis("coefficients = 1\nwidth = 2")),
                "width"},
        Mistake{"RadialAlongOnePoint",
                strut_with("[shapes.skin_t]\nkind = \"radial\"\ncounts = 4\n"
                           "points = [[0, 0, 0]]\ncoefficients = 1\n"),
                "expected two or more of these"},
        Mistake{"NegativeWidth",
                strut_with("[shapes.skin_t]\nkind = \"radial\"\nwidth = -1\n"
                           "points = [[0, 0, 0]]\ncoefficients = 1\n"),
                "the width is -1"},
        Mistake{"BelowZero",
                strut_with(changed(axis(), "initial = 1.2\nbounds = [0.5, 2]",
                                   "initial = 0\nbounds = [0, 2]")),
                "films.skin.tension is 0 at"},
        Mistake{"OfAFilmInItsTension", strut_with(rims("\"base\", \"head\"")),
                "films.skin.tension: shape 'skin_t' is of kind rims"},
        Mistake{"FromARimToItself", strut_with(rims("\"head\", \"head\"")),
                "shapes.skin_t: from curve 'head' to itself"},
        Mistake{"OfOneRim", strut_with(rims("\"head\"")),
                "shapes.skin_t.curves has 1; expected two"},
        Mistake{"Unknown", strut_with(axis(), "\"skin_d\""), "skin_d"}),
    [](const testing::TestParamInfo<Mistake>& mistake) {
      return mistake.param.name;
    });

}  // namespace
}  // namespace meniscus::case_shapes_test
