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

void add_breaks(const RimSide& side, std::vector<SplineBreak>& breaks) {
  const RimCurve& curve = side.rim->curve();
  const double way = side.rim->way(side.from, side.to, side.growing);
  const double start = side.rim->place(side.from);
  for (int k = 0; k < curve.piece_count(); ++k) {
    if (curve.piece_count() == 1 && !curve.is_sharp(k)) {
      continue;  // goes on smoothly where it begins
    }
    const double d =
        side.growing ? curve.start_of(k) - start : start - curve.start_of(k);
    const double share = curve.wrapped(d) / way;
    if (share > kSameKnot && share < 1.0 - kSameKnot) {
      breaks.push_back({share, curve.is_sharp(k) ? 3 : 2});
    }
  }
}

double turn_between(const RimSide& side, double first, double last) {
  double turn = 0.0;
  Vec3 before = Vec3::Zero();
  for (int k = 0; k < kTurnSamples; ++k) {
    const double share = first + (last - first) * (k + 0.5) / kTurnSamples;
    const Vec3 tangent = side.tangent(share);
    if (k > 0) {
      turn += std::atan2(before.cross(tangent).norm(), before.dot(tangent));
    }
    before = tangent;
  }
  return turn * kTurnSamples / (kTurnSamples - 1);
}

}  // namespace

double RimSide::place(double share) const {
  const double way = rim->way(from, to, growing);
  const double start = rim->place(from);
  return growing ? start + share * way : start - share * way;
}

Vec3 RimSide::point(double share) const {
  return rim->curve().point(place(share));
}

Vec3 RimSide::tangent(double share) const {
  return rim->curve().tangent(place(share));
}

SideDemand demand(const RimSide& side, bool backwards) {
  SideDemand result{side.rim->way(side.from, side.to, side.growing), side};
  if (backwards) {
    std::swap(result.rim.from, result.rim.to);
    result.rim.growing = !result.rim.growing;
  }
  return result;
}

std::vector<double> common_knots(const std::vector<SideDemand>& sides,
                                 double span) {
  // Where rims change their curve the spline may lose smoothness: multiple
  // knots there; places closer than rounding are one.
  std::vector<SplineBreak> breaks;
  for (const SideDemand& side : sides) {
    if (side.rim.rim != nullptr) {
      add_breaks(side.rim, breaks);
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
      if (side.rim.rim != nullptr) {
        need = std::max(need, turn_between(side.rim, start, end) / kMostTurn);
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

std::size_t span_at(const std::vector<double>& knots, double t) {
  std::size_t span = 0;
  for (std::size_t k = 1; k < knots.size() && knots[k] <= t; ++k) {
    span += knots[k] > knots[k - 1] && knots[k] < knots.back() ? 1 : 0;
  }
  return span;
}

std::size_t span_count(const std::vector<double>& knots) {
  return span_at(knots, knots.back()) + 1;
}

std::vector<double> halved(const std::vector<double>& knots,
                           const LongSpans& spans) {
  std::vector<double> result{knots[0]};
  std::size_t span = 0;
  for (std::size_t k = 1; k < knots.size(); ++k) {
    if (knots[k] > knots[k - 1] && spans[span++] != 0) {
      result.push_back(0.5 * (knots[k - 1] + knots[k]));
    }
    result.push_back(knots[k]);
  }
  return result;
}

SplineCurve fit_rim(const RimSide& side, const std::vector<double>& knots,
                    const Brep& brep) {
  constexpr int kPointsPerSpan = 6;
  SplineCurve whole{knots, {}};
  // From one corner of the rim, a threefold knot, to the next.
  std::size_t first = 3;
  for (std::size_t last = first + 1; last + 3 < knots.size(); ++last) {
    const bool end = last + 4 == knots.size();
    if (!end && (knots[last] != knots[last + 2])) {
      continue;
    }
    const double low = knots[first];
    const double high = knots[last];
    CurveFit fit;
    fit.knots.assign(4, 0.0);
    for (std::size_t k = first; k < last; ++k) {
      if (k > first) {
        fit.knots.push_back((knots[k] - low) / (high - low));
      }
      for (int i = 0; i < kPointsPerSpan && knots[k + 1] > knots[k]; ++i) {
        const double share =
            knots[k] + (knots[k + 1] - knots[k]) * (i + 0.5) / kPointsPerSpan;
        fit.at.push_back((share - low) / (high - low));
        fit.points.push_back(side.point(share));
      }
    }
    fit.knots.insert(fit.knots.end(), 4, 1.0);
    fit.start = whole.poles.empty() ? brep.vertices[side.rim->vertex(side.from)]
                                    : whole.poles.back();
    fit.end = end ? brep.vertices[side.rim->vertex(side.to)] : side.point(high);
    const SplineCurve part = fit_curve(fit);
    whole.poles.insert(whole.poles.end(),
                       part.poles.begin() + (whole.poles.empty() ? 0 : 1),
                       part.poles.end());
    first = end ? last : last + 2;
    last = first;
  }
  return whole;
}

}  // namespace meniscus::solid
