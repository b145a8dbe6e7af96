#include "pipeline/step_parts/rim_pieces.h"

#include <array>
#include <cmath>
#include <memory>
#include <numbers>

#include <Eigen/Geometry>

#include "evolve/curves/arc_side.h"
#include "evolve/curves/curve_copy.h"
#include "evolve/curves/curve_shape.h"

namespace meniscus::step_parts {

namespace {

constexpr double kFullTurn = 2.0 * std::numbers::pi;
constexpr double kSquare = 1e-9;  // cosine of a right angle

solid::RimPiece line_piece(const Vec3& from, const Vec3& to) {
  const Vec3 way = to - from;
  return {solid::StraightLine{from, way.normalized()}, 0.0, way.norm()};
}

std::vector<solid::RimPiece> pieces_of(const curves::Circle& circle) {
  const auto frame = curves::curve_shape::frame_of(circle);
  return {{solid::EllipseCurve{circle.center, circle.radius * frame.u,
                               circle.radius * frame.v},
           0.0, kFullTurn}};
}

std::vector<solid::RimPiece> pieces_of(const curves::Ellipse& ellipse) {
  const auto frame = curves::curve_shape::frame_of(ellipse);
  return {{solid::EllipseCurve{ellipse.center, ellipse.radius_1 * frame.u,
                               ellipse.radius_2 * frame.v},
           0.0, kFullTurn}};
}

std::vector<solid::RimPiece> pieces_of(const curves::Rectangle& box) {
  const auto frame = curves::curve_shape::frame_of(box);
  const double r = box.corner_radius;
  std::vector<solid::RimPiece> pieces;
  const auto at = [&](double a, double b) {
    return Vec3(box.center + a * frame.u + b * frame.v);
  };
  // Counter-clockwise from the right side, as evolve/curves/curve has it.
  const double w = 0.5 * box.width;
  const double h = 0.5 * box.height;
  const std::array<solid::Vec2, 4> from{
      solid::Vec2(w, r - h), solid::Vec2(w - r, h), solid::Vec2(-w, h - r),
      solid::Vec2(r - w, -h)};
  const std::array<solid::Vec2, 4> to{
      solid::Vec2(w, h - r), solid::Vec2(r - w, h), solid::Vec2(-w, r - h),
      solid::Vec2(w - r, -h)};
  const std::array<solid::Vec2, 4> middle{
      solid::Vec2(w - r, h - r), solid::Vec2(r - w, h - r),
      solid::Vec2(r - w, r - h), solid::Vec2(w - r, r - h)};
  for (int k = 0; k < 4; ++k) {
    pieces.push_back(
        line_piece(at(from[k][0], from[k][1]), at(to[k][0], to[k][1])));
    if (r > 0.0) {
      const double start = 0.25 * kFullTurn * k;
      pieces.push_back({solid::EllipseCurve{at(middle[k][0], middle[k][1]),
                                            r * frame.u, r * frame.v},
                        start, start + 0.25 * kFullTurn});
    }
  }
  return pieces;
}

std::vector<solid::RimPiece> pieces_of(const curves::Polygon& polygon) {
  std::vector<solid::RimPiece> pieces;
  const std::size_t n = polygon.points.size();
  for (std::size_t k = 0; k < n; ++k) {
    pieces.push_back(
        line_piece(polygon.points[k], polygon.points[(k + 1) % n]));
  }
  return pieces;
}

std::vector<solid::RimPiece> pieces_of(const curves::Polyline& line) {
  std::vector<solid::RimPiece> pieces;
  const std::size_t n = line.corners.size();
  for (std::size_t k = 0; k < n; ++k) {
    const Vec3& from = line.corners[k];
    const Vec3& to = line.corners[(k + 1) % n];
    if (!line.via[k]) {
      pieces.push_back(line_piece(from, to));
      continue;
    }
    const auto arc =
        curves::curve_shape::arc_through<double>(from, *line.via[k], to);
    pieces.push_back(
        {solid::EllipseCurve{arc.center, arc.u, arc.v}, 0.0, arc.angle});
  }
  return pieces;
}

/// Where a copy takes some points: it is the same of every curve, and one
/// through them has them for its corners.
Points moved(const curves::CurveCopy& copy, const Points& points) {
  curves::CurveCopy motion = copy;
  motion.offset.reset();
  motion.of = std::make_shared<curves::Curve>(
      curves::Curve{"", curves::Polygon{points}});
  std::vector<double> t;
  for (std::size_t k = 0; k < points.size(); ++k) {
    t.push_back(static_cast<double>(k) / static_cast<double>(points.size()));
  }
  return curves::points_at(motion, t);
}

std::vector<solid::RimPiece> pieces_of(const curves::CurveCopy& copy) {
  std::vector<solid::RimPiece> pieces =
      rim_pieces(curves::curve_shape::base_of(copy));
  for (solid::RimPiece& piece : pieces) {
    const auto* arc = std::get_if<solid::EllipseCurve>(&piece.curve);
    if (arc == nullptr) {
      const Points ends =
          moved(copy, {solid::point_of(piece.curve, piece.first),
                       solid::point_of(piece.curve, piece.last)});
      piece = line_piece(ends[0], ends[1]);
      continue;
    }
    const Points at =
        moved(copy, {arc->center, arc->center + arc->u, arc->center + arc->v});
    const Vec3 u = at[1] - at[0];
    const Vec3 v = at[2] - at[0];
    if (std::abs(u.dot(v)) > kSquare * u.norm() * v.norm()) {
      return {};  // scaled askew: no longer the ellipse's axes
    }
    piece.curve = solid::EllipseCurve{at[0], u, v};
  }
  return pieces;
}

/// Other kinds: none.
template <class Shape>
std::vector<solid::RimPiece> pieces_of(const Shape& /*shape*/) {
  return {};
}

}  // namespace

std::vector<solid::RimPiece> rim_pieces(const curves::CurveShape& shape) {
  return std::visit([](const auto& s) { return pieces_of(s); }, shape);
}

}  // namespace meniscus::step_parts
