/// The case that `meniscus new` writes: it reads back, runs, matches, and its
/// study can be exported and stored.
#include <filesystem>
#include <omp.h>

#include <gtest/gtest.h>

#include "core/atomic_file.h"
#include "pipeline/reader/case_reader.h"
#include "pipeline/results/export_part.h"
#include "pipeline/results/new_case.h"
#include "pipeline/results/results.h"
#include "pipeline/store/stored_case.h"
#include "pipeline/study/match_targets.h"
#include "pipeline/study/partial_result.h"
#include "tests/support/temp_folder.h"

namespace meniscus::start_case_test {
namespace {

const std::vector<std::string> kCoarse = {"resolution.fea=10",
                                          "resolution.film=5"};

case_data::Case start_case(std::vector<std::string> overrides = kCoarse) {
  reader::CaseReading reading = reader::read_case_text(
      results::new_case_text("strut"), "strut/case.toml", overrides);
  EXPECT_TRUE(reading.input)
      << (reading.problems.empty() ? "" : reading.problems.front());
  return *reading.input;
}

TEST(StartCase, ReadsBackWithoutProblemsOrWarnings) {
  for (const char* name : {"strut", "a \"quoted\" name", "träger", "a\\b\n"}) {
    const reader::CaseReading reading =
        reader::read_case_text(results::new_case_text(name), "case.toml");
    EXPECT_TRUE(reading.input) << name;
    EXPECT_TRUE(reading.problems.empty()) << name;
    EXPECT_TRUE(reading.warnings.empty()) << name;
  }
}

TEST(StartCase, ItsStudyMatchesAndIsStored) {
  const TempFolder folder;
  const case_data::Case input = start_case();
  store::StudyStore store = store::StudyStore::start(
      folder.path().string(),
      {.case_hash = input.hash, .case_text = store::stored_case(input)});
  const study::RunResult result = study::run_study(input, store, {});
  ASSERT_EQ(result.status, study::RunStatus::Converged) << result.message;
  EXPECT_EQ(store.size(), result.evaluations);
  EXPECT_NEAR(result.best->responses[0], 0.0065, 1e-3 * 0.0065);
  ASSERT_EQ(result.response_errors.size(), 2);
  EXPECT_GT(result.response_errors.minCoeff(), 0.0);
  ASSERT_EQ(result.design_errors.size(), 1);
  EXPECT_GT(result.design_errors[0], 0.0);
  EXPECT_EQ(store::best_record(input, store.all()).inputs, result.best->design);
  const study::RunResult so_far = study::result_so_far(input, store.all());
  EXPECT_EQ(so_far.best->design, result.best->design);
}

TEST(StartCase, ExportsFromTheResultsFolderAlone) {
  const TempFolder folder;
  {
    const case_data::Case input = start_case();
    store::StudyStore store = store::StudyStore::start(
        folder.path().string(),
        {.case_hash = input.hash, .case_text = store::stored_case(input)});
    study::run_study(input, store, {.estimate_errors = false});
  }
  for (const char* format : {"stl", "inp", "vtu"}) {
    const auto file = results::export_part(folder.path(), {.format = format});
    EXPECT_GT(std::filesystem::file_size(file), 10000u) << format;
    const std::string first = read_file(file);
    results::export_part(folder.path(), {.format = format});
    EXPECT_TRUE(first == read_file(file)) << format << " changes its bits";
  }
  const auto finer =
      results::export_part(folder.path(), {.format = "stl", .edge = 5.0});
  EXPECT_EQ(finer.filename(), "part_5.stl");
  EXPECT_THROW(results::export_part(folder.path(), {.format = "dxf"}),
               InvalidInput);
  EXPECT_THROW(results::export_part(folder.path() / "none", {}), Error);
}

TEST(StartCase, WarnsWhereLinearAnalysisEnds) {
  const TempFolder folder;
  std::vector<std::string> overrides = kCoarse;
  overrides.insert(overrides.end(), {"load=3e6", "study.kind=analyse"});
  const case_data::Case input = start_case(overrides);
  store::StudyStore store = store::StudyStore::start(folder.path().string(),
                                                     {.case_hash = input.hash});
  const study::RunResult result =
      study::run_study(input, store, {.estimate_errors = false});
  ASSERT_EQ(result.status, study::RunStatus::Converged) << result.message;
  ASSERT_EQ(result.warnings.size(), 3u);
  EXPECT_NE(result.warnings[0].find("above yield"), std::string::npos);
  EXPECT_NE(result.warnings[1].find("has no limit"), std::string::npos);
  EXPECT_NE(result.warnings[2].find("not small"), std::string::npos);
}

TEST(MatchTargets, ScaleByTheStartAndJudgeByThePresent) {
  case_data::Case input = start_case();
  input.study.equal = {"sway", "mass"};
  input.study.targets = {{"sway", 4.0}};
  VectorX start(2);
  start << 1.0, 3.0;  // mean magnitude 2
  const study::MatchTargets targets(input, start);
  VectorX now(2);
  now << 5.0, -3.0;
  VectorX residuals(2);
  residuals << 8.0 / 2.0, 1.0 / 4.0;
  EXPECT_EQ(targets.residuals(now), residuals);
  VectorX mismatch(2);
  mismatch << 8.0 / 4.0, 1.0 / 4.0;
  EXPECT_EQ(targets.mismatch(now), mismatch);
  VectorX errors(2);
  errors << 0.1, 0.3;  // of two responses: they add
  VectorX expected(2);
  expected << 0.4 / 2.0, 0.1 / 4.0;
  EXPECT_LT((targets.residual_errors(errors) - expected).norm(), 1e-15);
}

TEST(ForwardModel, ANumberThatFailsBetweenTheBoundsIsAnAnswer) {
  std::vector<std::string> overrides = kCoarse;
  overrides.emplace_back("load=1000 + 0/(foot_radius - 23)");
  const forward::ForwardModel model(start_case(overrides));
  ASSERT_FALSE(model.failure()) << model.failure()->message;
  const forward::Evaluation e = model.evaluate(VectorX::Constant(1, 23.0));
  ASSERT_TRUE(e.failure);
  EXPECT_EQ(e.failure->kind, FailureKind::NotANumber);
  EXPECT_FALSE(model.evaluate(VectorX::Constant(1, 24.0)).failure);
}

TEST(ForwardModel, GivesTheSameBitsOnOneAndTwoThreads) {
  const case_data::Case input =
      start_case({"resolution.fea=5", "resolution.film=2.5"});
  const auto responses = [&](int threads) {
    omp_set_num_threads(threads);
    const forward::ForwardModel model(input);
    EXPECT_FALSE(model.failure());
    return model.evaluate(VectorX::Constant(1, 23.0)).responses;
  };
  const VectorX one = responses(1);
  const VectorX two = responses(2);
  ASSERT_EQ(one.size(), 2);
  EXPECT_EQ(one, two);
}

}  // namespace
}  // namespace meniscus::start_case_test
