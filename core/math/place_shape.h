/// Shapes of fields: smooth functions of place that are 0 or more and add up
/// to 1, so that a sum of them lies between the least and the largest of its
/// coefficients. Three times continuously differentiable, as margins to
/// collapse ask.
#pragma once

#include <array>
#include <memory>
#include <span>

#include "core/types.h"

namespace meniscus {

/// f, its gradient and its Hessian at a place.
struct PlaceJet {
  double value = 0.0;
  Vec3 gradient = Vec3::Zero();
  Eigen::Matrix3d hessian = Eigen::Matrix3d::Zero();
};

class PlaceShape {
 public:
  virtual ~PlaceShape() = default;
  virtual int coefficients() const = 0;
  /// Least distance of two bumps [length]; infinite of one.
  virtual double spacing() const = 0;
  /// The sum of coefficient x function. Throws ExpressionError where there is
  /// none.
  virtual PlaceJet jet(const Vec3& at, std::span<const double> c) const = 0;
  /// Adds by_value x function + by_gradient . its gradient to each.
  virtual void add_transposed(const Vec3& at, double by_value,
                              const Vec3& by_gradient,
                              std::span<double> sum) const = 0;
};

/// Products of quartic B-splines along x, y, z. The coefficients of an axis
/// stand evenly from one face of the box to the other, one of a single
/// coefficient everywhere; the last axis runs fastest. Beyond the faces the
/// nearest coefficient goes on.
struct SplineBox {
  Vec3 from = Vec3::Zero();  // [length]
  Vec3 to = Vec3::Ones();    // [length]
  std::array<int, 3> counts = {1, 1, 1};
};
/// Throws InvalidInput for counts below 1 and a box without size along an axis
/// that has more.
std::shared_ptr<const PlaceShape> box_splines(const SplineBox& box);

/// The same along an axis and, periodic, around it: `around` coefficients from
/// the direction `zero` on, counter-clockwise seen against the axis. With more
/// than one around, there is no value on the axis itself.
struct SplineAxis {
  Vec3 from = Vec3::Zero();   // on the axis [length]
  Vec3 to = Vec3::UnitZ();    // on it [length]
  Vec3 zero = Vec3::UnitX();  // not along it; any length
  int along = 1;
  int around = 1;
};
/// Throws InvalidInput.
std::shared_ptr<const PlaceShape> axis_splines(const SplineAxis& axis);

/// Bell curves exp(-d^2 / (2 width^2)) about points, over their sum.
struct RadialShape {
  Points points;       // one or more [length]
  double width = 1.0;  // above 0 [length]
};
/// Throws InvalidInput.
std::shared_ptr<const PlaceShape> radial_functions(const RadialShape& shape);

/// A usual width for points: the mean distance to the nearest other.
double usual_width(const Points& points);

}  // namespace meniscus
