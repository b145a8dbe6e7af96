/// Inner nodes follow the surface: a linear map with coefficients fixed on the
/// reference mesh, so its transpose serves the adjoint.
#pragma once

#include <memory>

#include "core/geometry/tet_mesh.h"

namespace meniscus::mesh_tet {

/// Harmonic motion on the reference tetrahedra: inner displacements solve
/// K u = 0 for given surface displacements, where K is the Laplacian's
/// stiffness with conductivity 1/volume of each element, so that small
/// elements move almost rigidly (Jasak and Tukovic 2006 with quadratic inverse
/// diffusivity). Against elastic motion with the same weights the worst angle
/// differs by less than 2 degrees, at a tenth of the time; with constant
/// conductivity elements invert earlier.
class MeshMotion {
 public:
  /// `mesh`: order 1, not kept; its first `surface_points` nodes are the
  /// surface. Throws MeshError when an element has no positive volume.
  MeshMotion(const TetMesh& mesh, int surface_points);
  ~MeshMotion();
  MeshMotion(MeshMotion&&) noexcept;
  MeshMotion& operator=(MeshMotion&&) noexcept;

  /// All corner nodes for new surface points (same order), which come first,
  /// bit for bit. Exactly the reference nodes for the reference surface;
  /// translations exact up to rounding. Elements may invert under large
  /// motions: see find_inverted. Thread safe. Throws MeshError for a wrong
  /// number of points.
  Points move(const Points& surface) const;

  /// Transpose of d(nodes)/d(surface): from a gradient by all nodes to the
  /// gradient by surface points.
  Points transpose(const Points& node_gradient) const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace meniscus::mesh_tet
