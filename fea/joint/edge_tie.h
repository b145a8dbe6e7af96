/// Where a shell's edges lie on a solid's surface, and how the surface carries
/// the walls' ends.
///
/// A wall that ends on a solid covers a strip of its surface, as long as the
/// edge and as wide as the wall is thick. The strip is sampled by fibres across
/// the wall: displacements of an edge's nodes are means of the solid's over
/// them, and rotations those of the fibres, by least squares. Functions that
/// are biorthogonal to the edge's own weigh the fibres (as those of mortar
/// methods: Wohlmuth, SIAM J. Numer. Anal. 38, 2000), so that what is quadratic
/// along the edge passes as it is. Rigid motions of the solid move the edge
/// rigidly at any places of the nodes. The rotation about the wall's normal,
/// which a fibre does not feel, stays the node's own.
#pragma once

#include <array>
#include <vector>

#include "core/geometry/tet_mesh.h"
#include "fea/shell/shell_mesh.h"

namespace meniscus::joint {

/// A point of a six-node face of the solid.
struct TiePoint {
  std::array<int, 6> nodes = {};
  std::array<double, 6> shape = {};
  double weight = 0.0;  // in its fibre, where they sum to 1
};

using Fibre = std::vector<TiePoint>;

struct FibreShare {
  int fibre = 0;
  double share = 0.0;  // may be negative; of a node they sum to 1
};

struct TiedNode {
  int node = 0;  // of the shell
  std::vector<FibreShare> fibres;
  /// Two unit vectors that its rotation follows the fibres about, and across
  /// them the one that it does not.
  Mat3 axes = Mat3::Identity();
};

/// Fixed once, as sets of nodes and weights; for any places of these.
struct EdgeTie {
  std::vector<Fibre> fibres;
  std::vector<TiedNode> nodes;  // ascending
};

/// Of all edges of facets whose three nodes lie within a tenth of the thickness
/// and of their length of the surface of `solid`, which has ten-node elements.
/// Throws InvalidInput, naming the place, where a wall's end has no width on
/// the solid, so that it could turn there as on a hinge.
EdgeTie tie_edges(const TetMesh& solid, const shell::ShellMesh& mesh,
                  const std::vector<shell::Section>& sections);

}  // namespace meniscus::joint
