#include "cad/solid/patch_knots.h"

#include <algorithm>
#include <cmath>

#include <Eigen/Geometry>

#include "cad/solid/spline.h"

namespace meniscus::solid {

namespace {

constexpr double kMostTurn = 0.12;  // of a rim in a span [rad]
constexpr int kLeastSpans = 4;
constexpr double kSameKnot = 1e-6;
constexpr int kTurnSamples = 16;

double place_at(const SideDemand& side, double share) {
  const double way = side.rim->way(side.from, side.to, side.growing);
  const double start = side.rim->place(side.from);
  return side.growing ? start + share * way : start - share * way;
}

void add_breaks(const SideDemand& side, std::vector<SplineBreak>& breaks) {
  const RimCurve& curve = side.rim->curve();
  const double way = side.rim->way(side.from, side.to, side.growing);
  const double start = side.rim->place(side.from);
  for (int k = 0; k < curve.piece_count() && curve.piece_count() > 1; ++k) {
    const double d =
        side.growing ? curve.start_of(k) - start : start - curve.start_of(k);
    const double share = curve.wrapped(d) / way;
    if (share > kSameKnot && share < 1.0 - kSameKnot) {
      breaks.push_back({share, curve.is_sharp(k) ? 3 : 2});
    }
  }
}

double turn_between(const SideDemand& side, double first, double last) {
  double turn = 0.0;
  Vec3 before = Vec3::Zero();
  for (int k = 0; k < kTurnSamples; ++k) {
    const double share = first + (last - first) * (k + 0.5) / kTurnSamples;
    const Vec3 tangent = side.rim->curve().tangent(place_at(side, share));
    if (k > 0) {
      turn += std::atan2(before.cross(tangent).norm(), before.dot(tangent));
    }
    before = tangent;
  }
  return turn * kTurnSamples / (kTurnSamples - 1);
}

}  // namespace

std::vector<double> common_knots(const std::vector<SideDemand>& sides,
                                 double span) {
  // Where rims change their curve the spline may lose smoothness: multiple
  // knots there; places closer than rounding are one.
  std::vector<SplineBreak> breaks;
  for (const SideDemand& side : sides) {
    if (side.rim != nullptr) {
      add_breaks(side, breaks);
    }
  }
  std::sort(breaks.begin(), breaks.end(),
            [](const SplineBreak& a, const SplineBreak& b) {
              return a.at != b.at ? a.at < b.at
                                  : a.multiplicity > b.multiplicity;
            });
  std::vector<SplineBreak> merged;
  for (const SplineBreak& next : breaks) {
    if (merged.empty() || next.at - merged.back().at >= kSameKnot) {
      merged.push_back(next);
    } else {
      merged.back().multiplicity =
          std::max(merged.back().multiplicity, next.multiplicity);
    }
  }
  breaks = std::move(merged);
  // Between breaks, even spans: as many as the side that asks for most, by
  // length and by how far its rim turns.
  std::vector<SplineBreak> inner;
  double start = 0.0;
  for (std::size_t k = 0; k <= breaks.size(); ++k) {
    const double end = k < breaks.size() ? breaks[k].at : 1.0;
    double need = kLeastSpans * (end - start);
    for (const SideDemand& side : sides) {
      need = std::max(need, side.length * (end - start) / span);
      if (side.rim != nullptr) {
        need = std::max(need, turn_between(side, start, end) / kMostTurn);
      }
    }
    const int spans = std::max(1, static_cast<int>(std::ceil(need - 1e-9)));
    for (int i = 1; i < spans; ++i) {
      inner.push_back({start + (end - start) * i / spans, 1});
    }
    if (k < breaks.size()) {
      inner.push_back(breaks[k]);
    }
    start = end;
  }
  return clamped_knots(inner);
}

}  // namespace meniscus::solid
