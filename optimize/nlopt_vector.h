/// NLopt's vectors.
#pragma once

#include <vector>

#include "core/types.h"

namespace meniscus::optimize {

inline std::vector<double> to_vector(const VectorX& x) {
  return {x.data(), x.data() + x.size()};
}

}  // namespace meniscus::optimize
