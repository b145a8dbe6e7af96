/// An evaluated design as a CalculiX deck.
#pragma once

#include <string>

#include "io/calculix_inp.h"
#include "pipeline/forward_model.h"

namespace meniscus {

/// The deck of fields.mesh: materials, one step per load case with its
/// supports; forces as nodal loads (CalculiX has no surface load along a given
/// direction), pressures as CalculiX's own *DLOAD.
CalculixDeck calculix_deck_of(const Case& input, const EvaluatedCase& numbers,
                              const TetMesh& mesh);

}  // namespace meniscus
