#include "pipeline/study/design_evaluator.h"

#include <atomic>
#include <filesystem>
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/support/case_text.h"
#include "tests/support/temp_folder.h"

namespace meniscus::design_evaluator_test {
namespace {

using testing::SizeIs;

VectorX foot(double radius) { return VectorX::Constant(1, radius); }

/// Asks to stop once so many evaluations were told.
class StoppingMonitor : public Monitor {
 public:
  void stop_after_records(int count) { left_ = count; }
  void log(Severity /*severity*/, const std::string& /*message*/) override {
    --left_;
  }
  bool stop_requested() const override { return left_ <= 0; }

 private:
  std::atomic<int> left_ = 1'000'000;
};

class DesignEvaluatorTest : public testing::Test {
 protected:
  store::StudyStore start(const std::string& name) const {
    const auto folder = folder_.path() / name;
    std::filesystem::create_directory(folder);
    return store::StudyStore::start(folder.string(),
                                    {.case_hash = input_.hash});
  }

  case_data::Case input_ = *reader::read_case_text(strut(), "case.toml").input;
  TempFolder folder_;
};

TEST_F(DesignEvaluatorTest, WritesInOrderEachDesignOnce) {
  const std::vector<VectorX> designs = {foot(30), foot(22), foot(30), foot(24),
                                        foot(26)};
  std::vector<std::vector<store::EvaluationRecord>> found;
  for (const int jobs : {1, 3}) {
    store::StudyStore store = start(std::to_string(jobs));
    study::DesignEvaluator evaluator(input_, store, {.jobs = jobs});
    ASSERT_FALSE(evaluator.model().failure());
    evaluator.evaluate(foot(24), "start");
    const auto records = evaluator.evaluate_all(designs, "sweep");
    EXPECT_EQ(evaluator.counts().evaluations, 6);
    ASSERT_THAT(records, SizeIs(5));
    EXPECT_EQ(records[0].number, records[2].number);
    EXPECT_EQ(records[3].phase, "start") << "known before";
    found.push_back(store.all());
  }
  ASSERT_THAT(found[0], SizeIs(4));
  ASSERT_THAT(found[1], SizeIs(4));
  for (std::size_t k = 0; k < found[0].size(); ++k) {
    EXPECT_EQ(found[0][k].inputs, found[1][k].inputs);
    EXPECT_EQ(found[0][k].responses, found[1][k].responses);
    EXPECT_EQ(found[0][k].figures, found[1][k].figures);
  }
}

TEST_F(DesignEvaluatorTest, FetchedAheadIsNotCountedAndNotComputedAgain) {
  store::StudyStore store = start("ahead");
  study::DesignEvaluator evaluator(input_, store, {.jobs = 2});
  evaluator.prefetch({foot(22), foot(30)}, "difference");
  EXPECT_EQ(store.size(), 2);
  EXPECT_EQ(evaluator.counts().evaluations, 0);
  EXPECT_EQ(evaluator.evaluate(foot(30), "step").phase, "difference");
  EXPECT_EQ(store.size(), 2);
  EXPECT_EQ(evaluator.counts().evaluations, 1);
}

/// Whether the stiffness of each design is kept or only that of those whose
/// gradient is asked for.
TEST_F(DesignEvaluatorTest, AGradientIsOfItsOwnDesign) {
  std::vector<Eigen::RowVectorXd> gradients;
  for (const bool kept : {true, false}) {
    store::StudyStore store = start(kept ? "kept" : "again");
    study::DesignEvaluator evaluator(input_, store, {.with_gradients = kept});
    for (const double radius : {22.0, 30.0}) {
      evaluator.evaluate(foot(radius), "step");
      const optimize::JacobianAnswer answer =
          evaluator.gradient(foot(radius), {0});
      ASSERT_FALSE(answer.failure);
      gradients.emplace_back(answer.jacobian.row(0));
    }
  }
  EXPECT_NE(gradients[0], gradients[1]);
  EXPECT_EQ(gradients[0], gradients[2]);
  EXPECT_EQ(gradients[1], gradients[3]);
}

TEST_F(DesignEvaluatorTest, ATimeLimitKeepsTheBeginning) {
  store::StudyStore store = start("hurried");
  study::DesignEvaluator evaluator(input_, store, {.jobs = 2});
  evaluator.limit_time(1e-6);
  EXPECT_THAT(evaluator.evaluate_all({foot(22), foot(30)}, "sweep"), SizeIs(0));
  evaluator.limit_time(0.0);
  EXPECT_THAT(evaluator.evaluate_all({foot(22), foot(30)}, "sweep"), SizeIs(2));
}

TEST_F(DesignEvaluatorTest, AStopReachesTheCallerFromEveryJob) {
  StoppingMonitor monitor;
  store::StudyStore store = start("stopped");
  study::DesignEvaluator evaluator(input_, store,
                                   {.jobs = 2, .monitor = &monitor});
  monitor.stop_after_records(1);
  EXPECT_THROW(
      evaluator.evaluate_all({foot(21), foot(22), foot(23), foot(24), foot(26),
                              foot(27), foot(28), foot(29), foot(30)},
                             "sweep"),
      Interrupted);
  EXPECT_GE(store.size(), 1);
  EXPECT_LT(store.size(), 9);
}

}  // namespace
}  // namespace meniscus::design_evaluator_test
