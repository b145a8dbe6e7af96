/// Limits of time from several sides.
#pragma once

#include <algorithm>

#include "core/error.h"

namespace meniscus::study {

/// The time that the user gave is up before there is an answer.
class TimeIsUp : public Interrupted {
 public:
  using Interrupted::Interrupted;
};

/// The smaller of two limits [s], where 0 is none.
inline double smaller_limit(double a, double b) {
  return a > 0.0 && b > 0.0 ? std::min(a, b) : std::max(a, b);
}

}  // namespace meniscus::study
