/// The displacements that supports leave to each node.
#pragma once

#include <vector>

#include "core/types.h"

namespace meniscus::solver {

struct NodeFreedom {
  int nodes = 0;
  std::vector<int> held;        // nodes with a support, ascending
  std::vector<Mat3> projector;  // per held node, onto its free directions:
                                // symmetric, P P = P
};

}  // namespace meniscus::solver
