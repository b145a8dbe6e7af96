/// A vector field whose divergence is a given scalar, so that the scalar's
/// integral over a body becomes a flux through its facets:
///   F(x) = (x - o) int_0^1 t^2 phi(o + t (x - o)) dt.
#pragma once

#include <array>

#include "core/math/place_field.h"
#include "core/types.h"
#include "evolve/films/film_complex.h"

namespace meniscus::energy {

/// F, its derivative and the second derivatives of its components.
struct FieldJet {
  Vec3 value = Vec3::Zero();
  Eigen::Matrix3d slope = Eigen::Matrix3d::Zero();  // row m: grad F_m
  std::array<Eigen::Matrix3d, 3> bend;              // Hessian of F_m
};

/// F and its derivatives at a place, for phi at a place. Gauss points along
/// the ray, closer to each other towards a pole; exact to rounding for
/// polynomials of degree 12. Value and derivatives belong to the same sum.
/// Throws ExpressionError where phi has no value.
FieldJet radial_field(const PlaceField& phi, Numbers numbers,
                      const films::RayOrigin& origin, const Vec3& at);
/// F alone.
Vec3 radial_value(const PlaceField& phi, Numbers numbers,
                  const films::RayOrigin& origin, const Vec3& at);
/// How fast F and its derivative change as the numbers do; no second ones.
FieldJet radial_rate(const PlaceField& phi, Numbers numbers, Numbers rates,
                     const films::RayOrigin& origin, const Vec3& at);
/// Adds to `sum`, one per number, by_value . the derivative of F by it, and
/// the sum of by_slope x that of the derivative of F, element by element.
void add_radial_by_numbers(const PlaceField& phi, Numbers numbers,
                           const films::RayOrigin& origin, const Vec3& at,
                           const Vec3& by_value,
                           const Eigen::Matrix3d& by_slope, VectorX& sum);

}  // namespace meniscus::energy
