#include "evolve/films/ruled_band.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "core/math/golden_section.h"
#include "evolve/curves/curve_shape.h"

namespace meniscus::films {

namespace {

constexpr int kMatched = 96;         // points that are looked at on each curve
constexpr int kShareSteps = 2048;    // of a table of lengths
constexpr double kEqualSums = 1e-9;  // sums that differ by less are equal

double wrapped(double t) {
  const double in = t - std::floor(t);
  return in < 1.0 ? in : 0.0;
}

const curves::CurveShape& base_of(const curves::CurveShape& shape) {
  const auto* copy = std::get_if<curves::CurveCopy>(&shape);
  return copy != nullptr ? base_of(copy->of->shape) : shape;
}

/// Do equal parameters of the two mean the same?
bool are_alike(const curves::CurveShape& a, const curves::CurveShape& b) {
  return base_of(a).index() == base_of(b).index() &&
         curves::curve_shape::part_count(a) ==
             curves::curve_shape::part_count(b);
}

LengthShares shares_of(const curves::CurveShape& shape) {
  LengthShares table;
  const int parts = curves::curve_shape::part_count(shape);
  const int steps = parts * std::max(8, kShareSteps / parts);
  for (int k = 0; k <= steps; ++k) {
    table.t.push_back(static_cast<double>(k) / steps);
  }
  const Points points = curves::points_at(shape, table.t);
  table.share.push_back(0.0);
  for (std::size_t k = 1; k < points.size(); ++k) {
    table.share.push_back(table.share.back() +
                          (points[k] - points[k - 1]).norm());
  }
  const double total = table.share.back();
  for (double& share : table.share) {
    share /= total;
  }
  return table;
}

/// `to` at the place where `from` is x; both rise from 0 to 1.
double interpolated(const std::vector<double>& from,
                    const std::vector<double>& to, double x) {
  if (from.empty()) {
    return x;
  }
  const auto above = std::upper_bound(from.begin() + 1, from.end() - 1, x);
  const auto k = static_cast<std::size_t>(above - from.begin());
  const double width = from[k] - from[k - 1];
  const double w = width > 0.0 ? (x - from[k - 1]) / width : 0.0;
  return to[k - 1] + w * (to[k] - to[k - 1]);
}

/// Points of a curve at `count` equal steps of what partners share.
Points points_at_shares(const curves::CurveShape& shape,
                        const LengthShares& table, int count, double turn,
                        double shift) {
  std::vector<double> t;
  t.reserve(static_cast<std::size_t>(count));
  for (int k = 0; k < count; ++k) {
    t.push_back(
        interpolated(table.share, table.t, wrapped(turn * k / count + shift)));
  }
  return curves::points_at(shape, t);
}

double squared_lengths(const Points& a, const Points& b, int turn, int first) {
  const auto n = static_cast<int>(a.size());
  double sum = 0.0;
  for (int k = 0; k < n; ++k) {
    sum += (a[k] - b[((turn * k + first) % n + n) % n]).squaredNorm();
  }
  return sum;
}

/// Where the segment from a to b is nearest to `at`: its share in [0, 1].
double share_along(const Vec3& a, const Vec3& b, const Vec3& at) {
  const double length2 = (b - a).squaredNorm();
  return length2 > 0.0 ? std::clamp((at - a).dot(b - a) / length2, 0.0, 1.0)
                       : 0.0;
}

}  // namespace

double RuledBand::partner_of_outer(double t) const {
  const double share =
      interpolated(outer_shares.t, outer_shares.share, wrapped(t));
  return wrapped(interpolated(inner_shares.share, inner_shares.t,
                              wrapped(turn * share + shift)));
}

double RuledBand::partner_of_inner(double t) const {
  const double share =
      interpolated(inner_shares.t, inner_shares.share, wrapped(t));
  return wrapped(interpolated(outer_shares.share, outer_shares.t,
                              wrapped(turn * (share - shift))));
}

RuledBand match_band(const std::vector<curves::Curve>& curves, int outer,
                     int inner) {
  RuledBand band{.outer = outer, .inner = inner};
  const curves::CurveShape& from = curves[outer].shape;
  const curves::CurveShape& to = curves[inner].shape;
  const bool alike = are_alike(from, to);
  if (!alike) {
    band.outer_shares = shares_of(from);
    band.inner_shares = shares_of(to);
  }
  // Every shift by a sample, both ways around; where corners meet corners, by
  // whole parts.
  const int parts = alike ? curves::curve_shape::part_count(from) : 1;
  const int each = parts > 1 ? std::max(1, kMatched / parts) : 1;
  const int count = parts > 1 ? parts * each : kMatched;
  const Points start =
      points_at_shares(from, band.outer_shares, count, 1.0, 0.0);
  const Points end = points_at_shares(to, band.inner_shares, count, 1.0, 0.0);
  double least = std::numeric_limits<double>::infinity();
  for (const int turn : {1, -1}) {
    for (int first = 0; first < count; first += each) {
      const double sum = squared_lengths(start, end, turn, first);
      if (sum < least * (1.0 - kEqualSums)) {
        least = sum;
        band.turn = turn;
        band.shift = static_cast<double>(first) / count;
      }
    }
  }
  if (parts > 1) {
    return band;
  }
  // Smooth curves may meet between samples: the shift that is best of all.
  const auto sum_at = [&](double shift) {
    return squared_lengths(
        start, points_at_shares(to, band.inner_shares, count, band.turn, shift),
        1, 0);
  };
  const double step = 1.0 / count;
  const double best =
      golden_section(band.shift - step, band.shift + step, sum_at);
  if (sum_at(best) < least * (1.0 - kEqualSums)) {
    band.shift = wrapped(best);
  }
  return band;
}

Vec3 point_on_band(const RuledBand& band,
                   const std::vector<curves::Curve>& curves, double t,
                   double share) {
  return (1.0 - share) * curves::point_at(curves[band.outer].shape, t) +
         share * curves::point_at(curves[band.inner].shape,
                                  band.partner_of_outer(t));
}

BandPlace nearest_on_band(const RuledBand& band,
                          const std::vector<curves::Curve>& curves,
                          const Vec3& at) {
  const auto line_at = [&](double t) {
    return std::array<Vec3, 2>{
        curves::point_at(curves[band.outer].shape, wrapped(t)),
        curves::point_at(curves[band.inner].shape, band.partner_of_outer(t))};
  };
  const auto distance = [&](double t) {
    const auto [a, b] = line_at(t);
    return (a + share_along(a, b, at) * (b - a) - at).squaredNorm();
  };
  double best = 0.0;
  double least = distance(0.0);
  for (int k = 1; k < kMatched; ++k) {
    const double t = static_cast<double>(k) / kMatched;
    const double found = distance(t);
    if (found < least) {
      best = t;
      least = found;
    }
  }
  const double step = 1.0 / kMatched;
  const double t = golden_section(best - step, best + step, distance);
  const auto [a, b] = line_at(t);
  return {wrapped(t), share_along(a, b, at)};
}

BandPlace middle_on_band(const BandPlace& a, const BandPlace& b) {
  const double way = b.t - a.t - std::round(b.t - a.t);
  return {wrapped(a.t + 0.5 * way), 0.5 * (a.share + b.share)};
}

}  // namespace meniscus::films
