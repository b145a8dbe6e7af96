// The speed table at 1/16 of its size: films settle faster than Surface
// Evolver's, at an energy that is no higher.
#include <gtest/gtest.h>

#include "tests/support/evolver.h"
#include "tests/support/film_race.h"
#include "tests/support/not_here.h"

namespace meniscus::film_speed_test {
namespace {

constexpr int kScale = 2;  // 1/4^2 of the facets
// At 15k facets our time is mostly that of the coarse levels, which do not
// shrink with the size, and a run of 0.1 s is timed to a third on a busy
// machine: a fifth of the full table's ratios is asked.
constexpr double kLooser = 0.2;
constexpr double kEnergyAbove = 1e-4;  // relative, at equal facet counts
constexpr int kRuns = 5;               // of which the fastest counts

EvolverRun evolver_run(const SpeedWork& work, EvolverScript script) {
  return fastest(kRuns, [&] {
    return run_evolver(work.start(), {.refinements = work.refinements - kScale,
                                      .script = script,
                                      .descent = work.descent});
  });
}

class FilmSpeed : public ::testing::TestWithParam<SpeedWork> {};

TEST_P(FilmSpeed, BeatsSurfaceEvolver) {
  if (!have_evolver()) {
    MENISCUS_NOT_HERE("evolver (Debian package evolver) is not installed");
  }
#ifndef NDEBUG
  MENISCUS_NOT_HERE("times of a build without optimisation say nothing");
#endif
  const SpeedWork& work = GetParam();
  const FilmRun own = fastest(
      kRuns, [&] { return run_film(work.start(), work.refinements - kScale); });
  EXPECT_TRUE(own.settled) << own.verdict;
  const EvolverRun tuned = evolver_run(work, EvolverScript::Tuned);
  const EvolverRun typical = evolver_run(work, EvolverScript::Typical);
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
}  // namespace meniscus::film_speed_test
