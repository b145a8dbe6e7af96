#include "evolve/films/ruled_band.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include <fmt/format.h>

#include "core/error.h"
#include "core/math/golden_section.h"
#include "evolve/curves/curve_shape.h"
#include "evolve/films/shared_sides.h"

namespace meniscus::films {

namespace {

constexpr int kMatched = 96;         // points that are looked at on each curve
constexpr int kShareSteps = 2048;    // of a table of lengths
constexpr double kEqualSums = 1e-9;  // sums that differ by less are equal
constexpr double kSmoothJoin =
    0.02;                           // [rad] parts that meet at less: no corner
constexpr double kJoinStep = 1e-6;  // of a part, beside its ends

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

/// How two curves are joined, and the sum of squared lengths of some lines.
struct Match {
  double turn = 1.0;
  double shift = 0.0;
  double sum = std::numeric_limits<double>::infinity();
};

/// Both ways around, by every `each`-th of `count` samples.
Match match_samples(const Points& start, const Points& end, int each) {
  const auto count = static_cast<int>(start.size());
  Match best;
  for (const int turn : {1, -1}) {
    for (int first = 0; first < count; first += each) {
      const double sum = squared_lengths(start, end, turn, first);
      if (sum < best.sum * (1.0 - kEqualSums)) {
        best = {static_cast<double>(turn), static_cast<double>(first) / count,
                sum};
      }
    }
  }
  return best;
}

/// At equal parameters, part to part.
Match match_by_parts(const curves::CurveShape& from,
                     const curves::CurveShape& to, int parts) {
  const int each = std::max(1, kMatched / parts);
  const auto points = [&](const curves::CurveShape& shape) {
    return points_at_shares(shape, {}, parts * each, 1.0, 0.0);
  };
  Match match = match_samples(points(from), points(to), each);
  match.sum *= static_cast<double>(kMatched) / (parts * each);
  return match;
}

/// At equal shares, from whichever place is best: also between samples.
Match match_by_shares(const curves::CurveShape& from,
                      const LengthShares& of_outer,
                      const curves::CurveShape& to,
                      const LengthShares& of_inner) {
  const Points start = points_at_shares(from, of_outer, kMatched, 1.0, 0.0);
  Match match = match_samples(
      start, points_at_shares(to, of_inner, kMatched, 1.0, 0.0), 1);
  const auto sum_at = [&](double shift) {
    return squared_lengths(
        start, points_at_shares(to, of_inner, kMatched, match.turn, shift), 1,
        0);
  };
  constexpr double kStep = 1.0 / kMatched;
  const double best =
      golden_section(match.shift - kStep, match.shift + kStep, sum_at);
  const double sum = sum_at(best);
  if (sum < match.sum * (1.0 - kEqualSums)) {
    match.shift = wrapped(best);
    match.sum = sum;
  }
  return match;
}

/// Do parts of the curve meet at an angle?
bool has_corners(const curves::CurveShape& shape) {
  const int parts = curves::curve_shape::part_count(shape);
  for (int k = 0; k < parts && parts > 1; ++k) {
    const double at = static_cast<double>(k) / parts;
    const double step = kJoinStep / parts;
    const Points around =
        curves::points_at(shape, {wrapped(at - step), at, wrapped(at + step)});
    const Vec3 before = around[1] - around[0];
    const Vec3 after = around[2] - around[1];
    if (std::atan2(before.cross(after).norm(), before.dot(after)) >
        kSmoothJoin) {
      return true;
    }
  }
  return false;
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
  const curves::CurveShape& from = curves[outer].shape;
  const curves::CurveShape& to = curves[inner].shape;
  RuledBand band{.outer = outer, .inner = inner};
  Match best;
  const int parts = curves::curve_shape::part_count(from);
  const bool alike = are_alike(from, to);
  if (alike && parts > 1) {
    best = match_by_parts(from, to, parts);
  }
  if (alike && parts == 1) {
    best = match_by_shares(from, {}, to, {});
  } else if (!alike || !(has_corners(from) || has_corners(to))) {
    LengthShares of_outer = shares_of(from);
    LengthShares of_inner = shares_of(to);
    const Match match = match_by_shares(from, of_outer, to, of_inner);
    if (match.sum < best.sum * (1.0 - kEqualSums)) {
      best = match;
      band.outer_shares = std::move(of_outer);
      band.inner_shares = std::move(of_inner);
    }
  }
  band.turn = best.turn;
  band.shift = best.shift;
  return band;
}

void make_partners(RuledBand& band, double outer_t, double inner_t) {
  const auto share = [](const LengthShares& table, double t) {
    return interpolated(table.t, table.share, t);
  };
  band.shift = wrapped(share(band.inner_shares, inner_t) -
                       band.turn * share(band.outer_shares, outer_t));
}

RuledBand match_patch(const std::vector<curves::Curve>& curves, int curve) {
  const std::size_t sides = sides_of(curves[curve].shape).size();
  if (sides != 4) {
    throw InvalidInput(fmt::format(
        "curve '{}' has {} sides; a face between the first and the third side "
        "needs a polygon or polyline of four",
        curves[curve].name, sides));
  }
  return {.outer = curve,
          .inner = curve,
          .turn = -1.0,
          .shift = 0.75,
          .span = 0.25};
}

BandPlace place_on_patch(const RuledBand& patch, double t) {
  const double span = patch.span;
  const double side = std::floor(t / span);
  const double along = t / span - side;
  switch (static_cast<int>(side)) {
    case 0:
      return {t, 0.0};
    case 1:
      return {span, along};
    case 2:
      return {patch.partner_of_inner(t), 1.0};
    default:
      return {0.0, 1.0 - along};
  }
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
  const double step = band.span / kMatched;
  const int last = band.is_patch() ? kMatched : kMatched - 1;
  double best = 0.0;
  double least = distance(0.0);
  for (int k = 1; k <= last; ++k) {
    const double t = k * band.span / kMatched;
    const double found = distance(t);
    if (found < least) {
      best = t;
      least = found;
    }
  }
  double low = best - step;
  double high = best + step;
  if (band.is_patch()) {
    low = std::max(low, 0.0);
    high = std::min(high, band.span);
  }
  const double t = golden_section(low, high, distance);
  const auto [a, b] = line_at(t);
  return {wrapped(t), share_along(a, b, at)};
}

BandPlace middle_on_band(const BandPlace& a, const BandPlace& b) {
  const double way = b.t - a.t - std::round(b.t - a.t);
  return {wrapped(a.t + 0.5 * way), 0.5 * (a.share + b.share)};
}

}  // namespace meniscus::films
