/// What field energies are asked for: poles that attract or repel, and
/// pressures that vary (evolve/energy/fields.h makes energies of them).
#pragma once

#include <string>
#include <variant>
#include <vector>

#include "core/math/place_field.h"
#include "core/types.h"

namespace meniscus::films {

struct PointPole {
  Vec3 at = Vec3::Zero();
};
struct SegmentPole {
  Vec3 from = Vec3::Zero();
  Vec3 to = Vec3::UnitX();
};
/// A curve, sampled: segments from point to point; closed when the last point
/// is the first.
struct PolylinePole {
  Points points;
};
struct PlanePole {
  Vec3 at = Vec3::Zero();
  Vec3 normal = Vec3::UnitZ();  // any length but 0
};
using PoleShape = std::variant<PointPole, SegmentPole, PolylinePole, PlanePole>;

/// Energy per film area, of the named surfaces; none: of every liquid one.
struct PerArea {
  std::vector<std::string> surfaces;
};
/// Energy per volume of the named body; empty: of every body.
struct PerVolume {
  std::string body;
};

/// phi = -strength (1 + (d / core)^2)^(-power / 2), d the distance to the
/// shape. Strength > 0 attracts, < 0 repels; it is the depth of phi on the
/// pole [force/length per area, force/length^2 per volume]. Far away phi falls
/// as d^-power. Per area, phi adds to the tension: an attracting strength
/// must stay below it, or films crumple on the pole.
///
/// Points and planes: smooth. A segment: the second derivatives jump across
/// the planes through its ends, normal to it. A polyline also has a kink where
/// its nearest segment changes, on the inner side of its bends.
struct FieldSpec {
  std::string name;
  PoleShape shape;
  double strength = 0.0;
  double power = 2.0;  // > 0
  double core = 1.0;   // softening length, > 0 [length]
  std::variant<PerArea, PerVolume> per;
  bool moves = false;        // strength, power or core follow the design
  bool place_moves = false;  // the shape does
};

/// A pressure [force/length^2] that varies, on top of the body's own; positive
/// inflates.
struct PressureSpec {
  std::string name;
  std::string body;  // empty: every body
  PlaceField pressure;
};

}  // namespace meniscus::films
