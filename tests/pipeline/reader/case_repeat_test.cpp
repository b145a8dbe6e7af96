// One entry that stands for many, and curves that are one.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "evolve/frozen/film_model.h"
#include "pipeline/reader/case_reader.h"

namespace meniscus::case_repeat_test {
namespace {

using testing::AllOf;
using testing::Contains;
using testing::Each;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::SizeIs;

/// Rings of rims around an axis, with struts between neighbours. Line 5 is
/// the first of [curves.node].
const char* const kRing = R"case(title = "Ring"
units = "mm-N-MPa"
[parameters]
spokes = 6
[curves.node]
kind = "circle"
center = ["50 * cos(2 * pi * i / spokes)", "50 * sin(2 * pi * i / spokes)", "30 * j"]
normal = ["-sin(2 * pi * i / spokes)", "cos(2 * pi * i / spokes)", 0]
radius = 4
repeat = ["spokes", 2]
[curves.far]
kind = "copy"
of = "node_{i}_{j}"
about = ["50 * cos(2 * pi * i / spokes)", "50 * sin(2 * pi * i / spokes)", "30 * j"]
scale = 0.9
move = ["-10 * sin(2 * pi * i / spokes)", "10 * cos(2 * pi * i / spokes)", 0]
repeat = ["spokes", 2]
[films.stub]
kind = "loft"
curves = ["node_{i}_{j}", "far_{i}_{j}"]
tension = "1 + i / 10"
repeat = ["spokes", 2]
[films.rib]
kind = "loft"
curves = ["far_{i}_{j}", "node_{i % spokes + 1}_{j}"]
repeat = ["spokes", 2]
[walls.rib]
films = ["rib_{i}_1"]
thickness = "i / 10"
repeat = "spokes"
[walls.all]
films = [{ name = "stub_{i}_{j}", repeat = ["spokes", 2] }]
thickness = 0.1
[resolution]
fea = 4
)case";

std::vector<std::string> problems_of_repeated(std::string text,
                                              const std::string& from,
                                              const std::string& to) {
  const std::size_t at = text.find(from);
  EXPECT_NE(at, std::string::npos) << from;
  text.replace(at, from.size(), to);
  return reader::read_case_text(text, "case.toml").problems;
}

TEST(CaseRepeat, MakesPatternsOfFilmsAlongALattice) {
  const reader::CaseReading reading =
      reader::read_case_text(kRing, "case.toml");
  ASSERT_THAT(reading.problems, IsEmpty());
  const case_data::Case& input = *reading.input;
  EXPECT_THAT(input.curves, SizeIs(24));
  ASSERT_THAT(input.films, SizeIs(24));
  EXPECT_EQ(input.films[3].spec.name, "stub_2_2");
  EXPECT_THAT(input.films[3].spec.curves, ElementsAre("node_2_2", "far_2_2"));
  // The last rib of a ring ends where the first began.
  EXPECT_EQ(input.films[22].spec.name, "rib_6_1");
  EXPECT_THAT(input.films[22].spec.curves, ElementsAre("far_6_1", "node_1_1"));
  ASSERT_THAT(input.walls, SizeIs(7));
  EXPECT_EQ(input.walls[5].name, "rib_6");
  EXPECT_THAT(input.walls[5].films, ElementsAre("rib_6_1"));
  EXPECT_THAT(input.walls[6].films, SizeIs(12));
  EXPECT_EQ(input.walls[6].films.back(), "stub_6_2");
  const case_data::EvaluatedCase inputs =
      case_data::evaluate(input, case_data::initial_design(input));
  EXPECT_DOUBLE_EQ(inputs.film_system.films[11].tension, 1.6);
}

TEST(CaseRepeat, CountsInSupportsLoadsAndResponses) {
  const reader::CaseReading reading =
      reader::read_case_text(R"case(title = "Legs"
units = "mm-N-MPa"
[curves.leg]
kind = "circle"
center = ["40 * cos(2 * pi * i / 3)", "40 * sin(2 * pi * i / 3)", 0]
normal = ["-cos(2 * pi * i / 3)", "-sin(2 * pi * i / 3)", -1]
radius = 8
repeat = 3
[curves.top]
kind = "circle"
center = [0, 0, 40]
normal = [0, 0, 1]
radius = 12
[films.skin]
kind = "branch"
curves = [{ name = "leg_{i}", repeat = 3 }, "top"]
[solids.pad]
kind = "cap"
curve = "leg_{i}"
repeat = 3
[solids.lid]
kind = "cap"
curve = "top"
[bodies.part]
enclosed_by = ["skin", { name = "pad_{i}", repeat = 3 }, "lid"]
volume = 5e4
material = "steel"
[materials.steel]
youngs_modulus = 2e5
poisson_ratio = 0.3
density = 1
[load_cases.stand]
supports = [{ on = "pad_{i}", normal_stiffness = "10 * i", repeat = 3 }]
loads = [{ on = "lid", force = [0, 0, -1] }]
[responses.foot]
kind = "mean_displacement"
on = "pad_{i}"
direction = [0, 0, 1]
repeat = 3
[resolution]
fea = 6
)case",
                             "case.toml");
  ASSERT_THAT(reading.problems, IsEmpty());
  const case_data::Case& input = *reading.input;
  ASSERT_THAT(input.load_cases[0].springs, SizeIs(3));
  EXPECT_EQ(input.load_cases[0].springs[2].surface, "pad_3");
  EXPECT_THAT(case_data::response_names(input),
              ElementsAre("foot_1", "foot_2", "foot_3"));
  EXPECT_EQ(input.responses[1].surface, "pad_2");
}

