/// `meniscus solve`: a deck's steps by our own solver, and what it writes.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include <nlohmann/json_fwd.hpp>

#include "core/monitor.h"
#include "core/units.h"
#include "fea/modes/buckling.h"
#include "fea/modes/modes.h"
#include "pipeline/decks/deck_part.h"
#include "pipeline/forward/forward_model.h"
#include "pipeline/forward/stress_figures.h"

namespace meniscus::decks {

struct DeckStepFigures {
  std::string name;
  deck::DeckProcedure procedure = deck::DeckProcedure::Static;
  /// Index into `load_cases`, displacements and stresses of the result; none of
  /// frequencies.
  std::optional<std::size_t> load_case;
  double largest_displacement = 0.0;  // of a node [length]
  int largest_node = 0;               // the deck's number
  Vec3 largest_position = Vec3::Zero();
  Vec3 load = Vec3::Zero();      // resultant [force]
  Vec3 reaction = Vec3::Zero();  // of all supports and springs [force]
  std::optional<modes::NaturalModes> frequencies;
  std::optional<modes::BucklingModes> buckling;
};

struct DeckResult {
  std::string title;  // heading, or the file's name
  /// Mesh, materials, load cases of the static and buckling steps, their
  /// solution and stresses, and all modes.
  forward::EvaluationFields fields;
  std::vector<DeckStepFigures> steps;
  std::vector<forward::StressFigures> stress;  // per load case
  std::vector<int> node_numbers, element_numbers;
  double volume = 0.0;         // [length^3]
  std::optional<double> mass;  // none where a material has no density
  std::vector<std::string> not_needed;
  double seconds = 0.0;
};

/// Solves all steps. Throws what ElasticModel throws, SolverError where a
/// solution does not converge, Interrupted.
DeckResult solve_deck(DeckPart part, Monitor* monitor);

/// What the deck's numbers are in; a deck does not say: without a system all
/// units are empty.
case_data::Case deck_case(const DeckResult& result,
                          const std::optional<UnitSystem>& units);

/// part.vtu, part_surface.vtp, part.frd and, last, result.json. Throws IoError.
void write_deck_result(const DeckResult& result,
                       const std::optional<UnitSystem>& units,
                       const std::string& program_version,
                       const std::filesystem::path& folder);

/// The result for people.
std::string deck_text(const DeckResult& result,
                      const std::optional<UnitSystem>& units);

}  // namespace meniscus::decks
