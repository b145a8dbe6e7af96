/// Shape functions of a tetrahedron at any point, and a rule of degree five.
#pragma once

#include <array>

#include "core/types.h"
#include "fea/element/tet_element.h"

namespace meniscus::element {

/// Barycentric coordinates; their sum is 1.
using Barycentric = std::array<double, 4>;

/// Values of the shape functions in TetMesh's order; Nodes = 4 or 10.
template <int Nodes>
std::array<double, Nodes> tet_shapes(const Barycentric& L);

/// Their derivatives by the reference coordinates (L1, L2, L3).
template <int Nodes>
std::array<Vec3, Nodes> tet_slopes_at(const Barycentric& L);

/// Point q of the stiffness rule.
template <int Nodes>
Barycentric rule_point(int q) {
  if constexpr (Nodes == 4) {
    return {0.25, 0.25, 0.25, 0.25};
  } else {
    Barycentric L = {kTetRuleLow, kTetRuleLow, kTetRuleLow, kTetRuleLow};
    L[q] = kTetRuleHigh;
    return L;
  }
}

/// Fourteen points with positive weights (fractions of the volume), exact to
/// degree five (Walkington, Quadrature on simplices of arbitrary dimension,
/// 2000).
struct TetRulePoint {
  Barycentric L;
  double weight;
};
const std::array<TetRulePoint, 14>& fine_tet_rule();

/// Displacement gradient du_i/dx_j of nodal values `u` at `L`, and the
/// determinant of the map from the reference element (6 x volume of a
/// straight one) [length^3].
template <int Nodes>
struct GradientAt {
  Mat3 gradient;
  double determinant = 0.0;
};
template <int Nodes>
GradientAt<Nodes> gradient_at(const std::array<Vec3, Nodes>& x,
                              const std::array<Vec3, Nodes>& u,
                              const Barycentric& L);

}  // namespace meniscus::element
