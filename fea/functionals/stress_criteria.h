/// Criteria of strength and of fatigue at a node, as ratios: 1 where a stress
/// is just allowed. Bounds of their largest value: nodal_peak.h.
#pragma once

#include <span>
#include <vector>

#include "core/math/worst_direction.h"
#include "fea/functionals/nodal_peak.h"

namespace meniscus::functionals {

/// Von Mises stress over `allowable`, one per region, > 0 [pressure].
NodeCriterion von_mises_ratio(std::vector<double> allowable);

/// The same of the worst sum d_x a + d_y b + d_z c of three states, d a unit
/// vector in the cone: the root of a quadratic form's largest value, with what
/// worst_of_quadratic() says of its derivative.
NodeCriterion worst_von_mises_ratio(std::vector<double> allowable,
                                    const Cone& cone);

/// The d of that ratio at a node.
Vec3 worst_stress_direction(std::span<const element::Stress> stress,
                            const Cone& cone);

/// The largest principal stress over `allowable`, where it is tension: the
/// p-norm of the positive parts of all three, so that it is smooth where they
/// are equal, and at most 3^(1/p) times the largest.
NodeCriterion tension_ratio(std::vector<double> allowable);

/// What a material endures of stress that goes to and fro [pressure].
struct Endurance {
  double limit = 0.0;    // amplitude of reversed tension, > 0
  double tensile = 0.0;  // its tensile strength, > 0; of Goodman
  double torsion = 0.0;  // amplitude of reversed torsion, > 0; of Crossland
};

/// Between two states a and b, with amplitude (a - b) / 2 and mean (a + b) / 2:
///   von Mises(amplitude) / limit + max(0, trace(mean)) / tensile,
/// Goodman's line (J. Goodman, Mechanics applied to engineering, 1899) with the
/// effective amplitude and mean of N. E. Dowling, Mechanical behavior of
/// materials (multiaxial fatigue, the effective stress approach): in a bar the
/// stresses themselves, in shear no mean. The maximum is smooth, from above by
/// no more than kGoodmanRound.
inline constexpr double kGoodmanRound = 0.001;
NodeCriterion goodman_ratio(std::vector<Endurance> endurance);

/// Between two states:
///   (sqrt(J2) of the amplitude + alpha * larger hydrostatic stress) / torsion,
/// alpha = 3 torsion / limit - sqrt(3), so that it is 1 in reversed tension at
/// the limit and in reversed torsion (B. Crossland, Proc. Int. Conf. Fatigue of
/// Metals, 1956, 138). torsion >= limit / sqrt(3), as ductile metals have it,
/// or alpha would be below 0. The larger of two is smooth, the ratio from above
/// by no more than kCrosslandRound.
inline constexpr double kCrosslandRound = 0.001;
NodeCriterion crossland_ratio(std::vector<Endurance> endurance);

}  // namespace meniscus::functionals
