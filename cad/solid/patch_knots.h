/// Knots of patches, enough for the film's edges and its rims' bends, and their
/// sides on rims.
#pragma once

#include <vector>

#include "cad/solid/rim_edges.h"

namespace meniscus::solid {

/// A side of a patch on a rim, from one place of it to another.
struct RimSide {
  const RimEdges* rim = nullptr;
  double from = 0.0;
  double to = 0.0;
  bool growing = true;

  /// At a share of the way.
  double place(double share) const;
  Vec3 point(double share) const;
  Vec3 tangent(double share) const;
};

/// A side that the knots along it must serve.
struct SideDemand {
  double length = 0.0;  // of the side [length]
  RimSide rim = {};     // without one: no rim
};

/// What a side on a rim asks for, run backwards where asked.
SideDemand demand(const RimSide& side, bool backwards);

/// Knots over [0, 1] common to all the sides: doubled where smooth pieces of a
/// rim meet, threefold at its corners; spans no longer than `span` [length].
std::vector<double> common_knots(const std::vector<SideDemand>& sides,
                                 double span);

/// Per span of the knots (over [0, 1], those of no length left out) whether it
/// is too long.
using LongSpans = std::vector<char>;

/// The number of the span at t, and how many there are.
std::size_t span_at(const std::vector<double>& knots, double t);
std::size_t span_count(const std::vector<double>& knots);

/// Each span that is too long halved.
std::vector<double> halved(const std::vector<double>& knots,
                           const LongSpans& spans);

/// The curve between the rim's vertices that fits it best on these knots; exact
/// at its corners.
SplineCurve fit_rim(const RimSide& side, const std::vector<double>& knots,
                    const Brep& brep);

}  // namespace meniscus::solid
