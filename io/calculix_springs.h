/// A deck's springs as deck text (internal to the deck writer).
#pragma once

#include <string>
#include <vector>

#include "io/calculix_inp.h"

namespace meniscus::io {

/// Nodes, elements, stiffnesses and equations. Springs' nodes and elements are
/// numbered after the mesh's. The springs went through check_deck().
std::string springs_text(const TetMesh& mesh,
                         const std::vector<DeckSprings>& springs);

/// The lines of *BOUNDARY that let the step's springs act and no others.
std::string springs_boundary_text(const std::vector<DeckSprings>& springs,
                                  std::size_t step);

/// One *EQUATION of terms "node, component, factor"; the first depends on the
/// others.
std::string equation_text(const std::vector<std::string>& terms);

/// Nodes that springs_text() numbers.
int spring_nodes(const std::vector<DeckSprings>& springs);

}  // namespace meniscus::io
