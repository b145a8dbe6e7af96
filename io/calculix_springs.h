/// A deck's springs as deck text (internal to the deck writer).
#pragma once

#include <string>

#include "io/calculix_inp.h"

namespace meniscus::io {

/// Nodes, elements, stiffnesses and equations. Springs' nodes and elements are
/// numbered after the mesh's. The springs went through check_deck().
std::string springs_text(const TetMesh& mesh,
                         const std::vector<DeckSprings>& springs);

/// The lines of *BOUNDARY that let the step's springs act and no others.
std::string springs_boundary_text(const std::vector<DeckSprings>& springs,
                                  std::size_t step);

}  // namespace meniscus::io
