/// A vector field whose divergence is a given scalar, so that the scalar's
/// integral over a body becomes a flux through its facets:
///   F(x) = (x - o) int_0^1 t^2 phi(o + t (x - o)) dt.
#pragma once

#include <array>

#include "core/math/expression.h"
#include "core/types.h"

namespace meniscus::energy {

/// F, its derivative and the second derivatives of its components.
struct FieldJet {
  Vec3 value = Vec3::Zero();
  Eigen::Matrix3d slope = Eigen::Matrix3d::Zero();  // row m: grad F_m
  std::array<Eigen::Matrix3d, 3> bend;              // Hessian of F_m
};

/// F and its derivatives at a place, for phi over x, y, z. Gauss points along
/// the ray, closer to each other towards `origin` (o), where a pole is best
/// placed; exact to rounding for polynomials of degree 12. Value and
/// derivatives belong to the same sum. Throws ExpressionError where phi has no
/// value.
FieldJet radial_field(const Expression& phi, const Vec3& origin,
                      const Vec3& at);

}  // namespace meniscus::energy
