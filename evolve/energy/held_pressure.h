/// First guess of the pressures (Lagrange multipliers) of held functionals.
#pragma once

#include <vector>

#include "core/types.h"
#include "evolve/energy/energy.h"

namespace meniscus::energy {

/// One pressure per functional [energy per unit of the functional]: the
/// targets' where they are given, 0 elsewhere, and of the `held` ones those
/// that leave the least residual gradient - slopes p in the inverse of
/// `metric` (lumped area per unknown [length^2]). `slopes`: derivatives of the
/// functionals, unknowns x functionals.
VectorX guess_pressures(const films::FilmTargets& targets,
                        const std::vector<int>& held, const VectorX& gradient,
                        const Eigen::MatrixXd& slopes, const VectorX& metric);

}  // namespace meniscus::energy
