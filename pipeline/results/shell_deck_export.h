/// An evaluated design's shell as a deck for another solver.
#pragma once

#include "io/shell_deck/shell_deck.h"
#include "pipeline/case_data/case.h"
#include "pipeline/shells/shell_part.h"

namespace meniscus::results {

/// Sections are the shells of the case, sets its films and rims, steps its load
/// cases. Pressures, gravity and spin stay what they are; what acts on films
/// and rims becomes forces at nodes. Its comments: title and units.
shell_deck::ShellDeck shell_deck_of(const case_data::Case& input,
                                    const case_data::EvaluatedCase& inputs,
                                    const shells::ShellPart& part);

}  // namespace meniscus::results
