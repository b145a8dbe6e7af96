/// Integrals over a facet with their derivatives by its corners.
#pragma once

#include <Eigen/Geometry>

#include "evolve/energy/film_terms.h"
#include "evolve/energy/radial_field.h"

namespace meniscus::energy {

struct QuadraturePoint {
  std::array<double, 3> weight_of;  // barycentric
  double weight;                    // of the facet's area

  Vec3 at(const std::array<Vec3, 3>& c) const {
    return weight_of[0] * c[0] + weight_of[1] * c[1] + weight_of[2] * c[2];
  }
};

/// Degree 5 on a triangle, seven points (Radon 1948).
const std::array<QuadraturePoint, 7>& facet_rule();
/// Degree 2: three points inside.
const std::array<QuadraturePoint, 3>& three_points();
/// Degree 1: the middle.
const std::array<QuadraturePoint, 1>& middle_rule();

/// N = (b - a) x (c - a), its derivative and its constant second derivative:
/// dN/dx_i v = e_i x v.
struct NormalJet {
  Vec3 normal;
  std::array<Eigen::Matrix3d, 3> slope;  // [e_i]x

  explicit NormalJet(const std::array<Vec3, 3>& c) {
    normal = (c[1] - c[0]).cross(c[2] - c[0]);
    for (int i = 0; i < 3; ++i) {
      slope[i] = cross_matrix(c[(i + 2) % 3] - c[(i + 1) % 3]);
    }
  }
  /// Second derivative of f . N by x_i, x_j.
  static Eigen::Matrix3d bend(const Vec3& f, int i, int j) {
    if (i == j) {
      return Eigen::Matrix3d::Zero();
    }
    // d2N(v_i, w_j) = +- w x v, + for j = i + 2; f.(w x v) = v.(f x w).
    const Eigen::Matrix3d m = cross_matrix(f);
    return j == (i + 2) % 3 ? m : Eigen::Matrix3d(-m);
  }

 private:
  static Eigen::Matrix3d cross_matrix(const Vec3& v) {
    Eigen::Matrix3d m;
    m << 0, -v.z(), v.y(), v.z(), 0, -v.x(), -v.y(), v.x(), 0;
    return m;
  }
};

/// Adds the integral of sign F . n; `field`: (place, order) -> FieldJet.
template <class Field>
void add_flux(std::span<const QuadraturePoint> rule, double sign,
              const std::array<Vec3, 3>& c, JetOrder order, const Field& field,
              FacetJet& sum) {
  const NormalJet n(c);
  for (const QuadraturePoint& q : rule) {
    const auto& l = q.weight_of;
    const FieldJet f = field(q.at(c), order);
    const double w = 0.5 * sign * q.weight;
    sum.value += w * f.value.dot(n.normal);
    if (order == JetOrder::Value) {
      continue;
    }
    const Vec3 pull = f.slope.transpose() * n.normal;
    for (int i = 0; i < 3; ++i) {
      sum.gradient.template segment<3>(3 * i) +=
          w * (l[i] * pull + n.slope[i].transpose() * f.value);
    }
    if (order != JetOrder::Hessian) {
      continue;
    }
    Eigen::Matrix3d bend = Eigen::Matrix3d::Zero();
    for (int m = 0; m < 3; ++m) {
      bend += n.normal[m] * f.bend[m];
    }
    for (int i = 0; i < 3; ++i) {
      for (int j = 0; j < 3; ++j) {
        sum.hessian.template block<3, 3>(3 * i, 3 * j) +=
            w * (l[i] * l[j] * bend + l[i] * f.slope.transpose() * n.slope[j] +
                 l[j] * n.slope[i].transpose() * f.slope +
                 NormalJet::bend(f.value, i, j));
      }
    }
  }
}

}  // namespace meniscus::energy
