/// The faces and nodes that carry a surface's name.
#pragma once

#include <string>
#include <vector>

#include "core/geometry/tet_mesh.h"

namespace meniscus::element {

/// Index of a surface's label. Throws InvalidInput, listing the names there
/// are, for an unknown name, and for a surface without faces.
int surface_label(const TetMesh& mesh, const std::string& surface);

/// Nodes of the faces of `label`, ascending.
std::vector<int> surface_nodes(const TetMesh& mesh, int label);

}  // namespace meniscus::element
