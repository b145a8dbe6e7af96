#include "core/geometry/orientation.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include <boost/multiprecision/cpp_int.hpp>

namespace meniscus {

namespace {

using Whole = boost::multiprecision::cpp_int;

/// Roundings in a determinant of three rows of differences, in units of its
/// permanent: 7 and a little (Shewchuk); fused multiplications only have fewer.
constexpr double kRounding = 8.0 * 0.5 * std::numeric_limits<double>::epsilon();
/// Below, products of three differences may have lost digits to underflow.
constexpr double kLeastFactor = 1e-100;
constexpr double kLost = 1e-300;

int sign_of(const Whole& number) { return number.sign(); }

/// Coordinates as whole numbers of one power of two.
std::vector<Whole> whole(const std::vector<double>& numbers) {
  constexpr int kDigits = std::numeric_limits<double>::digits;
  int least = std::numeric_limits<int>::max();
  std::vector<int> exponents(numbers.size(), 0);
  for (std::size_t i = 0; i < numbers.size(); ++i) {
    if (numbers[i] != 0.0) {
      std::frexp(numbers[i], &exponents[i]);
      least = std::min(least, exponents[i]);
    }
  }
  std::vector<Whole> result(numbers.size());
  for (std::size_t i = 0; i < numbers.size(); ++i) {
    if (numbers[i] != 0.0) {
      int exponent = 0;
      const double fraction = std::frexp(numbers[i], &exponent);
      result[i] = static_cast<long long>(std::ldexp(fraction, kDigits));
      result[i] <<= exponent - least;
    }
  }
  return result;
}

int exact_orientation(const Vec3& a, const Vec3& b, const Vec3& c,
                      const Vec3& d) {
  const std::vector<Whole> x =
      whole({a.x(), a.y(), a.z(), b.x(), b.y(), b.z(), c.x(), c.y(), c.z(),
             d.x(), d.y(), d.z()});
  const auto from_a = [&x](std::size_t point, std::size_t k) -> Whole {
    return x[3 * point + k] - x[k];
  };
  Whole sum = 0;
  for (std::size_t k = 0; k < 3; ++k) {
    const std::size_t i = (k + 1) % 3;
    const std::size_t j = (k + 2) % 3;
    sum += from_a(3, k) *
           (from_a(1, i) * from_a(2, j) - from_a(1, j) * from_a(2, i));
  }
  return sign_of(sum);
}

int exact_orientation_along(int i, int j, const Vec3& a, const Vec3& b,
                            const Vec3& c) {
  const std::vector<Whole> x = whole({a[i], a[j], b[i], b[j], c[i], c[j]});
  return sign_of((x[2] - x[0]) * (x[5] - x[1]) - (x[3] - x[1]) * (x[4] - x[0]));
}

/// No product of these differences is lost to underflow or overflow.
template <class Differences>
bool products_are_sound(const Differences& differences) {
  constexpr double kLargestFactor = 1.0 / kLeastFactor;
  return std::all_of(differences.begin(), differences.end(), [](double x) {
    return x == 0.0 ||
           (std::abs(x) > kLeastFactor && std::abs(x) < kLargestFactor);
  });
}

}  // namespace

int orientation(const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& d) {
  const Vec3 u = b - a;
  const Vec3 v = c - a;
  const Vec3 w = d - a;
  double sum = 0.0;
  double permanent = 0.0;
  for (int k = 0; k < 3; ++k) {
    const int i = (k + 1) % 3;
    const int j = (k + 2) % 3;
    const double left = u[i] * v[j];
    const double right = u[j] * v[i];
    sum += w[k] * (left - right);
    permanent += std::abs(w[k]) * (std::abs(left) + std::abs(right));
  }
  const double bound = kRounding * permanent + kLost;
  if (std::abs(sum) > bound && std::isfinite(permanent)) {
    return sum > 0.0 ? 1 : -1;
  }
  // A plane along the axes: every product is nothing.
  if (permanent == 0.0 &&
      products_are_sound(
          std::array{u[0], u[1], u[2], v[0], v[1], v[2], w[0], w[1], w[2]})) {
    return 0;
  }
  return exact_orientation(a, b, c, d);
}

int orientation_along(int along, const Vec3& a, const Vec3& b, const Vec3& c) {
  const int i = (along + 1) % 3;
  const int j = (along + 2) % 3;
  const double left = (b[i] - a[i]) * (c[j] - a[j]);
  const double right = (b[j] - a[j]) * (c[i] - a[i]);
  const double bound = kRounding * (std::abs(left) + std::abs(right)) + kLost;
  const double difference = left - right;
  if (std::abs(difference) > bound && std::isfinite(bound)) {
    return difference > 0.0 ? 1 : -1;
  }
  return exact_orientation_along(i, j, a, b, c);
}

}  // namespace meniscus
