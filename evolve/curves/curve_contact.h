/// Where curves meet themselves or each other: no film starts there.
#pragma once

#include <optional>

#include "evolve/curves/curve.h"

namespace meniscus::curves {

/// A place where a closed curve comes within `gap` x its size of itself, other
/// than along itself: it crosses or touches itself. Judged on at least 128
/// chords, corners kept. The curve must be valid.
std::optional<Vec3> meets_itself(const CurveShape& shape, double gap = 1e-7);

/// Two closed curves of a list that come within `gap` x the smaller one's size
/// of each other: they cross, touch or lie on each other.
struct CurveMeeting {
  int first = 0;
  int second = 0;
  Vec3 place = Vec3::Zero();
};
std::vector<CurveMeeting> meetings_of(
    const std::vector<const CurveShape*>& shapes, double gap = 1e-7);

/// Do two valid closed curves lie on each other, either way around? The largest
/// distance of at least 64 places and the corners of each from the other, where
/// it is at most `gap` x the smaller one's size [length].
std::optional<double> lie_on_each_other(const CurveShape& a,
                                        const CurveShape& b, double gap = 1e-4);

}  // namespace meniscus::curves
