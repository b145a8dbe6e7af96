/// A deck's rigid pins as deck text (internal to the deck writer).
#pragma once

#include <string>

#include "io/calculix_inp.h"

namespace meniscus::io {

/// Two nodes a pin, with numbers after those of the mesh and its springs, and
/// an equation for each component of each of its nodes. Components 1 to 3 of
/// the first are the pin's translations along its axes, of the second its
/// rotations. The pins went through check_deck().
std::string pins_text(const TetMesh& mesh, const CalculixDeck& deck);

/// The lines of *BOUNDARY that hold pins in a step.
std::string pins_boundary_text(const TetMesh& mesh, const CalculixDeck& deck,
                               const DeckStep& step);

}  // namespace meniscus::io
