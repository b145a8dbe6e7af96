#include "cad/solid/curve_through.h"

#include <algorithm>
#include <cmath>

#include <Eigen/Geometry>

#include "cad/solid/spline.h"
#include "core/error.h"

namespace meniscus::solid {

namespace {

constexpr double kStraight = 1e-9;  // of the length
constexpr int kBeyond = 12;         // points; each tells 0.27 of the one before

double corner_turn(const Vec3& a, const Vec3& b) {
  return std::atan2(a.cross(b).norm(), a.dot(b));
}

bool lie_on_line(const Points& points) {
  const Vec3 way = points.back() - points.front();
  return way.norm() > 0.0 &&
         std::all_of(points.begin(), points.end(), [&](const Vec3& p) {
           return way.cross(p - points.front()).norm() <=
                  kStraight * way.squaredNorm();
         });
}

/// From corner to corner: a straight line, or one cubic spline that also knows
/// `beyond` points on either side of the piece.
class PieceThrough {
 public:
  PieceThrough(const Points& points, std::size_t beyond)
      : points_(points), beyond_(beyond), inner_(points.size() - 2 * beyond) {
    const Points own(points.begin() + static_cast<long>(beyond),
                     points.end() - static_cast<long>(beyond));
    if (lie_on_line(own)) {
      const Vec3 way = own.back() - own.front();
      piece_ = {StraightLine{own.front(), way.normalized()}, 0.0, way.norm()};
      for (const Vec3& p : own) {
        at_.push_back(
            std::clamp(way.dot(p - own.front()) / way.squaredNorm(), 0.0, 1.0));
      }
      return;
    }
    fit();
  }

  const RimPiece& piece() const { return piece_; }
  double share(std::size_t k) const { return at_[k]; }

 private:
  /// Parameters by chord length (Piegl, Tiller, The NURBS Book, 9.2.1), and a
  /// knot at each inner point.
  void fit() {
    CurveFit fit;
    fit.points = points_;
    std::vector<double> chord{0.0};
    for (std::size_t i = 1; i < points_.size(); ++i) {
      chord.push_back(chord.back() + (points_[i] - points_[i - 1]).norm());
    }
    std::vector<SplineBreak> inner;
    for (std::size_t i = 0; i < chord.size(); ++i) {
      fit.at.push_back(chord[i] / chord.back());
      if (i > 0 && i + 1 < chord.size()) {
        inner.push_back({fit.at[i], 1});
      }
    }
    fit.knots = clamped_knots(inner);
    fit.start = fit.points.front();
    fit.end = fit.points.back();
    piece_ = {fit_curve(fit), fit.at[beyond_],
              fit.at[fit.at.size() - 1 - beyond_]};
    for (std::size_t k = 0; k < inner_; ++k) {
      at_.push_back((fit.at[beyond_ + k] - piece_.first) /
                    (piece_.last - piece_.first));
    }
  }

  Points points_;
  std::size_t beyond_;
  std::size_t inner_;
  RimPiece piece_;
  std::vector<double> at_;
};

/// Where the polygon turns by more than `sharp`; ends of an open one.
std::vector<int> corners_of(const Points& points, bool closed, double sharp) {
  const int n = static_cast<int>(points.size());
  std::vector<int> corners;
  for (int i = 0; i < n; ++i) {
    const bool end = !closed && (i == 0 || i == n - 1);
    const Vec3 in = points[i] - points[(i + n - 1) % n];
    const Vec3 out = points[(i + 1) % n] - points[i];
    if (end || corner_turn(in, out) > sharp) {
      corners.push_back(i);
    }
  }
  return corners;
}

}  // namespace

PointCurve curve_through(const Points& points, bool closed, double sharp) {
  const int n = static_cast<int>(points.size());
  if (closed && n < 3) {
    throw MeshError("a rim has fewer than three points");
  }
  std::vector<int> corners = corners_of(points, closed, sharp);
  // A smooth closed curve runs on past its start, so that it has no corner; of
  // what was fitted one turn is used.
  const bool smooth = corners.empty();
  const int beyond = smooth ? std::min(kBeyond, n / 2) : 0;
  if (smooth) {
    corners.push_back(0);
  }
  PointCurve result;
  result.at.assign(points.size(), {});
  const std::size_t count = corners.size() - (closed ? 0 : 1);
  for (std::size_t c = 0; c < count; ++c) {
    const int first = corners[c];
    int steps = (corners[(c + 1) % corners.size()] - first + n) % n;
    steps = steps == 0 ? n : steps;
    Points there;
    for (int i = -beyond; i <= steps + beyond; ++i) {
      there.push_back(points[((first + i) % n + n) % n]);
    }
    const PieceThrough through(there, static_cast<std::size_t>(beyond));
    for (int i = 0; i <= steps; ++i) {
      // The end of a piece is the beginning of the next.
      if (i < steps || (!closed && c + 1 == count)) {
        result.at[(first + i) % n] = {static_cast<int>(c), through.share(i)};
      }
    }
    result.pieces.push_back(through.piece());
  }
  return result;
}

RimCurve rim_through(const Points& points, double sharp) {
  return RimCurve(curve_through(points, true, sharp).pieces);
}

}  // namespace meniscus::solid
