/// Where the part's surface lies, as functionals (functional.h).
#pragma once

#include "core/geometry/tet_mesh.h"
#include "fea/element/functional.h"
#include "fea/loads/load_case.h"

namespace meniscus::functionals {

/// Smooth largest value over the nodes of the outer surface of a level set
/// that is positive in a region to keep out of, and measures the distance from
/// its border there (to keep within a region: negative inside):
///   (1/k) ln sum exp(k level(x_i)) [length],
/// Kreisselmeier and Steinhauser's; above the largest by no more than
/// ln(nodes) / k. `sharpness` k > 0 [1/length]. Throws InvalidInput for a
/// sharpness that is not positive, a mesh without faces, a level set without a
/// finite value or, for derivatives, without a slope.
element::Functional intrusion_functional(
    const TetMesh& mesh, const loads::SlopedField& level, double sharpness,
    element::Derivatives derivatives = element::Derivatives::All);

/// What intrusion_functional() changes by when the level set at each place
/// changes by `rate`, the mesh held. Throws likewise.
double intrusion_rate(const TetMesh& mesh, const loads::NumberOfPlace& level,
                      const loads::NumberOfPlace& rate, double sharpness);

}  // namespace meniscus::functionals
