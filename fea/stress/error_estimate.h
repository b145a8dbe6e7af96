/// How far a finite-element solution is from the exact one.
#pragma once

#include <vector>

#include "fea/stress/patch_recovery.h"

namespace meniscus::stress {

/// Zienkiewicz and Zhu, A simple error estimator and adaptive procedure
/// (1987), with stresses recovered by patches (1992): energy norm of the
/// difference of recovered and computed stress,
/// |e|^2 = integral of (s* - s_h) : C^-1 : (s* - s_h). It knows nothing of the
/// error of the geometry.
struct EnergyError {
  std::vector<double> element;  // |e| of each [(force length)^(1/2)]
  double error = 0.0;           // of all: root of the sum of squares
  double energy_norm = 0.0;     // |u_h|: root of twice the strain energy
  /// error / (|u_h|^2 + error^2)^(1/2); 0.05 is a usual demand.
  double relative() const;
};

/// A solution under one load case with its recovered stresses, on loan.
struct StressedSolution {
  const VectorX& displacement;  // 3 per node [length]
  const RecoveredStress& stress;
  VectorX temperature_change;  // as point_stress() takes it
};

/// The same bits for any number of threads. Throws InvalidInput when the parts
/// do not fit each other.
EnergyError estimate_error(const TetMesh& mesh,
                           const std::vector<element::Material>& materials,
                           const StressedSolution& solution);

/// Error of a linear functional J of the displacement by dual weighting
/// (Becker and Rannacher, An optimal control approach to a posteriori error
/// estimation, 2001): with the dual solution z of a(v, z) = J(v),
/// J(u) - J(u_h) = integral of (s(u) - s(u_h)) : C^-1 : (s(z) - s(z_h)); the
/// exact stresses are replaced by recovered ones. The dual of a mean
/// displacement of a surface is the solution under a unit force spread over
/// that surface, with the same supports.
struct ResponseError {
  std::vector<double> element;  // contributions, signed
  double value = 0.0;           // their sum: J(u) - J(u_h), estimated
  double bound = 0.0;           // the sum of their sizes
};
ResponseError response_error(const TetMesh& mesh,
                             const std::vector<element::Material>& materials,
                             const StressedSolution& primal,
                             const StressedSolution& dual);

}  // namespace meniscus::stress
