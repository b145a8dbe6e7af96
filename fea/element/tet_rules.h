/// Quadrature rules of a tetrahedron with its shape functions tabulated.
#pragma once

#include <array>
#include <vector>

#include <Eigen/Core>

namespace meniscus::element {

/// Points in a tetrahedron and what they weigh of the reference determinant.
template <int Nodes>
struct TetRule {
  struct Point {
    Eigen::Matrix<double, Nodes, 3> slopes;  // by L1, L2, L3
    std::array<double, Nodes> shape;
    double weight;
  };
  std::vector<Point> points;
};

/// The stiffness rule.
template <int Nodes>
const TetRule<Nodes>& stiffness_rule();

/// Exact for the volume of curved elements, and of degree five: exact for
/// their moments.
template <int Nodes>
const TetRule<Nodes>& volume_rule();
template <int Nodes>
const TetRule<Nodes>& moment_rule();

/// Of degree five for both orders.
template <int Nodes>
const TetRule<Nodes>& fine_rule();

/// Exact for products of two shape functions on straight elements, as the
/// consistent mass needs; of degree five on curved ones.
template <int Nodes>
const TetRule<Nodes>& mass_rule();

}  // namespace meniscus::element
