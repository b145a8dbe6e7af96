#include "pipeline/forward/eigen_figures.h"

#include <cmath>

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "pipeline/forward/part_warnings.h"
#include "tests/support/case_text.h"
#include "tests/support/parts.h"

namespace meniscus::eigen_figures_test {
namespace {

using testing::AllOf;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::SizeIs;

/// A slender bar under its own solution: pushed, and pulled.
struct Bar {
  forward::EvaluationFields fields;
  std::optional<elastic::ElasticModel> model;

  explicit Bar(double push) {
    fields.mesh =
        shapes::straight_quadratic(shapes::brick({10.0, 1.0, 0.8}, 12, 2, 2));
    fields.inputs.materials = {parts::steel()};
    loads::LoadCase pushed = parts::pulled({-push, 0.0, 0.0});
    pushed.name = "push";
    loads::LoadCase pulled = parts::pulled({push, 0.0, 0.0});
    pulled.name = "pull";
    fields.inputs.load_cases = {pushed, pulled};
    model.emplace(fields.mesh, fields.inputs.materials,
                  fields.inputs.load_cases);
    fields.solution = model->base_solution();
  }

  forward::EigenFigures figures(
      const case_data::AnalysisEntry& analysis) const {
    case_data::Case input;
    input.analysis = analysis;
    return forward::eigen_figures(input, fields, &*model);
  }
};

TEST(EigenFigures, UnaskedAreOneFactorPerLoadCase) {
  const Bar bar(100.0);
  const forward::EigenFigures rough = bar.figures({});
  EXPECT_FALSE(rough.frequencies);
  ASSERT_EQ(rough.buckling.size(), 2U);
  ASSERT_EQ(rough.buckling[0].modes.factors.size(), 1U);
  const forward::EigenFigures exact = bar.figures({.buckling = 1});
  const double factor = exact.buckling[0].modes.factors.at(0);
  EXPECT_NEAR(rough.buckling[0].modes.factors[0], factor, 1e-3 * factor);
  EXPECT_THAT(forward::mode_shapes(case_data::Case{}, rough), IsEmpty());
  EXPECT_THAT(forward::eigen_warnings(rough), IsEmpty());
}

TEST(EigenFigures, OfNoBucklingAreNone) {
  const forward::EigenFigures none = Bar(100.0).figures({.buckling = 0});
  EXPECT_THAT(none.buckling, IsEmpty());
  EXPECT_EQ(forward::eigen_text(none), "");
}

TEST(EigenFigures, TellFrequenciesFactorsAndTheirModes) {
  case_data::Case input;
  input.analysis = {.frequencies = 3, .supports_of = 1, .buckling = 2};
  const Bar bar(100.0);
  const forward::EigenFigures figures =
      forward::eigen_figures(input, bar.fields, &*bar.model);
  nlohmann::ordered_json told;
  forward::add_eigen_json(figures, told);
  EXPECT_EQ(told["natural_frequencies"]["supports_of"], "pull");
  EXPECT_EQ(told["natural_frequencies"]["values"].size(), 3U);
  EXPECT_EQ(told["buckling"]["push"]["factors"].size(), 2U);
  EXPECT_LE(told["buckling"]["push"]["residuals"][1].get<double>(), 1e-6);
  EXPECT_THAT(
      forward::eigen_text(figures),
      AllOf(HasSubstr("  buckling of 'push': "),
            HasSubstr(" x the loads on this mesh alone, whose error is not"),
            HasSubstr("  natural frequencies, held as in 'pull': ")));
  std::vector<std::string> names;
  for (const forward::ModeShape& mode : forward::mode_shapes(input, figures)) {
    names.push_back(mode.name);
    EXPECT_EQ(mode.shape.size(),
              static_cast<Eigen::Index>(3 * bar.fields.mesh.nodes.size()));
  }
  EXPECT_THAT(names,
              testing::IsSupersetOf({"mode_1", "mode_2", "mode_3",
                                     "buckling_push_1", "buckling_push_2"}));
}

TEST(EigenFigures, OfAFreePartCountItsRigidMotions) {
  const forward::EigenFigures figures =
      Bar(100.0).figures({.frequencies = 2,
                          .supports_of = case_data::AnalysisEntry::kFree,
                          .buckling = 0});
  nlohmann::ordered_json told;
  forward::add_eigen_json(figures, told);
  EXPECT_EQ(told["natural_frequencies"]["supports_of"], "free");
  EXPECT_EQ(told["natural_frequencies"]["rigid_motions"], 6);
  EXPECT_EQ(told["natural_frequencies"]["values"].size(), 2U);
  EXPECT_THAT(forward::eigen_text(figures),
              HasSubstr("6 rigid motions left out"));
}

TEST(EigenFigures, WarnOfAFactorBelowOne) {
  EXPECT_THAT(
      forward::eigen_warnings(Bar(1e5).figures({})),
      testing::Contains(AllOf(HasSubstr("buckling factor below 1"),
                              HasSubstr("load case 'push' buckles at"))));
}

/// The pushed bar, with a yield strength and an error, 0.1 of the factor.
modes::BucklingFigures judged(double push, double yield, double error) {
  Bar bar(push);
  bar.fields.inputs.materials[0].yield_strength = yield;
  modes::BucklingFigures figures = bar.figures({.buckling = 1}).buckling[0];
  figures.errors = {error * figures.modes.factors.at(0)};
  return figures;
}

TEST(BucklingVerdict, IsOfFactorErrorAndYield) {
  using modes::BucklingVerdict;
  // Euler's stress of the bar: pi^2 E h^2 / (48 L^2), 276 MPa.
  constexpr double kCritical = 276.0;
  const modes::BucklingFigures stands = judged(100.0, 300.0, 0.1);
  EXPECT_EQ(verdict_of(stands), BucklingVerdict::Stands);
  EXPECT_NEAR(slenderness(stands, 0), std::sqrt(300.0 / kCritical), 0.05);
  EXPECT_NEAR(safe_factor(stands), 0.9 * stands.modes.factors[0], 1e-9);
  EXPECT_THAT(buckling_text(stands),
              AllOf(HasSubstr(" +- "), HasSubstr(" x the loads, before it")));
  // Where yield is a hundredth of it, nothing buckles that matters.
  const modes::BucklingFigures stocky = judged(100.0, kCritical / 100.0, 0.1);
  EXPECT_EQ(verdict_of(stocky), BucklingVerdict::BeyondYield);
  EXPECT_THAT(buckling_text(stocky),
              testing::MatchesRegex("none that matters below 2\\.[0-9] x the "
                                    "loads, where its stress is [0-9.e+]+ "
                                    "times yield"));
  EXPECT_EQ(safe_factor(stocky), stocky.modes.factors[0]);
  EXPECT_THAT(modes::buckling_warnings(stocky), IsEmpty());
}

TEST(BucklingVerdict, SaysHowSureItIs) {
  using modes::BucklingVerdict;
  const double critical = 100.0 * judged(100.0, 300.0, 0.0).modes.factors[0];
  EXPECT_EQ(verdict_of(judged(critical / 0.8, 300.0, 0.1)),
            BucklingVerdict::Buckles);
  const modes::BucklingFigures near = judged(critical / 1.05, 300.0, 0.1);
  EXPECT_EQ(verdict_of(near), BucklingVerdict::Uncertain);
  EXPECT_THAT(modes::buckling_warnings(near),
              ElementsAre(HasSubstr("within its error of 1")));
  const modes::BucklingFigures apart = judged(critical / 9.0, 300.0, 0.71);
  EXPECT_EQ(verdict_of(apart), BucklingVerdict::Stands);
  EXPECT_THAT(buckling_text(apart),
              HasSubstr("no certain factor: 9 x the loads on this mesh, no "
                        "less than 2.6 on others"));
  modes::BucklingFigures alone = judged(critical / 9.0, 300.0, 0.0);
  alone.errors.clear();
  EXPECT_EQ(verdict_of(alone), BucklingVerdict::Uncertain);
  EXPECT_EQ(safe_factor(alone), 0.0);
}

TEST(BucklingVerdict, WithoutAYieldStrengthIsOfTheStrain) {
  Bar bar(100.0);
  modes::BucklingFigures figures = bar.figures({.buckling = 1}).buckling[0];
  EXPECT_TRUE(std::isnan(slenderness(figures, 0)));
  EXPECT_TRUE(matters(figures, 0));
  figures.stresses[0].strain = 0.11 / figures.modes.factors[0];
  EXPECT_FALSE(matters(figures, 0));
  EXPECT_THAT(buckling_text(figures), HasSubstr("it is strained by 11 %"));
}

TEST(EigenFigures, WithoutAnAnswerSayWhy) {
  forward::EvaluationFields fields = Bar(100.0).fields;
  fields.inputs.materials[0].density = 0.0;
  const elastic::ElasticModel model(fields.mesh, fields.inputs.materials,
                                    fields.inputs.load_cases);
  case_data::Case input;
  input.analysis = {.frequencies = 2, .buckling = 0};
  const forward::EigenFigures figures =
      forward::eigen_figures(input, fields, &model);
  EXPECT_THAT(forward::eigen_warnings(figures),
              ElementsAre(HasSubstr("'steel' of region 0 has density 0")));
}

TEST(EigenFigures, AreLeftOutWithARemarkWhereTheMatrixIsSpread) {
  const Bar bar(100.0);
  case_data::Case input;
  input.analysis.solver = equations::SolverKind::Distributed;
  const forward::EigenFigures figures =
      forward::eigen_figures(input, bar.fields, &*bar.model);
  EXPECT_THAT(figures.buckling, IsEmpty());
  EXPECT_THAT(forward::eigen_warnings(figures),
              ElementsAre(HasSubstr("no buckling factors: the solver petsc")));
  input.analysis.buckling = 0;
  EXPECT_THAT(forward::eigen_warnings(
                  forward::eigen_figures(input, bar.fields, &*bar.model)),
              IsEmpty());
}

case_data::Case strut_with(const std::string& analysis) {
  const reader::CaseReading reading =
      reader::read_case_text(strut() + analysis, "case.toml");
  EXPECT_THAT(reading.problems, IsEmpty());
  return *reading.input;
}

TEST(AnalysisTable, KnowsTheSolver) {
  EXPECT_EQ(strut_with("").analysis.solver, equations::SolverKind::Automatic);
  for (const auto& [name, kind] :
       {std::pair("auto", equations::SolverKind::Automatic),
        std::pair("cholmod", equations::SolverKind::Cholesky),
        std::pair("p-multigrid", equations::SolverKind::Multigrid),
        std::pair("petsc", equations::SolverKind::Distributed)}) {
    const case_data::Case input =
        strut_with(fmt::format("[analysis]\nsolver = \"{}\"\n", name));
    EXPECT_EQ(input.analysis.solver, kind);
    EXPECT_EQ(input.analysis.processes, 2);
    EXPECT_NE(input.hash, strut_with("").hash) << "last digits depend on it";
  }
  EXPECT_EQ(strut_with("[analysis]\nsolver = \"petsc\"\nprocesses = 7\n")
                .analysis.processes,
            7);
}

TEST(AnalysisTable, RefusesWhatTheSolverCannotDo) {
  const auto problems = [](const std::string& keys) {
    return problems_of(strut() + "[analysis]\n" + keys);
  };
  EXPECT_THAT(problems("solver = \"pets\"\n"), SizeIs(1));
  EXPECT_THAT(problems("solver = \"petsc\"\nprocesses = 0\n"), SizeIs(1));
  EXPECT_THAT(problems("processes = 2\n"),
              ElementsAre(HasSubstr("belongs to solver = \"petsc\"")));
  EXPECT_THAT(problems("solver = \"petsc\"\nbuckling = 1\n"),
              ElementsAre(HasSubstr("analysis.buckling needs the matrix")));
  EXPECT_THAT(problems("solver = \"petsc\"\nfrequencies = 2\n"),
              ElementsAre(HasSubstr("analysis.frequencies needs the matrix")));
  EXPECT_THAT(problems("solver = \"petsc\"\nbuckling = 0\n"), IsEmpty());
}

TEST(AnalysisTable, IsRead) {
  const case_data::Case plain = strut_with("");
  EXPECT_EQ(plain.analysis.frequencies, 0);
  EXPECT_FALSE(plain.analysis.buckling);
  const case_data::Case full = strut_with(
      "[analysis]\nfrequencies = 6\nsupports_of = \"service\"\nbuckling = 3\n");
  EXPECT_EQ(full.analysis.frequencies, 6);
  EXPECT_EQ(full.analysis.supports_of, 0);
  EXPECT_EQ(full.analysis.buckling, 3);
  const case_data::Case loose =
      strut_with("[analysis]\nfrequencies = 6\nsupports_of = \"free\"\n");
  EXPECT_EQ(loose.analysis.supports_of, case_data::AnalysisEntry::kFree);
  EXPECT_EQ(full.hash, plain.hash) << "no evaluation depends on it";
}

TEST(AnalysisTable, WrongNumbersAndNamesAreRefused) {
  const auto problems = [](const std::string& line) {
    return problems_of(strut() + "[analysis]\n" + line + "\n");
  };
  EXPECT_THAT(problems("frequencies = -1"),
              ElementsAre(HasSubstr("analysis.frequencies is -1; expected a "
                                    "whole number from 0 to 50")));
  EXPECT_THAT(problems("buckling = true"),
              ElementsAre(HasSubstr("analysis.buckling")));
  EXPECT_THAT(problems("buckling = 2.5"),
              ElementsAre(HasSubstr("a whole number from 0 to 50")));
  EXPECT_THAT(problems("supports_of = \"servce\""),
              ElementsAre(HasSubstr("did you mean 'service'?")));
  EXPECT_THAT(problems("frequency = 3"),
              ElementsAre(HasSubstr("did you mean 'frequencies'?")));
  EXPECT_THAT(problems_of(changed(strut(), "2.8e-9", "0") +
                          "[analysis]\nfrequencies = 1\n"),
              ElementsAre(HasSubstr("density is 0, but natural frequencies")));
  EXPECT_THAT(problems_of(tube("films = [\"skin\"]\nthickness = 2\n") +
                          "[analysis]\nfrequencies = 2\n"),
              ElementsAre(HasSubstr("analysis needs a load case")));
}

}  // namespace
}  // namespace meniscus::eigen_figures_test
