#include "fea/shell/facet_geometric.h"

#include <array>

#include <Eigen/Geometry>

namespace meniscus::shell {

namespace {

/// Of a facet's numbers: columns as those of FacetMatrix.
using VectorRows = Eigen::Matrix<double, 3, kUnknowns>;

/// Derivatives of u and of theta x n along the frame's axes.
struct MotionSlopes {
  std::array<VectorRows, 2> moved;
  std::array<VectorRows, 2> turned;
};

Mat3 crossed_with(const Vec3& n) {  // theta -> theta x n
  Mat3 m;
  m << 0.0, n[2], -n[1], -n[2], 0.0, n[0], n[1], -n[0], 0.0;
  return m;
}

MotionSlopes motion_slopes(const FacetPoint& p,
                           const FacetFrame<double>& frame) {
  const Mat3 normal = crossed_with(as_vector(frame.axes[2]));
  MotionSlopes slopes;
  for (int k = 0; k < 2; ++k) {
    const auto& g = frame.by_axis[k];
    const Mat3 turning =
        crossed_with(frame.curvature[k][0] * as_vector(frame.axes[0]) +
                     frame.curvature[k][1] * as_vector(frame.axes[1]));
    for (int i = 0; i < kNodes; ++i) {
      const double slope = g[0] * p.slope(i, 0) + g[1] * p.slope(i, 1);
      slopes.moved[k].middleCols<3>(6 * i) = slope * Mat3::Identity();
      slopes.moved[k].middleCols<3>(6 * i + 3).setZero();
      slopes.turned[k].middleCols<3>(6 * i).setZero();
      slopes.turned[k].middleCols<3>(6 * i + 3) =
          slope * normal + p.shape[i] * turning;
    }
  }
  return slopes;
}

}  // namespace

FacetMatrix facet_geometric(const Facet& facet, const ShellLoads& loads,
                            const FacetLoad& own, const FacetVector& u) {
  const auto X = triples(facet);
  const Eigen::Vector2d b = bubble_rotation(whole_stiffness(facet),
                                            facet_forces(facet, loads, own), u);
  const auto axes = bubble_axes(X);
  const Triple<double> bubble = plus(times(b[0], axes[0]), b[1], axes[1]);
  const FacetField field = Eigen::Map<const FacetField>(u.data());
  const WallState state = wall_state(loads, own);
  FacetMatrix K = FacetMatrix::Zero();
  for (const FacetPoint& p : facet_rule()) {
    const FacetFrame<double> frame = facet_frame(X, p, facet.direction);
    const FacetStrain<double> strain = facet_strain(X, p, frame, field, bubble);
    const double t = thickness_at(facet, p);
    // Stress along the axes times powers 0, 1, 2 of zeta over the wall.
    std::array<Eigen::Matrix2d, 3> S;
    S.fill(Eigen::Matrix2d::Zero());
    for (const LayerPoint& layer : facet.law->points) {
      const double zeta = (layer.at + facet.offset) * t;
      const Square<double> shift = shifter(frame.curvature, zeta);
      const Square<double> back = inverse(shift);
      const PlyLaw& ply = facet.law->plies[layer.ply];
      const Vec3 stress =
          ply.plane * (as_vector(layer_strain(strain, back, zeta).plane) -
                       state.free_strain(ply, layer.at));
      Eigen::Matrix2d here;
      here << stress[0], stress[2], stress[2], stress[1];
      Eigen::Matrix2d to_surface;
      to_surface << back[0][0], back[0][1], back[1][0], back[1][1];
      const Eigen::Matrix2d weighted = layer.weight * t * determinant(shift) *
                                       to_surface.transpose() * here *
                                       to_surface;
      S[0] += weighted;
      S[1] += zeta * weighted;
      S[2] += zeta * zeta * weighted;
    }
    const MotionSlopes d = motion_slopes(p, frame);
    const double area = p.weight * frame.area;
    for (int i = 0; i < 2; ++i) {
      for (int j = 0; j < 2; ++j) {
        K.noalias() +=
            area * S[0](i, j) * (d.moved[i].transpose() * d.moved[j]);
        K.noalias() +=
            area * S[1](i, j) * (d.moved[i].transpose() * d.turned[j]);
        K.noalias() +=
            area * S[1](i, j) * (d.turned[i].transpose() * d.moved[j]);
        K.noalias() +=
            area * S[2](i, j) * (d.turned[i].transpose() * d.turned[j]);
      }
    }
  }
  return K;
}

}  // namespace meniscus::shell
