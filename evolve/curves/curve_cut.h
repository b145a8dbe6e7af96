/// Closed curves that a plane of symmetry cuts.
#pragma once

#include <vector>

#include "evolve/curves/curve.h"

namespace meniscus::curves {

/// The parameters, increasing, at which a valid closed curve passes from one
/// side of the plane to the other. `normal`: of unit length.
std::vector<double> crossings(const CurveShape& shape, const Vec3& at,
                              const Vec3& normal);

/// Of a curve that crosses the plane at parameter `t`: how far its point at
/// t + s is from the image of that at t - s, at most [length]. 0 but for
/// rounding where the curve is its own image and its parts are, too.
double asymmetry(const CurveShape& shape, const Vec3& at, const Vec3& normal,
                 double t);

/// The parameters of `samples`, increasing, with those `wanted` among them:
/// a sample that is next to one gives way to it, but for corners and others
/// that are wanted.
std::vector<double> with_parameters(const CurveShape& shape,
                                    std::vector<double> samples,
                                    const std::vector<double>& wanted);

}  // namespace meniscus::curves
