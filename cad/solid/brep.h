/// A solid as its faces: what leaves films for CAD programs. Plain arrays like
/// SurfaceMesh; faces share edges and edges share vertices by number, so that
/// what is closed here is closed without sewing.
#pragma once

#include <string>
#include <variant>
#include <vector>

#include "core/geometry/exact_shape.h"
#include "core/types.h"

namespace meniscus::solid {

using Vec2 = Eigen::Vector2d;

/// start + t direction, direction of unit length: t is a length.
struct StraightLine {
  Vec3 start = Vec3::Zero();
  Vec3 direction = Vec3::UnitX();
};

/// center + cos(t) u + sin(t) v; u and v at right angles, a circle where they
/// are of one length.
struct EllipseCurve {
  Vec3 center = Vec3::Zero();
  Vec3 u = Vec3::UnitX();
  Vec3 v = Vec3::UnitY();
};

/// Cubic; `knots` with their multiplicities, four at each end.
struct SplineCurve {
  std::vector<double> knots;
  Points poles;  // knots.size() - 4
};

using EdgeCurve = std::variant<StraightLine, EllipseCurve, SplineCurve>;

/// The part of a curve from parameter `first` to `last` > first.
struct BrepEdge {
  int from = 0;  // vertex at first
  int to = 0;    // at last
  EdgeCurve curve;
  double first = 0.0;
  double last = 1.0;
  double gap = 0.0;  // the farthest that an adjoining surface's own boundary
                     // lies from the curve [length]
};

struct PlaneSurface {
  Vec3 point = Vec3::Zero();
  Vec3 normal = Vec3::UnitZ();  // unit, out of the solid
};

/// Around `axis` by the angle a from `zero`, and along it by b from `center`.
struct CylinderSurface {
  Vec3 center = Vec3::Zero();
  Vec3 axis = Vec3::UnitZ();  // unit
  Vec3 zero = Vec3::UnitX();  // unit, at right angles to the axis
  double radius = 1.0;
  bool inward = false;  // the solid is outside of it: a bore
};

/// The same, b along its lines: of radius + b sin(angle), b cos(angle) along
/// the axis.
struct ConeSurface {
  Vec3 center = Vec3::Zero();
  Vec3 axis = Vec3::UnitZ();
  Vec3 zero = Vec3::UnitX();
  double radius = 1.0;
  double angle = 0.0;  // between lines and axis, not 0 [radian]
  bool inward = false;
};

/// By longitude a from `zero` around `axis`, and latitude b towards it.
struct SphereSurface {
  Vec3 center = Vec3::Zero();
  Vec3 axis = Vec3::UnitZ();
  Vec3 zero = Vec3::UnitX();
  double radius = 1.0;
  bool inward = false;
};

/// Bicubic tensor product over [0,1] x [0,1]; dS/da x dS/db points out of the
/// solid.
struct SplineSurface {
  std::vector<double> knots_a;
  std::vector<double> knots_b;
  Points poles;  // pole (i, j) at i * (knots_b.size() - 4) + j
};

/// An edge in a face's loop. The surface's parameters (a, b) at the edge's own
/// first and last, between which they run linearly; not used on planes. A face
/// that closes upon itself uses its seam twice, once each way.
struct BrepUse {
  int edge = 0;  // kPole: no edge but the way across a sphere's pole, from
                 // at_first to at_last, at the end of the use before
  bool forward = true;
  Vec2 at_first = Vec2::Zero();
  Vec2 at_last = Vec2::Zero();
};

constexpr int kPole = -1;

struct BrepFace {
  std::string name;
  std::variant<PlaneSurface, CylinderSurface, ConeSurface, SphereSurface,
               SplineSurface>
      surface;
  // Closed, counter-clockwise seen from outside, the outer one first.
  std::vector<std::vector<BrepUse>> loops;
};

/// Faces of a solid from CAD as they are. Their edges are their own: they lie
/// on those of other faces, and are joined to them by sewing.
struct ExactFaces {
  ExactShape shape;
  std::vector<int> faces;          // of the shape
  std::vector<std::string> names;  // of these
};

/// One closed solid; several shells where it has cavities or parts.
struct Brep {
  Points vertices;  // [length]
  std::vector<BrepEdge> edges;
  std::vector<BrepFace> faces;
  std::vector<ExactFaces> exact;
};

}  // namespace meniscus::solid
