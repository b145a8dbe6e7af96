/// Beds of springs as blocks of the stiffness matrix.
#pragma once

#include <array>
#include <vector>

#include "core/geometry/tet_mesh.h"
#include "fea/loads/load_case.h"
#include "fea/solver/block_matrix.h"
#include "fea/supports/supports.h"

namespace meniscus::supports {

/// Blocks of the lower triangle, ascending by row and column.
struct SpringBlocks {
  std::vector<std::array<int, 2>> at;  // row >= column
  std::vector<Mat3> block;             // symmetric [force/length]

  bool operator==(const SpringBlocks&) const = default;
};

/// S_ab = int N_a N_b (axes diag(components) axes^T + normal n n^T) dA over all
/// beds of the load case, with seven points a face, and k c_a c_b^T of its
/// springs at nodes. `order`: that of the shape functions; 1 on a ten-node mesh
/// gives the corners' plane faces, and the ends of mid-sides half of what these
/// have, which is what multigrid's four-node level needs. Throws InvalidInput,
/// naming load case and surface: unknown surfaces, axes that span no plane,
/// stiffnesses that are negative, not finite or all 0, a spring whose nodes are
/// not of one element.
SpringBlocks spring_blocks(const TetMesh& mesh,
                           const loads::LoadCase& load_case, int order);

/// A bed's stiffness per area: `tensor` + normal n n^T [pressure/length].
struct BedStiffness {
  Mat3 tensor = Mat3::Zero();
  double normal = 0.0;
};
BedStiffness bed_stiffness_of(const TetMesh& mesh, const loads::SpringBed& bed);

/// The blocks with nodes renumbered.
SpringBlocks renumbered(const SpringBlocks& springs,
                        const std::vector<int>& number);

/// Adds the blocks; every pair of them must be in the pattern.
void add_springs(const solver::BlockPattern& pattern,
                 const SpringBlocks& springs,
                 solver::BlockMatrix<double>& matrix);

/// S u: what the springs pull with, against u [force].
VectorX spring_forces(const SpringBlocks& springs, const VectorX& u);

/// Reactions, as ElasticSolution hands them out, of supports and pins alone:
/// without what springs pull with at u.
VectorX reactions_of_supports(const VectorX& reactions,
                              const SpringBlocks& springs, const VectorX& u);

/// Springs of one stiffness k: each pulls with k e on e = sum c_a . u_a.
struct SpringSet {
  double stiffness = 0.0;  // [pressure/length] per area, [force/length] in
                           // total; above 0
  struct Spring {
    std::vector<int> nodes;  // of a face
    Points coefficients;     // c_a: root of the share of the area x shape
                             // function x direction
  };
  std::vector<Spring> springs;
  bool nodal = false;  // of springs at nodes, not of a bed
};

/// The same as springs: S = sum of k c c^T, the quadrature of
/// spring_blocks point by point, for programs that know springs and no beds.
/// A set for each component and normal that has a stiffness, and for each
/// stiffness of the springs at nodes. Throws what spring_blocks throws.
std::vector<SpringSet> spring_sets(const TetMesh& mesh,
                                   const loads::LoadCase& load_case);

/// The directions that springs pull along, with the uncertainty of normals.
std::vector<HeldDirection> sprung_directions(const TetMesh& mesh,
                                             const loads::LoadCase& load_case);

}  // namespace meniscus::supports
