/// A conventional part with a deck of its own, beside a run's part.
#pragma once

#include <string>

#include "core/monitor.h"
#include "pipeline/decks/deck_part.h"
#include "pipeline/results/part_comparison.h"

namespace meniscus::decks {

/// The deck's part solved as the deck says: its mesh, materials, supports and
/// loads, all in the run's units, which a deck does not tell. Its static steps
/// stand beside the run's load cases of their names (case does not matter, as
/// nowhere in decks); where none has such a name and there are as many of both,
/// in their order; else by themselves. Surfaces of the run's names are known by
/// them, for zones of analysis.exclude. Throws InvalidInput (a part of another
/// order of size, a deck without a static step, a zone's surface that the deck
/// has not), SolverError. `kept` receives mesh and solution.
results::PartFigures compared_deck_figures(DeckPart part,
                                           const std::string& path,
                                           const results::RunPart& run,
                                           Monitor* monitor,
                                           forward::EvaluationFields* kept);

/// The run's case with the load cases that `fields` are of, for files.
case_data::Case case_for_fields(case_data::Case input,
                                const forward::EvaluationFields& fields);

}  // namespace meniscus::decks
