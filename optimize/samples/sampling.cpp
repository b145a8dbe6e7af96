#include "optimize/samples/sampling.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numeric>

#include <boost/random/sobol.hpp>
#include <fmt/format.h>

namespace meniscus::samples {

static_assert(kMostSobolDimensions ==
              boost::random::default_sobol_table::max_dimension);

namespace {

void check_count(const char* what, int dimension, int count) {
  if (dimension < 1 || count < 0 || count > kMostSamples) {
    throw InvalidInput(fmt::format(
        "{}: {} points of {} variables; expected 0 to {} points and at least "
        "one variable",
        what, count, dimension, kMostSamples));
  }
}

// SplitMix64: the same numbers everywhere, unlike std::shuffle.
class Generator {
 public:
  explicit Generator(std::uint64_t seed) : state_(seed) {}
  std::uint64_t next() {
    state_ += 0x9E3779B97F4A7C15ULL;
    std::uint64_t z = state_;
    z = (z ^ (z >> 30U)) * 0xBF58476D1CE4E5B9ULL;
    z = (z ^ (z >> 27U)) * 0x94D049BB133111EBULL;
    return z ^ (z >> 31U);
  }
  // Below `count`; the bias is below count / 2^64.
  int below(int count) {
    return static_cast<int>(next() % static_cast<std::uint64_t>(count));
  }
  double unit() { return static_cast<double>(next() >> 11U) * 0x1p-53; }