TEST(CaseRepeat, ErrorsNameLineAndCopy) {
  EXPECT_THAT(
      problems_of_repeated(kRing, "\"node_{i % spokes + 1}_{j}\"",
                           "\"node_{i + 1}_{j}\""),
      ElementsAre(AllOf(HasSubstr("case.toml:25:"), HasSubstr("'node_7_1'")),
                  AllOf(HasSubstr("case.toml:25:"), HasSubstr("'node_7_2'"))));
  EXPECT_THAT(problems_of_repeated(kRing, "radius = 4", "radius = \"4 - i\""),
              Contains(AllOf(HasSubstr("case.toml:"), HasSubstr("node_4_1"))));
  EXPECT_THAT(
      problems_of_repeated(kRing, "{i % spokes + 1}", "{i % spokes + }"),
      Contains(
          AllOf(HasSubstr("case.toml:25"), HasSubstr("'{i % spokes + }'"))));
  EXPECT_THAT(problems_of_repeated(kRing, "{i % spokes + 1}", "{i / 4}"),
              Contains(HasSubstr("1 / 4, which is no whole number")));
  EXPECT_THAT(problems_of_repeated(kRing, "{i % spokes + 1}", "{count}"),
              Contains(HasSubstr("'count', which has no constant value")));
  EXPECT_THAT(
      problems_of_repeated(kRing, "spokes = 6", "spokes = 2.5"),
      Contains(AllOf(HasSubstr("case.toml:10: curves.node.repeat is 2.5"),
                     HasSubstr("whole number"))));
  EXPECT_THAT(problems_of_repeated(kRing, "spokes = 6", "spokes = 6\ni = 2"),
              Contains(HasSubstr("counts with i, which is also a parameter")));
  EXPECT_THAT(problems_of_repeated(kRing, "[walls.all]", "[walls.rib_2]"),
              Contains(HasSubstr("makes 'rib_2', which is there already")));
  EXPECT_THAT(
      problems_of_repeated(kRing, "repeat = [\"spokes\", 2]\n[curves.far]",
                           "repeat = [500, 500]\n[curves.far]"),
      Contains(HasSubstr("at most 4000 are taken")));
}

/// Two tubes that end on curves of their own in one place; `second` is the
/// radius there of the upper one.
std::string tubes(const std::string& second) {
  return R"case(title = "Two tubes"
units = "m-N-Pa"
[design.wide]
initial = 1.0
bounds = [0.9, 1.1]
[curves.low]
kind = "circle"
center = [0, 0, -0.5]
normal = [0, 0, 1]
radius = 1
[curves.middle]
kind = "circle"
center = [0, 0, 0]
normal = [0, 0, 1]
radius = "wide"
[curves.same]
kind = "circle"
center = [0, 0, 0]
normal = [0, 0, -1]
radius = ")case" +
         second + R"case("
[curves.high]
kind = "circle"
center = [0, 0, 0.5]
normal = [0, 0, 1]
radius = 1
[films.lower]
kind = "loft"
curves = ["low", "middle"]
[films.upper]
kind = "loft"
curves = ["same", "high"]
[walls.web]
films = ["lower", "upper"]
thickness = 0.01
[resolution]
fea = 0.2
)case";
}

TEST(CaseMerge, CurvesThatLieOnEachOtherAreOne) {
  const reader::CaseReading reading =
      reader::read_case_text(tubes("wide"), "case.toml");
  ASSERT_THAT(reading.problems, IsEmpty());
  EXPECT_THAT(reading.warnings, IsEmpty());
  const case_data::Case& input = *reading.input;
  EXPECT_THAT(input.remarks,
              ElementsAre(AllOf(HasSubstr("case.toml:16: curve 'same' lies on "
                                          "'middle' within"),
                                HasSubstr("know as 'middle'"))));
  EXPECT_THAT(input.films[1].spec.curves, ElementsAre("middle", "high"));
  const case_data::EvaluatedCase inputs =
      case_data::evaluate(input, case_data::initial_design(input));
  const frozen::FilmModel model = frozen::FilmModel::freeze(
      inputs.film_system, {.edge = 0.2, .refinements = 0});
  ASSERT_FALSE(model.reference().failure);
  EXPECT_FALSE(model.rim("middle").empty());
  EXPECT_TRUE(model.rim("same").empty());
}

TEST(CaseMerge, CurvesThatPartOrOnlyTouchAreRefused) {
  EXPECT_THAT(
      reader::read_case_text(tubes("wide^2"), "case.toml").problems,
      Contains(AllOf(HasSubstr("case.toml:16: curves 'middle' and "
                               "'same' lie on each other at the initial"),
                     HasSubstr("part where design variables"))));
  EXPECT_THAT(
      reader::read_case_text(tubes("1.001 * wide"), "case.toml").problems,
      IsEmpty());  // near, and two
  EXPECT_THAT(
      problems_of_repeated(tubes("wide"), "curves = [\"low\", \"middle\"]",
                           "curves = [\"same\", \"middle\"]"),
      Contains(HasSubstr("names the curves 'same' and 'middle', which "
                         "lie on each other")));
}

}  // namespace
}  // namespace meniscus::case_repeat_test
