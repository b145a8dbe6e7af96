// When a study freezes a new model, where, and how its database brings the
// models back.
#include "pipeline/store/refreeze.h"

#include <gtest/gtest.h>

#include "tests/support/case_text.h"

namespace meniscus::refreeze_test {
namespace {

/// The strut: foot from 20 to 32, frozen at 25.
case_data::Case strut_case() {
  return *reader::read_case_text(strut(), "case.toml").input;
}

store::EvaluationRecord answered(int number, double foot,
                                 const std::string& model = "base") {
  store::EvaluationRecord record;
  record.number = number;
  record.model = model;
  record.inputs = VectorX::Constant(1, foot);
  record.responses = Eigen::Vector2d(foot, 1.0);
  record.figures = R"({"tet": {"min_dihedral_deg": 12.0}})";
  return record;
}

store::EvaluationRecord inverted(
    int number, double foot, FailureKind kind = FailureKind::ElementsInverted) {
  store::EvaluationRecord record = answered(number, foot);
  record.responses.resize(0);
  record.failure = Failure{kind, "folded"};
  return record;
}

std::optional<store::Refreeze> found(
    const std::vector<store::EvaluationRecord>& records, double best) {
  const case_data::Case input = strut_case();
  const std::string model = "base";
  const VectorX design = VectorX::Constant(1, best);
  return store::find_refreeze({.input = input,
                               .records = records,
                               .model = model,
                               .best = design,
                               .min_dihedral_deg = 12.0});
}

TEST(Refreeze, IsWantedAtTheBestDesignBesideInvertedOnes) {
  const auto wanted =
      found({answered(1, 25.0), answered(2, 27.0), inverted(3, 28.0)}, 27.0);
  ASSERT_TRUE(wanted);
  EXPECT_EQ(wanted->evaluation, 2);
  EXPECT_EQ(wanted->design[0], 27.0);
  EXPECT_EQ(wanted->responses[0], 27.0);
  EXPECT_FALSE(wanted->go_on_from);
  EXPECT_FALSE(found({answered(1, 25.0), answered(2, 27.0)}, 27.0));
}

// A sweep's models answer for the designs that they were made for; the way to
// one of them is in the database, too.
TEST(Refreeze, RejoinedModelsAnswerForTheirDesignsAlone) {
  const case_data::Case input = strut_case();
  EXPECT_TRUE(store::is_study_model(store::rejoined_model(3)));
  const std::vector<store::EvaluationRecord> records = {
      answered(1, 25.0),
      answered(2, 26.0),
      inverted(3, 30.0, FailureKind::FilmRejoins),
      inverted(4, 29.0, FailureKind::FilmRejoins),
      inverted(5, 31.9, FailureKind::FilmRejoins),
      answered(6, 30.0, store::rejoined_model(3))};
  EXPECT_EQ(store::answering_model(records), "base");
  const auto beside = [&](double best) {
    return store::rejoined_beside(input, records, VectorX::Constant(1, best));
  };
  ASSERT_TRUE(beside(27.0));
  EXPECT_EQ(beside(27.0)->number, 4);
  EXPECT_FALSE(beside(25.0));  // a third of the range off
  std::vector<store::EvaluationRecord> later = records;
  later.push_back(answered(7, 30.0, store::refrozen_model(6)));
  const case_data::Case frozen =
      store::frozen_as_answered(input, later, VectorX::Constant(1, 30.0));
  ASSERT_EQ(frozen.earlier_freezes.size(), 1U);
  EXPECT_EQ(frozen.earlier_freezes[0][0], 25.0);
}

// A study that returns to its start begins that model last; one that goes on
// later may end on the model before.
TEST(Refreeze, TheAnsweringModelIsTheLastThatKnowsTheAnswer) {
  const std::string second = store::refrozen_model(2);
  const std::string back = store::refrozen_model(1);
  const std::vector<store::EvaluationRecord> records = {
      answered(1, 25.0),         answered(2, 27.0),
      answered(3, 27.0, second), answered(4, 29.0, second),
      answered(5, 25.0, back),   answered(6, 30.0, second)};
  EXPECT_EQ(store::answering_model(records), back);
  const auto frozen = [&](double answer) {
    return store::frozen_as_answered(strut_case(), records,
                                     VectorX::Constant(1, answer));
  };
  EXPECT_EQ(frozen(25.0).design[0].initial, 25.0);
  EXPECT_TRUE(frozen(25.0).earlier_freezes.empty());
  for (const double answer : {27.0, 29.0, 30.0}) {
    EXPECT_EQ(frozen(answer).design[0].initial, 27.0) << answer;
    EXPECT_EQ(frozen(answer).earlier_freezes.size(), 1U) << answer;
  }
}

TEST(Refreeze, IsWantedBesideFilletsThatTheModelCannotMake) {
  const auto beside = [](FailureKind kind) {
    return found(
        {answered(1, 25.0), answered(2, 27.0), inverted(3, 28.0, kind)}, 27.0);
  };
  EXPECT_TRUE(beside(FailureKind::SurfaceInvalid));
  EXPECT_FALSE(beside(FailureKind::NotANumber));
}

// The best design is the start, since those nearer to the optimum miss a
// constraint or invert: a new model all the same, at one of these.
TEST(Refreeze, IsWantedWhereTheBestDesignIsTheStart) {
  const auto wanted = found({answered(1, 25.0), answered(2, 24.0),
                             answered(3, 27.0), inverted(4, 27.5)},
                            25.0);
  ASSERT_TRUE(wanted);
  EXPECT_EQ(wanted->evaluation, 3);
  EXPECT_EQ(wanted->design[0], 27.0);
  ASSERT_TRUE(wanted->go_on_from);
  EXPECT_EQ((*wanted->go_on_from)[0], 25.0);
  // Nothing else has answered: there is nowhere to freeze one.
  EXPECT_FALSE(found({answered(1, 25.0), inverted(2, 27.5)}, 25.0));
}

TEST(Refreeze, SixInvertedDesignsAnywhereAreEnough) {
  std::vector<store::EvaluationRecord> records = {answered(1, 25.0),
                                                  answered(2, 21.0)};
  for (int k = 0; k < 5; ++k) {
    records.push_back(inverted(3 + k, 31.0 + 0.1 * k));
  }
  EXPECT_FALSE(found(records, 21.0));  // far from the best, and five
  records.push_back(inverted(8, 32.0));
  EXPECT_TRUE(found(records, 21.0));
}

TEST(Refreeze, TheDatabaseBringsBackTheWholeWay) {
  const std::vector<store::EvaluationRecord> records = {
      answered(1, 25.0), answered(2, 27.0),
      answered(3, 27.0, "frozen at evaluation 2"),
      answered(4, 30.0, "frozen at evaluation 2"),
      answered(5, 30.0, "frozen at evaluation 4")};
  const case_data::Case last = store::frozen_as_answered(
      strut_case(), records, VectorX::Constant(1, 30.0));
  EXPECT_EQ(case_data::initial_design(last)[0], 30.0);
  ASSERT_EQ(last.earlier_freezes.size(), 2U);
  EXPECT_EQ(last.earlier_freezes[0][0], 25.0);
  EXPECT_EQ(last.earlier_freezes[1][0], 27.0);
  const case_data::Case first = store::frozen_as_answered(
      strut_case(), {records[0], records[1]}, VectorX::Constant(1, 27.0));
  EXPECT_EQ(case_data::initial_design(first)[0], 25.0);
  EXPECT_TRUE(first.earlier_freezes.empty());
}

}  // namespace
}  // namespace meniscus::refreeze_test
