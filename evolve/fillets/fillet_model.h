/// Fillets frozen on a film: where it meets another surface along a curve, the
/// arc of a ball that rolls along the curve and touches both takes the place of
/// the sharp corner, exactly at every design and every radius.
///
///   y(p) = x + sum of weight x (q_i(s; x, r) - p_i(s; x))
///
/// for each point x beside the curve, over the two sections next to it: p_i the
/// surface's section across the curve, q_i the same with the arc in its corner
/// (evolve/fillets/rolling_arc.h). Which sections, s and weight are fixed when
/// the model is frozen; the arc is found anew at every design. With r = 0, y is
/// x.
#pragma once

#include <vector>

#include "core/geometry/surface_mesh.h"
#include "evolve/fillets/fillet_bands.h"
#include "evolve/frozen/film_model.h"

namespace meniscus::fillets {

/// A response's derivatives by what a rounded surface is made of.
struct FilletGradient {
  Points film;     // by the film's points
  VectorX radius;  // by each fillet's radius
};

class FilletModel {
 public:
  /// On the film `points` of a state of `film`; `system`: its own, whose
  /// fillets are made. Throws InvalidInput as freeze_bands().
  static FilletModel freeze(const frozen::FilmModel& film,
                            const films::FilmSystem& system,
                            const Points& points);

  /// The same on a closed surface, outward, with points on each fillet's curve.
  FilletModel(const SurfaceMesh& surface, const films::FilmSystem& system,
              const std::vector<std::vector<int>>& rims);

  /// The film's points with the fillets of `system`, one of the same names.
  /// Throws InvalidInput, with the place, where a ball does not fit within the
  /// bands that were frozen, for a radius below 0, and for one above 0 where
  /// the model was frozen with 0.
  Points rounded(const Points& film, const films::FilmSystem& system) const;

  /// rounded() transposed.
  FilletGradient transpose(const Points& film, const films::FilmSystem& system,
                           const Points& by_rounded) const;

  const std::vector<FilletBands>& bands() const { return bands_; }

 private:
  std::vector<FilletBands> bands_;
};

}  // namespace meniscus::fillets
