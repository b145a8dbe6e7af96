/// What holds the nodes of a shell as CalculiX can hold them (internal to its
/// writer of shells).
#pragma once

#include <array>
#include <map>
#include <optional>
#include <vector>

#include "io/shell_deck/shell_deck.h"

namespace meniscus::shell_deck {

/// Components of a node, 0: held; along its frame, or x y z without one.
struct HeldShellNode {
  std::array<bool, 6> fixed = {};
  std::optional<Mat3> frame;  // unit vectors, one a column
};

/// Third axis along the wall's normal, a unit vector, first as near to `first`
/// as it can be.
Mat3 wall_frame(const Vec3& first, const Vec3& normal);

/// Per step, by node. CalculiX has no rotation about a wall's normal: where it
/// is held beside another, the wall can not turn at all in CalculiX. A node
/// whose rotations are held in part has a frame along its normal, and those
/// about tangents held that the support leaves no way to turn about: what is
/// free about the normal is free. `normals`: one per node, unit vectors. Throws
/// InvalidInput, naming step and node, where displacements are held aslant to
/// that frame, and for a node that steps hold in different frames.
std::vector<std::map<int, HeldShellNode>> held_shell_nodes(
    const ShellDeck& deck, const Points& normals);

}  // namespace meniscus::shell_deck
