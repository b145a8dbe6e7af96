/// What holds a part: plain data, by surface name.
#pragma once

#include <array>
#include <optional>
#include <string>
#include <vector>

#include "core/types.h"
#include "fea/element/local_axes.h"
#include "fea/loads/surfaces.h"

namespace meniscus::loads {

enum class SupportKind {
  Components,  // those that are fixed, along x, y, z or the support's axes
  Normal,      // the surface slides: no displacement along its normal
  Symmetry     // the same for a plane, which the surface must be
};

/// Fixes components of displacement on a surface. Where surfaces meet, a node
/// is held along all their directions; normals that differ by no more than the
/// mesh's own facets do count as one.
struct Support {
  std::string surface;
  bool fix_x = false, fix_y = false, fix_z = false;  // of Components
  SupportKind kind = SupportKind::Components;
  std::optional<element::LocalAxes>
      axes;  // x, y, z of Components are along these
  /// Of Components: what the fixed ones are held at, along the same axes;
  /// without it 0 [length]. Whoever may ever enforce one gives it, if only 0.
  std::optional<Vec3> displacement = {};
  /// Of shells: rotations about the same axes, held at 0 or as displacements
  /// are [rad].
  std::array<bool, 3> fix_rotation = {};
  std::optional<Vec3> rotation = {};
  /// Of shells: holds the surface's node that is nearest to it, and no other
  /// [length].
  std::optional<Vec3> at = {};

  bool operator==(const Support&) const = default;
};

/// A node, on a surface or inside, held along a direction, whatever surfaces
/// do.
struct HeldNode {
  int node = 0;
  Vec3 direction = Vec3::UnitX();  // any length but 0
  double displacement = 0.0;       // that it is held at along it [length]

  bool operator==(const HeldNode&) const = default;
};

enum class SpringMeasure { PerArea, Total };

/// A bed of springs between a surface and the ground, spread consistently:
/// traction -stiffness u. All stiffnesses are 0 or above.
struct SpringBed {
  std::string surface;
  Vec3 components =
      Vec3::Zero();     // along x, y, z or the axes [pressure/length]
                        // per area, [force/length] in total
  double normal = 0.0;  // along the surface's normal; the same
  SpringMeasure measure = SpringMeasure::PerArea;
  std::optional<element::LocalAxes> axes;

  bool operator==(const SpringBed&) const = default;
};

/// A spring between nodes of one element and the ground: it pulls with
/// stiffness x e on e = sum coefficients . u.
struct NodeSpring {
  double stiffness = 0.0;  // above 0 [force/length]
  std::vector<int> nodes;
  Points coefficients;  // one per node

  bool operator==(const NodeSpring&) const = default;
};

/// Surfaces whose nodes move as one rigid body, as on a stiff pin that is
/// bonded to them. It moves freely but for what is fixed; its forces and
/// moments are remote loads on the same surfaces.
struct RigidPin {
  Surfaces surfaces;
  /// Displacement of the point, and rotation, along x, y, z or the axes.
  std::array<bool, 3> fix = {}, fix_rotation = {};
  std::optional<element::LocalAxes> axes = {};
  Vec3 point = Vec3::Zero();  // where something is fixed [length]
  /// What the fixed ones are held at; as of Support [length], [rad].
  std::optional<Vec3> displacement = {}, rotation = {};

  bool holds() const {
    return fix != std::array<bool, 3>{} ||
           fix_rotation != std::array<bool, 3>{};
  }
  bool operator==(const RigidPin&) const = default;
};

inline Vec3 value_of(const std::optional<Vec3>& displacement) {
  return displacement.value_or(Vec3::Zero());
}

}  // namespace meniscus::loads
