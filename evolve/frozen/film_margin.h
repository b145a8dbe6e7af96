/// How far a film is from collapse: a smooth lower bound of the eigenvalues
/// that report.min_eigenvalue is the least of, with its derivatives
/// (docs/theory.md, Margins).
#pragma once

#include "evolve/energy/saddle_system.h"
#include "evolve/frozen/film_gradient.h"

namespace meniscus::frozen {

/// Of the film at `points` along `paths`, in the metric of lumped area
/// [force/length^3]; `pressure` and `saddle` are of that film, `scale` > 0 an
/// eigenvalue [force/length^3] that must not depend on the design. Throws
/// InvalidInput for options out of range, energy::ModesNotFound for an unstable
/// film and for modes that are not found.
FilmResponse film_margin(const energy::FilmEnergy& energy,
                         const films::FilmTargets& targets,
                         const Points& points, const energy::FilmPaths& paths,
                         const VectorX& pressure,
                         const energy::SaddleSystem& saddle, double scale,
                         const MarginOptions& options);

}  // namespace meniscus::frozen
