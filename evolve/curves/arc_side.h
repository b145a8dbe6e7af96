/// Internal to curves: a circular arc through three points, over numbers or
/// duals.
#pragma once

#include <numbers>

#include "evolve/curves/curve_shape.h"

namespace meniscus::curves::curve_shape {

template <class Scalar>
struct Arc {
  Vector<Scalar> center;
  Vector<Scalar> u;  // from the center to the start
  Vector<Scalar> v;  // the same a quarter turn further
  Scalar angle;      // from start to end, above 0 [radian]

  /// s from 0 to 1, by arclength.
  Vector<Scalar> at(double s) const {
    using std::cos;
    using std::sin;
    const Scalar turn = s * angle;
    return center + cos(turn) * u + sin(turn) * v;
  }
};

inline double plain(double x) { return x; }
inline double plain(const BasicDual<1>& x) { return x.value; }

/// From a through m to b, which must not lie on a line.
template <class Scalar>
Arc<Scalar> arc_through(const Vector<Scalar>& a, const Vector<Scalar>& m,
                        const Vector<Scalar>& b) {
  using std::atan2;
  const Vector<Scalar> p = m - a;
  const Vector<Scalar> q = b - a;
  const Vector<Scalar> w = p.cross(q);
  const Scalar size = 2.0 * w.dot(w);
  Arc<Scalar> arc;
  arc.center = a + (q.dot(q) * w.cross(p) + p.dot(p) * q.cross(w)) / size;
  arc.u = a - arc.center;
  const Vector<Scalar> normal = unit<Scalar>(w);
  arc.v = normal.cross(arc.u);
  const Vector<Scalar> end = b - arc.center;
  arc.angle = atan2(end.dot(arc.v), end.dot(arc.u));
  if (!(plain(arc.angle) > 0.0)) {
    arc.angle = arc.angle + 2.0 * std::numbers::pi;
  }
  return arc;
}

}  // namespace meniscus::curves::curve_shape
