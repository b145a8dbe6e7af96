/// Inner nodes follow the surface: a linear map with coefficients fixed on the
/// reference mesh, so its transpose serves the adjoint.
#pragma once

#include <memory>

#include "core/tet_mesh.h"

namespace meniscus {

/// Weighted graph-free harmonic motion on the reference tetrahedra: inner
/// displacements solve K u = 0 for a stiffness that grows where elements are
/// small, with surface displacements given.
class MeshMotion {
 public:
  /// `mesh`: order 1; its first `surface_points` nodes are the surface.
  MeshMotion(const TetMesh& mesh, int surface_points);
  ~MeshMotion();
  MeshMotion(MeshMotion&&) noexcept;
  MeshMotion& operator=(MeshMotion&&) noexcept;

  /// All corner nodes for new surface points (same order). Exact for rigid
  /// motions and affine maps of the reference up to rounding where the weights
  /// allow; always the reference nodes for the reference surface.
  Points move(const Points& surface) const;

  /// Transpose of d(nodes)/d(surface): from a gradient by all nodes to the
  /// gradient by surface points.
  Points transpose(const Points& node_gradient) const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace meniscus
