#include "evolve/energy/bent_facets.h"

#include <array>
#include <cmath>

#include <Eigen/Geometry>

#include "core/math/dual.h"

namespace meniscus::energy {

namespace {

using std::atan2;
using std::sin;
using std::sqrt;
using Dual9 = BasicDual<9>;

constexpr double kSmallTurn = 0.3;  // rad

double number(double value) { return value; }
double number(const Dual9& value) { return value.value; }

template <class Scalar>
using WallPlace = std::array<Scalar, 3>;
template <class Scalar>
using WallFacet = std::array<WallPlace<Scalar>, 3>;

template <class Scalar>
Scalar dot(const WallPlace<Scalar>& a, const WallPlace<Scalar>& b) {
  return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

template <class Scalar>
WallPlace<Scalar> minus(const WallPlace<Scalar>& a,
                        const WallPlace<Scalar>& b) {
  return {a[0] - b[0], a[1] - b[1], a[2] - b[2]};
}

/// By edges: of a facet that is small beside its wall the corners' own products
/// cancel to the digits of the wall's size.
template <class Scalar>
Scalar det(const WallFacet<Scalar>& c) {
  const WallPlace<Scalar> b = minus(c[1], c[0]);
  const WallPlace<Scalar> d = minus(c[2], c[0]);
  const WallPlace<Scalar> cross = {b[1] * d[2] - b[2] * d[1],
                                   b[2] * d[0] - b[0] * d[2],
                                   b[0] * d[1] - b[1] * d[0]};
  return dot(c[0], cross);
}

/// sin t - t.
template <class Scalar>
Scalar sin_less(const Scalar& t) {
  if (std::abs(number(t)) > kSmallTurn) {
    return sin(t) - t;
  }
  // The series, to t^15 / 15! < 1e-17 t^3.
  const Scalar square = t * t;
  Scalar sum = 1.0;
  for (const double k : {12.0, 10.0, 8.0, 6.0, 4.0}) {
    sum = 1.0 - square / (k * (k + 1.0)) * sum;
  }
  return -1.0 / 6.0 * t * square * sum;
}

/// A facet about the wall's axis, z along it; of cylinders from the first
/// corner's z, by which nothing changes.
template <class Scalar>
WallFacet<Scalar> about_axis(const films::BentWall& wall,
                             const WallFacet<Scalar>& corners) {
  std::array<Vec3, 3> axes = {films::first_axis(wall), Vec3::Zero(), wall.axis};
  axes[1] = axes[2].cross(axes[0]);
  WallFacet<Scalar> result;
  for (int i = 0; i < 3; ++i) {
    const WallPlace<Scalar> from = {corners[i][0] - wall.at[0],
                                    corners[i][1] - wall.at[1],
                                    corners[i][2] - wall.at[2]};
    for (int k = 0; k < 3; ++k) {
      result[i][k] =
          axes[k][0] * from[0] + axes[k][1] * from[1] + axes[k][2] * from[2];
    }
  }
  if (wall.kind == films::WallKind::Cylinder) {
    const double first = number(result[0][2]);
    for (WallPlace<Scalar>& place : result) {
      place[2] = place[2] - first;
    }
  }
  return result;
}

/// An edge across the axis: a x b, and the angle from a to b.
template <class Scalar>
struct Turn {
  Scalar cross;
  Scalar angle;

  Turn(const WallPlace<Scalar>& a, const WallPlace<Scalar>& b)
      : cross(a[0] * (b[1] - a[1]) - a[1] * (b[0] - a[0])),
        angle(atan2(cross, a[0] * b[0] + a[1] * b[1])) {}
};

template <class Scalar>
bool is_apex(const films::BentWall& wall, const WallPlace<Scalar>& about) {
  return wall.kind == films::WallKind::Cone && number(about[0]) == 0.0 &&
         number(about[1]) == 0.0;
}

/// The solid angle that the facet fills, seen from the origin.
template <class Scalar>
Scalar solid_angle(const WallFacet<Scalar>& c) {
  const std::array<Scalar, 3> size = {
      sqrt(dot(c[0], c[0])), sqrt(dot(c[1], c[1])), sqrt(dot(c[2], c[2]))};
  const Scalar below = size[0] * size[1] * size[2] + dot(c[0], c[1]) * size[2] +
                       dot(c[1], c[2]) * size[0] + dot(c[2], c[0]) * size[1];
  return 2.0 * atan2(det(c), below);
}

/// Of the edges' (a, b, turn); those that end at an apex add nothing.
template <class Scalar, class OfEdge>
Scalar sum_over_edges(const films::BentWall& wall, const WallFacet<Scalar>& c,
                      const OfEdge& of_edge) {
  Scalar sum = 0.0;
  for (int i = 0; i < 3; ++i) {
    const WallPlace<Scalar>& a = c[i];
    const WallPlace<Scalar>& b = c[(i + 1) % 3];
    if (!is_apex(wall, a) && !is_apex(wall, b)) {
      sum = sum + of_edge(a, b, Turn<Scalar>(a, b));
    }
  }
  return sum;
}

/// Signed by whether the facet is counter-clockwise seen from outside.
template <class Scalar>
Scalar area_outward(const films::BentWall& wall,
                    const WallFacet<Scalar>& corners) {
  using Place = WallPlace<Scalar>;
  const WallFacet<Scalar> c = about_axis(wall, corners);
  if (wall.kind == films::WallKind::Sphere) {
    return wall.radius * wall.radius * solid_angle(c);
  }
  if (wall.kind == films::WallKind::Cylinder) {
    return -0.5 * wall.radius *
           sum_over_edges(
               wall, c,
               [](const Place& a, const Place& b, const Turn<Scalar>& turn) {
                 return (a[2] + b[2]) * turn.angle;
               });
  }
  const double s = std::sin(wall.half_angle);
  const double line = 1.0 / std::cos(wall.half_angle);
  return -0.5 * line * line *
         sum_over_edges(
             wall, c,
             [s](const Place& a, const Place& b, const Turn<Scalar>& turn) {
               return a[2] * b[2] * sin(s * turn.angle);
             });
}

/// Between the flat facet and the wall. With z along the axis and the angle t
/// between an edge's ends about it, what is behind an edge as seen from a point
/// of the axis is (za + zb) (R^2 sin t - 3 R^2 t) / 12 of a cylinder, and of a
/// cone beyond its plane with the apex tan^2 za zb (za + zb) (sin t - t) / 12.
template <class Scalar>
Scalar lens(const films::BentWall& wall, const WallFacet<Scalar>& corners) {
  using Place = WallPlace<Scalar>;
  const WallFacet<Scalar> c = about_axis(wall, corners);
  const Scalar flat = det(c) / 6.0;
  if (wall.kind == films::WallKind::Sphere) {
    const double r = wall.radius;
    return r * r * r / 3.0 * solid_angle(c) - flat;
  }
  if (wall.kind == films::WallKind::Cylinder) {
    const double square = wall.radius * wall.radius;
    const Scalar behind = sum_over_edges(
        wall, c,
        [square](const Place& a, const Place& b, const Turn<Scalar>& turn) {
          return (a[2] + b[2]) * (turn.cross - 3.0 * square * turn.angle);
        });
    return behind / 12.0 - flat;
  }
  const double t = std::tan(wall.half_angle);
  const Scalar behind = sum_over_edges(
      wall, c, [](const Place& a, const Place& b, const Turn<Scalar>& turn) {
        return a[2] * b[2] * (a[2] + b[2]) * sin_less(turn.angle);
      });
  return t * t / 12.0 * behind - flat;
}

/// A function of a facet's corners as a term, by duals.
template <class OfFacet>
class CornersTerm : public FilmTerm {
 public:
  CornersTerm(OfFacet of_facet, double factor)
      : of_facet_(std::move(of_facet)), factor_(factor) {}

  FacetJet jet(const Element& element, const std::array<Vec3, 3>& corner,
               JetOrder order, Numbers /*numbers*/) const override {
    const double w = factor_ * element.sign;
    FacetJet result;
    if (order == JetOrder::Value) {
      result.value = w * of_facet_(places<double>(corner));
      return result;
    }
    const Dual9 found = of_facet_(places<Dual9>(corner));
    result.value = w * found.value;
    result.gradient = w * found.gradient;
    result.hessian = w * found.hessian;
    return result;
  }

 private:
  template <class Scalar>
  static WallFacet<Scalar> places(const std::array<Vec3, 3>& corner) {
    WallFacet<Scalar> result;
    for (int i = 0; i < 9; ++i) {
      const double at = corner[i / 3][i % 3];
      if constexpr (std::is_same_v<Scalar, double>) {
        result[i / 3][i % 3] = at;
      } else {
        result[i / 3][i % 3] = Scalar::variable(at, i);
      }
    }
    return result;
  }

  OfFacet of_facet_;
  double factor_;
};

template <class OfFacet>
std::unique_ptr<FilmTerm> corners_term(OfFacet of_facet, double factor) {
  return std::make_unique<CornersTerm<OfFacet>>(std::move(of_facet), factor);
}

}  // namespace

std::unique_ptr<FilmTerm> bent_area_term(const films::BentWall& wall,
                                         double side) {
  return corners_term(
      [wall](const auto& corners) { return area_outward(wall, corners); },
      side);
}

std::unique_ptr<FilmTerm> bent_lens_term(const films::BentWall& wall) {
  return corners_term(
      [wall](const auto& corners) { return lens(wall, corners); }, 1.0);
}

}  // namespace meniscus::energy
