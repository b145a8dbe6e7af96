/// Where a picture is seen from: perspective of a camera with z up.
#pragma once

#include "core/types.h"

namespace meniscus::render {

/// Fractions of a panel, from its lower left corner.
struct Box {
  double left, bottom, right, top;
};

/// A camera before a panel of `width` x `height` pixels.
struct EyeView {
  Vec3 eye = Vec3::Zero();  // [length]
  Vec3 right = Vec3::UnitX();
  Vec3 up = Vec3::UnitZ();
  Vec3 back = -Vec3::UnitY();  // from the model to the eye
  double width = 1.0;          // [pixel]
  double height = 1.0;

  /// Right, up and towards the eye [length]; z < 0 is before the eye.
  Vec3 seen(const Vec3& p) const {
    const Vec3 d = p - eye;
    return {right.dot(d), up.dot(d), back.dot(d)};
  }
  /// Of a direction or normal.
  Vec3 turned(const Vec3& v) const {
    return {right.dot(v), up.dot(v), back.dot(v)};
  }
  /// Pixels from the panel's lower left corner.
  Eigen::Vector2d project(const Vec3& p) const;
  /// A pixel's side at a place [length].
  double pixel_at(const Vec3& p) const;

  static constexpr double kAngle = 20.0;  // vertical [deg]: mild perspective
};

/// Looks from `view` (from the model to the eye) so that all `shown` lie in
/// `box`; `width`, `height`: the panel's [pixel].
EyeView fit_view(const Points& shown, const Vec3& view, const Box& box,
                 double width, double height);

/// Height over width of what is seen from afar from `view`, z up; 1 without
/// points or width.
double seen_aspect(const Points& shown, const Vec3& view);

}  // namespace meniscus::render
