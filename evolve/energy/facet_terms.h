/// One facet's share of the energies: value, first and second derivatives
/// along given directions at its corners.
///
/// With N = (b - a) x (c - a), n = N / |N| and e_i the edge opposite corner i
/// (e_a = c - b), moving corner i by v changes N by e_i x v, so
///   area   A = |N| / 2,  dA = n . (e_i x v) / 2,
///   d2A(v_i, w_j) = ((u_i . u_j - (n.u_i)(n.u_j)) / |N| +- n.(w x v)) / 2
/// with u_i = e_i x v, and the sign of the last term + for j = i + 2 (mod 3),
/// - for j = i + 1, none for j = i.
///   volume of the cone to the origin V = a . (b x c) / 6.
#pragma once

#include <array>

#include <Eigen/Geometry>

#include "core/types.h"

namespace meniscus::energy {

inline std::array<Vec3, 3> corners_of(const Points& points, const Triangle& t) {
  return {points[t[0]], points[t[1]], points[t[2]]};
}

struct FacetFrame {
  std::array<Vec3, 3> corner;    // relative to the local origin [length]
  std::array<Vec3, 3> opposite;  // e_i
  Vec3 normal;                   // unit; zero for a facet without area
  double area2;                  // |N|, twice the area
  bool turns;  // its normal does, when corners move: not where it is given

  /// `flat`: the unit normal along which its area counts, with its sign;
  /// null: its own.
  FacetFrame(const Vec3& a, const Vec3& b, const Vec3& c,
             const Vec3* flat = nullptr)
      : corner{a, b, c}, opposite{c - b, a - c, b - a} {
    normal = (b - a).cross(c - a);
    if (flat != nullptr) {
      area2 = normal.dot(*flat);
      normal = *flat;
      turns = false;
      return;
    }
    area2 = normal.norm();
    turns = area2 > 0.0;
    if (turns) {
      normal /= area2;
    }
  }

  /// dA/dx_i [length].
  Vec3 area_gradient(int i) const { return 0.5 * normal.cross(opposite[i]); }

  /// dV/dx_i [length^2].
  Vec3 volume_gradient(int i) const {
    return corner[(i + 1) % 3].cross(corner[(i + 2) % 3]) / 6.0;
  }

  double volume() const {
    return corner[0].dot(corner[1].cross(corner[2])) / 6.0;
  }

  /// d2A along v at corner i and w at corner j.
  double area_hessian(int i, const Vec3& v, int j, const Vec3& w) const {
    const Vec3 u_i = opposite[i].cross(v);
    const Vec3 u_j = opposite[j].cross(w);
    double sum =
        turns ? (u_i.dot(u_j) - normal.dot(u_i) * normal.dot(u_j)) / area2
              : 0.0;
    if (i != j) {
      const double twist = normal.dot(w.cross(v));
      sum += j == (i + 2) % 3 ? twist : -twist;
    }
    return 0.5 * sum;
  }

  /// d2V along v at corner i and w at corner j.
  double volume_hessian(int i, const Vec3& v, int j, const Vec3& w) const {
    if (i == j) {
      return 0.0;
    }
    const int k = 3 - i - j;
    const double det = corner[k].dot(v.cross(w));
    return (j == (i + 1) % 3 ? det : -det) / 6.0;
  }
};

}  // namespace meniscus::energy
