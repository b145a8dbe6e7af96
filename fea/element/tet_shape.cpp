#include "fea/element/tet_shape.h"

#include <Eigen/LU>

#include "core/geometry/tet_mesh.h"

namespace meniscus::element {

namespace {

/// Derivatives of L0..L3 by the reference coordinates (L1, L2, L3).
const Vec3& slope(int corner) {
  static const std::array<Vec3, 4> kSlopes = {
      Vec3(-1.0, -1.0, -1.0), Vec3::UnitX(), Vec3::UnitY(), Vec3::UnitZ()};
  return kSlopes[corner];
}

std::array<TetRulePoint, 14> make_fine_rule() {
  constexpr double kInner = 0.31088591926330060980;
  constexpr double kOuter = 0.092735250310891226402;
  constexpr double kEdge = 0.045503704125649649492;
  std::array<TetRulePoint, 14> rule;
  int next = 0;
  for (const auto& [a, weight] : {std::pair{kInner, 0.11268792571801585080},
                                  std::pair{kOuter, 0.073493043116361949544}}) {
    for (int c = 0; c < 4; ++c) {
      rule[next] = {{a, a, a, a}, weight};
      rule[next++].L[c] = 1.0 - 3.0 * a;
    }
  }
  for (const auto& [a, b] : kTetEdges) {
    rule[next] = {{kEdge, kEdge, kEdge, kEdge}, 0.042546020777081466438};
    rule[next].L[a] = 0.5 - kEdge;
    rule[next++].L[b] = 0.5 - kEdge;
  }
  return rule;
}

}  // namespace

template <int Nodes>
std::array<double, Nodes> tet_shapes(const Barycentric& L) {
  std::array<double, Nodes> N;
  for (int c = 0; c < 4; ++c) {
    N[c] = Nodes == 4 ? L[c] : L[c] * (2.0 * L[c] - 1.0);
  }
  if constexpr (Nodes == 10) {
    for (int m = 0; m < 6; ++m) {
      N[4 + m] = 4.0 * L[kTetEdges[m][0]] * L[kTetEdges[m][1]];
    }
  }
  return N;
}

const std::array<TetRulePoint, 14>& fine_tet_rule() {
  static const std::array<TetRulePoint, 14> kRule = make_fine_rule();
  return kRule;
}

template <int Nodes>
std::array<Vec3, Nodes> tet_slopes_at(const Barycentric& L) {
  std::array<Vec3, Nodes> d;
  for (int c = 0; c < 4; ++c) {
    d[c] = slope(c) * (Nodes == 4 ? 1.0 : 4.0 * L[c] - 1.0);
  }
  if constexpr (Nodes == 10) {
    for (int m = 0; m < 6; ++m) {
      const auto [a, b] = kTetEdges[m];
      d[4 + m] = 4.0 * (L[a] * slope(b) + L[b] * slope(a));
    }
  }
  return d;
}

template <int Nodes>
GradientAt<Nodes> gradient_at(const std::array<Vec3, Nodes>& x,
                              const std::array<Vec3, Nodes>& u,
                              const Barycentric& L) {
  const std::array<Vec3, Nodes> d = tet_slopes_at<Nodes>(L);
  Mat3 J = Mat3::Zero();  // dx_i / dxi_j
  Mat3 U = Mat3::Zero();
  for (int a = 0; a < Nodes; ++a) {
    J.noalias() += x[a] * d[a].transpose();
    U.noalias() += u[a] * d[a].transpose();
  }
  return {U * J.inverse(), J.determinant()};
}

template std::array<double, 4> tet_shapes<4>(const Barycentric&);
template std::array<double, 10> tet_shapes<10>(const Barycentric&);
template std::array<Vec3, 4> tet_slopes_at<4>(const Barycentric&);
template std::array<Vec3, 10> tet_slopes_at<10>(const Barycentric&);
template GradientAt<4> gradient_at<4>(const std::array<Vec3, 4>&,
                                      const std::array<Vec3, 4>&,
                                      const Barycentric&);
template GradientAt<10> gradient_at<10>(const std::array<Vec3, 10>&,
                                        const std::array<Vec3, 10>&,
                                        const Barycentric&);

}  // namespace meniscus::element
