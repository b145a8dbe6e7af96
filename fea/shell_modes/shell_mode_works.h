/// The works of a shell's mode that its eigenvalue is a quotient of, and sums
/// of eigenvalues, with their derivatives: what
/// fea/modes/eigenvalue_functionals has of solids. All vectors have 6 numbers
/// per node.
#pragma once

#include <functional>
#include <vector>

#include "core/math/linear_solve.h"
#include "fea/modes/eigenvalue_functionals.h"
#include "fea/shell/shell_gradient.h"
#include "fea/shell/shell_loads.h"
#include "fea/shell/shell_mesh.h"

namespace meniscus::shell {

/// Derivatives with all else held: nodal displacements too, not the bubbles,
/// which follow them.
struct ModeWork : ShellGradient {
  VectorX by_displacement;
  Points by_points = {};  // of rigid rims; empty: 0
};

/// x^T K_g(u) x, `u` the solution under `loads`. Exact, by a tape over each
/// facet; the same bits for any number of threads. Throws as ShellSystem does.
ModeWork geometric_work(const ShellMesh& mesh,
                        const std::vector<Section>& sections,
                        const ShellLoads& loads, const VectorX& u,
                        const VectorX& x);

/// x^T M x likewise.
ShellGradient inertia_work(const ShellMesh& mesh,
                           const std::vector<Section>& sections,
                           const VectorX& x);

/// M of all nodes' numbers, lower triangle.
SparseMatrix nodal_mass(const ShellMesh& mesh,
                        const std::vector<Section>& sections);

/// Adds the derivatives, by nodes and rims' points, that springs and rigid rims
/// have in -x . A x: A is K + factor K_g, or K - omega^2 M, of that mode.
using AddHeldWork =
    std::function<void(std::size_t mode, const VectorX& x, ModeWork& work)>;

/// sum weight_k factor_k, factors of the loads at the solution `u` under them:
/// d lambda = -x^T (dK + lambda dK_g) x / x^T K_g x. Throws as the works.
/// `held` as of frequency_functional().
ModeWork factor_functional(const ShellMesh& mesh,
                           const std::vector<Section>& sections,
                           const ShellLoads& loads, const VectorX& u,
                           const modes::WeightedModes& modes,
                           const AddHeldWork& held = {});

/// sum weight_k f_k: with omega = 2 pi f, d omega^2 = x^T (dK - omega^2 dM) x /
/// x^T M x. By displacement nothing. `held`: of the springs that K has, too,
/// and of rigid rims; empty where it has none.
ModeWork frequency_functional(const ShellMesh& mesh,
                              const std::vector<Section>& sections,
                              const modes::WeightedModes& modes,
                              const AddHeldWork& held = {});

}  // namespace meniscus::shell
