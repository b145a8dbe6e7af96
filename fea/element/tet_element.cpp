#include "fea/element/tet_element.h"

#include <Eigen/LU>

#include "core/geometry/tet_mesh.h"

namespace meniscus::element {

namespace {

using Barycentric = std::array<double, 4>;

/// Derivatives of L0..L3 by the reference coordinates (L1, L2, L3).
constexpr double kSlope[4][3] = {
    {-1.0, -1.0, -1.0}, {1.0, 0.0, 0.0}, {0.0, 1.0, 0.0}, {0.0, 0.0, 1.0}};

/// Derivatives of the ten shape functions, one column per node.
Eigen::Matrix<double, 3, 10> quadratic_slopes(const Barycentric& L) {
  Eigen::Matrix<double, 3, 10> d;
  for (int k = 0; k < 3; ++k) {
    for (int c = 0; c < 4; ++c) {
      d(k, c) = (4.0 * L[c] - 1.0) * kSlope[c][k];
    }
    for (int m = 0; m < 6; ++m) {
      const auto [a, b] = kTetEdges[m];
      d(k, 4 + m) = 4.0 * (L[a] * kSlope[b][k] + L[b] * kSlope[a][k]);
    }
  }
  return d;
}

template <int Nodes>
using Slopes = std::array<Eigen::Matrix<double, 3, Nodes>, kTetPoints<Nodes>>;

Slopes<4> rule_slopes(std::integral_constant<int, 4>) {
  Slopes<4> slopes;
  for (int c = 0; c < 4; ++c) {
    slopes[0].col(c) = Vec3(kSlope[c][0], kSlope[c][1], kSlope[c][2]);
  }
  return slopes;
}

Slopes<10> rule_slopes(std::integral_constant<int, 10>) {
  Slopes<10> slopes;
  for (int q = 0; q < 4; ++q) {
    Barycentric L;
    L.fill(kTetRuleLow);
    L[q] = kTetRuleHigh;
    slopes[q] = quadratic_slopes(L);
  }
  return slopes;
}

template <int Nodes>
Mat3 jacobian(const Eigen::Matrix<double, 3, Nodes>& slopes,
              const std::array<Vec3, Nodes>& x) {
  Mat3 J = Mat3::Zero();
  for (int a = 0; a < Nodes; ++a) {
    J.noalias() += slopes.col(a) * x[a].transpose();
  }
  return J;
}

}  // namespace

template <int Nodes>
bool tet_gradients(const std::array<Vec3, Nodes>& x, TetGradients<Nodes>& out) {
  static const Slopes<Nodes> kSlopes =
      rule_slopes(std::integral_constant<int, Nodes>{});
  constexpr double kWeight = Nodes == 4 ? 1.0 / 6.0 : 1.0 / 24.0;
  bool positive = true;
  for (int q = 0; q < kTetPoints<Nodes>; ++q) {
    const Mat3 J = jacobian<Nodes>(kSlopes[q], x);
    const double det = J.determinant();
    positive = positive && det > 0.0;
    out.volume[q] = kWeight * det;
    const Mat3 inverse = J.inverse();
    for (int a = 0; a < Nodes; ++a) {
      out.gradient[q][a].noalias() = inverse * kSlopes[q].col(a);
    }
  }
  return positive;
}

template bool tet_gradients<4>(const std::array<Vec3, 4>&, TetGradients<4>&);
template bool tet_gradients<10>(const std::array<Vec3, 10>&, TetGradients<10>&);

double quadratic_volume(const std::array<Vec3, 10>& x) {
  constexpr double kCentre = -4.0 / 5.0;
  constexpr double kOuter = 9.0 / 20.0;
  double sum =
      kCentre *
      jacobian<10>(quadratic_slopes({0.25, 0.25, 0.25, 0.25}), x).determinant();
  for (int q = 0; q < 4; ++q) {
    Barycentric L;
    L.fill(1.0 / 6.0);
    L[q] = 0.5;
    sum += kOuter * jacobian<10>(quadratic_slopes(L), x).determinant();
  }
  return sum / 6.0;
}

}  // namespace meniscus::element
