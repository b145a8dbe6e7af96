/// Where on a closed curve points lie.
#pragma once

#include <vector>

#include "evolve/curves/curve.h"

namespace meniscus::curves {

struct CurvePlace {
  double t = 0.0;         // in [0, 1)
  double distance = 0.0;  // from the point [length]
};

/// The nearest place of a valid closed curve to each point: the nearest of at
/// least 256 chords, and from there by golden sections.
std::vector<CurvePlace> nearest_places(const CurveShape& shape,
                                       const Points& points);

/// The same between `low` and `high`, one pair of parameters per point, where
/// the distance has one minimum.
std::vector<CurvePlace> nearest_between(const CurveShape& shape,
                                        const Points& points,
                                        std::vector<double> low,
                                        std::vector<double> high);

/// Parameters at which a curve may have corners, increasing; none where it is
/// smooth all around.
std::vector<double> corner_parameters(const CurveShape& shape);

}  // namespace meniscus::curves
