/// Internal to curves: planar shapes are center + a u + b v at a fixed curve
/// parameter, where the frame (u, v) hangs on directions alone and (a, b) is
/// linear in the lengths. The frame's arithmetic runs over numbers or duals.
#pragma once

#include <array>
#include <cmath>
#include <numbers>

#include <Eigen/Geometry>

#include "core/math/dual.h"
#include "evolve/curves/curve.h"

namespace meniscus::curves::curve_shape {

template <class Scalar>
using Vector = Eigen::Matrix<Scalar, 3, 1>;
using Vector1 = Vector<Dual1>;

template <class Scalar>
struct Frame {
  Vector<Scalar> u;
  Vector<Scalar> v;
};

template <class Scalar>
Vector<Scalar> unit(const Vector<Scalar>& v) {
  using std::sqrt;
  return v / sqrt(v.dot(v));
}

/// `p` turned by the smallest rotation that takes unit vector a to unit b.
template <class Scalar>
Vector<Scalar> turned(const Vector<Scalar>& p, const Vector<Scalar>& a,
                      const Vector<Scalar>& b) {
  const Vector<Scalar> axis = a.cross(b);
  const Scalar c = a.dot(b);
  const Scalar share = axis.dot(p) / (1.0 + c);
  return c * p + axis.cross(p) + axis * share;
}

/// No frame is continuous on the whole sphere. This one is smooth but for one
/// normal, -(2, 3, 6)/7, which is far from the axes and the diagonals; normal
/// +z has u = +x. `near_pole`: the normal is that one.
template <class Scalar>
Frame<Scalar> frame_of(const Vector<Scalar>& normal, bool near_pole) {
  const Vector<Scalar> n = unit<Scalar>(normal);
  const Vec3 pole = Vec3(2.0, 3.0, 6.0) / 7.0;
  const Vec3 start = turned<double>(Vec3::UnitX(), Vec3::UnitZ(), pole);
  Vector<Scalar> u = Vec3(Vec3::UnitX()).cast<Scalar>();
  if (!near_pole) {
    u = turned<Scalar>(start.cast<Scalar>(), pole.cast<Scalar>(), n);
  }
  u = unit<Scalar>(u - u.dot(n) * n);
  return {u, n.cross(u)};
}

/// `axis` made normal to `normal`.
template <class Scalar>
Frame<Scalar> frame_of(const Vector<Scalar>& normal,
                       const Vector<Scalar>& axis) {
  const Vector<Scalar> n = unit<Scalar>(normal);
  const Vector<Scalar> u = unit<Scalar>(axis - axis.dot(n) * n);
  return {u, n.cross(u)};
}

inline bool is_near_pole(const Vec3& normal) {
  const Vec3 pole = Vec3(2.0, 3.0, 6.0) / 7.0;
  return !(1.0 + pole.dot(unit<double>(normal)) > 1e-14);
}

inline Frame<double> frame_of(const Circle& c) {
  return frame_of<double>(c.normal, is_near_pole(c.normal));
}
inline Frame<double> frame_of(const Ellipse& e) {
  return frame_of<double>(e.normal, e.axis);
}
inline Frame<double> frame_of(const Rectangle& r) {
  return frame_of<double>(r.normal, r.axis);
}

/// A curve as parts of equal share in t.
int part_count(const CurveShape& shape);

/// Where a parameter lies: part of equal share in t, and s from 0 to 1 there.
struct Place {
  int part = 0;
  double s = 0.0;
};
Place place_of(const CurveShape& shape, double t);

struct InPlane {
  double a;  // along u
  double b;  // along v
};

/// Linear in the lengths of the first argument; the second, a valid shape,
/// says of what parts it is.
inline InPlane in_plane(const Circle& c, const Circle& /*kind*/, Place at) {
  const double angle = 2.0 * std::numbers::pi * at.s;
  return {c.radius * std::cos(angle), c.radius * std::sin(angle)};
}
inline InPlane in_plane(const Ellipse& e, const Ellipse& /*kind*/, Place at) {
  const double angle = 2.0 * std::numbers::pi * at.s;
  return {e.radius_1 * std::cos(angle), e.radius_2 * std::sin(angle)};
}
/// Parts: right side, arc, top, arc, left, arc, bottom, arc; without corner
/// radius only the sides.
InPlane in_plane(const Rectangle& r, const Rectangle& kind, Place at);

}  // namespace meniscus::curves::curve_shape
