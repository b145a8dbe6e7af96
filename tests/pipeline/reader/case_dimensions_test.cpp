// A quantity keeps its dimension to where it is used.
#include <fstream>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "pipeline/reader/case_reader.h"
#include "pipeline/reader/family_members.h"
#include "tests/support/case_text.h"
#include "tests/support/temp_folder.h"

namespace meniscus::case_dimensions_test {
namespace {

using testing::AllOf;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;

std::string with_units() {
  return changed(changed(strut(), "load = 1000.0", "load = \"1 kN\""),
                 "length = 60.0", "length = \"60 mm\"");
}

std::vector<std::string> problems_with(
    const std::string& text, const std::vector<std::string>& overrides) {
  return reader::read_case_text(text, "case.toml", overrides).problems;
}

TEST(CaseDimensions, TheStrutWithUnitsIsTheStrut) {
  EXPECT_THAT(problems_of(with_units()), IsEmpty());
  EXPECT_THAT(problems_with(strut(), {"load=1 kN", "length=6 cm"}), IsEmpty());
}

TEST(CaseDimensions, AnOverrideOfAnotherDimensionIsRefusedWhereItIsUsed) {
  EXPECT_THAT(problems_with(strut(), {"load=200 kg"}),
              ElementsAre(AllOf(HasSubstr("case.toml:52: "),
                                HasSubstr("'load' is a mass (load is a mass); "
                                          "expected a force"))));
  EXPECT_THAT(
      problems_with(strut(), {"length=6 kN"}),
      ElementsAre(AllOf(HasSubstr("case.toml:20: curves.head.center[z]"),
                        HasSubstr("is a force"), HasSubstr("a length"))));
}

TEST(CaseDimensions, AnOverrideOfAnotherDimensionThanTheFilesIsRefused) {
  EXPECT_THAT(
      problems_with(with_units(), {"load=200 kg"}),
      testing::Contains(AllOf(HasSubstr("--set load=200 kg"),
                              HasSubstr("'200 kg' is a mass"),
                              HasSubstr("expected a force, as '1 kN'"))));
}

TEST(CaseDimensions, AMembersValueKeepsItsDimension) {
  const std::string family =
      changed(strut(), "kind = \"match\"\ntargets = { sway = 0.01 }",
              "kind = \"family\"\neach = \"match\"\ntargets = { sway = 0.01 }\n"
              "[study.members.tall]\nlength = \"6 kN\"\n"
              "[study.members.low]\nlength = \"50 mm\"");
  const std::vector<std::string> problems = problems_of(family);
  ASSERT_EQ(problems.size(), 1U);
  EXPECT_THAT(problems[0],
              AllOf(HasSubstr("member 'tall'"), HasSubstr("a force"),
                    HasSubstr("expected a length")));
}

struct Mismatch {
  const char* name;
  const char* from;
  const char* to;
  const char* first;  // both must appear in the one problem
  const char* second;
};

class MismatchTest : public testing::TestWithParam<Mismatch> {};

TEST_P(MismatchTest, NamesPlaceAndBothDimensions) {
  const Mismatch& m = GetParam();
  const std::vector<std::string> problems =
      problems_of(changed(with_units(), m.from, m.to));
  ASSERT_EQ(problems.size(), 1U) << testing::PrintToString(problems);
  EXPECT_THAT(problems[0], AllOf(HasSubstr("case.toml:"), HasSubstr(m.first),
                                 HasSubstr(m.second)));
}

const Mismatch kMismatches[] = {
    {"Sum", "\"length\"]", "\"length + load\"]", "the sum of a length",
     "a force"},
    {"Product", "radius = 20", "radius = \"length * length / 180\"", "an area",
     "a length"},
    {"ThroughAParameter", "length = \"60 mm\"",
     "tall = \"6 kN\"\nlength = \"2 * tall\"", "(length is a force)",
     "expected a length"},
    {"Function", "radius = 20", "radius = \"20 * sin(length)\"",
     "sin of a length", "sin(length)"},
    {"Bracket", "radius = 20", "radius = \"macaulay(length, 1, load)\"",
     "macaulay of a length", "a force"},
    {"PowerOfABracket", "radius = 20",
     "radius = \"macaulay(length - 3, 2, 1)\"", "an area", "a length"},
    {"Branches", "radius = 20", "radius = \"if(length > 3, load, length)\"",
     "the branches of a force", "a length"},
    {"Comparison", "radius = 20", "radius = \"if(length > load, 3, 4)\"",
     "the comparison of a length", "a force"},
    {"Bounds", "bounds = [20.0, 32.0]", "bounds = [\"20 mm\", \"6 kN\"]",
     "is a force", "a length"},
    {"InitialAndBounds", "initial = 25.0\nbounds = [20.0, 32.0]",
     "initial = \"25 N\"\nbounds = [\"20 mm\", 32]", "is a length", "a force"},
    {"DesignVariable", "initial = 25.0", "initial = \"25 N\"",
     "'foot' is a force", "a length"},
    {"Target", "sway = 0.01", "sway = \"1 kN\"", "a force", "a length"},
    {"Literal", "radius = 20", "radius = \"20 kg\"",
     "'20 kg' is no length but a mass", "mm"},
    {"Volume", "volume = 9e4", "volume = \"30 * length\"", "is a length",
     "a volume"},
    {"Vector", "direction = [1, 0, 0]", "direction = [\"length\", \"load\", 0]",
     "a length", "a force"}};

INSTANTIATE_TEST_SUITE_P(All, MismatchTest, testing::ValuesIn(kMismatches),
                         [](const auto& each) { return each.param.name; });

TEST(CaseDimensions, WhatFitsIsTaken) {
  const std::vector<std::pair<std::string, std::string>> good = {
      {"radius = 20", "radius = \"length / 3\""},
      {"radius = 20", "radius = \"length - 40\""},
      {"radius = 20", "radius = \"sqrt(length * length / 9)\""},
      {"radius = 20", "radius = \"(length^3 / 216)^(1/3) + 10\""},
      {"radius = 20", "radius = \"10 + 10 * sin(length / 5 / length)\""},
      {"radius = 20", "radius = \"min(length, max(20, length / 4))\""},
      {"radius = 20", "radius = \"if(load > 900, length / 3, 20)\""},
      {"radius = 20", "radius = \"foot * length / 75\""},
      {"volume = 9e4", "volume = \"length^3 / 2.4\""},
      {"direction = [1, 0, 0]", "direction = [\"length\", 0, \"length / 2\"]"},
      {"[design.foot]",
       "slope = \"3 N/mm2/s\"\nlift = \"2 m/s2\"\n[design.foot]"},
      {"[\"load\", 0, 0] }",
       "[\"load\", 0, 0] }, { gravity = [0, 0, "
       "\"-9.81 m/s2\"] }"}};
  for (const auto& [from, to] : good) {
    EXPECT_THAT(problems_of(changed(with_units(), from, to)), IsEmpty()) << to;
  }
}

// Numbers without units say nothing: what held before holds on.
TEST(CaseDimensions, PlainNumbersStandForAnything) {
  for (const char* radius : {"\"length - load / 25\"", "\"20 + sin(length)\"",
                             "\"if(length > load, 3, 20)\""}) {
    EXPECT_THAT(problems_of(changed(strut(), "radius = 20",
                                    std::string("radius = ") + radius)),
                IsEmpty())
        << radius;
  }
}

TEST(CaseDimensions, AConstraintOnAnExpressionKnowsWhatItMeasures) {
  const std::string study =
      changed(changed(with_units(), "[study]",
                      "[responses.work]\nkind = \"expression\"\nvalue = "
                      "\"sway * load\"\n[study]"),
              "kind = \"match\"\ntargets = { sway = 0.01 }",
              "kind = \"minimize\"\nobjective = \"mass\"\nconstraints = [{ "
              "response = \"work\", max = \"3 J\" }]");
  EXPECT_THAT(problems_of(study), IsEmpty());
  EXPECT_THAT(
      problems_of(changed(study, "3 J", "3 MPa")),
      ElementsAre(AllOf(HasSubstr("study.constraints.max"),
                        HasSubstr("a pressure"), HasSubstr("an energy"))));
}

// A price of mass and deflection: what it is in is its author's.
TEST(CaseDimensions, WeightedSumsOfResponsesAreTaken) {
  const auto with = [](const std::string& value) {
    return changed(with_units(), "[study]",
                   "[responses.price]\nkind = \"expression\"\nvalue = \"" +
                       value + "\"\n[study]");
  };
  EXPECT_THAT(problems_of(with("2.5 * mass + 40 * sway / length")), IsEmpty());
  EXPECT_THAT(problems_of(with("mass * (load + length)")),
              ElementsAre(HasSubstr("the sum of a force and a length")));
}

TEST(CaseDimensions, SpringsKnowWhetherTheyAreOfAnArea) {
  const auto with = [](const std::string& spring) {
    return changed(strut(), "fix = \"xyz\"", spring);
  };
  const std::string total =
      "stiffness = [\"2 kN/mm\", 1, 1], stiffness_of = \"total\"";
  EXPECT_THAT(problems_of(with(total)), IsEmpty());
  EXPECT_THAT(problems_of(with("normal_stiffness = \"2 N/mm3\"")), IsEmpty());
  EXPECT_THAT(
      problems_of(with("normal_stiffness = \"2 kN/mm\"")),
      testing::Contains(AllOf(HasSubstr("'2 kN/mm' is no stiffness per area"),
                              HasSubstr("tension"))));
}

}  // namespace
}  // namespace meniscus::case_dimensions_test
