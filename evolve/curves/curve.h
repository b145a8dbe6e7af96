/// Boundary curves: where films are held. Numbers only; the case file's
/// expressions have been evaluated before.
#pragma once

#include <array>
#include <memory>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "core/math/expression.h"
#include "core/types.h"

namespace meniscus::curves {

/// All closed shapes run counter-clockwise seen from the tip of `normal`
/// (which need not be of unit length, but not zero). Lengths in case units.
/// A circle's t = 0 lies where its frame says: normal +z has it at +x, and the
/// frame turns smoothly with the normal everywhere but at -(2, 3, 6)/7.
struct Circle {
  Vec3 center = Vec3::Zero();
  Vec3 normal = Vec3::UnitZ();
  double radius = 1.0;
};

struct Ellipse {
  Vec3 center = Vec3::Zero();
  Vec3 normal = Vec3::UnitZ();
  Vec3 axis = Vec3::UnitX();  // direction of radius_1, made normal to `normal`
  double radius_1 = 1.0;
  double radius_2 = 1.0;
};

struct Rectangle {
  Vec3 center = Vec3::Zero();
  Vec3 normal = Vec3::UnitZ();
  Vec3 axis = Vec3::UnitX();  // direction of `width`
  double width = 1.0;
  double height = 1.0;
  double corner_radius = 0.0;  // 0, or above and below half the shorter side
};

/// Closed polygon through `points` in order; may be non-planar.
struct Polygon {
  Points points;
};

/// x(t), y(t), z(t) as expressions of one name, t: any range, not wrapped, not
/// closed of itself.
struct ParametricCurve {
  std::array<Expression, 3> coordinates;
};

/// Closed smooth curve through `points` in order; may be non-planar. Cubic
/// between them with continuous curvature (de Boor 1978, ch. IV, periodic), its
/// knots at the chords' lengths, so that t runs nearly by arclength.
struct Spline {
  Points points;
};

/// Closed curve of straight lines and circular arcs; may be non-planar. Side k
/// runs from corner k to the next, as an arc through via[k] where there is one.
struct Polyline {
  Points corners;
  std::vector<std::optional<Vec3>> via;  // one per corner
};

struct Curve;

/// Another curve offset in its plane, then scaled, mirrored, turned and moved,
/// in this order; t is the other curve's.
struct CurveCopy {
  std::shared_ptr<const Curve> of;  // any closed shape; an offset, no copy
  // Outwards [length]. Corners stay sharp (mitred), arcs and rounded corners
  // concentric; ellipses and splines become splines through offset points.
  std::optional<double> offset;
  Vec3 scale = Vec3::Ones();   // along x, y, z from `about`, above 0
  std::optional<Vec3> mirror;  // normal of the plane through `about`
  double angle = 0.0;          // right-handed about `axis` [radian]
  Vec3 axis = Vec3::UnitZ();   // through `about`; any length but 0
  Vec3 about = Vec3::Zero();
  Vec3 move = Vec3::Zero();
};

using CurveShape = std::variant<Circle, Ellipse, Rectangle, Polygon,
                                ParametricCurve, Spline, Polyline, CurveCopy>;

struct Curve {
  std::string name;
  CurveShape shape;
  double fineness = 1.0;  // it is cut into pieces of so much of the films'
                          // edge, in (0, 1]; models are frozen with it
  /// Films only begin along it; their common line moves to where it balances.
  bool free = false;
  /// The same along these sides of a polygon or polyline alone, from 0: side k
  /// runs from corner k to the next. It holds films along the others.
  std::vector<int> free_sides = {};
};

/// Of the same kind and numbers. Expressions are not looked at: false.
bool are_equal(const CurveShape& a, const CurveShape& b);

/// Throws InvalidInput, naming the curve and the value, for a shape that is no
/// curve: radius or side not above 0, zero normal, fewer than three points,
/// two equal neighbours, an arc through points on a line, an offset that leaves
/// nothing, anything not finite.
void validate(const Curve& curve);

/// Point at parameter t (in [0, 1) where the shape is closed), by arclength
/// along straight parts and by angle along arcs; smooth in the shape's numbers
/// at fixed t.
Vec3 point_at(const CurveShape& shape, double t);
/// The same at many parameters, what they share computed once.
Points points_at(const CurveShape& shape, const std::vector<double>& t);

/// Derivative of point_at at fixed t when the shape's numbers change at the
/// numbers of `rate`, a shape of the same kind (not a valid one: its numbers
/// are derivatives; a parametric curve's are expressions of t).
Vec3 point_rate(const CurveShape& shape, const CurveShape& rate, double t);
/// The same at many parameters, what they share computed once. Throws
/// InvalidInput for another kind, or unequal numbers of points.
Points point_rates(const CurveShape& shape, const CurveShape& rate,
                   const std::vector<double>& t);

/// Position and its first and second derivative by t.
struct CurveJet {
  Vec3 point;
  Vec3 first;
  Vec3 second;
};
/// Throws InvalidInput for all but circles, ellipses and parametric curves:
/// corners have none.
CurveJet jet_at(const CurveShape& shape, double t);

/// Parameter of the point halfway between two points of the curve: the way
/// that is at most half around on closed shapes; on parametric ones the point
/// nearest to the middle of the chord.
double middle_parameter(const CurveShape& shape, double a, double b);

/// Total length [length].
double length_of(const CurveShape& shape);

/// Increasing parameters in [0, 1) that cut the curve into pieces of about
/// `edge` [length], corners kept, at least `least` pieces in all. Not for
/// parametric curves, which have no range.
std::vector<double> sample_parameters(const CurveShape& shape, double edge,
                                      int least = 12);

}  // namespace meniscus::curves
