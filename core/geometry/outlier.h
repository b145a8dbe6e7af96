/// A point so far from all others that a number of its file is wrong.
#pragma once

#include <optional>
#include <string>

#include "core/types.h"

namespace meniscus {

struct Outlier {
  int point = -1;         // its number
  double distance = 0.0;  // from the middle of all points [length]
  double usual = 0.0;     // within which nine tenths of them are
};

/// The farthest of eight points or more, should it be a thousand times as far
/// from their middle (the median of each coordinate) as nine tenths of them.
/// A part has no such point: a digit, a sign of an exponent or a unit is wrong.
std::optional<Outlier> find_outlier(const Points& points);

/// "the point (1, 2, 3e+30) is 3e+30 away from the middle of all points, and
/// nine tenths of them are within 12; its file has a wrong number there".
std::string outlier_text(const Outlier& outlier, const Points& points);

}  // namespace meniscus
