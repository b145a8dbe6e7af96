/// Newton's method to film equilibrium at the bodies' volumes and pressures,
/// with the verdict on what was found.
#pragma once

#include "evolve/energy.h"
#include "evolve/film_model.h"

namespace meniscus {

/// Equilibrium over heights h, each free vertex at base + h d. A pure function
/// of its arguments. The film is a minimum wherever one is found from `start`
/// (empty: h = 0); where descent finds none, a saddle near the start is looked
/// for, so that the failure can name it. After the stop criterion one more
/// full step is taken: the result is converged to rounding, so that it is a
/// smooth function of `base` and `targets`. state.failure: FilmUnstable,
/// FilmPinched or FilmNotFound. Throws Interrupted only.
FilmState settle_along(const FilmEnergy& energy, const FilmComplex& complex,
                       const FilmTargets& targets, const Points& base,
                       const Points& directions, const VectorX& start,
                       const SettleOptions& options);

/// The same along the current vertex normals, which are taken anew at every
/// step; `start` is the whole film. heights of the result are zero.
FilmState settle_in_normals(const FilmEnergy& energy,
                            const FilmComplex& complex,
                            const FilmTargets& targets, const Points& start,
                            const SettleOptions& options);

/// What settle_along and settle_in_normals say of a film that is given:
/// report.verdict and failure from residual, index, mode and necks in
/// state.report; `converged` false says why in `reason`.
void judge(const FilmEnergy& energy, const FilmComplex& complex,
           FilmState& state, const std::string& reason,
           const Vec3& mode_position);

}  // namespace meniscus
