#include "pipeline/files/step_curve.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <utility>

#include <Eigen/Geometry>
#include <fmt/format.h>

#include "core/geometry/surface_mesh.h"
#include "evolve/curves/curve_place.h"

namespace meniscus::files {

namespace {

constexpr double kSmooth = 0.02;      // tangents at a joint, sine [1]
constexpr double kSplineMiss = 1e-6;  // of the loop's size
constexpr double kArcMiss = 1e-4;
constexpr int kFewestPoints = 16;
constexpr int kMostCurvePoints = 2048;
constexpr int kAll = step::StepPiece::kIntervals;
constexpr double kStraight = 1e-9;  // sagitta that is none [chord]
constexpr double kGoesOn = 1e-7;    // off the line or circle before

double length_of(const step::StepLoop& loop) {
  double sum = 0.0;
  for (const step::StepPiece& piece : loop.pieces) {
    sum += piece.length;
  }
  return sum;
}

double size_of(const step::StepLoop& loop) {
  Points all;
  for (const step::StepPiece& piece : loop.pieces) {
    all.insert(all.end(), piece.samples.begin(), piece.samples.end());
  }
  return bounding_diagonal(all);
}

bool is_smooth(const step::StepLoop& loop) {
  for (std::size_t k = 0; k < loop.pieces.size(); ++k) {
    const Vec3& in = loop.pieces[k].arrives;
    const Vec3& out = loop.pieces[(k + 1) % loop.pieces.size()].leaves;
    if (in.cross(out).norm() > kSmooth || in.dot(out) < 0.0) {
      return false;
    }
  }
  return true;
}

/// A spline through about `count` points, and how far it misses the others.
curves::Spline spline_through(const step::StepLoop& loop, int count,
                              double& miss) {
  const double step = length_of(loop) / count;
  curves::Spline spline;
  Points places;             // between those points
  std::vector<double> from;  // per place: the point before it
  for (const step::StepPiece& piece : loop.pieces) {
    const auto wanted = static_cast<unsigned>(
        std::clamp(std::ceil(piece.length / step), 1.0, double(kAll)));
    const int stride = kAll / static_cast<int>(std::bit_ceil(wanted));
    for (int k = 0; k < kAll; ++k) {
      if (k % stride == 0) {
        spline.points.push_back(piece.samples[k]);
      } else {
        places.push_back(piece.samples[k]);
        from.push_back(static_cast<double>(spline.points.size()) - 1.0);
      }
    }
  }
  // t runs by the chords' lengths.
  std::vector<double> t = {0.0};
  const std::size_t n = spline.points.size();
  for (std::size_t k = 0; k < n; ++k) {
    t.push_back(t.back() +
                (spline.points[(k + 1) % n] - spline.points[k]).norm());
  }
  std::vector<double> low;
  std::vector<double> high;
  for (const double k : from) {
    low.push_back(t[static_cast<std::size_t>(k)] / t.back());
    high.push_back(t[static_cast<std::size_t>(k) + 1] / t.back());
  }
  miss = 0.0;
  for (const curves::CurvePlace& place : curves::nearest_between(
           spline, places, std::move(low), std::move(high))) {
    miss = std::max(miss, place.distance);
  }
  return spline;
}

StepCurve fit_spline(const step::StepLoop& loop, const std::string& unit) {
  const double allowed = kSplineMiss * size_of(loop);
  StepCurve result;
  curves::Spline best;
  for (int count = kFewestPoints; count <= kMostCurvePoints; count *= 2) {
    best = spline_through(loop, count, result.deviation);
    if (result.deviation <= allowed) {
      break;
    }
  }
  result.description =
      fmt::format("a spline through {} points, {:.2g} {} off its edges at most",
                  best.points.size(), result.deviation, unit);
  result.shape = std::move(best);
  return result;
}

/// A side of a polyline. `exact`: an edge's own line or arc, which goes on in
/// the next edge where a file has cut it in two.
struct Side {
  Vec3 from;
  Vec3 via;
  Vec3 to;
  bool arc = false;
  bool exact = false;
};

bool is_straight(const Vec3& from, const Vec3& via, const Vec3& to) {
  const Vec3 chord = to - from;
  return (via - from).cross(chord).norm() <= kStraight * chord.squaredNorm();
}

/// Of the circle through three points, from the first.
Vec3 center_from(const Vec3& a, const Vec3& m, const Vec3& b) {
  const Vec3 p = m - a;
  const Vec3 q = b - a;
  const Vec3 normal = p.cross(q);
  return (p.squaredNorm() * q.cross(normal) -
          q.squaredNorm() * p.cross(normal)) /
         (2.0 * normal.squaredNorm());
}

/// Does `b` go on where `a` ends, on the same line or circle?
bool goes_on(const Side& a, const Side& b) {
  if (!a.exact || !b.exact || a.arc != b.arc) {
    return false;
  }
  const Vec3 back = a.from - a.to;
  const Vec3 on = b.to - b.from;
  if (!a.arc) {
    return back.dot(on) < 0.0 &&
           back.cross(on).norm() <= kGoesOn * back.norm() * on.norm();
  }
  const Vec3 center = a.from + center_from(a.from, a.via, a.to);
  const Vec3 other = b.from + center_from(b.from, b.via, b.to);
  const Vec3 turn = (a.via - a.from).cross(a.to - a.via).normalized();
  const Vec3 turn_b = (b.via - b.from).cross(b.to - b.via).normalized();
  return (center - other).norm() <= kGoesOn * (a.from - center).norm() &&
         turn.dot(turn_b) > 1.0 - kGoesOn;
}

void join(std::vector<Side>& sides) {
  const auto append = [](Side& a, const Side& b) {
    a.via = a.to;
    a.to = b.to;
  };
  std::vector<Side> joined;
  for (const Side& side : sides) {
    if (!joined.empty() && goes_on(joined.back(), side)) {
      append(joined.back(), side);
    } else {
      joined.push_back(side);
    }
  }
  if (joined.size() > 3 && goes_on(joined.back(), joined.front())) {
    append(joined.back(), joined.front());
    joined.erase(joined.begin());
  }
  sides = std::move(joined);
}

/// How far samples from `first` to `last` are off the arc that runs through
/// them by their middle.
double arc_miss(const Points& samples, int first, int last) {
  const Vec3& a = samples[first];
  const Vec3& m = samples[(first + last) / 2];
  const Vec3& b = samples[last];
  const Vec3 q = b - a;
  double most = 0.0;
  if (is_straight(a, m, b)) {
    for (int k = first; k <= last; ++k) {
      const Vec3 r = samples[k] - a;
      most = std::max(most, r.cross(q).norm() / q.norm());
    }
    return most;
  }
  const Vec3 center = center_from(a, m, b);
  const Vec3 n = (m - a).cross(q).normalized();
  for (int k = first; k <= last; ++k) {
    const Vec3 r = samples[k] - a - center;
    const double up = r.dot(n);
    most = std::max(most, std::hypot(up, (r - up * n).norm() - center.norm()));
  }
  return most;
}

/// Arcs that an edge needs, and how far it is off these.
int arcs_of(const step::StepPiece& piece, double allowed, double& miss) {
  for (int arcs = 1;; arcs *= 2) {
    const int width = kAll / arcs;
    double most = 0.0;
    for (int k = 0; k < arcs; ++k) {
      most =
          std::max(most, arc_miss(piece.samples, k * width, (k + 1) * width));
    }
    if (most <= allowed || arcs == kAll / 2) {
      miss = std::max(miss, most);
      return arcs;
    }
  }
}

StepCurve fit_polyline(const step::StepLoop& loop, const std::string& unit) {
  const double allowed = kArcMiss * size_of(loop);
  StepCurve result;
  std::vector<Side> sides;
  for (const step::StepPiece& piece : loop.pieces) {
    const Points& p = piece.samples;
    const bool exact = piece.kind != step::StepPiece::Kind::Free;
    const int width =
        kAll / (exact ? 1 : arcs_of(piece, allowed, result.deviation));
    for (int k = 0; k < kAll; k += width) {
      Side side{p[k], p[k + width / 2], p[k + width]};
      side.exact = exact;
      side.arc = piece.kind != step::StepPiece::Kind::Line &&
                 !is_straight(side.from, side.via, side.to);
      sides.push_back(side);
    }
  }
  join(sides);
  curves::Polyline line;
  for (const Side& side : sides) {
    line.corners.push_back(side.from);
    line.via.push_back(side.arc ? std::optional(side.via) : std::nullopt);
  }
  const auto straight =
      std::count(line.via.begin(), line.via.end(), std::optional<Vec3>());
  result.description = fmt::format(
      "{} straight sides and {} arcs, {}", straight,
      std::ssize(line.via) - straight,
      result.deviation > 0.0 ? fmt::format("{:.2g} {} off its edges at most",
                                           result.deviation, unit)
                             : std::string("exact"));
  result.shape = std::move(line);
  return result;
}

StepCurve conic(const solid::EllipseCurve& ellipse, const std::string& unit) {
  const double a = ellipse.u.norm();
  const double b = ellipse.v.norm();
  const Vec3 normal = ellipse.u.cross(ellipse.v) / (a * b);
  if (std::abs(a - b) <= 1e-9 * a) {
    return {curves::Circle{ellipse.center, normal, a}, 0.0,
            fmt::format("a circle of radius {:.6g} {}, exact", a, unit)};
  }
  return {curves::Ellipse{ellipse.center, normal, ellipse.u / a, a, b}, 0.0,
          fmt::format("an ellipse of radii {:.6g} and {:.6g} {}, exact", a, b,
                      unit)};
}

}  // namespace

StepCurve fit_step_loop(const step::StepLoop& loop, const std::string& unit) {
  if (loop.whole) {
    return conic(*loop.whole, unit);
  }
  const bool lines_and_arcs = std::all_of(
      loop.pieces.begin(), loop.pieces.end(), [](const step::StepPiece& piece) {
        return piece.kind != step::StepPiece::Kind::Free;
      });
  return is_smooth(loop) && !lines_and_arcs ? fit_spline(loop, unit)
                                            : fit_polyline(loop, unit);
}

}  // namespace meniscus::files
