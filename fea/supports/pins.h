/// Rigid pins on a mesh: which nodes move together, and how.
#pragma once

#include <array>
#include <vector>

#include "core/geometry/tet_mesh.h"
#include "fea/loads/load_case.h"
#include "fea/loads/support.h"

namespace meniscus::supports {

/// A pin's nodes and its six motions: translations of `point` along the axes,
/// then rotations about them.
struct PinFrame {
  std::vector<int> nodes;
  Vec3 point = Vec3::Zero();       // of a free pin the middle of its nodes
  Mat3 axes = Mat3::Identity();    // one a column; of a free pin x, y, z
  std::array<bool, 6> fixed = {};  // these motions

  bool is_free() const { return fixed == std::array<bool, 6>{}; }
  /// Displacement at x per unit of motion k [length, length/rad].
  Vec3 motion(int k, const Vec3& x) const {
    return k < 3 ? Vec3(axes.col(k)) : Vec3(axes.col(k - 3).cross(x - point));
  }

  bool operator==(const PinFrame&) const = default;
};

/// One per pin of the load case, nodes ascending, in the mesh's numbering.
/// Throws InvalidInput, naming load case and surfaces: unknown surfaces, nodes
/// that two pins share or that lie on a line, axes that span no plane, numbers
/// that are not finite.
std::vector<PinFrame> pin_frames(const TetMesh& mesh,
                                 const loads::LoadCase& load_case);

/// Of fixed motion k of a pin: its value [length, rad].
double pin_value(const loads::RigidPin& pin, int k);

/// A rigid motion of a pin: of its point, and about it.
struct PinMotion {
  Vec3 displacement = Vec3::Zero();  // [length]
  Vec3 rotation = Vec3::Zero();      // [rad]
};

/// The one nearest to how the pin's nodes move; theirs where that is rigid.
/// `x`, `u` (3 each): of all nodes, in the frame's numbering.
PinMotion motion_of(const PinFrame& pin, const Points& x, const VectorX& u);

}  // namespace meniscus::supports
