/// The exact shape of a film's rim: lines, arcs and splines end to end.
#pragma once

#include <vector>

#include "cad/solid/brep.h"

namespace meniscus::solid {

inline constexpr double kSharpTurn = 0.6;  // what is a corner [rad]

struct RimPiece {
  EdgeCurve curve;
  double first = 0.0;  // the curve's parameter where the piece begins
  double last = 1.0;   // > first
};

/// Closed; a place on it is s in [0, length()), which runs along each piece in
/// proportion to the piece's own parameter.
class RimCurve {
 public:
  explicit RimCurve(std::vector<RimPiece> pieces);

  double length() const { return starts_.back(); }  // [length]
  int piece_count() const { return static_cast<int>(pieces_.size()); }
  const RimPiece& piece(int k) const { return pieces_[k]; }
  double start_of(int k) const { return starts_[k]; }
  /// The piece at s and its curve's parameter there. s outside of the range
  /// is brought into it.
  int piece_at(double s) const;
  double parameter_at(int piece, double s) const;
  Vec3 point(double s) const;
  Vec3 tangent(double s) const;  // unit, along growing s
  /// The place nearest to `p`, of points on the curve or near it.
  double nearest(const Vec3& p) const;
  /// The angle at which the piece and the one before meet [rad].
  double corner_angle(int k) const;
  /// True where they meet with an angle.
  bool is_sharp(int k) const;
  /// Places of the corners, those that count where some turn by more than
  /// kSharpTurn: these; in order of their angles, the sharpest first.
  std::vector<double> corners() const;
  /// The sharp corner at s: the number of the piece that begins there, or -1.
  int sharp_corner(double s) const;
  /// Unit, at right angles to both sides of a sharp corner.
  Vec3 corner_normal(int k) const;
  /// How far the tangent turns along a piece [rad].
  double turning(int k) const;
  double wrapped(double s) const;
  /// The pieces from one place to a later one, which may lie beyond the
  /// beginning by less than a turn; `ends` receives where each ends.
  std::vector<RimPiece> between(double from, double to,
                                std::vector<double>& ends) const;

 private:
  std::vector<RimPiece> pieces_;
  std::vector<double> starts_;  // one more than pieces
};

Vec3 point_of(const EdgeCurve& curve, double t);
Vec3 slope_of(const EdgeCurve& curve, double t);

/// The same run backwards.
RimPiece reversed(const RimPiece& piece);

}  // namespace meniscus::solid
