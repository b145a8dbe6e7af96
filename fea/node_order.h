/// The order in which the solver stores nodes and elements: nodes along a
/// Morton curve through the base mesh, elements by their lowest node, so that
/// neighbours in space are neighbours in memory.
#pragma once

#include <vector>

#include "core/tet_mesh.h"

namespace meniscus {

struct NodeOrder {
  std::vector<int> to_mesh;    // solver's node -> the mesh's node
  std::vector<int> to_solver;  // the mesh's node -> solver's node
  std::vector<int> element;    // solver's element -> the mesh's element
};

NodeOrder morton_order(const TetMesh& mesh);

}  // namespace meniscus
