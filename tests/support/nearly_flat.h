/// Random points that lie nearly, or exactly, in one plane, on one line or on
/// each other: where signs go wrong.
#pragma once

#include <cmath>
#include <limits>
#include <random>
#include <vector>

#include "core/types.h"

namespace meniscus::rational {

/// `count` points of one kind out of six: on a plane along the axes, on a
/// tilted one with roundings, the same with some points off by a few units in
/// their last place, on a line of a plane, on a coarse lattice, far from the
/// origin; of any size from 1e-12 to 1e12.
inline Points nearly_flat(std::mt19937& random, int count) {
  const auto in = [&random](double low, double high) {
    return std::uniform_real_distribution<double>(low, high)(random);
  };
  const auto one_of = [&random](int n) {
    return std::uniform_int_distribution<int>(0, n - 1)(random);
  };
  const int kind = one_of(6);
  const double size = std::pow(10.0, one_of(25) - 12);
  const Vec3 origin = (kind == 5 ? 1e6 : 1.0) * size *
                      Vec3(in(-1.0, 1.0), in(-1.0, 1.0), in(-1.0, 1.0));
  const Vec3 u = size * Vec3(in(-1.0, 1.0), in(-1.0, 1.0), in(-1.0, 1.0));
  const Vec3 v = size * Vec3(in(-1.0, 1.0), in(-1.0, 1.0), in(-1.0, 1.0));
  Points points;
  for (int i = 0; i < count; ++i) {
    // Few different numbers, so that points meet lines and each other.
    const double a = 0.1 * one_of(11);
    const double b = 0.1 * one_of(11);
    Vec3 x = origin + a * u + b * v;
    if (kind == 0) {
      x = size * Vec3(a, b, 0.3);
    } else if (kind == 3) {
      x = origin + (a + (i % 2) * 0.7 * b) * u + (i % 3 == 0 ? b : 0.0) * v;
    } else if (kind == 4) {
      x = size * 0.1 * Vec3(one_of(5), one_of(5), one_of(5));
    }
    if (kind >= 2 && kind != 4 && one_of(2) == 0) {
      double& moved = x[one_of(3)];
      const double way = one_of(2) == 0 ? -1.0 : 1.0;
      for (int step = one_of(4); step > 0; --step) {
        moved = std::nextafter(moved,
                               way * std::numeric_limits<double>::infinity());
      }
    }
    points.push_back(x);
  }
  return points;
}

}  // namespace meniscus::rational
