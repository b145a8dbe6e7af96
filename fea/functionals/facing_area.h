/// How much of the surface faces which way, as functionals (functional.h): what
/// of a part needs supports or does not leave its die. No facet stands in
/// another's way here: what hides behind others is not found.
#pragma once

#include <string>
#include <vector>

#include "core/geometry/tet_mesh.h"
#include "fea/element/functional.h"

namespace meniscus::functionals {

/// A facet counts by a switch that goes from 0 to 1 as the cosine that it is
/// asked of passes a limit, over `width` on either side of the limit's angle: a
/// polynomial with two derivatives. So the area lies between those of the
/// limits moved by the width, and where cosines are spread evenly, as over a
/// sphere, the two sides cancel.
struct FacingLimits {
  double angle = 0.0;  // 0 < angle < 90 degrees [rad]
  double width = 0.0;  // 0 < width < angle [rad]
};

/// Area of the outer surface that hangs over when the part is built layer by
/// layer along `direction`: where the surface is at less than the angle to the
/// build plate and looks down, n . direction < -cos(angle) [length^2]. `base`:
/// surfaces that stand on the plate, which need no supports. Seven points a
/// facet; exact derivatives. Throws InvalidInput: a direction of length 0,
/// limits out of their range, an unknown surface.
element::DirectedFunctional overhang_functional(
    const TetMesh& mesh, const Vec3& direction, const FacingLimits& limits,
    const std::vector<std::string>& base,
    element::Derivatives derivatives = element::Derivatives::All);

/// Area whose draft is less than the angle, of a part that leaves its die along
/// `direction`. Of one surface (`on`): n . direction < sin(angle), undercuts
/// that look back among it. Empty: of the whole outer surface, whose facets
/// each leave on the side that they look to: |n . direction| < sin(angle).
/// Throws likewise.
element::DirectedFunctional draft_functional(
    const TetMesh& mesh, const Vec3& direction, const FacingLimits& limits,
    const std::string& on,
    element::Derivatives derivatives = element::Derivatives::All);

}  // namespace meniscus::functionals
