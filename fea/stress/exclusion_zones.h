/// Zones of a part that stress figures leave out.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "core/geometry/tet_mesh.h"

namespace meniscus::stress {

/// Where stresses are left out of account: about clamps, grooves and loads they
/// are the model's, not the part's.
struct ExclusionZone {
  std::string surface;    // empty: none
  double distance = 0.0;  // to the surface's nearest node [length]
  struct Box {
    Vec3 low = Vec3::Zero();
    Vec3 high = Vec3::Zero();  // [length]
  };
  std::optional<Box> box;
  struct Ball {
    Vec3 center = Vec3::Zero();  // [length]
    double radius = 0.0;         // [length]
  };
  std::optional<Ball> ball;
};

/// What the zones hold: elements with their centre in one count in no mean
/// over the volume; they, and nodes in one, in no peak. One char each, 1 where
/// it is left out; empty where nothing is.
struct Excluded {
  std::vector<char> element;
  std::vector<char> node;
  bool inverted = false;  // what is left out counts, and nothing else

  bool counts(int e, int n) const {
    const bool out =
        !element.empty() && (element[static_cast<std::size_t>(e)] != 0 ||
                             node[static_cast<std::size_t>(n)] != 0);
    return out == inverted;
  }
};

/// Ask once, at a model's base design: the same elements and nodes must then
/// count in every design. Throws InvalidInput for an unknown surface, a
/// distance or radius that is not positive, an empty box, and a zone with none
/// of them.
Excluded excluded_by(const TetMesh& mesh,
                     const std::vector<ExclusionZone>& zones);

}  // namespace meniscus::stress
