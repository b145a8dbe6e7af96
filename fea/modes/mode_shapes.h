/// What a mode's shape says: which of several it was in another design, and at
/// what stress a part buckles in it.
#pragma once

#include <functional>
#include <optional>
#include <vector>

#include "fea/modes/mode_works.h"

namespace meniscus::modes {

/// The one of `shapes`, modes of one eigenproblem, that is most like
/// `reference`, a shape on the same nodes, and more than half of it: by the
/// share (x^T M r)^2 / (x^T M x  r^T M r), the modal assurance criterion (R. J.
/// Allemang, The modal assurance criterion: twenty years of use and abuse,
/// Sound and Vibration 37, 2003) in the inner product of M, in which modes of
/// vibration are orthogonal: their shares sum up to 1. Not in that of K: what a
/// bent shape lacks in a thicker part is stiff. `density`: one per region, that
/// of M. Nothing where none is. Throws as mass_times().
std::optional<std::size_t> same_mode(const TetMesh& mesh,
                                     const std::vector<double>& density,
                                     const std::vector<VectorX>& shapes,
                                     const VectorX& reference);

/// The same with a product by M of any kind.
std::optional<std::size_t> same_mode(
    const std::function<VectorX(const VectorX& x)>& mass_times,
    const std::vector<VectorX>& shapes, const VectorX& reference);

/// Of the load case's own stresses, not yet times the factor: means over the
/// places where they push the mode on, weighted by the work they do there, the
/// positive part of -sigma : (grad x^T grad x). Of a slender column that is the
/// stress of its section; of a mode beside a singular edge that of the edge.
struct ModeStress {
  double von_mises = 0.0;  // [pressure]
  double strain = 0.0;     // norm of the elastic strain
  /// Von Mises stress over the yield strength of its material; not a number
  /// where a material that takes part has none.
  double of_yield = 0.0;
  Vec3 position = Vec3::Zero();  // the mean place [length]
};

/// Throws as geometric_work() without derivatives.
ModeStress mode_stress(const TetMesh& mesh,
                       const std::vector<element::Material>& materials,
                       const loads::LoadCase& load_case, const VectorX& u,
                       const VectorX& x);

}  // namespace meniscus::modes
