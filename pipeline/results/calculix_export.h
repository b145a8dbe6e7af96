/// An evaluated design as a CalculiX deck.
#pragma once

#include <string>
#include <vector>

#include "io/calculix_inp.h"
#include "pipeline/forward/forward_model.h"

namespace meniscus::results {

io::DeckMaterial deck_material_of(const element::Material& material);

/// The deck of a mesh: materials, one step per load case. Numbers that CalculiX
/// has a card for go there (*DLOAD pressure, gravity, spin; *TEMPERATURE),
/// other loads become nodal forces; oblique supports become equations, beds of
/// springs SPRING1 elements. Throws InvalidInput for load cases with different
/// oblique supports.
io::CalculixDeck calculix_deck_of(
    const std::vector<element::Material>& materials,
    const std::vector<loads::LoadCase>& load_cases, const TetMesh& mesh);

/// The same for a case, with its title and units.
io::CalculixDeck calculix_deck_of(const case_data::Case& input,
                                  const case_data::EvaluatedCase& inputs,
                                  const TetMesh& mesh);

}  // namespace meniscus::results
