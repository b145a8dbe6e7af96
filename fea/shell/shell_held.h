/// Whether supports keep a shell from moving as a whole.
#pragma once

#include <string>
#include <vector>

#include "core/math/dense.h"
#include "fea/shell/shell_mesh.h"
#include "fea/shell/shell_supports.h"

namespace meniscus::shell {

/// How well the least held motion is held, of how the best is: two nodes h
/// apart hold the turn of a part of size L by (h / L)^2, rounding leaves 1e-14.
inline constexpr double kHeld = 1e-11;

/// A node's six numbers under six motions: along x y z, and turns about the
/// part's center by which `size` moves 1; rotations times `size`.
Matrix6 rigid_motions(const Vec3& arm, double size);

/// "turn about (0, 0, 1)", for messages, of factors of these.
std::string motion_text(const Eigen::Matrix<double, 6, 1>& motion);

/// The rigid motions that facets which hang together, by rigid rims too, are
/// free to make, one a column, on the unknowns.
Eigen::MatrixXd free_motions(const ShellMesh& mesh,
                             const ShellFreedom& freedom);

/// Throws SolverError, naming a place and the motion, where there are any that
/// the springs leave, too. A factor may not notice: rounding leaves pivots that
/// are positive.
void check_held(const ShellMesh& mesh, const ShellFreedom& freedom,
                const std::vector<GroundSpring>& springs = {});

}  // namespace meniscus::shell