 private:
  std::uint64_t state_;
};

double ratio(const std::array<double, 8>& top,
             const std::array<double, 8>& bottom, double r) {
  double above = 0.0;
  double below = 0.0;
  for (std::size_t k = top.size(); k-- > 0;) {
    above = above * r + top[k];
    below = below * r + bottom[k];
  }
  return above / below;
}

}  // namespace

Samples grid_samples(const std::vector<int>& levels) {
  double count = 1.0;
  for (const int level : levels) {
    if (level < 1) {
      throw InvalidInput(fmt::format(
          "grid: {} levels of a variable; expected at least 1", level));
    }
    count *= level;
  }
  if (levels.empty() || count > kMostSamples) {
    throw InvalidInput(
        fmt::format("grid: {} variables make {:.6g} points; expected at least "
                    "one variable and at most {} points",
                    levels.size(), count, kMostSamples));
  }
  Samples samples;
  samples.reserve(static_cast<std::size_t>(count));
  for (int k = 0; k < static_cast<int>(count); ++k) {
    VectorX t(static_cast<Eigen::Index>(levels.size()));
    int rest = k;
    for (Eigen::Index j = t.size() - 1; j >= 0; --j) {
      const int level = levels[static_cast<std::size_t>(j)];
      t[j] = level == 1 ? 0.5 : double(rest % level) / (level - 1);
      rest /= level;
    }
    samples.push_back(std::move(t));
  }
  return samples;
}

Samples latin_hypercube_samples(int dimension, int count, std::uint64_t seed) {
  check_count("latin hypercube", dimension, count);
  Samples samples(static_cast<std::size_t>(count), VectorX(dimension));
  Generator generator(seed);
  std::vector<int> slices(static_cast<std::size_t>(count));
  for (int j = 0; j < dimension; ++j) {
    std::iota(slices.begin(), slices.end(), 0);
    for (int k = count - 1; k > 0; --k) {
      std::swap(slices[static_cast<std::size_t>(k)],
                slices[static_cast<std::size_t>(generator.below(k + 1))]);
    }
    for (std::size_t k = 0; k < slices.size(); ++k) {
      samples[k][j] = (slices[k] + generator.unit()) / count;
    }
  }
  return samples;
}

Samples sobol_samples(int dimension, int count, int first) {
  check_count("Sobol sequence", dimension, count);
  if (dimension > kMostSobolDimensions) {
    throw InvalidInput(fmt::format(
        "Sobol sequence: {} variables; there are directions for {}. Take a "
        "latin hypercube",
        dimension, kMostSobolDimensions));
  }
  if (first < 0 || first > std::numeric_limits<int>::max() - count) {
    throw InvalidInput(fmt::format(
        "Sobol sequence: {} points from point {} on; expected a first point "
        "of at least 0 and fewer than 2^31 in all",
        count, first));
  }
  Samples samples(static_cast<std::size_t>(count), VectorX(dimension));
  auto sample = samples.begin();
  if (first == 0 && count > 0) {  // Boost's sequence begins with point 1
    sample->setZero();
    ++sample;
  }
  boost::random::sobol engine(static_cast<std::size_t>(dimension));
  engine.discard(static_cast<boost::uintmax_t>(std::max(first, 1) - 1) *
                 static_cast<boost::uintmax_t>(dimension));
  for (; sample != samples.end(); ++sample) {
    for (double& t : *sample) {
      t = static_cast<double>(engine()) * 0x1p-64;
    }
  }
  return samples;
}

std::vector<VectorX> designs_of(
    const std::vector<optimize::Variable>& variables, const Samples& samples) {
  std::vector<VectorX> designs;
  designs.reserve(samples.size());
  for (const VectorX& t : samples) {
    if (t.size() != static_cast<Eigen::Index>(variables.size())) {
      throw InvalidInput(
          fmt::format("samples of {} numbers for {} design variables", t.size(),
                      variables.size()));
    }
    VectorX x(t.size());
    for (Eigen::Index j = 0; j < x.size(); ++j) {
      const optimize::Variable& variable =
          variables[static_cast<std::size_t>(j)];
      x[j] = t[j] >= 1.0
                 ? variable.upper
                 : variable.lower + t[j] * (variable.upper - variable.lower);
    }
    designs.push_back(std::move(x));
  }
  return designs;
}

double normal_quantile(double p) {
  if (!(p > 0.0 && p < 1.0)) {
    throw InvalidInput(
        fmt::format("normal quantile of {}; expected between 0 and 1", p));
  }
  // Wichura's AS 241 (PPND16): minimax rational functions on three ranges.
  // The middle, odd in q = p - 1/2.
  const double q = p - 0.5;
  if (std::abs(q) <= 0.425) {
    const std::array<double, 8> a = {
        3.3871328727963666080e0,  1.3314166789178437745e+2,
        1.9715909503065514427e+3, 1.3731693765509461125e+4,
        4.5921953931549871457e+4, 6.7265770927008700853e+4,
        3.3430575583588128105e+4, 2.5090809287301226727e+3};
    const std::array<double, 8> b = {1.0,
                                     4.2313330701600911252e+1,
                                     6.8718700749205790830e+2,
                                     5.3941960214247511077e+3,
                                     2.1213794301586595867e+4,
                                     3.9307895800092710610e+4,
                                     2.8729085735721942674e+4,
                                     5.2264952788528545610e+3};
    return q * ratio(a, b, 0.180625 - q * q);
  }
  // Tails in r = sqrt(-ln min(p, 1 - p)), in which the quantile is nearly
  // linear.
  const double r = std::sqrt(-std::log(q < 0.0 ? p : 1.0 - p));
  double tail = 0.0;
  if (r <= 5.0) {
    const std::array<double, 8> c = {
        1.42343711074968357734e0,  4.63033784615654529590e0,
        5.76949722146069140550e0,  3.64784832476320460504e0,
        1.27045825245236838258e0,  2.41780725177450611770e-1,
        2.27238449892691845833e-2, 7.74545014278341407640e-4};
    const std::array<double, 8> d = {1.0,
                                     2.05319162663775882187e0,
                                     1.67638483018380384940e0,
                                     6.89767334985100004550e-1,
                                     1.48103976427480074590e-1,
                                     1.51986665636164571966e-2,
                                     5.47593808499534494600e-4,
                                     1.05075007164441684324e-9};
    tail = ratio(c, d, r - 1.6);
  } else {
    const std::array<double, 8> e = {
        6.65790464350110377720e0,  5.46378491116411436990e0,
        1.78482653991729133580e0,  2.96560571828504891230e-1,
        2.65321895265761230930e-2, 1.24266094738807843860e-3,
        2.71155556874348757815e-5, 2.01033439929228813265e-7};
    const std::array<double, 8> f = {1.0,
                                     5.99832206555887937690e-1,
                                     1.36929880922735805310e-1,
                                     1.48753612908506148525e-2,
                                     7.86869131145613259100e-4,
                                     1.84631831751005468180e-5,
                                     1.42151175831644588870e-7,
                                     2.04426310338993978564e-15};
    tail = ratio(e, f, r - 5.0);
  }
  return q < 0.0 ? -tail : tail;
}

}  // namespace meniscus::samples
