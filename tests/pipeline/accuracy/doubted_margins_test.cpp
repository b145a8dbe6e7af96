#include "pipeline/accuracy/doubted_margins.h"

#include <limits>
#include <utility>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "pipeline/accuracy/mesh_errors.h"
#include "pipeline/study/study_records.h"
#include "tests/support/case_text.h"

namespace meniscus::doubted_margins_test {
namespace {

using testing::HasSubstr;
using testing::Not;

constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();
constexpr double kInfinity = std::numeric_limits<double>::infinity();

/// Three margins and a mass; the second is held from above only.
case_data::Case with_margins() {
  case_data::Case input = *reader::read_case_text(strut(), "case.toml").input;
  input.study.kind = case_data::StudyKind::Minimize;
  input.responses.clear();
  for (const char* name : {"wide", "tight", "lost", "mass"}) {
    case_data::ResponseEntry entry;
    entry.name = name;
    entry.kind = std::string(name) == "mass"
                     ? case_data::ResponseKind::Mass
                     : case_data::ResponseKind::CollapseMargin;
    input.responses.push_back(entry);
  }
  input.study.objective = 3;
  input.study.constraints = {{.response = 0, .lower = 1e-4},
                             {.response = 1, .upper = 1e-2},
                             {.response = 1, .lower = 1e-4},
                             {.response = 2, .lower = 1e-4},
                             {.response = 3, .lower = 1.0}};
  return input;
}

TEST(DoubtedMargins, AreThoseThatLessTheirErrorMissTheirBound) {
  const case_data::Case input = with_margins();
  const VectorX values = Eigen::Vector4d(3e-4, 2e-4, 2e-4, 0.5);
  // Above its bound by twice its error, by less than it, and by no known one.
  const VectorX errors = Eigen::Vector4d(1e-4, 1.1e-4, kNaN, 1.0);
  const auto doubted = accuracy::doubted_margins(input, values, errors);
  ASSERT_EQ(doubted.size(), 2);
  EXPECT_EQ(doubted[0].constraint, 2);
  EXPECT_EQ(doubted[0].name, "tight");
  EXPECT_EQ(doubted[0].lower, 1e-4);
  EXPECT_THAT(accuracy::doubt_text(doubted[0]), HasSubstr("0.00011"));
  EXPECT_EQ(doubted[1].constraint, 3);
  EXPECT_THAT(accuracy::doubt_text(doubted[1]),
              HasSubstr("other facets have no"));
}

TEST(DoubtedMargins, AreNotThoseOnTheirBoundWithoutAnError) {
  const case_data::Case input = with_margins();
  const double on_bound = 1e-4 * (1.0 - 1e-7);
  const VectorX values = Eigen::Vector4d(on_bound, on_bound, on_bound, 0.5);
  EXPECT_TRUE(
      accuracy::doubted_margins(input, values, VectorX::Zero(4)).empty());
}

TEST(DoubtedMargins, AreHeldAboveTheirErrorAndTheirBound) {
  const accuracy::HeldMargin known{
      .value = 2e-4, .error = 1.5e-4, .lower = 1e-4};
  const double raised = accuracy::raised_bound(known, 1e-4);
  EXPECT_GT(raised, known.value);
  EXPECT_GT(raised,
            accuracy::margin_to_hold(known.lower, known.value, known.error));
  EXPECT_LT(raised, 1.5 * known.value);
  EXPECT_GT(accuracy::raised_bound(known, 5e-4), 5e-4);
  // A wild error sends no study away at once.
  accuracy::HeldMargin wild = known;
  wild.error = 100.0 * wild.value;
  EXPECT_DOUBLE_EQ(accuracy::raised_bound(wild, 1e-4), 1.5 * wild.value);
  const accuracy::HeldMargin lost{.value = 2e-4, .error = kNaN, .lower = 1e-4};
  EXPECT_GT(accuracy::raised_bound(lost, 1e-4), lost.value);
  EXPECT_LT(accuracy::raised_bound(lost, 1e-4), kInfinity);
}

TEST(DoubtedMargins, AreForeseenWhereTheyAreNearTheirBound) {
  const accuracy::HeldMargin near{.value = 3e-4, .error = 3e-5, .lower = 2e-4};
  const double foreseen = accuracy::foreseen_bound(near, near.lower);
  EXPECT_GT(foreseen, accuracy::margin_to_hold(2e-4, 3e-4, 3e-5));
  EXPECT_LT(foreseen, 1.5 * near.lower);
  EXPECT_DOUBLE_EQ(accuracy::foreseen_bound(near, 5e-4), 5e-4);
  for (const auto& [value, error] :
       {std::pair{3e-4, 2e-3}, {3e-4, kNaN}, {1e-3, 1e-4}}) {
    accuracy::HeldMargin other = near;
    other.value = value;
    other.error = error;
    EXPECT_DOUBLE_EQ(accuracy::foreseen_bound(other, 2e-4), 2e-4);
  }
}

TEST(Describe, NamesWhatTheStudyAsksForWhereThereIsMuch) {
  case_data::Case input = with_margins();
  store::EvaluationRecord record;
  record.number = 7;
  record.phase = "step";
  const int variables = 9;
  input.design.resize(variables);
  for (std::size_t k = 0; k < input.design.size(); ++k) {
    input.design[k].name = "x" + std::to_string(k);
  }
  record.input_names = case_data::design_names(input);
  record.inputs = VectorX::Constant(variables, 2.0);
  const case_data::ResponseEntry margin = input.responses[0];
  while (input.responses.size() < 20) {
    input.responses.insert(input.responses.begin(), margin);
    input.responses.front().name =
        "more" + std::to_string(20 - input.responses.size());
  }
  const int mass = 19;
  input.study.objective = mass;
  input.study.constraints = {{.response = 18, .lower = 1e-4}};
  record.response_names = case_data::response_names(input);
  record.responses = VectorX::Constant(20, 0.25);
  const std::string text = study::describe(input, record);
  EXPECT_THAT(text, Not(HasSubstr("x0")));
  EXPECT_THAT(text, HasSubstr("evaluation 7 (step): mass = "));
  EXPECT_THAT(text, HasSubstr("lost = "));
  EXPECT_LT(text.size(), 200U);
  input.design.resize(2);
  record.input_names.resize(2);
  record.inputs.conservativeResize(2);
  EXPECT_THAT(study::describe(input, record), HasSubstr("x0 = 2 x1 = 2; mass"));
  // A vector counts as one.
  input.design.resize(variables);
  input.vectors = {{.name = "t", .shape = {2, 4}, .first = 1}};
  record.input_names = case_data::design_names(input);
  record.inputs = VectorX::LinSpaced(variables, 1.0, 9.0);
  EXPECT_THAT(study::describe(input, record),
              HasSubstr("x0 = 1 t = 2 to 9, mean 5.5; mass"));
  record.failure = Failure{FailureKind::FilmPinched, "a neck"};
  EXPECT_THAT(study::describe(input, record),
              HasSubstr("; cannot evaluate here: a neck"));
}

}  // namespace
}  // namespace meniscus::doubted_margins_test
