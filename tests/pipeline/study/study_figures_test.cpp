#include <cmath>
#include <limits>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "pipeline/reader/case_reader.h"
#include "pipeline/store/incumbent.h"
#include "pipeline/store/refreeze.h"
#include "pipeline/study/front_figures.h"
#include "pipeline/study/sweep_figures.h"
#include "pipeline/study/tolerance_figures.h"
#include "tests/support/case_text.h"

namespace meniscus::study_figures_test {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::Pair;
using testing::SizeIs;

VectorX one(double value) { return VectorX::Constant(1, value); }

store::EvaluationRecord answer(double x, double mass, double sway) {
  store::EvaluationRecord record;
  record.inputs = one(x);
  record.response_names = {"mass", "sway"};
  record.responses = Eigen::Vector2d(mass, sway);
  return record;
}

store::EvaluationRecord failure(double x, FailureKind kind) {
  store::EvaluationRecord record;
  record.inputs = one(x);
  record.response_names = {"mass", "sway"};
  record.failure = Failure{kind, "no film"};
  return record;
}

TEST(SweepFigures, RangesLeaveFailuresOut) {
  const study::SweepFigures figures = study::sweep_figures(
      6,
      {failure(0, FailureKind::FilmUnstable), answer(1, 3, -2), answer(2, 1, 5),
       answer(3, 1, 0), failure(4, FailureKind::FilmUnstable)});
  EXPECT_EQ(figures.designs, 6);
  EXPECT_EQ(figures.looked_at, 5);
  EXPECT_EQ(figures.failed, 2);
  EXPECT_THAT(figures.failures,
              ElementsAre(Pair(name_of(FailureKind::FilmUnstable), 2)));
  ASSERT_THAT(figures.responses, SizeIs(2));
  const study::ResponseRange& mass = figures.responses[0];
  EXPECT_EQ(mass.least, 1.0);
  EXPECT_EQ(mass.least_at, one(2)) << "the first of equal ones";
  EXPECT_EQ(mass.largest_at, one(1));
  EXPECT_DOUBLE_EQ(mass.mean, 5.0 / 3.0);
  EXPECT_EQ(figures.responses[1].least, -2.0);
}

TEST(SweepFigures, NothingThatAnsweredHasNoRange) {
  EXPECT_THAT(
      study::sweep_figures(1, {failure(0, FailureKind::FilmPinched)}).responses,
      IsEmpty());
}

TEST(Incumbent, KeepingConstraintsGoesBeforeTheObjective) {
  case_data::StudyEntry study;
  study.objective = 0;
  study.constraints = {{.response = 1, .upper = 4.0}};
  const auto best = [&](const std::vector<store::EvaluationRecord>& records) {
    const store::EvaluationRecord* found = store::best_by_objective(
        study, records, store::answering_model(records));
    return found == nullptr ? -1.0 : found->inputs[0];
  };
  EXPECT_EQ(best({answer(1, 3, 0), answer(2, 1, 5), answer(3, 2, 4)}), 3);
  EXPECT_EQ(best({answer(1, 3, 9), answer(2, 1, 7)}), 2) << "least violation";
  EXPECT_EQ(best({failure(1, FailureKind::FilmPinched)}), -1);
  EXPECT_DOUBLE_EQ(store::violation_of(study.constraints[0], 6.0), 0.5);
  EXPECT_EQ(store::violation_of(study.constraints[0], -9.0), 0.0);
  EXPECT_DOUBLE_EQ(store::violation_of({.lower = 0.0, .upper = 0.0}, -0.25),
                   0.25);
}

TEST(FrontFigures, MiddleIsNearestToTheBestOfBoth) {
  const std::vector<study::FrontPoint> points = {{.first = 0, .second = 100},
                                                 {.first = 3, .second = 20},
                                                 {.first = 10, .second = 0}};
  EXPECT_EQ(study::middle_of_front(points), 1);
  EXPECT_EQ(study::middle_of_front({points[0]}), 0);
}

TEST(ToleranceFigures, WarnsWhereTheSampleIsFarFromLinear) {
  const case_data::Case input =
      *reader::read_case_text(strut(), "case.toml").input;
  const auto count = static_cast<Eigen::Index>(input.responses.size());
  study::ToleranceFigures figures;
  figures.responses = {0};
  figures.linear.deviation = one(1.0);
  samples::SampledSpread sampled;
  sampled.count = 10;
  sampled.deviation = VectorX::Constant(count, 1.2);
  sampled.deviation_error = VectorX::Constant(count, 0.1);
  figures.sampled = sampled;
  EXPECT_THAT(study::tolerance_warnings(input, figures), IsEmpty());
  figures.sampled->deviation[0] = 1.5;
  EXPECT_THAT(study::tolerance_warnings(input, figures),
              ElementsAre(HasSubstr(input.responses[0].name)));
  figures.sampled.reset();
  EXPECT_THAT(study::tolerance_warnings(input, figures), IsEmpty());
}

}  // namespace
}  // namespace meniscus::study_figures_test
