#include "pipeline/study/own_mesh.h"

#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/support/case_text.h"
#include "tests/support/temp_folder.h"

namespace meniscus::own_mesh_test {
namespace {

/// A strut whose head is shifted along x, farther than a mesh follows, for the
/// least centre of mass above a bound.
case_data::Case leaning_strut(double least_centre, int max_evaluations) {
  std::string text = changed(strut(), "[curves.base]",
                             "[design.lean]\ninitial = 0\nbounds = [-60, 60]\n"
                             "\n[curves.base]");
  text = changed(text, "center = [0, 0, \"length\"]",
                 "center = [\"lean\", 0, \"length\"]");
  text = changed(text, "fea = 6.0\nfilm = 3.0", "fea = 9.0\nfilm = 4.5");
  text = text.substr(0, text.find("[responses.mass]")) +
         "[responses.centre]\nkind = \"centre_of_mass\"\n"
         "direction = [1, 0, 0]\n\n"
         "[study]\nkind = \"minimize\"\nobjective = \"centre\"\n"
         "constraints = [{ response = \"centre\", min = " +
         std::to_string(least_centre) +
         " }]\nmax_evaluations = " + std::to_string(max_evaluations) + "\n";
  return *reader::read_case_text(text, "case.toml").input;
}

/// A study of it, at its start.
struct OpenStudy {
  explicit OpenStudy(double least_centre, int max_evaluations = 400)
      : input(leaning_strut(least_centre, max_evaluations)) {
    models.freeze();
  }

  case_data::Case input;
  TempFolder folder;
  store::StudyStore store = store::StudyStore::start(folder.path().string(),
                                                     {.case_hash = input.hash});
  study::StudyModels models{input, store, {}};
  study::DeadlineMonitor unlimited{silent_monitor(), 0.0};
};

// Seeking a bound that cannot be kept, the first search ends as far to the
// right as may be; the one from the mesh made there has to end far to the left.
TEST(OwnMesh, ASearchThatLeavesItsReachGoesOnOnNewModels) {
  constexpr double kLeast = -20.0;
  OpenStudy open(kLeast);
  study::StudyModels& models = open.models;
  models.working().study.constraints[0].lower = 1000.0;
  models.stage()->conduct();
  ASSERT_FALSE(all_kept(models.stage()->outcome().constraints));

  int rounds = 0;
  ASSERT_TRUE(study::judge_answer(models, open.unlimited, [&] {
    ++rounds;
    models.working().study.constraints[0].lower = kLeast;
  }));
  EXPECT_GE(rounds, 1);
  const study::StudyOutcome& found = models.stage()->outcome();
  EXPECT_EQ(found.status, study::RunStatus::Converged) << found.message;
  EXPECT_NEAR(models.answer().responses[1], kLeast, 0.02);
  study::RunResult result;
  models.add_to(result);
  std::vector<std::string> others;
  bool own = false;
  for (const store::Refreeze& model : result.refrozen) {
    const bool of_answer = model.reason == "the answer on a mesh of its own";
    if (own && !of_answer) {
      others.push_back(model.reason);
    }
    own = own || of_answer;
  }
  EXPECT_FALSE(others.empty());
}

// One evaluation more, and its figures are those that are judged.
TEST(OwnMesh, TheBestOfALimitedSearchIsJudgedOnItsOwnMesh) {
  constexpr int kMost = 3;
  OpenStudy open(-20.0, kMost);
  study::StudyModels& models = open.models;
  models.stage()->conduct();
  const VectorX best = models.stage()->outcome().best;
  ASSERT_TRUE(models.stage()->outcome().ended_by_limit());
  ASSERT_TRUE(models.has_dragged_answer());

  ASSERT_TRUE(study::judge_answer(models, open.unlimited,
                                  [] { FAIL() << "nothing goes on"; }));
  const study::StudyOutcome& found = models.stage()->outcome();
  EXPECT_EQ(found.status, study::RunStatus::Stopped);
  EXPECT_EQ(found.best, best);
  EXPECT_EQ(models.stage()->start().design, best);
  EXPECT_EQ(found.objective, models.stage()->start().responses[1]);
  EXPECT_EQ(std::ssize(open.store.all()), kMost + 1);
  EXPECT_FALSE(models.has_dragged_answer());
}

TEST(OwnMesh, AStudyThatTheTimeEndedIsNotJudgedOnOne) {
  OpenStudy open(-20.0, 3);
  study::StudyModels& models = open.models;
  models.stage()->conduct();
  const study::DeadlineMonitor late(silent_monitor(), 1e-9);
  ASSERT_TRUE(study::judge_answer(models, late, [] {}));
  EXPECT_TRUE(models.has_dragged_answer());
  study::RunResult result;
  models.add_to(result);
  EXPECT_THAT(result.warnings,
              testing::ElementsAre(testing::HasSubstr("the time ended")));
}

/// Searches for a centre of mass that may be beyond the case's bound, by one of
/// its own, and returns to what is kept.
struct Returned {
  bool returned = false;
  study::StudyOutcome outcome;
  VectorX responses;
  VectorX of_the_start;
  std::string answering;
};

Returned return_from(double bound, double sought) {
  OpenStudy open(bound);
  study::StudyModels& models = open.models;
  Returned result;
  result.of_the_start = models.stage()->start().responses;
  models.working().study.constraints[0].lower = sought;
  models.stage()->conduct();
  EXPECT_TRUE(study::judge_answer(models, open.unlimited, [] {}));
  result.returned = study::return_to_kept(models);
  result.outcome = models.stage()->outcome();
  result.responses = models.stage()->start().responses;
  result.answering = store::answering_model(open.store.all());
  return result;
}

// A search that misses the bound leaves the start, which keeps it: its own
// model again, to the bit.
TEST(OwnMesh, AMinimumThatIsNotKeptGivesWayToTheBestThatIs) {
  const Returned at = return_from(-20.0, -26.0);
  ASSERT_TRUE(at.returned) << at.outcome.message;
  EXPECT_EQ(at.outcome.status, study::RunStatus::Stopped);
  EXPECT_TRUE(all_kept(at.outcome.constraints));
  EXPECT_THAT(at.outcome.message, testing::HasSubstr("'centre' is -"));
  EXPECT_THAT(at.outcome.message,
              testing::HasSubstr("that of evaluation 1 is the best"));
  EXPECT_EQ(at.outcome.best[1], 0.0);
  EXPECT_EQ(at.responses, at.of_the_start);
  EXPECT_EQ(at.answering, store::refrozen_model(1));
}

// The bounds of the search may be above those of the case, as of a margin that
// is doubted: what misses only them is the answer.
TEST(OwnMesh, AMinimumThatMissesRaisedBoundsAloneStays) {
  const Returned at = return_from(-20.0, 1000.0);
  EXPECT_FALSE(at.returned) << at.outcome.message;
  EXPECT_FALSE(all_kept(at.outcome.constraints));
}

TEST(OwnMesh, AMinimumThatIsKeptButForTheMeshesNoiseStays) {
  const Returned at = return_from(-20.0, -20.1);
  EXPECT_FALSE(at.returned) << at.outcome.message;
  EXPECT_NEAR(at.responses[1], -20.1, 0.1);
  const Returned beside_zero = return_from(0.0, -0.005);
  EXPECT_FALSE(beside_zero.returned) << beside_zero.outcome.message;
}

}  // namespace
}  // namespace meniscus::own_mesh_test
