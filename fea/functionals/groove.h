/// How deep the grooves of a part are, as a functional (functional.h).
#pragma once

#include "core/geometry/tet_mesh.h"
#include "fea/element/functional.h"

namespace meniscus::functionals {

/// (1/k) ln sum exp(k t) over the edges where outer faces of two labels meet
/// [rad], t how far the surface turns into the material there (outer_edges.h):
/// above the largest t, by no more than ln(edges) / k. `sharpness` k > 0. Where
/// a t is above 0 the stress has no limit (fea/stress/singular_edges.h). Throws
/// InvalidInput for a sharpness that is not positive and a mesh without such
/// edges.
element::Functional groove_functional(
    const TetMesh& mesh, double sharpness,
    element::Derivatives derivatives = element::Derivatives::All);

}  // namespace meniscus::functionals
