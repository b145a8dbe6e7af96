/// Weighted sums of buckling factors and of natural frequencies as functionals
/// of the design (functional.h). Weights that are the derivatives of a
/// symmetric function of the values (eigenvalue_bound.h) give its derivatives,
/// also where values are equal: any basis of their modes gives the same.
#pragma once

#include <vector>

#include "fea/modes/mode_works.h"

namespace meniscus::modes {

/// Modes and what each counts; not owned.
struct WeightedModes {
  const std::vector<double>& values;   // factors or frequencies
  const std::vector<VectorX>& shapes;  // 3 per node, of any length but 0
  const VectorX& weights;              // those of 0 cost nothing
};

/// sum weight_k factor_k with all its partial derivatives: by nodes, moduli and
/// pins' points with the modes' own motion, by displacement and temperature.
/// From x^T (K + lambda K_g) x = 0: d lambda = -x^T (dK + lambda dK_g) x / x^T
/// K_g x. `u`: the solution of the load case. Throws as geometric_work() and
/// stiffness_work().
ModeFunctional factor_functional(
    const TetMesh& mesh, const std::vector<element::Material>& materials,
    const loads::LoadCase& load_case, const VectorX& u,
    const WeightedModes& modes);

/// sum weight_k f_k likewise: with omega = 2 pi f, d omega^2 = x^T (dK -
/// omega^2 dM) x / x^T M x. `held`: its loads are not read. Throws as
/// inertia_work() and stiffness_work().
ModeFunctional frequency_functional(
    const TetMesh& mesh, const std::vector<element::Material>& materials,
    const loads::LoadCase& held, const WeightedModes& modes);

}  // namespace meniscus::modes
