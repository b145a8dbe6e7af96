/// The boundary of a solid from a CAD program: faces on their exact surfaces,
/// which share edges by number, which share vertices. Plain values; lengths in
/// one unit, angles in radians.
#pragma once

#include <string>
#include <variant>
#include <vector>

#include "core/types.h"

namespace meniscus {

using Vec2 = Eigen::Vector2d;

/// point + t direction, direction of unit length.
struct ExactLine {
  Vec3 point = Vec3::Zero();
  Vec3 direction = Vec3::UnitX();
};

/// center + cos(t) u + sin(t) v; u and v at right angles, a circle where they
/// are of one length.
struct ExactEllipse {
  Vec3 center = Vec3::Zero();
  Vec3 u = Vec3::UnitX();
  Vec3 v = Vec3::UnitY();
};

/// Rational B-spline (Piegl and Tiller 1997, ch. 4); `knots` with their
/// multiplicities, poles.size() + degree + 1 of them, not periodic.
struct ExactSpline {
  int degree = 1;
  std::vector<double> knots;
  Points poles;
  std::vector<double> weights;  // above 0, one a pole
};

using ExactCurve = std::variant<ExactLine, ExactEllipse, ExactSpline>;

/// The part of a curve between two parameters; closed where from == to.
struct ExactEdge {
  std::string name;  // the file's; empty: none
  int from = 0;      // vertex at first
  int to = 0;        // at last
  ExactCurve curve;
  double first = 0.0;
  double last = 1.0;
};

/// Directions of unit length at right angles; may be left-handed.
struct ExactFrame {
  Vec3 origin = Vec3::Zero();
  Vec3 x = Vec3::UnitX();
  Vec3 y = Vec3::UnitY();
  Vec3 z = Vec3::UnitZ();
};

/// origin + a x + b y.
struct ExactPlane {
  ExactFrame frame;
};

/// Around z by the angle a from x, along it by b.
struct ExactCylinder {
  ExactFrame frame;
  double radius = 1.0;
};

/// The same, b along its lines: at radius + b sin(angle), b cos(angle) along z.
struct ExactCone {
  ExactFrame frame;
  double radius = 1.0;
  double angle = 0.5;  // between lines and z, not 0
};

/// By longitude a from x around z, and latitude b towards z.
struct ExactSphere {
  ExactFrame frame;
  double radius = 1.0;
};

/// Around z by the angle a, around the ring by b: at major + minor cos(b),
/// minor sin(b) along z.
struct ExactTorus {
  ExactFrame frame;
  double major = 2.0;
  double minor = 1.0;
};

/// Rational tensor product; pole (i, j) at i * count_b + j.
struct ExactSplineSurface {
  int degree_a = 1;
  int degree_b = 1;
  std::vector<double> knots_a;
  std::vector<double> knots_b;
  Points poles;
  std::vector<double> weights;

  int count_b() const {
    return static_cast<int>(knots_b.size()) - degree_b - 1;
  }
};

using ExactSurface = std::variant<ExactPlane, ExactCylinder, ExactCone,
                                  ExactSphere, ExactTorus, ExactSplineSurface>;

/// An edge in a face's loop. A face that closes upon itself uses its seam
/// twice, once each way; `start` tells on which side: the surface's parameters
/// where the loop enters the edge. Of angles alone the file says them.
struct ExactUse {
  int edge = 0;
  bool forward = true;
  Vec2 start = Vec2::Zero();
};

struct ExactFace {
  std::string name;  // unique
  ExactSurface surface;
  bool outward = true;  // the cross product of its tangents along a and b
                        // points out of the solid
  std::vector<std::vector<ExactUse>> loops;  // closed
};

struct ExactShape {
  Points vertices;
  std::vector<ExactEdge> edges;
  std::vector<ExactFace> faces;
};

/// As text, numbers to the last bit.
std::string exact_shape_text(const ExactShape& shape);

/// It back. Throws InvalidInput for a text that is none, or whose numbers point
/// beyond its lists.
ExactShape read_exact_shape_text(const std::string& text);

}  // namespace meniscus
