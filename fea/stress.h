/// Nodal stresses.
#pragma once

#include <array>
#include <vector>

#include "core/tet_mesh.h"
#include "fea/material.h"

namespace meniscus {

/// Stress by averaging element extrapolations at nodes (volume-weighted).
/// Six components per node: xx yy zz xy yz zx [pressure].
struct StressField {
  std::vector<std::array<double, 6>> nodal;
  std::vector<double> von_mises;  // per node [pressure]
  double max_von_mises = 0.0;
  int max_node = 0;
};

/// Ten-node elements: from the four points of the stiffness rule linearly to
/// the corners, mid-sides the mean of their ends; as CalculiX does.
/// `displacement`: 3 per node [length]. Throws InvalidInput when sizes or
/// materials do not fit the mesh.
StressField recover_stress(const TetMesh& mesh,
                           const std::vector<Material>& materials,
                           const VectorX& displacement);

double von_mises(const std::array<double, 6>& stress);

/// Volume [length^3] and mass [mass] by quadrature on curved elements.
double mesh_volume(const TetMesh& mesh);
double mesh_mass(const TetMesh& mesh, const std::vector<Material>& materials);

}  // namespace meniscus
