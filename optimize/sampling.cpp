#include "optimize/sampling.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numeric>

#include <fmt/format.h>

namespace meniscus {
namespace {

constexpr int kBits = 31;  // a Sobol coordinate is an integer over 2^31

struct Direction {
  unsigned polynomial = 0;  // its bits, the leading one included
  std::array<unsigned, 8> first = {};
};

// Dimensions 2 to 40 of new-joe-kuo-6; dimension 1 is van der Corput's.
constexpr std::array<Direction, kMostSobolDimensions - 1> kDirections = {{
    {3, {1}},
    {7, {1, 3}},
    {11, {1, 3, 1}},
    {13, {1, 1, 1}},
    {19, {1, 1, 3, 3}},
    {25, {1, 3, 5, 13}},
    {37, {1, 1, 5, 5, 17}},
    {41, {1, 1, 5, 5, 5}},
    {47, {1, 1, 7, 11, 19}},
    {55, {1, 1, 5, 1, 1}},
    {59, {1, 1, 1, 3, 11}},
    {61, {1, 3, 5, 5, 31}},
    {67, {1, 3, 3, 9, 7, 49}},
    {91, {1, 1, 1, 15, 21, 21}},
    {97, {1, 3, 1, 13, 27, 49}},
    {103, {1, 1, 1, 15, 7, 5}},
    {109, {1, 3, 1, 15, 13, 25}},
    {115, {1, 1, 5, 5, 19, 61}},
    {131, {1, 3, 7, 11, 23, 15, 103}},
    {137, {1, 3, 7, 13, 13, 15, 69}},
    {143, {1, 1, 3, 13, 7, 35, 63}},
    {145, {1, 3, 5, 9, 1, 25, 53}},
    {157, {1, 3, 1, 13, 9, 35, 107}},
    {167, {1, 3, 1, 5, 27, 61, 31}},
    {171, {1, 1, 5, 11, 19, 41, 61}},
    {185, {1, 3, 5, 3, 3, 13, 69}},
    {191, {1, 1, 7, 13, 1, 19, 1}},
    {193, {1, 3, 7, 5, 13, 19, 59}},
    {203, {1, 1, 3, 9, 25, 29, 41}},
    {211, {1, 3, 5, 13, 23, 1, 55}},
    {213, {1, 3, 7, 3, 13, 59, 17}},
    {229, {1, 3, 1, 3, 5, 53, 69}},
    {239, {1, 1, 5, 5, 23, 33, 13}},
    {241, {1, 1, 7, 7, 1, 61, 123}},
    {247, {1, 1, 7, 9, 13, 61, 49}},
    {253, {1, 3, 3, 5, 3, 55, 33}},
    {285, {1, 3, 1, 15, 31, 13, 49, 245}},
    {299, {1, 3, 5, 15, 31, 59, 63, 97}},
    {301, {1, 3, 1, 11, 11, 11, 77, 249}},
}};

int degree_of(unsigned polynomial) {
  int degree = 0;
  for (unsigned rest = polynomial >> 1; rest != 0; rest >>= 1) {
    ++degree;
  }
  return degree;
}

// The kBits direction numbers of one dimension, scaled by 2^31.
std::array<std::uint32_t, kBits> direction_numbers(int dimension) {
  std::array<std::uint32_t, kBits> v = {};
  if (dimension == 0) {
    for (int k = 0; k < kBits; ++k) {
      v[static_cast<std::size_t>(k)] = 1U << (kBits - 1 - k);
    }
    return v;
  }
  const Direction& direction =
      kDirections[static_cast<std::size_t>(dimension) - 1];
  const int degree = degree_of(direction.polynomial);
  for (int k = 0; k < kBits; ++k) {
    const auto at = static_cast<std::size_t>(k);
    if (k < degree) {
      v[at] = direction.first[at] << (kBits - 1 - k);
      continue;
    }
    const std::uint32_t oldest = v[static_cast<std::size_t>(k - degree)];
    v[at] = oldest ^ (oldest >> degree);
    for (int i = 1; i < degree; ++i) {
      if ((direction.polynomial >> (degree - i) & 1U) != 0) {
        v[at] ^= v[static_cast<std::size_t>(k - i)];
      }
    }
  }
  return v;
}

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
  for (int j = 0; j < dimension; ++j) {
    const std::array<std::uint32_t, kBits> v = direction_numbers(j);
    for (int k = 0; k < count; ++k) {
      const auto index = static_cast<std::uint32_t>(first + k);
      const std::uint32_t gray = index ^ (index >> 1U);
      std::uint32_t bits = 0;
      for (int b = 0; b < kBits; ++b) {
        if ((gray >> b & 1U) != 0) {
          bits ^= v[static_cast<std::size_t>(b)];
        }
      }
      samples[static_cast<std::size_t>(k)][j] = bits * 0x1p-31;
    }
  }
  return samples;
}

std::vector<VectorX> designs_of(const std::vector<Variable>& variables,
                                const Samples& samples) {
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
      const Variable& variable = variables[static_cast<std::size_t>(j)];
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

}  // namespace meniscus
