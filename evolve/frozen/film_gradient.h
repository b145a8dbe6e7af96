/// Gradients through the frozen film, backwards: from what is asked of a
/// settled film to what its design gives (FilmModel::transpose). J may be in
/// any unit; derivatives are J's unit per that of what they are taken by.
#pragma once

#include <string>
#include <vector>

#include "core/types.h"

namespace meniscus::frozen {

/// Derivatives of a response J by what a settled film shows, each at fixed
/// others. What is empty is zero; a list of another length is refused.
struct FilmCovector {
  Points points;        // by x, one per vertex of the film
  VectorX pressures;    // by the bodies' pressures, in the report's order
  VectorX volumes;      // by the bodies' volumes, in the report's order
  VectorX areas;        // by the films' areas, one per label; caps do not count
  double energy = 0.0;  // by the report's energy
  Points directions;    // by dx/dh, one per height (film margins have this)
  Points bends;         // by d2x/dh2, the same
  VectorX tensions;     // by the films' tensions themselves, one per label
  std::vector<VectorX> numbers;  // by those of the fields (films::FilmTargets)
};

/// dJ by the points of one curve that the model's rim vertices lie on.
struct RimGradient {
  std::string curve;
  std::vector<double> parameters;  // t of each rim vertex
  Points by_points;                // one per parameter
};

/// Total derivatives of J by the design: the film has followed to its
/// equilibrium.
struct FilmGradient {
  std::vector<RimGradient> rims;  // one per curve of the model
  VectorX tensions;   // one per label, of walls too; 0 for caps that wet none
                      // and for tension fields
  VectorX volumes;    // by the volume asked for, one per body; 0 if none is
  VectorX pressures;  // by the pressure asked for; 0 where a volume is
  std::vector<VectorX> numbers;  // by those of the fields (films::FilmTargets)
};

/// A response of the settled film with its derivatives, for transpose().
struct FilmResponse {
  double value = 0.0;
  FilmCovector by;
};

/// Margin to collapse: a smooth bound from below of the film's lowest
/// eigenvalue (Kreisselmeier, Steinhauser 1979),
///   m = lambda_1 - log(sum_j exp(-s (lambda_j - lambda_1))) / s,
/// over the lowest modes; s = sharpness / the reference's lowest eigenvalue.
struct MarginOptions {
  int modes = 4;            // > 0; more where many fall together
  double sharpness = 20.0;  // > 0; more: nearer to lambda_1, less smooth
};

}  // namespace meniscus::frozen
