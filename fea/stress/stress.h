/// Nodal stresses.
#pragma once

#include <vector>

#include "core/geometry/tet_mesh.h"
#include "fea/element/material.h"
#include "fea/element/point_stress.h"
#include "fea/element/stress_measures.h"

namespace meniscus::stress {

/// Six components per node: xx yy zz xy yz zx [pressure].
struct StressField {
  std::vector<element::Stress> nodal;
  std::vector<double> von_mises;  // per node [pressure]
  double max_von_mises = 0.0;
  int max_node = 0;
};

/// Fills in von Mises stresses and their peak from `field.nodal`.
void find_peak(StressField& field);

/// Nodal stresses by patch recovery (patch_recovery.h) of point_stress
/// (point_stress.h); where materials meet, those of the side with the larger
/// von Mises stress. Throws InvalidInput when sizes or materials do not fit the
/// mesh.
StressField recover_stress(const TetMesh& mesh,
                           const std::vector<element::Material>& materials,
                           const VectorX& displacement,
                           const VectorX& temperature_change = {});

/// Volume [length^3] and mass [mass] by quadrature on curved elements.
double mesh_volume(const TetMesh& mesh);
double mesh_mass(const TetMesh& mesh,
                 const std::vector<element::Material>& materials);

}  // namespace meniscus::stress
