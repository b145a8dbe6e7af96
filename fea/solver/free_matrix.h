/// A stiffness matrix on its free directions, as a sparse one.
#pragma once

#include <vector>

#include "core/math/linear_solve.h"
#include "fea/solver/block_matrix.h"
#include "fea/solver/node_freedom.h"

namespace meniscus::solver {

/// Free directions as the first columns, and how many; the axes themselves
/// where the support follows them.
struct FreeBasis {
  Mat3 axes = Mat3::Identity();
  int rank = 3;
};

/// The unknowns of a matrix: what is free at each node, along orthonormal axes.
struct FreeUnknowns {
  std::vector<int> start;        // per node: its first; nodes + 1
  std::vector<FreeBasis> bases;  // per node
};
FreeUnknowns free_unknowns(const NodeFreedom& freedom, int nodes);

/// Lower triangle, by columns.
SparseMatrix free_matrix(const BlockPattern& pattern,
                         const BlockMatrix<double>& matrix,
                         const FreeUnknowns& unknowns);

}  // namespace meniscus::solver
