/// Tension that depends on how a film is turned: T g(n) per area, n its normal.
/// g is the support function of a convex body, the sum (Minkowski's) of
/// spheroids, so that it is smooth and convex however these are chosen. A free
/// drop takes that body's shape (Wulff; Taylor, Crystalline variational
/// problems, Bull. AMS 84, 1978):
///   g(n) = sum sqrt(along^2 (n.a)^2 + across^2 |n - (n.a) a|^2)
/// (Barrett, Garcke, Nuernberg, A variational formulation of anisotropic
/// geometric evolution equations in higher dimensions, Numer. Math. 109, 2008).
#pragma once

#include <cmath>
#include <string>
#include <vector>

#include "core/types.h"

namespace meniscus::films {

/// Long ones (along > across) round an edge along their axis, flat ones make a
/// face across it.
struct Spheroid {
  Vec3 axis = Vec3::UnitZ();  // not 0, any length
  double along = 1.0;         // half axes, above 0 [1]
  double across = 1.0;
};

using DropShape = std::vector<Spheroid>;  // empty: g = 1

constexpr int kSpheroidNumbers = 5;  // its axis, along, across

/// What no drop can have, for messages; empty: nothing.
inline std::string what_is_wrong(const DropShape& shape) {
  for (const Spheroid& part : shape) {
    const bool sized = part.along > 0.0 && std::isfinite(part.along) &&
                       part.across > 0.0 && std::isfinite(part.across);
    if (!sized || part.axis.isZero(0.0) || !part.axis.allFinite()) {
      return "each spheroid of its drop needs an axis that is not 0 and half "
             "axes above 0";
    }
  }
  return "";
}

/// Of all directions the mean of g, for spheroids that are nearly spheres.
inline double mean_support(const DropShape& shape) {
  double sum = shape.empty() ? 1.0 : 0.0;
  for (const Spheroid& part : shape) {
    sum += (part.along + 2.0 * part.across) / 3.0;
  }
  return sum;
}

/// The numbers of a film's tension that its energy follows: those of its field,
/// or where a drop shape alone makes it one, its tension; then those of its
/// spheroids. `film`: FilmSpec or ComplexSurface, with values or with rates.
template <class Film>
VectorX tension_numbers(const Film& film) {
  VectorX own;
  if (film.tension_field) {
    own = film.tension_field->numbers;
  } else if (!film.drop_shape.empty()) {
    own = VectorX::Constant(1, film.tension);
  }
  const Eigen::Index first = own.size();
  own.conservativeResize(first +
                         kSpheroidNumbers *
                             static_cast<Eigen::Index>(film.drop_shape.size()));
  for (std::size_t k = 0; k < film.drop_shape.size(); ++k) {
    const Spheroid& part = film.drop_shape[k];
    own.segment<kSpheroidNumbers>(first + kSpheroidNumbers *
                                              static_cast<Eigen::Index>(k))
        << part.axis,
        part.along, part.across;
  }
  return own;
}

/// The way back.
template <class Film>
void set_tension_numbers(const VectorX& numbers, Film& film) {
  const Eigen::Index first =
      numbers.size() -
      kSpheroidNumbers * static_cast<Eigen::Index>(film.drop_shape.size());
  if (film.tension_field) {
    film.tension_field->numbers = numbers.head(first);
  } else if (!film.drop_shape.empty()) {
    film.tension = numbers[0];
  }
  for (std::size_t k = 0; k < film.drop_shape.size(); ++k) {
    const auto part = numbers.segment<kSpheroidNumbers>(
        first + kSpheroidNumbers * static_cast<Eigen::Index>(k));
    film.drop_shape[k] = {part.head<3>(), part[3], part[4]};
  }
}

}  // namespace meniscus::films
