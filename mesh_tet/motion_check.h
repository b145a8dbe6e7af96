/// Is a mesh that followed its surface still one?
#pragma once

#include <optional>

#include "core/error.h"
#include "core/geometry/tet_mesh.h"
#include "mesh_tet/tet_quality.h"

namespace meniscus::mesh_tet {

struct MotionBounds {
  QualityBounds corners = {.min_dihedral_deg = 0.2, .max_dihedral_deg = 179.7};
  double least_jacobian = 1e-3;  // of ten-node elements: determinant over its
                                 // mean, everywhere on the element
};

/// ElementsInverted, in words with place and surfaces, when an element is
/// turned inside out, folded by its curved sides, flatter than the bounds or
/// not finite; nothing when all are sound. `quality` receives the report.
std::optional<Failure> check_moved(const TetMesh& mesh,
                                   const MotionBounds& bounds = {},
                                   TetQuality* quality = nullptr);

}  // namespace meniscus::mesh_tet
