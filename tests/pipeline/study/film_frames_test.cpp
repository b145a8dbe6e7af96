// Which designs of a study are shown, and what it tells of each.
#include "pipeline/frames/film_frames.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/atomic_file.h"
#include "pipeline/study/progress_tracker.h"
#include "pipeline/study/study.h"
#include "tests/support/case_text.h"
#include "tests/support/temp_folder.h"

namespace meniscus::film_frames_test {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using testing::Not;

/// The strut's responses: sway, mass.
store::EvaluationRecord record(int number, double sway, double mass,
                               const char* phase = "step") {
  store::EvaluationRecord record;
  record.number = number;
  record.phase = phase;
  record.input_names = {"foot"};
  record.inputs = VectorX::Constant(1, 20.0 + number);
  record.response_names = {"sway", "mass"};
  record.responses = Eigen::Vector2d(sway, mass);
  return record;
}

case_data::Case minimized() {
  case_data::Case input = *reader::read_case_text(strut(), "case.toml").input;
  input.study.kind = case_data::StudyKind::Minimize;
  input.study.objective = 1;
  input.study.constraints = {{.response = 0, .upper = 1.0}};
  input.study.max_evaluations = 10;
  return input;
}

std::vector<int> numbers_of(const std::vector<frames::KeptDesign>& kept) {
  std::vector<int> numbers;
  for (const frames::KeptDesign& design : kept) {
    numbers.push_back(design.record->number);
  }
  return numbers;
}

TEST(KeptDesigns, AreTheStartWhatIsBetterAndTheBest) {
  const case_data::Case input = minimized();
  std::vector<store::EvaluationRecord> records = {
      record(1, 2.0, 5.0, "start"), record(2, 1.9, 5.0, "difference"),
      record(3, 1.5, 6.0),          record(4, 1.7, 4.0),
      record(5, 0.9, 7.0),          record(6, 0.8, 6.5),
      record(7, 0.7, 9.0),          record(8, 0.9, 6.0)};
  records[5].failure = Failure{FailureKind::FilmNotFound, "none"};
  store::EvaluationRecord other = record(9, 0.1, 0.1);
  other.model = "coarse x2";
  records.push_back(other);
  const auto kept = frames::kept_designs(input, records, records[7].inputs);
  EXPECT_THAT(numbers_of(kept), ElementsAre(1, 3, 5, 8));
  EXPECT_STREQ(kept.front().why, "start");
  EXPECT_STREQ(kept[1].why, "better");
  EXPECT_STREQ(kept.back().why, "best");
  EXPECT_THAT(
      numbers_of(frames::kept_designs(input, records, records[4].inputs, 2)),
      ElementsAre(1, 5));
}

TEST(KeptDesigns, OfASweepAreAllOrSomeEvenlyChosen) {
  case_data::Case input = minimized();
  input.study.kind = case_data::StudyKind::Sweep;
  input.study.objective.reset();
  std::vector<store::EvaluationRecord> records;
  for (int k = 1; k <= 41; ++k) {
    records.push_back(record(k, 1.0, 1.0, "sweep"));
  }
  EXPECT_EQ(frames::kept_designs(input, records, records[0].inputs, 50).size(),
            41);
  EXPECT_THAT(
      numbers_of(frames::kept_designs(input, records, records[0].inputs, 5)),
      ElementsAre(1, 11, 21, 31, 41));
  // The best takes the place of a neighbour.
  EXPECT_THAT(
      numbers_of(frames::kept_designs(input, records, records[12].inputs, 5)),
      ElementsAre(1, 11, 13, 31, 41));
}

TEST(FilmFrames, HaveTheEvaluationsOwnBits) {
  const TempFolder folder;
  const case_data::Case input =
      *reader::read_case_text(strut(), "case.toml").input;
  store::StudyStore store = store::StudyStore::start(folder.path().string(),
                                                     {.case_hash = input.hash});
  forward::EvaluationFields fields;
  const study::RunResult result = study::run_study(
      input, store, {.estimate_errors = false, .frames = 24}, &fields);
  ASSERT_FALSE(fields.history.empty());
  const forward::FilmFrame& last = fields.history.back();
  EXPECT_EQ(last.design, result.best->design);
  ASSERT_EQ(last.surface.points.size(), fields.surface.base.points.size());
  for (std::size_t i = 0; i < last.surface.points.size(); ++i) {
    EXPECT_EQ(last.surface.points[i], fields.surface.base.points[i]);
  }
  frames::write_frames(input, fields.history, folder.path());
  EXPECT_THAT(read_file(folder.path() / "frames.pvd"),
              HasSubstr("frames/" + frames::frame_name(last.evaluation)));
  frames::remove_frames(folder.path());
  EXPECT_FALSE(std::filesystem::exists(folder.path() / "frames"));
  EXPECT_FALSE(std::filesystem::exists(folder.path() / "frames.pvd"));
}

TEST(ProgressTracker, KnowsTheBestSoFarAndWhatIsLeft) {
  const case_data::Case input = minimized();
  study::ProgressTracker tracker(input, store::kStudyModel);
  tracker.add(record(1, 2.0, 5.0));  // found in the database
  store::EvaluationRecord failed = record(2, 0.0, 0.0);
  failed.failure = Failure{FailureKind::FilmNotFound, "none"};
  EXPECT_EQ(tracker.add_new(failed).best->evaluation, 1);
  const store::EvaluationRecord good = record(3, 0.5, 6.0);
  const study::EvaluationEvent event = tracker.add_new(good);
  EXPECT_EQ(event.best->evaluation, 3);
  EXPECT_EQ(event.status.objective, 6.0);
  EXPECT_EQ(event.status.violation, 0.0);
  EXPECT_EQ(event.evaluations, 3);
  EXPECT_EQ(event.failed, 1);
  EXPECT_EQ(event.planned, 10);
  EXPECT_TRUE(event.left);
  EXPECT_THAT(study::progress_text(event), HasSubstr("the best so far"));
  const store::EvaluationRecord worse = record(4, 1.5, 3.0);
  const std::string text = study::progress_text(tracker.add_new(worse));
  EXPECT_THAT(text, HasSubstr("violation 0.5 of '"));
  EXPECT_THAT(text, HasSubstr("best so far mass = 6000 kg (evaluation 3)"));
  EXPECT_THAT(study::duration_text(61.0), Not(HasSubstr("min")));
  EXPECT_EQ(study::duration_text(119.5), "2 min");
}

}  // namespace
}  // namespace meniscus::film_frames_test
