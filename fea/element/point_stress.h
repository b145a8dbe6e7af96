/// Stresses where the finite-element solution knows them best: at the
/// integration points of the stiffness rule (tet_element.h; one point for
/// four-node elements, CalculiX's four for ten-node ones).
#pragma once

#include <cstddef>
#include <vector>

#include "core/geometry/tet_mesh.h"
#include "fea/element/stress_measures.h"

namespace meniscus::element {

/// Point q of element e stands at index e * points_per_element + q.
struct PointStress {
  int points_per_element = 1;
  std::vector<Stress> stress;  // [pressure]
  Points position;             // [length]
  std::vector<double> volume;  // weight x det J [length^3]

  std::size_t index(int element, int point = 0) const {
    return static_cast<std::size_t>(element) * points_per_element + point;
  }
};

/// `displacement`: 3 per node [length]; `temperature_change`: one per node, or
/// empty (fea/temperature.h) [temperature]. The same bits for any number of
/// threads. Throws InvalidInput when sizes or materials do not fit the mesh.
PointStress point_stress(const TetMesh& mesh,
                         const std::vector<Material>& materials,
                         const VectorX& displacement,
                         const VectorX& temperature_change = {});

}  // namespace meniscus::element
