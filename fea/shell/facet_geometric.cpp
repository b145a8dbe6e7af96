#include "fea/shell/facet_geometric.h"

#include <array>

#include <Eigen/Geometry>

#include "fea/shell/facet_resultants.h"

namespace meniscus::shell {

namespace {

Mat3 cross_matrix(const Vec3& a) {  // b -> a x b
  Mat3 m;
  m << 0.0, -a[2], a[1], a[2], 0.0, -a[0], -a[1], a[0], 0.0;
  return m;
}

/// The symmetric matrix of theta -> theta x (theta x n) . c.
Mat3 second_turn(const Vec3& n, const Vec3& c) {
  return 0.5 * (n * c.transpose() + c * n.transpose()) -
         n.dot(c) * Mat3::Identity();
}

/// A point's resultants as coefficients of what nodes do there: slopes along
/// the frame's axes, theta -> theta x n and its derivatives.
struct TurnForms {
  Mat3 normal;                  // theta -> theta x n
  std::array<Mat3, 2> turning;  // by n's derivatives
  std::array<Mat3, 2> slope;    // of u, with theta: shear and drilling
  std::array<Mat3, 2> bend;     // of theta, with theta
  Mat3 turned = Mat3::Zero();   // theta with itself
};

TurnForms turn_forms(const FacetFrame<double>& frame,
                     const FacetResultants<double>& r) {
  const std::array<Vec3, 3> t = {as_vector(frame.axes[0]),
                                 as_vector(frame.axes[1]),
                                 as_vector(frame.axes[2])};
  const Vec3& n = t[2];
  std::array<Vec3, 2> slope_of_n;
  for (int a = 0; a < 2; ++a) {
    slope_of_n[a] = frame.curvature[a][0] * t[0] + frame.curvature[a][1] * t[1];
  }
  TurnForms forms;
  forms.normal = -cross_matrix(n);
  for (int a = 0; a < 2; ++a) {
    Vec3 moments = Vec3::Zero();
    for (int b = 0; b < 2; ++b) {
      moments += r.stress[1][a][b] * t[b] + r.stress[2][a][b] * slope_of_n[b];
    }
    forms.turning[a] = -cross_matrix(slope_of_n[a]);
    const double side = a == 0 ? -1.0 : 1.0;
    forms.slope[a] =
        r.shear[a] * forms.normal + side * r.drilling * cross_matrix(t[1 - a]);
    forms.bend[a] = second_turn(n, moments);
    forms.turned += second_turn(slope_of_n[a], moments);
  }
  forms.turned += second_turn(
      n, r.shear[0] * t[0] + r.shear[1] * t[1] - as_vector(r.lever));
  return forms;
}

void add_point(const FacetPoint& p, const FacetFrame<double>& frame,
               const FacetResultants<double>& r, FacetMatrix& K) {
  const TurnForms forms = turn_forms(frame, r);
  const double area = p.weight * frame.area;
  const auto& g = frame.by_axis;
  Eigen::Matrix<double, 2, kNodes> slope;  // along the axes
  Eigen::Matrix<double, kNodes, kNodes> stretch =
      Eigen::Matrix<double, kNodes, kNodes>::Zero();
  for (int a = 0; a < 2; ++a) {
    slope.row(a) =
        (p.slope.topRows<kNodes>() * Eigen::Vector2d(g[a][0], g[a][1]))
            .transpose();
    for (int b = 0; b < 2; ++b) {
      const double s = r.stress[0][a][b];
      const Vec3 by_component(s * g[a][0] * g[b][0],
                              s * (g[a][0] * g[b][1] + g[a][1] * g[b][0]),
                              s * g[a][1] * g[b][1]);
      for (int i = 0; i < kNodes; ++i) {
        stretch.row(i) +=
            by_component.transpose() * p.stretched.middleRows<3>(3 * i);
      }
    }
  }
  std::array<std::array<Mat3, 2>, kNodes> turned;  // derivatives of theta x n
  for (int i = 0; i < kNodes; ++i) {
    for (int a = 0; a < 2; ++a) {
      turned[i][a] = slope(a, i) * forms.normal + p.shape[i] * forms.turning[a];
    }
  }
  for (int i = 0; i < kNodes; ++i) {
    for (int j = 0; j < kNodes; ++j) {
      Mat3 mixed = Mat3::Zero();
      Mat3 turns = p.shape[i] * p.shape[j] * forms.turned;
      for (int a = 0; a < 2; ++a) {
        mixed += slope(a, i) * p.shape[j] * forms.slope[a];
        turns += (slope(a, i) * p.shape[j] + p.shape[i] * slope(a, j)) *
                 forms.bend[a];
        for (int b = 0; b < 2; ++b) {
          mixed += r.stress[1][a][b] * slope(a, i) * turned[j][b];
          turns += r.stress[2][a][b] * turned[i][a].transpose() * turned[j][b];
        }
      }
      K.block<3, 3>(6 * i, 6 * j) += area * stretch(i, j) * Mat3::Identity();
      K.block<3, 3>(6 * i, 6 * j + 3) += area * mixed;
      K.block<3, 3>(6 * j + 3, 6 * i) += area * mixed.transpose();
      K.block<3, 3>(6 * i + 3, 6 * j + 3) += area * turns;
    }
  }
}

}  // namespace

FacetMatrix facet_geometric(const Facet& facet, const ShellLoads& loads,
                            const FacetLoad& own, const FacetVector& u) {
  const auto X = triples(facet);
  const Eigen::Vector2d b = bubble_rotation(whole_stiffness(facet),
                                            facet_forces(facet, loads, own), u);
  const auto axes = bubble_axes(X);
  const Triple<double> bubble = bubble_turn(axes, b);
  const FacetField field = Eigen::Map<const FacetField>(u.data());
  FacetMatrix K = FacetMatrix::Zero();
  for (const FacetPoint& p : facet_rule()) {
    const FacetFrame<double> frame = facet_frame(X, p, facet.direction);
    const FacetStrain<double> strain = facet_strain(X, p, frame, field, bubble);
    add_point(p, frame,
              facet_resultants<double>({facet, loads, own, p, frame, strain,
                                        thickness_at(facet, p)}),
              K);
  }
  return K;
}

}  // namespace meniscus::shell
