#include "fea/shell/facet_matrices.h"

#include <Eigen/LU>

namespace meniscus::shell {

namespace {

/// Components of a FacetStrain in a row: stretch 11 12 21 22, bend the same,
/// shear 1 2.
constexpr int kStrains = 10;
using StrainRows = Eigen::Matrix<double, kStrains, kWhole>;
using StrainLaw = Eigen::Matrix<double, kStrains, kStrains>;
using StrainVector = Eigen::Matrix<double, kStrains, 1>;
/// Strains of a layer, 11 22 12 13 23, from a FacetStrain.
using LayerRows = Eigen::Matrix<double, 5, kStrains>;

using BubbleAxes = Eigen::Matrix<double, 3, 2>;

BubbleAxes bubble_columns(const std::array<Triple<double>, kNodes>& X) {
  const auto axes = bubble_axes(X);
  BubbleAxes columns;
  columns << as_vector(axes[0]), as_vector(axes[1]);
  return columns;
}

/// Interpolations of N_i dX per reference coordinate, and of sym(dN_i dX) per
/// component 11, 12, 22.
using CarriedTangents = std::array<std::array<Vec3, 2>, kFunctions>;
using StretchedTangents = std::array<std::array<Vec3, 3>, kNodes>;

CarriedTangents carried_tangents(const Eigen::Matrix<double, 3, kNodes>& X,
                                 const FacetPoint& p) {
  const Eigen::Matrix<double, 3, 2 * kFunctions> all =
      X * p.carried.transpose();
  CarriedTangents R;
  for (int i = 0; i < kFunctions; ++i) {
    R[i] = {all.col(2 * i), all.col(2 * i + 1)};
  }
  return R;
}

StretchedTangents stretched_tangents(const Eigen::Matrix<double, 3, kNodes>& X,
                                     const FacetPoint& p) {
  const Eigen::Matrix<double, 3, 3 * kNodes> all = X * p.stretched.transpose();
  StretchedTangents S;
  for (int i = 0; i < kNodes; ++i) {
    S[i] = {all.col(3 * i), all.col(3 * i + 1), all.col(3 * i + 2)};
  }
  return S;
}

/// What one function adds to the ten strains.
using FormRows = Eigen::Matrix<double, kStrains, 3>;

FormRows rotation_rows(const FacetFrame<double>& frame,
                       const std::array<Vec3, 3>& t,
                       const std::array<Vec3, 2>& carried, const FacetPoint& p,
                       int function) {
  FormRows B;
  for (int k = 0; k < 2; ++k) {
    const auto& g = frame.by_axis[k];
    const double slope =
        g[0] * p.slope(function, 0) + g[1] * p.slope(function, 1);
    const Vec3 R = g[0] * carried[0] + g[1] * carried[1];
    B.row(2 * k) = t[0].cross(R);
    B.row(2 * k + 1) = t[1].cross(R);
    B.row(8 + k) = t[2].cross(R);
    B.row(4 + 2 * k) = slope * t[1];  // n x t1
    B.row(5 + 2 * k) = -slope * t[0];
  }
  // Of the stretch only the skew part is the one-form's.
  const Eigen::RowVector3d skew = 0.5 * (B.row(1) - B.row(2));
  B.topRows<4>() << 0.0, 0.0, 0.0, skew, -skew, 0.0, 0.0, 0.0;
  return B;
}

FormRows displacement_rows(const FacetFrame<double>& frame,
                           const std::array<Vec3, 3>& t,
                           const std::array<Vec3, 3>& stretched,
                           const FacetPoint& p, int node) {
  const auto& g = frame.by_axis;
  std::array<double, 2> slope;
  for (int k = 0; k < 2; ++k) {
    slope[k] = g[k][0] * p.slope(node, 0) + g[k][1] * p.slope(node, 1);
  }
  const auto symmetric = [&](int i, int j) -> Vec3 {
    return g[i][0] * g[j][0] * stretched[0] +
           (g[i][0] * g[j][1] + g[i][1] * g[j][0]) * stretched[1] +
           g[i][1] * g[j][1] * stretched[2];
  };
  const Vec3 skew = 0.5 * (slope[0] * t[1] - slope[1] * t[0]);
  const Vec3 both = symmetric(0, 1);
  FormRows B = FormRows::Zero();
  B.row(0) = symmetric(0, 0);
  B.row(1) = both + skew;
  B.row(2) = both - skew;
  B.row(3) = symmetric(1, 1);
  B.row(8) = slope[0] * t[2];
  B.row(9) = slope[1] * t[2];
  return B;
}

StrainRows strain_rows(const std::array<Triple<double>, kNodes>& X,
                       const FacetPoint& p, const FacetFrame<double>& frame,
                       const BubbleAxes& bubble) {
  const Eigen::Map<const Eigen::Matrix<double, 3, kNodes>> places(X[0].data());
  const CarriedTangents R = carried_tangents(places, p);
  const StretchedTangents S = stretched_tangents(places, p);
  const std::array<Vec3, 3> t = {as_vector(frame.axes[0]),
                                 as_vector(frame.axes[1]),
                                 as_vector(frame.axes[2])};
  StrainRows B;
  for (int i = 0; i < kNodes; ++i) {
    B.middleCols<3>(6 * i) = displacement_rows(frame, t, S[i], p, i);
    B.middleCols<3>(6 * i + 3) = rotation_rows(frame, t, R[i], p, i);
  }
  B.rightCols<2>() = rotation_rows(frame, t, R[kNodes], p, kNodes) * bubble;
  return B;
}

LayerRows layer_rows(const Square<double>& by_tangent, double zeta) {
  LayerRows S;
  for (int c = 0; c < kStrains; ++c) {
    const StrainVector e = StrainVector::Unit(c);
    const FacetStrain<double> unit = {{{{e[0], e[1]}, {e[2], e[3]}}},
                                      {{{e[4], e[5]}, {e[6], e[7]}}},
                                      {e[8], e[9]}};
    const LayerStrain<double> layer = layer_strain(unit, by_tangent, zeta);
    S.col(c) << layer.plane[0], layer.plane[1], layer.plane[2], layer.across[0],
        layer.across[1];
  }
  return S;
}

/// visit(rows, weight, ply, height) for each point through the thickness, the
/// weight per area of the surface.
template <class Visit>
void for_each_layer(const Facet& facet, const FacetFrame<double>& frame,
                    double t, const Visit& visit) {
  for (const LayerPoint& point : facet.law->points) {
    const double zeta = (point.at + facet.offset) * t;
    const Square<double> shift = shifter(frame.curvature, zeta);
    visit(layer_rows(inverse(shift), zeta),
          point.weight * t * determinant(shift), point);
  }
}

StrainLaw strain_law(const Facet& facet, const FacetFrame<double>& frame,
                     double t) {
  StrainLaw H = StrainLaw::Zero();
  for_each_layer(facet, frame, t,
                 [&](const LayerRows& S, double weight, const LayerPoint& at) {
                   const PlyLaw& ply = facet.law->plies[at.ply];
                   const auto plane = S.topRows<3>();
                   const auto across = S.bottomRows<2>();
                   H += weight * (plane.transpose() * ply.plane * plane);
                   H += weight *
                        (across.transpose() * facet.law->across * across);
                 });
  StrainVector skew = StrainVector::Zero();
  skew[1] = 1.0;
  skew[2] = -1.0;
  H += kDrilling * facet.law->mean_shear * t * (skew * skew.transpose());
  return H;
}

}  // namespace

std::array<Triple<double>, kNodes> triples(const Facet& facet) {
  std::array<Triple<double>, kNodes> X;
  for (int i = 0; i < kNodes; ++i) {
    X[i] = {facet.nodes[i][0], facet.nodes[i][1], facet.nodes[i][2]};
  }
  return X;
}

Vec3 corner_shares(const FacetPoint& p) {
  // Linear from the quadratic functions: half of both middles beside a corner.
  const auto& N = p.shape;
  return {N[0] + 0.5 * (N[3] + N[5]), N[1] + 0.5 * (N[4] + N[3]),
          N[2] + 0.5 * (N[5] + N[4])};
}

double thickness_at(const Facet& facet, const FacetPoint& p) {
  return corner_shares(p).dot(facet.thickness);
}

WholeMatrix whole_stiffness(const Facet& facet, const FacetRule& rule) {
  const auto X = triples(facet);
  const BubbleAxes bubble = bubble_columns(X);
  WholeMatrix K = WholeMatrix::Zero();
  for (const FacetPoint& p : rule) {
    const FacetFrame<double> frame = facet_frame(X, p, facet.direction);
    const StrainRows B = strain_rows(X, p, frame, bubble);
    const StrainLaw H = strain_law(facet, frame, thickness_at(facet, p)) *
                        (p.weight * frame.area);
    const StrainRows HB = H * B;
    K.noalias() += B.transpose() * HB;
  }
  return K;
}

FacetMatrix condensed(const WholeMatrix& K, WholeVector* f) {
  const Eigen::Matrix2d own = K.bottomRightCorner<2, 2>().inverse();
  const Eigen::Matrix<double, 2, kUnknowns> X =
      own * K.bottomLeftCorner<2, kUnknowns>();
  if (f != nullptr) {
    f->head<kUnknowns>() -= X.transpose() * f->tail<2>();
  }
  FacetMatrix result = K.topLeftCorner<kUnknowns, kUnknowns>();
  // Of two columns: no work for a product in blocks.
  result.noalias() -= K.topRightCorner<kUnknowns, 2>().lazyProduct(X);
  return result;
}

Eigen::Vector2d bubble_rotation(const WholeMatrix& K, const WholeVector& f,
                                const FacetVector& u) {
  return K.bottomRightCorner<2, 2>().inverse() *
         (f.tail<2>() - K.bottomLeftCorner<2, kUnknowns>() * u);
}

std::array<double, 3> wall_moments(const Facet& facet,
                                   const FacetFrame<double>& frame,
                                   double thickness) {
  std::array<double, 3> moments = {0.0, 0.0, 0.0};
  for (const LayerPoint& point : facet.law->points) {
    const double zeta = (point.at + facet.offset) * thickness;
    const double mass = facet.law->plies[point.ply].density * point.weight *
                        thickness * determinant(shifter(frame.curvature, zeta));
    moments[0] += mass;
    moments[1] += mass * zeta;
    moments[2] += mass * zeta * zeta;
  }
  return moments;
}

FacetMatrix facet_mass(const Facet& facet, const FacetRule& rule) {
  const auto X = triples(facet);
  FacetMatrix M = FacetMatrix::Zero();
  for (const FacetPoint& p : rule) {
    const FacetFrame<double> frame = facet_frame(X, p, facet.direction);
    const auto m = wall_moments(facet, frame, thickness_at(facet, p));
    const Vec3 n = as_vector(frame.axes[2]);
    Mat3 arm;  // theta x n = arm theta
    arm << 0.0, n[2], -n[1], -n[2], 0.0, n[0], n[1], -n[0], 0.0;
    Eigen::Matrix<double, 6, 6> block;
    block << m[0] * Mat3::Identity(), m[1] * arm, m[1] * arm.transpose(),
        m[2] * arm.transpose() * arm;
    for (int i = 0; i < kNodes; ++i) {
      for (int j = 0; j < kNodes; ++j) {
        M.block<6, 6>(6 * i, 6 * j) +=
            p.weight * frame.area * p.shape[i] * p.shape[j] * block;
      }
    }
  }
  return M;
}

WholeVector holding_forces(const Facet& facet, const WallStates& states,
                           const FacetRule& rule) {
  const auto X = triples(facet);
  const BubbleAxes bubble = bubble_columns(X);
  WholeVector f = WholeVector::Zero();
  for (const FacetPoint& p : rule) {
    const FacetFrame<double> frame = facet_frame(X, p, facet.direction);
    const WallState state = states.at(p);
    StrainVector s = StrainVector::Zero();
    for_each_layer(
        facet, frame, thickness_at(facet, p),
        [&](const LayerRows& S, double weight, const LayerPoint& at) {
          const PlyLaw& ply = facet.law->plies[at.ply];
          s += weight * (S.topRows<3>().transpose() *
                         (ply.plane * state.free_strain(ply, at.at)));
        });
    f += p.weight * frame.area *
         (strain_rows(X, p, frame, bubble).transpose() * s);
  }
  return f;
}

Facet facet_of(const ShellMesh& mesh, const std::vector<Section>& sections,
               const std::vector<LaminateLaw>& laws, int facet) {
  Facet result;
  const int section = mesh.section[facet];
  for (int i = 0; i < kNodes; ++i) {
    result.nodes[i] = mesh.nodes[mesh.facets[facet][i]];
  }
  result.thickness = mesh.thickness[facet];
  result.offset = sections[section].offset;
  result.direction =
      sections[section].direction ? &*sections[section].direction : nullptr;
  result.law = &laws[section];
  return result;
}

FacetVector numbers_of(const ShellMesh& mesh, int facet, const VectorX& nodal) {
  FacetVector own;
  for (int i = 0; i < kNodes; ++i) {
    own.segment<6>(6 * i) = nodal.segment<6>(6L * mesh.facets[facet][i]);
  }
  return own;
}

}  // namespace meniscus::shell
