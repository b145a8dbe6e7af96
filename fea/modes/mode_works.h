/// The works of a mode that its eigenvalue is a quotient of, with their partial
/// derivatives, the mode held: K x = -lambda K_g(u) x of buckling, K x =
/// omega^2 M x of vibration (docs/theory.md, Eigenvalues as responses).
#pragma once

#include <vector>

#include "core/geometry/tet_mesh.h"
#include "fea/element/functional.h"
#include "fea/element/material.h"
#include "fea/loads/load_case.h"

namespace meniscus::modes {

/// Of a number that depends on the densities and on rigid pins, too.
struct ModeFunctional : element::Functional {
  std::vector<double> by_density;  // per region [value/density]
  /// By the points of the load case's rigid pins, which those turn about that
  /// fix some motion; of others 0 [value/length].
  Points by_pin_point;
};

/// x^T K_g(u) x = int sigma(u) : (grad x^T grad x) dV, expansion of the load
/// case's temperature taken out of sigma, by the stiffness rule as
/// geometric_stiffness() has it [force length, of a mode in lengths]. `u` and
/// `x`: 3 per node. With derivatives by nodes, displacement, temperature and
/// moduli. Throws InvalidInput: check_materials(), sizes that do not fit, a
/// temperature without a slope where derivatives are asked for.
element::Functional geometric_work(
    const TetMesh& mesh, const std::vector<element::Material>& materials,
    const loads::LoadCase& load_case, const VectorX& u, const VectorX& x,
    element::Derivatives derivatives = element::Derivatives::All);

/// x^T M x = int rho |x|^2 dV, M the consistent mass by MassRule::Exact
/// [mass length^2]. With derivatives by nodes and densities. Throws as above.
ModeFunctional inertia_work(
    const TetMesh& mesh, const std::vector<element::Material>& materials,
    const VectorX& x,
    element::Derivatives derivatives = element::Derivatives::All);

/// x^T K x, springs included, where x keeps to what the supports of `held`
/// leave free as these turn with the nodes, its pins' nodes to a rigid motion;
/// its loads are not read. `reactions`
/// to the mode, springs' forces apart, as buckling_reactions() and
/// vibration_reactions() have them: they count along normals and on pins only.
/// With derivatives by nodes, moduli and pins' points. Throws as
/// residual_gradient().
ModeFunctional stiffness_work(
    const TetMesh& mesh, const std::vector<element::Material>& materials,
    const loads::LoadCase& held, const VectorX& x, const VectorX& reactions,
    element::Derivatives derivatives = element::Derivatives::All);

/// (K + S) x, S the springs' matrix, 3 per node [force].
VectorX stiffness_times(const TetMesh& mesh,
                        const std::vector<element::Material>& materials,
                        const loads::LoadCase& held, const VectorX& x);

/// M x, M the consistent mass of `density`, one per region, by MassRule::Exact
/// [mass length]. Throws InvalidInput for sizes that do not fit.
VectorX mass_times(const TetMesh& mesh, const std::vector<double>& density,
                   const VectorX& x);

/// K x + factor K_g(u) x, and K x - square M x with `square` omega^2: what
/// supports and springs hold the mode with, 3 per node [force].
VectorX buckling_reactions(const TetMesh& mesh,
                           const std::vector<element::Material>& materials,
                           const loads::LoadCase& load_case, const VectorX& u,
                           double factor, const VectorX& x);
VectorX vibration_reactions(const TetMesh& mesh,
                            const std::vector<element::Material>& materials,
                            double square, const VectorX& x);

}  // namespace meniscus::modes
