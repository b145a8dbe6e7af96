/// Gradients of the shape functions of one tetrahedron at the points of its
/// stiffness rule: one point for four nodes, CalculiX's four for ten (C3D10).
#pragma once

#include <array>

#include "core/types.h"

namespace meniscus::element {

template <int Nodes>
inline constexpr int kTetPoints = Nodes == 4 ? 1 : 4;

/// Barycentric coordinates of the four-point rule: one of them is
/// kTetRuleHigh, the others kTetRuleLow; weight 1/24 each, exact to degree 2.
inline constexpr double kTetRuleHigh = 0.58541019662496845446;
inline constexpr double kTetRuleLow = 0.13819660112501051518;

template <int Nodes>
struct TetGradients {
  std::array<double, kTetPoints<Nodes>> volume;  // weight x det J [length^3]
  std::array<std::array<Vec3, Nodes>, kTetPoints<Nodes>>
      gradient;  // [1/length]
};

/// Fills `out` for nodes `x` in TetMesh's order, for Nodes = 4 or 10. False
/// when the Jacobian determinant is not positive at a point.
template <int Nodes>
bool tet_gradients(const std::array<Vec3, Nodes>& x, TetGradients<Nodes>& out);

/// Volume of a curved ten-node element, exactly: the determinant is a cubic
/// polynomial and the five-point rule has degree 3 [length^3].
double quadratic_volume(const std::array<Vec3, 10>& x);

}  // namespace meniscus::element
