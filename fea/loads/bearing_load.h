/// A force that a round pin presses into its bores.
#pragma once

#include <array>

#include "fea/element/face_points.h"
#include "fea/loads/load_case.h"

namespace meniscus::loads {

/// Pressure of a bearing load at a place with inward normal m across the axis a
/// (the part of it there): p = max(0, m . (s + z t)), z along the axis from the
/// point. Of all pressures that are nowhere negative and have the given force
/// across the axis (and no moment about the point across it) that of least
/// int p^2 dA; on a round bore cos(phi) of the angle from the force. What the
/// force has along the axis is spread evenly.
class BearingPressure {
 public:
  /// Throws InvalidInput, naming the surfaces: numbers that are not finite, a
  /// force of 0, an axis without length, surfaces that are no bore and have no
  /// axis given, that cannot press against the force, or whose pressure turns
  /// about the axis through the point by more than 2 % of force x radius.
  BearingPressure(const TetMesh& mesh, const BearingLoad& load);

  const Vec3& axis() const { return axis_; }  // unit
  bool axis_is_fitted() const { return fitted_; }
  /// Vectors across the axis.
  Vec3 s() const { return basis_ * y_.head<2>(); }  // [pressure]
  Vec3 t() const { return basis_ * y_.tail<2>(); }  // [pressure/length]

  /// Pressure times the point's area, minus the normal's part across the axis:
  /// the force is this times that over the area [force].
  double pressed(const element::FacePoint& point) const;
  /// Along the axis, from the point; 0 where no moment is balanced.
  double height(const Vec3& x) const {
    return balanced_ ? axis_.dot(x - point_) : 0.0;
  }
  Vec3 across(const Vec3& v) const { return v - axis_.dot(v) * axis_; }
  /// Force of the point's share of the surface.
  Vec3 force_at(const element::FacePoint& point) const;

  /// By s and t, the change of sum v . force that a change of them makes,
  /// solved back: with `work` = sum over pressed points of b (m . v) dA.
  std::array<Vec3, 2> adjoint(const Eigen::Vector4d& work) const;
  /// b of a point: what its pressure has of each number, times its area.
  Eigen::Vector4d shape(const element::FacePoint& point) const;

  /// d(g . axis) of a fitted axis as B : d(int n n^T dA).
  Mat3 by_normals(const Vec3& g) const;

 private:
  void find_axis(const TetMesh& mesh, const BearingLoad& load);
  void balance(const TetMesh& mesh, const BearingLoad& load);
  void check_turn(const TetMesh& mesh, const BearingLoad& load) const;

  Vec3 axis_ = Vec3::UnitZ();
  Vec3 point_ = Vec3::Zero();
  bool fitted_ = false;
  bool balanced_ = false;
  Vec3 spread_ = Vec3::Zero();          // of the fit: eigenvalues
  Mat3 directions_ = Mat3::Identity();  // and eigenvectors
  Eigen::Matrix<double, 3, 2> basis_;   // across the axis
  Eigen::Vector4d y_ = Eigen::Vector4d::Zero();
  Eigen::Matrix4d H_ = Eigen::Matrix4d::Zero();  // of the pressed points
};

/// Adds the nodal forces of the load, 3 per node [force].
void add_bearing_forces(const TetMesh& mesh, const BearingLoad& load,
                        VectorX& f);

/// Of v . f, f the nodal forces of a bearing load and v (3 per node) held.
struct BearingGradient {
  double value = 0.0;
  Vec3 by_point = Vec3::Zero();  // 0 without a point
  Vec3 by_force = Vec3::Zero();
  Vec3 by_axis = Vec3::Zero();  // of a given one
};

/// `gradient`: that by node positions is added to it, if it is not null. Exact
/// but where a point of the quadrature is just where the pressure ends. Throws
/// as BearingPressure.
BearingGradient bearing_gradient(const TetMesh& mesh, const BearingLoad& load,
                                 const VectorX& v, Points* gradient);

}  // namespace meniscus::loads
