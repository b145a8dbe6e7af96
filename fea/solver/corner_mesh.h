/// The four-node mesh of a ten-node mesh's corners: multigrid's second level.
#pragma once

#include <array>
#include <vector>

#include "fea/solver/assembly.h"
#include "fea/solver/node_order.h"

namespace meniscus::solver {

/// How the ten-node mesh and its corner mesh hang together, in the solver's
/// numbering. Corners keep their order and chunks.
struct CornerMap {
  std::vector<int> corner;               // coarse node -> fine node
  std::vector<int> mid;                  // fine mid-side nodes ...
  std::vector<std::array<int, 2>> ends;  // ... and the coarse ends of each
  // The mid-side nodes around each coarse node.
  std::vector<int> around_start;
  std::vector<int> around;
};

struct CornerMesh {
  ElementTable table;
  Points x;                  // of coarse nodes [length]
  std::vector<int> element;  // table's element -> the mesh's element
  CornerMap map;
};

CornerMesh make_corner_mesh(const TetMesh& mesh, const NodeOrder& order);

}  // namespace meniscus::solver
