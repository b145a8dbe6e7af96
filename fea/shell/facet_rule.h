/// What a six-node facet knows before it has a place: points of its rule with
/// shape functions, and how a rotation is carried along the facet.
#pragma once

#include <array>
#include <vector>

#include <Eigen/Core>

namespace meniscus::shell {

/// Nodes: corners 0 1 2, then the middles of edges (01), (12), (20). Function
/// 6 is the cubic bubble, which only rotations have.
inline constexpr int kNodes = 6;
inline constexpr int kFunctions = 7;

struct FacetPoint {
  double weight = 0.0;  // of the reference triangle's area, 1/2 in sum
  std::array<double, kFunctions> shape;
  Eigen::Matrix<double, kFunctions, 2> slope;  // by the two coordinates
  Eigen::Matrix<double, kNodes, 3> curve;      // second: 11, 12, 22
  /// Entry (2 i + a, j): component a of the interpolation of N_i dN_j here, so
  /// that a rotation's theta x dX becomes the sum of theta_i x X_j times it.
  Eigen::Matrix<double, 2 * kFunctions, kNodes> carried;
  /// Entry (3 i + k, j): component k (11, 12, 22) of the interpolation of
  /// sym(dN_i dN_j) here, so that the surface's strain sym(du . dX) becomes the
  /// sum of u_i . X_j times it.
  Eigen::Matrix<double, 3 * kNodes, kNodes> stretched;
};

using FacetRule = std::vector<FacetPoint>;

/// Shape functions at a place of the reference triangle; `carried` is left 0.
FacetPoint facet_functions(double xi, double eta);

/// Six points, exact to degree four. One-forms are interpolated in Nedelec's
/// first space of degree two by their moments along edges and inside (Nedelec,
/// Numer. Math. 35, 1980): gradients of quadratic fields are in it.
const FacetRule& facet_rule();

/// The same at a place of the caller's, weight 0: where stresses are asked.
FacetPoint facet_point(double xi, double eta);

/// At the center.
const FacetPoint& facet_center();

/// Three points along each edge (01), (12), (20), weights of its length in the
/// reference coordinates, `along` from its first corner to its second.
struct EdgePoint {
  FacetPoint at;
  double weight = 0.0;
  Eigen::Vector2d along;
};
const std::array<std::array<EdgePoint, 3>, 3>& edge_rules();

}  // namespace meniscus::shell
