/// Internal to fe_write: which boundary or constraint of a datafile carries
/// the line integrals of an edge.
#pragma once

#include <array>
#include <map>
#include <vector>

#include "evolve/films/film_complex.h"

namespace meniscus::datafile {

/// Is the curve smooth, so that a datafile has it as a boundary?
bool fe_is_boundary(const films::FilmComplex& complex, int curve);
bool fe_on_boundary(const films::FilmComplex& complex,
                    const films::ComplexEdge& edge);
bool fe_has_levels(const films::ComplexEdge& edge);

/// A boundary or constraint carries the integrals of its edges when they are
/// the same for all; those of other edges get constraints of their own.
struct FeIntegralPlaces {
  explicit FeIntegralPlaces(const films::FilmComplex& complex);

  bool needs_carrier(const films::FilmComplex& complex,
                     const films::ComplexEdge& edge) const;
  /// Level set that the carrier repeats, so that vertices born there stay on
  /// it, or -1; set of integrals.
  static std::array<int, 2> key_of(const films::FilmComplex& complex,
                                   const films::ComplexEdge& edge);

  std::vector<int> of_curve;  // set of integrals; below 0: none
  std::vector<int> of_level;
  std::map<std::array<int, 2>, int> carriers;  // constraint number
};

}  // namespace meniscus::datafile
