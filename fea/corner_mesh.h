/// The four-node mesh of a ten-node mesh's corners: multigrid's coarse level.
#pragma once

#include "fea/assembly.h"
#include "fea/node_order.h"
#include "fea/preconditioner.h"

namespace meniscus {

/// Coarse nodes are numbered as the solver orders them.
struct CornerMesh {
  ElementTable table;
  Points x;  // of coarse nodes [length]
  CornerMap map;
};

CornerMesh make_corner_mesh(const TetMesh& mesh, const NodeOrder& order);

}  // namespace meniscus
