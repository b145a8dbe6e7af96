/// Multigrid: ten-node elements over their four-node corner mesh (p-multigrid;
/// on straight elements its matrix is the Galerkin one), that over rigid
/// motions of aggregates, the smallest level by a Cholesky factor. Smoothers
/// are Gauss-Seidel sweeps by blocks in single precision.
#pragma once

#include <memory>
#include <vector>

#include "fea/solver/corner_mesh.h"
#include "fea/solver/preconditioner.h"

namespace meniscus::solver {

/// Blocks below the diagonal in single precision, divided by `scale`; shared
/// by load cases, whatever they hold.
struct SmootherMatrix {
  double scale = 1.0;
  std::vector<float> lower;
};
SmootherMatrix make_smoother_matrix(const BlockMatrix<double>& matrix);

/// The level that aggregation starts from.
struct NodalLevel {
  const BlockPattern* pattern;        // kept: must outlive the preconditioner
  const BlockMatrix<double>* matrix;  // read at construction only
  const SmootherMatrix* smoother;     // kept
  const Points* x;                    // read at construction only [length]
};

struct MultigridInput {
  NodalLevel nodal;            // the four-node mesh
  const NodeFreedom* freedom;  // of the finest mesh's nodes
  // With ten-node elements, the level above:
  const BlockPattern* fine_pattern = nullptr;        // kept
  const BlockMatrix<double>* fine_matrix = nullptr;  // at construction only
  const SmootherMatrix* fine_smoother = nullptr;     // kept
  const CornerMap* map = nullptr;                    // kept
};

std::unique_ptr<Preconditioner> make_multigrid(const MultigridInput& input);

}  // namespace meniscus::solver
