// The speed table at 1/16 of its size: films settle faster than Surface
// Evolver's, at an energy that is no higher.
#include <algorithm>

#include <gtest/gtest.h>

#include "tests/support/evolver.h"
#include "tests/support/film_race.h"

namespace meniscus {
namespace {

constexpr int kScale = 2;  // 1/4^2 of the facets
// At 15k facets our time is mostly that of the coarse levels, which do not
// shrink with the size, and a run of 0.1 s is timed to a third on a busy
// machine: a fifth of the full table's ratios is asked.
constexpr double kLooser = 0.2;
constexpr double kEnergyAbove = 1e-4;  // relative, at equal facet counts
constexpr int kRuns = 3;               // of which the median counts

EvolverRun median_evolver(const SpeedWork& work, EvolverScript script) {
  std::vector<EvolverRun> runs;
  for (int i = 0; i < kRuns; ++i) {
    runs.push_back(
        run_evolver(work.start(), {.refinements = work.refinements - kScale,
                                   .script = script,
                                   .descent = work.descent}));
  }
  std::sort(runs.begin(), runs.end(),
            [](const EvolverRun& a, const EvolverRun& b) {
              return a.user_seconds < b.user_seconds;
            });
  return runs[kRuns / 2];
}

class FilmSpeed : public ::testing::TestWithParam<SpeedWork> {};

TEST_P(FilmSpeed, BeatsSurfaceEvolver) {
  if (!have_evolver()) {
    GTEST_SKIP() << "evolver (Debian package evolver) is not installed";
  }
#ifndef NDEBUG
  GTEST_SKIP() << "times of a build without optimisation say nothing";
#endif
  const SpeedWork& work = GetParam();
  const FilmRun own =
      median_run(work.start(), work.refinements - kScale, kRuns);
  EXPECT_TRUE(own.settled) << own.verdict;
  const EvolverRun tuned = median_evolver(work, EvolverScript::Tuned);
  const EvolverRun typical = median_evolver(work, EvolverScript::Typical);
  ASSERT_TRUE(tuned.ended) << tuned.output;
  ASSERT_TRUE(typical.ended) << typical.output;
  EXPECT_EQ(own.facets, tuned.facets);
  EXPECT_GT(tuned.user_seconds / own.user_seconds, kLooser * work.least_tuned)
      << own.user_seconds << " s";
  EXPECT_GT(typical.user_seconds / own.user_seconds,
            kLooser * work.least_typical)
      << own.user_seconds << " s";
  EXPECT_LT(own.energy, (1.0 + kEnergyAbove) * typical.energy);
}

INSTANTIATE_TEST_SUITE_P(Works, FilmSpeed, ::testing::ValuesIn(speed_works()),
                         [](const auto& work) { return work.param.name; });

}  // namespace
}  // namespace meniscus
