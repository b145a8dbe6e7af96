#include "optimize/samples/sampling.h"

#include <cmath>
#include <set>

#include <gmock/gmock.h>

#include "tests/support/standard_problems.h"

namespace meniscus::sampling_test {
namespace {

using tests::vector_of;

TEST(Grid, HasEveryCombinationAndTheEnds) {
  const samples::Samples samples = samples::grid_samples({3, 1, 2});
  ASSERT_EQ(samples.size(), 6U);
  EXPECT_EQ(samples[0], vector_of({0.0, 0.5, 0.0}));
  EXPECT_EQ(samples[1], vector_of({0.0, 0.5, 1.0}));
  EXPECT_EQ(samples[3], vector_of({0.5, 0.5, 1.0}));
  EXPECT_EQ(samples[5], vector_of({1.0, 0.5, 1.0}));
  EXPECT_THROW(samples::grid_samples({3, 0}), InvalidInput);
  EXPECT_THROW(samples::grid_samples({}), InvalidInput);
  EXPECT_THROW(samples::grid_samples({10000, 10000}), InvalidInput);
}

TEST(LatinHypercube, PutsOnePointIntoEachSlice) {
  const int count = 37;
  const samples::Samples samples =
      samples::latin_hypercube_samples(5, count, 11);
  for (Eigen::Index j = 0; j < 5; ++j) {
    std::set<int> slices;
    for (const VectorX& t : samples) {
      EXPECT_TRUE(t[j] >= 0.0 && t[j] < 1.0);
      slices.insert(static_cast<int>(std::floor(t[j] * count)));
    }
    EXPECT_EQ(slices.size(), static_cast<std::size_t>(count)) << j;
  }
}

TEST(LatinHypercube, RepeatsBySeed) {
  EXPECT_EQ(samples::latin_hypercube_samples(3, 8, 1),
            samples::latin_hypercube_samples(3, 8, 1));
  EXPECT_NE(samples::latin_hypercube_samples(3, 8, 1),
            samples::latin_hypercube_samples(3, 8, 2));
  // SplitMix64 from seed 1: these bits hold on every platform.
  EXPECT_EQ(samples::latin_hypercube_samples(1, 1, 1)[0][0],
            static_cast<double>(0x910A2DEC89025CC1ULL >> 11U) * 0x1p-53);
}

TEST(Sobol, FollowsJoeAndKuo) {
  // Points 1 to 8 of new-joe-kuo-6.
  const samples::Samples samples = samples::sobol_samples(5, 8);
  EXPECT_EQ(samples[0], vector_of({0.5, 0.5, 0.5, 0.5, 0.5}));
  EXPECT_EQ(samples[1], vector_of({0.75, 0.25, 0.25, 0.25, 0.75}));
  EXPECT_EQ(samples[2], vector_of({0.25, 0.75, 0.75, 0.75, 0.25}));
  EXPECT_EQ(samples[4], vector_of({0.875, 0.875, 0.125, 0.375, 0.875}));
  EXPECT_EQ(samples[7], vector_of({0.1875, 0.3125, 0.9375, 0.4375, 0.5625}));
  EXPECT_EQ(samples::sobol_samples(5, 1, 0)[0], VectorX::Zero(5));
}

// Designs that users keep come from them, whichever library makes them.
TEST(Sobol, KeepsItsBits) {
  const VectorX t = samples::sobol_samples(40, 1, 1000)[0];
  EXPECT_EQ(t[5], 0.9072265625);
  EXPECT_EQ(t[19], 0.7255859375);
  EXPECT_EQ(t[39], 0.4794921875);
}

TEST(Sobol, IsEvenInEachDimensionAndContinues) {
  const int count = 256;
  const samples::Samples samples =
      samples::sobol_samples(samples::kMostSobolDimensions, count, 0);
  for (Eigen::Index j = 0; j < samples::kMostSobolDimensions; ++j) {
    std::set<double> seen;
    for (const VectorX& t : samples) {
      seen.insert(std::floor(t[j] * count));
    }
    EXPECT_EQ(seen.size(), static_cast<std::size_t>(count)) << j;
  }
  EXPECT_EQ(samples::sobol_samples(7, 5, 100), [] {
    samples::Samples tail = samples::sobol_samples(7, 105, 0);
    tail.erase(tail.begin(), tail.begin() + 100);
    return tail;
  }());
}

TEST(Sobol, IntegratesBetterThanChance) {
  // prod (1 + (t_j - 1/2) / 2) has the mean 1; its standard deviation in 6
  // dimensions is 0.37, so chance errs by 0.37 / 64 at 4096 points.
  double sum = 0.0;
  for (const VectorX& t : samples::sobol_samples(6, 4096, 0)) {
    sum += (1.0 + 0.5 * (t.array() - 0.5)).prod();
  }
  EXPECT_NEAR(sum / 4096, 1.0, 0.37 / 64 / 5);
}

TEST(Sobol, RefusesWhatItHasNot) {
  EXPECT_THROW(samples::sobol_samples(samples::kMostSobolDimensions + 1, 1),
               InvalidInput);
  EXPECT_THROW(samples::sobol_samples(0, 1), InvalidInput);
  EXPECT_THROW(samples::sobol_samples(2, -1), InvalidInput);
  EXPECT_THROW(samples::sobol_samples(2, 1, -1), InvalidInput);
  EXPECT_THROW(samples::latin_hypercube_samples(0, 4, 1), InvalidInput);
}

TEST(Designs, KeepTheBounds) {
  const std::vector<optimize::Variable> variables = {{"a", 0.3, 0.1, 0.3},
                                                     {"b", 0.0, -1.0, 2.0}};
  const auto designs = samples::designs_of(
      variables, {vector_of({1.0, 0.0}), vector_of({0.0, 0.5})});
  EXPECT_EQ(designs[0], vector_of({0.3, -1.0}));
  EXPECT_EQ(designs[1], vector_of({0.1, 0.5}));
  EXPECT_THROW(samples::designs_of(variables, {vector_of({1.0})}),
               InvalidInput);
}

TEST(NormalQuantile, InvertsTheDistribution) {
  for (const double p : {1e-300, 1e-20, 1e-12, 1e-6, 0.01, 0.0749, 0.0751, 0.3,
                         0.5, 0.6, 0.9, 0.95, 0.999, 1.0 - 1e-9}) {
    const double x = samples::normal_quantile(p);
    // erfc loses relative precision like |x|^2 epsilon in its tail.
    EXPECT_NEAR(0.5 * std::erfc(-x / std::sqrt(2.0)) / p, 1.0,
                1e-14 * (10.0 + x * x))
        << p;
  }
  EXPECT_EQ(samples::normal_quantile(0.5), 0.0);
  EXPECT_THROW(samples::normal_quantile(0.0), InvalidInput);
  EXPECT_THROW(samples::normal_quantile(1.0), InvalidInput);
}

}  // namespace
}  // namespace meniscus::sampling_test
