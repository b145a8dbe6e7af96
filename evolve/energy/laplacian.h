/// Cotangent Laplacian over chosen vertices of a triangle mesh.
#pragma once

#include "core/geometry/surface_mesh.h"
#include "core/math/linear_solve.h"

namespace meniscus::energy {

enum class CotanWeights {
  Exact,   // reproduces linear functions on planar meshes
  Clamped  // at least 1e-3 of the mean: positive, so that interpolation is
           // monotone (maximum principle) on any mesh
};

/// Symmetric system of the vertices with unknown_of[v] >= 0: sum over edges of
/// w (x_i - x_j), w = (cot a + cot b) / 2 (Pinkall, Polthier 1993).
struct LaplaceSystem {
  SparseMatrix inner;  // lower triangle, unknown x unknown
  SparseMatrix outer;  // unknown x vertex: weights to the other vertices
};

/// `facet_weight`: factor per facet (tension), 0 leaves a facet out.
/// `unknown_of`: per vertex its number in 0..unknowns-1 or -1.
LaplaceSystem cotan_laplacian(const SurfaceMesh& mesh,
                              const std::vector<double>& facet_weight,
                              const std::vector<int>& unknown_of, int unknowns,
                              CotanWeights weights);

}  // namespace meniscus::energy
