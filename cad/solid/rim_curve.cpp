#include "cad/solid/rim_curve.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>

#include <Eigen/Geometry>
#include <Eigen/LU>

#include "cad/solid/spline.h"
#include "core/error.h"

namespace meniscus::solid {

namespace {

constexpr double kSharp = 1e-3;      // [rad]
constexpr double kSamePlace = 1e-6;  // of the length
constexpr int kSamples = 64;         // per piece, for lengths and first guesses

double length_of(const RimPiece& piece) {
  if (std::holds_alternative<StraightLine>(piece.curve)) {
    return piece.last - piece.first;
  }
  double length = 0.0;
  for (int k = 0; k < kSamples; ++k) {
    const double t =
        piece.first + (piece.last - piece.first) * (k + 0.5) / kSamples;
    length += slope_of(piece.curve, t).norm();
  }
  return length * (piece.last - piece.first) / kSamples;
}

double angle_between(const Vec3& a, const Vec3& b) {
  return std::atan2(a.cross(b).norm(), a.dot(b));
}

/// The piece's parameter nearest to p, by Gauss-Newton from one near it.
double nearest_from(const RimPiece& piece, const Vec3& p, double t) {
  for (int round = 0; round < 30; ++round) {
    const Vec3 slope = slope_of(piece.curve, t);
    const double step =
        slope.dot(p - point_of(piece.curve, t)) / slope.squaredNorm();
    t = std::clamp(t + step, piece.first, piece.last);
  }
  return t;
}

/// The same from samples that are nearer than both beside them: where a curve
/// comes near itself, the nearest of all may lie on its other side. Either end
/// counts, for a curve of one piece ends where it begins.
double nearest_on(const RimPiece& piece, const Vec3& p) {
  std::array<double, kSamples + 1> off = {};
  const auto at = [&](int k) {
    return piece.first + (piece.last - piece.first) * k / kSamples;
  };
  for (int k = 0; k <= kSamples; ++k) {
    off[k] = (point_of(piece.curve, at(k)) - p).norm();
  }
  // Between two samples the curve goes on by a sample's length at most.
  const double least = *std::min_element(off.begin(), off.end());
  const double reach = least + length_of(piece) / kSamples;
  double best = piece.first;
  double distance = std::numeric_limits<double>::infinity();
  for (int k = 0; k <= kSamples; ++k) {
    if (off[k] > reach || (k > 0 && off[k - 1] < off[k]) ||
        (k < kSamples && off[k + 1] < off[k])) {
      continue;
    }
    const double t = nearest_from(piece, p, at(k));
    const double d = (point_of(piece.curve, t) - p).norm();
    if (d < distance) {
      distance = d;
      best = t;
    }
  }
  return best;
}

}  // namespace

Vec3 point_of(const EdgeCurve& curve, double t) {
  if (const auto* line = std::get_if<StraightLine>(&curve)) {
    return line->start + t * line->direction;
  }
  if (const auto* arc = std::get_if<EllipseCurve>(&curve)) {
    return arc->center + std::cos(t) * arc->u + std::sin(t) * arc->v;
  }
  return point_of(std::get<SplineCurve>(curve), t);
}

Vec3 slope_of(const EdgeCurve& curve, double t) {
  if (const auto* line = std::get_if<StraightLine>(&curve)) {
    return line->direction;
  }
  if (const auto* arc = std::get_if<EllipseCurve>(&curve)) {
    return std::cos(t) * arc->v - std::sin(t) * arc->u;
  }
  return slope_of(std::get<SplineCurve>(curve), t);
}

RimCurve::RimCurve(std::vector<RimPiece> pieces)
    : pieces_(std::move(pieces)), starts_{0.0} {
  for (const RimPiece& piece : pieces_) {
    starts_.push_back(starts_.back() + length_of(piece));
  }
}

double RimCurve::wrapped(double s) const {
  return s - length() * std::floor(s / length());
}

int RimCurve::piece_at(double s) const {
  const auto after =
      std::upper_bound(starts_.begin(), starts_.end() - 1, wrapped(s));
  return std::max(0, static_cast<int>(after - starts_.begin()) - 1);
}

double RimCurve::parameter_at(int k, double s) const {
  const double share = (s - starts_[k]) / (starts_[k + 1] - starts_[k]);
  return pieces_[k].first + share * (pieces_[k].last - pieces_[k].first);
}

Vec3 RimCurve::point(double s) const {
  const int k = piece_at(s);
  return point_of(pieces_[k].curve, parameter_at(k, wrapped(s)));
}

Vec3 RimCurve::tangent(double s) const {
  const int k = piece_at(s);
  return slope_of(pieces_[k].curve, parameter_at(k, wrapped(s))).normalized();
}

double RimCurve::nearest(const Vec3& p) const {
  double best = 0.0;
  double distance = -1.0;
  for (int k = 0; k < piece_count(); ++k) {
    const RimPiece& piece = pieces_[k];
    const double t = nearest_on(piece, p);
    const double d = (point_of(piece.curve, t) - p).norm();
    if (distance < 0.0 || d < distance) {
      distance = d;
      best = starts_[k] + (t - piece.first) / (piece.last - piece.first) *
                              (starts_[k + 1] - starts_[k]);
    }
  }
  return wrapped(best);
}

double RimCurve::corner_angle(int k) const {
  const RimPiece& before = pieces_[(k + piece_count() - 1) % piece_count()];
  return angle_between(slope_of(before.curve, before.last),
                       slope_of(pieces_[k].curve, pieces_[k].first));
}

bool RimCurve::is_sharp(int k) const { return corner_angle(k) > kSharp; }

std::vector<double> RimCurve::corners() const {
  std::vector<std::pair<double, double>> found;  // angle, place
  for (int k = 0; k < piece_count(); ++k) {
    if (is_sharp(k)) {
      found.emplace_back(corner_angle(k), start_of(k));
    }
  }
  std::stable_sort(
      found.begin(), found.end(),
      [](const auto& a, const auto& b) { return a.first > b.first; });
  std::vector<double> places;
  for (const auto& [angle, place] : found) {
    if (angle > kSharpTurn || found.front().first <= kSharpTurn) {
      places.push_back(place);
    }
  }
  return places;
}

int RimCurve::sharp_corner(double s) const {
  for (int k = 0; k < piece_count(); ++k) {
    const double d = s - starts_[k];
    if (is_sharp(k) && std::abs(d - length() * std::round(d / length())) <
                           kSamePlace * length()) {
      return k;
    }
  }
  return -1;
}

Vec3 RimCurve::corner_normal(int k) const {
  const RimPiece& before = pieces_[(k + piece_count() - 1) % piece_count()];
  return slope_of(before.curve, before.last)
      .cross(slope_of(pieces_[k].curve, pieces_[k].first))
      .normalized();
}

double RimCurve::turning(int k) const {
  const RimPiece& piece = pieces_[k];
  double angle = 0.0;
  Vec3 before = slope_of(piece.curve, piece.first);
  for (int i = 1; i <= kSamples; ++i) {
    const Vec3 slope = slope_of(
        piece.curve, piece.first + (piece.last - piece.first) * i / kSamples);
    angle += angle_between(before, slope);
    before = slope;
  }
  return angle;
}

std::vector<RimPiece> RimCurve::between(double from, double to,
                                        std::vector<double>& ends) const {
  std::vector<RimPiece> result;
  ends.clear();
  const double least = kSamePlace * length();
  for (double s = from; to - s > least;) {
    const int k = piece_at(s + 0.5 * least);
    const double turn = length() * std::floor((s + 0.5 * least) / length());
    double end = std::min(to, turn + starts_[k + 1]);
    end = to - end < least ? to : end;
    RimPiece part = pieces_[k];
    part.first = parameter_at(k, std::max(s - turn, starts_[k]));
    part.last = parameter_at(k, std::min(end - turn, starts_[k + 1]));
    result.push_back(std::move(part));
    ends.push_back(end);
    s = end;
  }
  return result;
}

RimPiece reversed(const RimPiece& piece) {
  if (const auto* line = std::get_if<StraightLine>(&piece.curve)) {
    return {StraightLine{line->start, -line->direction}, -piece.last,
            -piece.first};
  }
  if (const auto* arc = std::get_if<EllipseCurve>(&piece.curve)) {
    return {EllipseCurve{arc->center, arc->u, -arc->v}, -piece.last,
            -piece.first};
  }
  return {reversed(std::get<SplineCurve>(piece.curve)), 1.0 - piece.last,
          1.0 - piece.first};
}

}  // namespace meniscus::solid
