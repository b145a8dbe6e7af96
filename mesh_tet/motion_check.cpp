#include "mesh_tet/motion_check.h"

#include <fmt/format.h>

#include "mesh_tet/quadratic.h"

namespace meniscus::mesh_tet {

namespace {

Failure failure(const TetMesh& mesh, int element, const std::string& what) {
  return {FailureKind::ElementsInverted,
          fmt::format("element {} {} {}: this design is too far from the "
                      "initial one for its mesh; choose an initial design "
                      "nearer to it, or narrower bounds",
                      element, place_of(mesh, element), what)};
}

}  // namespace

std::optional<Failure> check_moved(const TetMesh& mesh,
                                   const MotionBounds& bounds,
                                   TetQuality* quality) {
  const TetQuality found = tet_quality(mesh);
  if (quality != nullptr) {
    *quality = found;
  }
  const int inverted = find_inverted(mesh, bounds.least_jacobian);
  if (inverted >= 0) {
    const bool folded = corner_volume(mesh, inverted) > 0.0;
    return failure(
        mesh, inverted,
        folded ? "is folded by its curved sides" : "is turned inside out");
  }
  if (const auto breach = find_breach(found, bounds.corners)) {
    return failure(mesh, breach->element, "has " + breach->what);
  }
  return std::nullopt;
}

}  // namespace meniscus::mesh_tet
