/// The order in which the solver stores nodes and elements: neighbours in space
/// are neighbours in memory, and threads find independent work.
#pragma once

#include <vector>

#include "core/geometry/tet_mesh.h"
#include "fea/solver/row_chunks.h"

namespace meniscus::solver {

struct NodeOrder {
  std::vector<int> to_mesh;    // solver's node -> the mesh's node
  std::vector<int> to_solver;  // the mesh's node -> solver's node
  std::vector<int> element;    // solver's element -> the mesh's element
  RowChunks chunks;            // of solver's nodes
};

/// Cuts a Morton curve through the nodes into chunks, colours the chunks so
/// that no node neighbours two of one colour, and orders nodes by colour, chunk
/// and place on the curve, elements by their lowest node.
NodeOrder chunked_order(const TetMesh& mesh);

/// Nodes along the Morton curve, all in one chunk, elements by their lowest
/// node: equal ranges of nodes are compact pieces of the part.
NodeOrder curve_order(const TetMesh& mesh);

}  // namespace meniscus::solver
