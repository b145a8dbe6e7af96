/// Do the supports hold the body?
#pragma once

#include <string>
#include <vector>

#include "core/geometry/tet_mesh.h"
#include "fea/supports/pins.h"
#include "fea/supports/supports.h"

namespace meniscus::supports {

/// Throws SolverError when a connected part of the mesh can move rigidly
/// although it is held along `held` (held_directions, sprung_directions) and by
/// the fixed motions of pins, which also join parts: the six rigid motions,
/// restricted to these directions, must have full rank; normals of a curved
/// surface count only beyond their uncertainty, so that a ball in its socket is
/// known to turn. The message names the motion.
void check_held(const TetMesh& mesh, const std::vector<HeldDirection>& held,
                const std::vector<PinFrame>& pins,
                const std::string& load_case);

/// The rigid motions that `held` leaves to the connected parts of the mesh:
/// displacements, 3 per node, one motion a column; no columns where all is
/// held.
Eigen::MatrixXd free_motions(const TetMesh& mesh,
                             const std::vector<HeldDirection>& held);

}  // namespace meniscus::supports
