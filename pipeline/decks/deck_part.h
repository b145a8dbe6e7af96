/// A deck of CalculiX or Abaqus as the stages take it.
#pragma once

#include <filesystem>
#include <vector>

#include "fea/element/material.h"
#include "fea/loads/load_case.h"
#include "io/deck/deck_reader.h"

namespace meniscus::decks {

struct DeckPart {
  deck::ReadDeck deck;
  std::vector<element::Material> materials;  // one per region
  /// One per step, in their order: what holds it, and as nodal forces what
  /// loads it; of a step of frequencies what holds it alone.
  std::vector<loads::LoadCase> load_cases;
};

/// Whether the file's name ends in .inp.
bool is_deck(const std::filesystem::path& path);

/// Reads a deck and checks all that the solver will need. Throws IoError, and
/// InvalidInput with file and line: what the reader refuses, a material out of
/// its range, an element turned inside out, a step whose supports do not hold
/// the part or that has no load, gravity without density.
DeckPart read_deck_part(const std::filesystem::path& path);

/// The same of what was read already.
DeckPart make_deck_part(deck::ReadDeck deck);

}  // namespace meniscus::decks
