/// Newton's method to film equilibrium at the bodies' volumes and pressures,
/// with the verdict on what was found.
#pragma once

#include "evolve/energy/constrained_hessian.h"
#include "evolve/energy/energy.h"
#include "evolve/settle/film_state.h"
#include "evolve/settle/neck.h"

namespace meniscus::settle {

/// Equilibrium over heights h, each free vertex at base + h d. A pure function
/// of its arguments. The film is a minimum wherever one is found from `start`
/// (empty: h = 0); where descent finds none, a saddle near the start is looked
/// for, so that the failure can name it. After the stop criterion one more
/// full step is taken: the result is converged to rounding, so that it is a
/// smooth function of `base` and `targets`. `usual_neck`: the smallest neck of
/// a film that is known to be sound, against which necks are judged; 0 for
/// none. state.failure: FilmUnstable, FilmPinched or FilmNotFound. Throws
/// Interrupted only.
FilmState settle_along(const energy::FilmEnergy& energy,
                       const films::FilmComplex& complex,
                       const films::FilmTargets& targets, const Points& base,
                       const Points& directions, const VectorX& start,
                       double usual_neck, const SettleOptions& options);

/// The same along the current vertex normals, which are taken anew at every
/// step; `start` is the whole film. heights of the result are zero.
FilmState settle_in_normals(const energy::FilmEnergy& energy,
                            const films::FilmComplex& complex,
                            const films::FilmTargets& targets,
                            const Points& start, const SettleOptions& options,
                            double usual_neck = 0.0);

/// The same; from a saddle with one falling direction on to a film beside it:
/// at a fold one side falls to the film and the other tears. The saddle where
/// neither side settles.
FilmState settle_past_saddles(const energy::FilmEnergy& energy,
                              const films::FilmComplex& complex,
                              const films::FilmTargets& targets,
                              const Points& start, const SettleOptions& options,
                              double usual_neck = 0.0);

/// Lowest mode of a film at `points` (more may follow its vertices: only the
/// first are read) under the given pressures, by a factorisation.
energy::LowestMode lowest_mode_of(const energy::FilmEnergy& energy,
                                  const films::FilmTargets& targets,
                                  const Points& points,
                                  const VectorX& pressure);

/// What can be read from a film at `points`: counts, energy, area, and per
/// functional its value and `pressure`. The rest is left at its defaults.
FilmReport figures_of(const energy::FilmEnergy& energy,
                      const films::FilmTargets& targets, const Points& points,
                      const VectorX& pressure);

/// One per functional.
VectorX pressures_of(const FilmReport& report);

/// The films of a complex that pops made, at `points`.
std::vector<PulledFilm> popped_films(const films::FilmComplex& complex,
                                     const Points& points);

struct VerdictInput {
  std::string reason;  // why no equilibrium was reached; empty: it was
  Vec3 mode_position = Vec3::Zero();  // where the lowest mode is largest
  double usual_neck = 0.0;            // [length]; 0: not known
  std::optional<Neck> neck;           // where it has been measured already
};

/// Measures the narrowest neck and says in words what was found, from the
/// residual and the index in state.report: sets report.smallest_neck,
/// neck_position and verdict, and state.failure. A film that settled is still
/// called pinching when its neck is under two edges, or under a fifth of the
/// usual one: such a film can end at a perfect residual and a positive
/// definite Hessian.
void set_verdict(const energy::FilmEnergy& energy,
                 const films::FilmComplex& complex, const VerdictInput& input,
                 FilmState& state);

}  // namespace meniscus::settle
