#include "pipeline/decks/compared_deck.h"

#include <algorithm>
#include <vector>

#include <fmt/format.h>

#include "core/error.h"
#include "fea/elastic/elasticity.h"
#include "io/deck/deck_cards.h"
#include "pipeline/results/imported_part.h"

namespace meniscus::decks {

namespace {

/// Names that are the run's but for case and blanks become the run's.
void use_names(const std::vector<std::string>& of_run,
               const std::vector<std::string*>& of_deck) {
  for (std::string* name : of_deck) {
    const auto same =
        std::find_if(of_run.begin(), of_run.end(), [&](const auto& other) {
          return deck::deck_word(other) == deck::deck_word(*name);
        });
    if (same != of_run.end()) {
      *name = *same;
    }
  }
}

void name_load_cases(const std::vector<loads::LoadCase>& of_run,
                     std::vector<loads::LoadCase>& of_deck) {
  std::vector<std::string> names;
  names.reserve(of_run.size());
  for (const loads::LoadCase& load_case : of_run) {
    names.push_back(load_case.name);
  }
  std::vector<std::string*> own;
  own.reserve(of_deck.size());
  for (loads::LoadCase& load_case : of_deck) {
    own.push_back(&load_case.name);
  }
  use_names(names, own);
  const bool any =
      std::any_of(own.begin(), own.end(), [&](const std::string* name) {
        return std::find(names.begin(), names.end(), *name) != names.end();
      });
  for (std::size_t k = 0; !any && own.size() == names.size() && k < own.size();
       ++k) {
    *own[k] = names[k];
  }
}

}  // namespace

results::PartFigures compared_deck_figures(DeckPart part,
                                           const std::string& path,
                                           const results::RunPart& run,
                                           Monitor* monitor,
                                           forward::EvaluationFields* kept) {
  forward::EvaluationFields fields;
  fields.mesh = std::move(part.deck.mesh);
  results::require_like_size(fields.mesh.nodes, run.fields.mesh.nodes, path,
                             run.input.units.length);
  fields.inputs.materials = std::move(part.materials);
  for (std::size_t s = 0; s < part.deck.steps.size(); ++s) {
    if (part.deck.steps[s].procedure == deck::DeckProcedure::Static) {
      fields.inputs.load_cases.push_back(std::move(part.load_cases[s]));
    }
  }
  if (fields.inputs.load_cases.empty()) {
    throw InvalidInput(fmt::format(
        "{}: the deck has no static step, and there is nothing to compare",
        path));
  }
  name_load_cases(run.fields.inputs.load_cases, fields.inputs.load_cases);
  std::vector<std::string*> labels;
  labels.reserve(fields.mesh.labels.size());
  for (std::string& label : fields.mesh.labels) {
    labels.push_back(&label);
  }
  use_names(run.fields.mesh.labels, labels);
  fields.exclusion = forward::choose_exclusion(run.input, fields.mesh,
                                               forward::EmptyZones::Allowed);
  const elastic::ElasticModel model(fields.mesh, fields.inputs.materials,
                                    fields.inputs.load_cases,
                                    {.solver = run.input.analysis.solver,
                                     .processes = run.input.analysis.processes,
                                     .monitor = monitor});
  fields.solution = model.base_solution();
  if (fields.solution.failure) {
    throw SolverError(path + ": " + fields.solution.failure->message);
  }
  results::PartFigures figures = results::part_figures(path, fields);
  if (kept != nullptr) {
    *kept = std::move(fields);
  }
  return figures;
}

case_data::Case case_for_fields(case_data::Case input,
                                const forward::EvaluationFields& fields) {
  input.load_cases.clear();
  for (const loads::LoadCase& load_case : fields.inputs.load_cases) {
    input.load_cases.emplace_back().name = load_case.name;
  }
  return input;
}

}  // namespace meniscus::decks
