/// Internal to curves: what a copy of another curve comes to.
#pragma once

#include "evolve/curves/curve_shape.h"

namespace meniscus::curves::curve_shape {

/// A shape, and its rates as a shape of the same kind.
struct Drift {
  CurveShape shape;
  CurveShape rate;
};

/// `shape` offset by `distance` outwards in its (mean) plane, which changes at
/// `distance_rate` while the shape changes at `rate` (null: neither does). The
/// result may be of another kind and need not be a curve: validate it. Throws
/// InvalidInput for copies and parametric curves.
Drift offset_of(const CurveShape& shape, double distance,
                const CurveShape* rate = nullptr, double distance_rate = 0.0);

/// The curve that a copy moves, offset where the copy asks for it.
CurveShape base_of(const CurveCopy& copy);

Points points_on(const CurveCopy& copy, const std::vector<double>& t);
Points rates_on(const CurveCopy& copy, const CurveCopy& rate,
                const std::vector<double>& t);

}  // namespace meniscus::curves::curve_shape
