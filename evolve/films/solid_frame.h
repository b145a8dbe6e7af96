/// Where a solid from a CAD program is: four points that move with it.
#pragma once

#include <array>
#include <vector>

#include "core/geometry/exact_shape.h"
#include "evolve/curves/curve.h"
#include "evolve/films/film_system.h"

namespace meniscus::films {

/// The points (frame_points()) where `frame`, a polygon of four or a copy of
/// one, has them.
std::array<Vec3, 4> frame_at(const curves::CurveShape& frame);

/// The parameter of the frame's k-th point.
constexpr double frame_parameter(int k) { return 0.25 * k; }

/// What each of a frame's points counts in a point that is fixed to it; their
/// sum is 1.
std::array<double, 4> frame_weights(const std::array<Vec3, 4>& frame,
                                    const Vec3& at);

/// The shape moved as rigidly as its frame, from its own coordinates.
ExactShape moved_shape(const ExactShape& shape, const std::array<Vec3, 4>& to);

/// The solid's shape where the curves have its frame. Throws InvalidInput for a
/// frame that is not among them.
ExactShape shape_at(const SolidSpec& solid,
                    const std::vector<curves::Curve>& curves);

}  // namespace meniscus::films
