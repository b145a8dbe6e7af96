/// A spine as poles whose strengths hold a film at the spine's radius.
///
/// Poles of a density w along a straight line, each with the core e, press with
///   phi(d) = (4/3) w / (d^2 + e^2)^2
/// at the distance d from it. A tube of radius R and tension T rests where
/// phi(R) = T / R. With e = c R:
///   w = 3/4 (1 + c^2)^2 T R^3,
/// the second variation of the mode cos(m a) sin(k z) per area is
///   T (m^2 - 1 + 4 / (1 + c^2)) / R^2 + T k^2,
/// above 0 for every wavelength, and a tube has the energy
///   pi T R (1 - 1 / c^2)
/// per length: below 0 where c < 1, so that the liquid keeps to the whole of
/// its spine. Where radii change, spines bend or meet, the film blends
/// (docs/theory.md, Spines); nothing is solved for there.
#pragma once

#include <cmath>
#include <vector>

#include "evolve/films/spine_spec.h"

namespace meniscus::spines {

inline constexpr double kCore = 0.7;  // c: of poles, over the radius

/// Gauss points along each piece of the spine, less than half its radius apart.
/// `beyond`: the spine goes on straight past its first and its last point, as
/// where it ends at a rim; else the liquid ends round there. Throws
/// InvalidInput for less than two points, points that coincide, lists that do
/// not fit, a radius or tension that is not above 0.
films::SpineSampling sample_spine(const films::SpineSpec& spine, int body,
                                  const std::array<bool, 2>& beyond);

/// Whether its last point is its first, but for rounding.
bool is_closed(const films::SpineSpec& spine);

/// The poles of a spine at a design: one per sample. Throws InvalidInput for
/// other counts of points than the sampling's, for one that closes or opens,
/// and as sample_spine().
std::vector<films::Pole> poles_of(const films::SpineSampling& sampling,
                                  const films::SpineSpec& spine);

/// How fast they change, `rates` the spine with each number's derivative.
std::vector<films::Pole> pole_rates(const films::SpineSampling& sampling,
                                    const films::SpineSpec& spine,
                                    const films::SpineSpec& rates);

/// The same of all spines of one body, in the order of `samplings`; the specs
/// by their names. Throws InvalidInput also for a name that is not among them.
std::vector<films::Pole> poles_of(
    const std::vector<films::SpineSampling>& samplings, int body,
    const std::vector<films::SpineSpec>& spines);
std::vector<films::Pole> pole_rates(
    const std::vector<films::SpineSampling>& samplings, int body,
    const std::vector<films::SpineSpec>& spines,
    const std::vector<films::SpineSpec>& rates);

/// The spines sampled anew for a design, where they go on beyond as before.
void sample_again(const std::vector<films::SpineSpec>& spines,
                  std::vector<films::SpineSampling>& samplings);

/// What a pole adds to the level whose surface, at 1, is the film of a straight
/// spine of any radius.
inline double level_at(const films::Pole& pole, double tension, const Vec3& x) {
  const double s = (x - pole.at).squaredNorm() + pole.core2;
  return pole.strength * std::sqrt(pole.core2) / (kCore * tension) /
         (s * s * std::sqrt(s));
}

}  // namespace meniscus::spines
