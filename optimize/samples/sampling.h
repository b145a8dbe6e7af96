/// Points of the unit cube for sweeps, the same on every platform: integers
/// make them, and one exact division.
#pragma once

#include <cstdint>
#include <vector>

#include "optimize/problem.h"

namespace meniscus::samples {

/// Each point is a VectorX of the dimension's length, entries in [0, 1].
using Samples = std::vector<VectorX>;

/// Every combination of levels[j] >= 1 evenly spaced values, ends included (one
/// level: the middle); the last variable runs fastest. Throws InvalidInput for
/// a level below 1 or more than kMostSamples points.
Samples grid_samples(const std::vector<int>& levels);

/// M. D. McKay, R. J. Beckman, W. J. Conover, Technometrics 21, 1979: each of
/// `count` equal slices of each variable holds one point. `seed` feeds the
/// counter-based generator SplitMix64 (G. Steele et al., OOPSLA 2014).
Samples latin_hypercube_samples(int dimension, int count, std::uint64_t seed);

/// I. M. Sobol's sequence from point `first` on (point 0 is the origin), with
/// the direction numbers of S. Joe and F. Y. Kuo, SIAM J. Sci. Comput. 30,
/// 2008 (new-joe-kuo-6), Boost's. dimension <= kMostSobolDimensions, first +
/// count < 2^31. Longer sequences begin with shorter ones.
Samples sobol_samples(int dimension, int count, int first = 1);

constexpr int kMostSobolDimensions = 3667;
constexpr int kMostSamples = 10'000'000;

/// lower + t (upper - lower), t = 0 and 1 giving the bounds themselves.
std::vector<VectorX> designs_of(
    const std::vector<optimize::Variable>& variables, const Samples& samples);

/// The quantile of the standard normal distribution, 0 < p < 1, to 1e-15
/// relative (M. J. Wichura, Applied Statistics 37, 1988, algorithm AS 241).
double normal_quantile(double p);

}  // namespace meniscus::samples
