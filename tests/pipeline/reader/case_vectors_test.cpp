// Design variables under one name: [design.NAME] with a shape.
#include <random>

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "pipeline/case_data/design_vectors.h"
#include "tests/support/case_text.h"

namespace meniscus::case_vectors_test {
namespace {

using testing::AllOf;
using testing::Contains;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::StartsWith;

reader::CaseReading reading_of(const std::string& text,
                               const std::vector<std::string>& overrides = {}) {
  return reader::read_case_text(text, "case.toml", overrides);
}

/// The design of the petal strut with overrides; empty, and a failure, where
/// there are problems.
VectorX initial_with(const std::vector<std::string>& overrides,
                     const std::string& text = petal_strut()) {
  const reader::CaseReading reading = reading_of(text, overrides);
  EXPECT_THAT(reading.problems, IsEmpty());
  return reading.input ? case_data::initial_design(*reading.input) : VectorX();
}

std::vector<double> numbers(const VectorX& values) {
  return {values.begin(), values.end()};
}

TEST(DesignVectors, AreDesignVariablesUnderOneName) {
  const case_data::Case input = case_of(petal_strut());
  EXPECT_THAT(
      case_data::design_names(input),
      ElementsAre("t[1,1]", "t[1,2]", "t[1,3]", "t[2,1]", "t[2,2]", "t[2,3]"));
  ASSERT_EQ(input.vectors.size(), 1U);
  EXPECT_EQ(input.vectors[0].name, "t");
  EXPECT_THAT(input.vectors[0].shape, ElementsAre(2, 3));
  EXPECT_EQ(input.vectors[0].first, 0U);
  EXPECT_EQ(input.vectors[0].line, 8);
  for (const case_data::DesignVariable& variable : input.design) {
    EXPECT_EQ(variable.initial, 25.0);
    EXPECT_EQ(variable.lower, 20.0);
    EXPECT_EQ(variable.upper, 32.0);
  }
}

TEST(DesignVectors, HaveArraysOfInitialValuesAndBounds) {
  const std::string arrays =
      changed(changed(petal_strut(), "initial = 25.0",
                      "initial = [[21, \"22 mm\", 23],\n[24, \"20 + 5\", 26]]"),
              "bounds = [20.0, 32.0]",
              "bounds = [20, [[27, 28, 29], [30, 31, \"3.2 cm\"]]]");
  const case_data::Case input = case_of(arrays);
  EXPECT_THAT(numbers(case_data::initial_design(input)),
              ElementsAre(21, 22, 23, 24, 25, 26));
  for (std::size_t k = 0; k < input.design.size(); ++k) {
    EXPECT_EQ(input.design[k].lower, 20.0);
    EXPECT_EQ(input.design[k].upper, 27.0 + static_cast<double>(k));
    EXPECT_TRUE(input.design[k].measure.is_known());
  }
  // One to three counts; one alone is a list of one.
  for (const char* shape : {"6", "[6]", "[6, 1]", "[1, 2, 3]"}) {
    const reader::CaseReading reading = reading_of(
        changed(changed(strut(), "[design.foot]",
                        fmt::format("[design.w]\nshape = {}\ninitial = 1\n"
                                    "bounds = [0, 2]\n[design.foot]",
                                    shape)),
                "radius = 20", "radius = 20"));
    ASSERT_TRUE(reading.input) << shape;
    EXPECT_EQ(reading.input->design.size(), 7U) << shape;
    EXPECT_THAT(reading.warnings, Contains(HasSubstr("'w' is not used")));
  }
}

TEST(DesignVectors, ExpressionsFindTheirElements) {
  // Each point of the foot moves by its own element alone, as far.
  const case_data::Case input = case_of(petal_strut());
  const VectorX design = case_data::initial_design(input);
  const auto points = [&](const VectorX& at) {
    return std::get<curves::Spline>(
               case_data::evaluate(input, at).film_system.curves[0].shape)
        .points;
  };
  const auto before = points(design);
  ASSERT_EQ(before.size(), 6U);
  for (Eigen::Index k = 0; k < design.size(); ++k) {
    VectorX moved = design;
    moved[k] += 1.5;
    const auto after = points(moved);
    for (std::size_t p = 0; p < after.size(); ++p) {
      EXPECT_NEAR((after[p] - before[p]).norm(),
                  static_cast<Eigen::Index>(p) == k ? 1.5 : 0.0, 1e-12);
    }
  }
}

TEST(DesignVectors, IndicesMayBeConstantParameters) {
  const std::string text = changed(
      changed(petal_strut(), "load = 1000.0",
              "load = 1000.0\nlast = 3\nmean = \"(t[1, 1] + t[2, last]) / 2\"\n"
              "two = \"last - 1\""),
      "radius = 20", "radius = \"(mean + t[two, last]) / 2\"");
  const reader::CaseReading reading = reading_of(text);
  ASSERT_THAT(reading.problems, IsEmpty());
  EXPECT_THAT(reading.warnings, testing::Not(Contains(HasSubstr("not used"))));
  VectorX design = case_data::initial_design(*reading.input);
  design[5] = 31.0;
  const auto values = case_data::parameter_values(*reading.input, design);
  EXPECT_EQ(values[2].second, 28.0);
  // A parameter that follows the design is no index.
  EXPECT_THAT(problems_of(changed(text, "last = 3", "last = \"t[1, 1] / 10\"")),
              Contains(HasSubstr("an index of 't' depends on 'last'")));
}

TEST(DesignVectors, OfPlaceKeepTheirValueInFields) {
  // Those of films keep them as numbers, others are bound to values as text.
  const std::string text =
      changed(tube("films = [\"skin\"]\nthickness = "
                   "\"s[2] + s[ 1 ] * z / 1000\"\n"),
              "[design.foot]",
              "[design.s]\nshape = 2\ninitial = [3, 0.5]\nbounds = [0.1, 4]\n"
              "[design.foot]");
  const case_data::Case walled = case_of(text);
  const PlaceField thickness =
      case_data::evaluate(walled, case_data::initial_design(walled))
          .walls[0]
          .thickness;
  EXPECT_THAT(numbers(thickness.numbers), ElementsAre(3.0, 0.5));
  EXPECT_DOUBLE_EQ(value_at(thickness, thickness.own(), {0, 0, 20}), 0.56);
  const case_data::Case input = case_of(changed(
      petal_strut(),
      "loads = [{ on = \"head_pad\", force = [\"load\", "
      "0, 0] }]",
      "loads = [{ on = \"head_pad\", pressure = \"t[1, 2] + t[2, 1+1] * "
      "x\" }]"));
  VectorX design = case_data::initial_design(input);
  design[1] = 21.0;
  design[4] = 0.25 + 20.0;
  const case_data::EvaluatedCase at = case_data::evaluate(input, design);
  ASSERT_EQ(at.load_cases[0].pressures.size(), 1U);
  EXPECT_EQ(at.load_cases[0].pressures[0].field(Vec3(2.0, 0, 0)), 61.5);
}

TEST(DesignVectors, WrongFormsAreToldByLineAndShape) {
  struct Wrong {
    const char* from;
    const char* to;
    const char* told;
  };
  const std::vector<Wrong> all = {
      {"shape = [2, 3]", "shape = []",
       "case.toml:9: design.t.shape is an array of 0; expected one to three "
       "whole numbers"},
      {"shape = [2, 3]", "shape = [2, 0]", "case.toml:9: design.t.shape is"},
      {"shape = [2, 3]", "shape = [2, 3.0]", "case.toml:9: design.t.shape is"},
      {"shape = [2, 3]", "shape = [1, 2, 3, 1]", "design.t.shape is"},
      {"shape = [2, 3]", "shape = \"six\"", "is the text 'six'; expected one"},
      {"shape = [2, 3]", "shape = [200, 300]",
       "design.t.shape makes 60000 design variables; at most 4000"},
      {"initial = 25.0", "initial = [25, 25]",
       "case.toml:10: design.t.initial has 25 where 3 values are "
       "wanted: its shape is 2 x 3; expected one value for all, or 2 arrays "
       "of 3"},
      {"initial = 25.0", "initial = [[25, 25, 25]]",
       "has an array of 1 where 2 values are wanted"},
      {"initial = 25.0", "initial = [[25, 25, 25],\n[25, 25]]",
       "case.toml:11: design.t.initial has an array of 2 where 3"},
      {"initial = 25.0", "initial = [[25, 25, 25],\n[25, 25, 40]]",
       "case.toml:11: design.t[2,3].initial is 40, outside its bounds [20, "
       "32]"},
      {"initial = 25.0", "initial = [[25, 25, 25],\n[25, 25, \"2 kg\"]]",
       "outside its bounds"},
      {"initial = 25.0",
       "initial = [[\"25 mm\", 25, 25],\n[25, 25, \"25 kg\"]]",
       "case.toml:11: design.t.initial: 0.025 is a mass, and initial a length"},
      {"initial = 25.0", "initial = [[25, 25, 25], [25, 25, \"t[1, 1]\"]]",
       "design.t.initial depends on 't[1,1]'"},
      {"bounds = [20.0, 32.0]", "bounds = 20",
       "design.t.bounds is 20; expected two numbers: [least, largest], each "
       "one value for all, or 2 arrays of 3"},
      {"bounds = [20.0, 32.0]", "bounds = [[20, 20, 20], [32, 32, 32]]",
       "design.t.bounds has an array of 3 where 2 values are wanted"},
      {"bounds = [20.0, 32.0]", "bounds = [20, [[32, 32, 32], [32, 32, 19]]]",
       "case.toml:11: design.t[2,3].bounds are [20, 19]; the first must not be "
       "above the second"},
      {"[design.t]\nshape = [2, 3]\n", "[design.t]\n", "unexpected '['"},
      {"[design.t]", "[design.sin]", "'sin' is a name that expressions know"},
      {"load = 1000.0", "load = 1000.0\nt = 1",
       "'t' is both a parameter and a design variable"},
      {"[design.t]", "[design.i]",
       "counts with i, which is also a parameter or design variable"},
      {"t[i, j] * cos", "t[i, j, 1] * cos", "3 of 2 indices: 't' is 2 x 3"},
      {"t[i, j] * cos", "t[j, i] * cos",
       "case.toml:16: curves.base.points[0][x]: t[3,1] is not there: 't' is 2 "
       "x 3, counted from 1"},
      {"t[i, j] * cos", "t[i, j - 1] * cos", "t[1,0] is not there"},
      {"t[i, j] * cos", "t[i] * cos", "1 of 2 indices: 't' is 2 x 3"},
      {"t[i, j] * cos", "t[i, j / 2] * cos",
       "the index 0.5 of 't' is not whole: 't' is 2 x 3"},
      {"t[i, j] * cos", "t * cos", "'t' has 2 x 3 elements: write one of them"},
      {"t[i, j] * cos", "t[i, ] * cos", "an index is missing"},
      {"radius = 20", "radius = \"t[i, j]\"", "unknown name 'i'"},
      {"radius = 20", "radius = \"t[load, 1]\"", "t[1000,1] is not there"},
      {"radius = 20", "radius = \"t[t[1, 1], 1]\"",
       "an index of 't' depends on 't[1,1]', which moves or has no value"},
  };
  for (const Wrong& wrong : all) {
    EXPECT_THAT(problems_of(changed(petal_strut(), wrong.from, wrong.to)),
                Contains(HasSubstr(wrong.told)))
        << wrong.to;
  }
}

TEST(DesignVectors, AreOverriddenWholeOrByElement) {
  EXPECT_THAT(numbers(initial_with({"t=30"})),
              ElementsAre(30, 30, 30, 30, 30, 30));
  EXPECT_THAT(numbers(initial_with({"t=[[21, 22, 23], [24, 25, 26]]"})),
              ElementsAre(21, 22, 23, 24, 25, 26));
  EXPECT_THAT(
      numbers(initial_with(
          {"t[2, 3]=30", "design.t[1,2].initial=2.1 cm", "t[1,1]=\"20 + 2\""})),
      ElementsAre(22, 21, 25, 25, 25, 30));
  // In their order: what comes later holds.
  EXPECT_THAT(numbers(initial_with({"t[1,1]=21", "t=30", "t[1,2]=31"})),
              ElementsAre(30, 31, 30, 30, 30, 30));
  const reader::CaseReading bounded =
      reading_of(petal_strut(), {"design.t[2,1].bounds=[24, 26]"});
  ASSERT_TRUE(bounded.input);
  for (std::size_t k = 0; k < 6; ++k) {
    EXPECT_EQ(bounded.input->design[k].lower, k == 3 ? 24.0 : 20.0);
    EXPECT_EQ(bounded.input->design[k].upper, k == 3 ? 26.0 : 32.0);
  }
}

TEST(DesignVectors, WrongOverridesAreToldAsGiven) {
  struct Wrong {
    const char* given;
    const char* told;
  };
  for (const Wrong& wrong : std::vector<Wrong>{
           {"t[3,1]=25", "there is no element 't[3,1]': its shape is 2 x 3"},
           {"t[0,1]=25", "its shape is 2 x 3"},
           {"t[1]=25", "its shape is 2 x 3"},
           {"t[1,x]=25", "its shape is 2 x 3"},
           {"t[]=25", "its shape is 2 x 3"},
           {"t[1,1]=50", "design.t[1,1].initial is 50, outside its bounds"},
           {"t[1,1]=[1, 2]", "is an array of 2; expected a number"},
           {"t[1,1=25", "there is no vector of design variables that has"},
           {"u[1]=25", "there is no vector of design variables that has"},
           {"load[1]=25", "there is no vector of design variables that has"},
           {"design.t[1,1].shape=25", "there is no vector"},
           {"design.t[1,1].bounds=25", "expected two numbers"},
           {"t=[25, 25]", "design.t.initial has 25 where 3 values"}}) {
    EXPECT_THAT(reading_of(petal_strut(), {wrong.given}).problems,
                Contains(AllOf(StartsWith(fmt::format("case.toml: --set {}: ",
                                                      wrong.given)),
                               HasSubstr(wrong.told))))
        << wrong.given;
  }
  // Nothing is made of a shape that no vector can have.
  EXPECT_THAT(
      reading_of(changed(petal_strut(), "shape = [2, 3]",
                         "shape = [4000, 4000, 4000]"),
                 {"t[1,2,3]=25"})
          .problems,
      AllOf(Contains(HasSubstr("its shape 4000 x 4000 x 4000 has more than "
                               "4000")),
            Contains(HasSubstr("design.t.shape makes 64000000000"))));
  EXPECT_THAT(reading_of(strut(), {"foot[1]=25"}).problems,
              Contains(HasSubstr("it has no shape and is one value")));
}

TEST(DesignVectors, SurviveRandomIndices) {
  const std::vector<std::string> pieces = {"1", "2", "3", "i", "j", ",",
                                           "+", "-", "[", "]", "t", " "};
  std::mt19937 generator(5);
  int good = 0;
  for (int round = 0; round < 300; ++round) {
    std::string index;
    for (std::size_t k = 0, length = 1 + generator() % 5; k < length; ++k) {
      index += pieces[generator() % pieces.size()];
    }
    const reader::CaseReading read = reading_of(
        changed(petal_strut(), "t[i, j] * cos", "t[" + index + "] * cos"));
    EXPECT_NE(read.input.has_value(), !read.problems.empty()) << index;
    good += read.input ? 1 : 0;
    const reader::CaseReading put =
        reading_of(petal_strut(), {"t[" + index + "]=26"});
    EXPECT_NE(put.input.has_value(), !put.problems.empty()) << index;
  }
  EXPECT_GT(good, 0);
}

TEST(DesignVectors, TheFirstElementThatDoesNotFitSpeaksForAll) {
  // At -25 a point lies on the one across.
  const std::vector<std::string> problems = problems_of(
      changed(petal_strut(), "bounds = [20.0, 32.0]", "bounds = [-25, 32]"));
  ASSERT_EQ(problems.size(), 1U) << testing::PrintToString(problems);
  EXPECT_THAT(problems[0],
              HasSubstr("with 't[1,1]' at the end of its bounds, -25"));
}

TEST(DesignVectors, ElementsThatNothingUsesAreTold) {
  const reader::CaseReading reading =
      reading_of(changed(petal_strut(), "shape = [2, 3]", "shape = [2, 5]"));
  EXPECT_THAT(
      reading.warnings,
      Contains(
          "case.toml:8: warning: design variable 't': 4 of its 10 elements "
          "are not used, t[1,4], t[1,5], t[2,4], ..."));
  EXPECT_THAT(reading_of(petal_strut()).warnings, IsEmpty());
}

TEST(DesignVectors, StudiesNameThemWholeOrByElement) {
  const std::string without =
      petal_strut().substr(0, petal_strut().find("[study]"));
  const case_data::Case grid =
      case_of(without +
              "[study]\nkind = \"sweep\"\nmethod = \"grid\"\n"
              "levels = { t = 2, \"t[2, 3]\" = 3 }\n");
  EXPECT_THAT(grid.study.levels, ElementsAre(2, 2, 2, 2, 2, 3));
  const case_data::Case scatter =
      case_of(without +
              "[study]\nkind = \"tolerance\"\n"
              "deviations = { \"t[1,2]\" = 0.1 }\n");
  EXPECT_THAT(scatter.study.deviations, ElementsAre(0, 0.1, 0, 0, 0, 0));
  EXPECT_THAT(problems_of(without + "[study]\nkind = \"sweep\"\nmethod = "
                                    "\"grid\"\nlevels = { \"t[3,1]\" = 2 }\n"),
              Contains(HasSubstr("there is no design variable 't[3,1]'")));
}

TEST(DesignVectors, RowsShowThemAsOne) {
  const case_data::Case input = case_of(
      changed(changed(petal_strut(), "[design.t]",
                      "[design.a]\ninitial = \"20 mm\"\nbounds = [1, 30]\n\n"
                      "[design.t]"),
              "radius = 20", "radius = \"a\""));
  const std::vector<case_data::DesignRow> rows = case_data::design_rows(input);
  ASSERT_EQ(rows.size(), 2U);
  EXPECT_EQ(rows[0].label(), "a");
  EXPECT_EQ(rows[1].label(), "t [2 x 3]");
  EXPECT_EQ(rows[1].first, 1U);
  VectorX design = case_data::initial_design(input);
  design[2] = 31.0;
  design[6] = 22.5;
  EXPECT_EQ(case_data::row_text(input, rows[0], design), "20 mm");
  EXPECT_EQ(case_data::row_text(input, rows[1], design),
            "22.5 to 31, mean 25.5833");
  EXPECT_EQ(case_data::row_text(input, rows[1], VectorX::Constant(7, 25.0)),
            "25 each");
  EXPECT_THAT(case_data::positions_of(input, "t"),
              ElementsAre(1, 2, 3, 4, 5, 6));
  EXPECT_THAT(case_data::positions_of(input, "t[2, 1]"), ElementsAre(4));
  EXPECT_THAT(case_data::positions_of(input, "a"), ElementsAre(0));
  EXPECT_THAT(case_data::positions_of(input, "t[3,1]"), IsEmpty());
}

}  // namespace
}  // namespace meniscus::case_vectors_test
