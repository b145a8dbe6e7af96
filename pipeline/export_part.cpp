#include "pipeline/export_part.h"

#include <fmt/format.h>

#include "fea/body_loads.h"
#include "io/stl.h"
#include "pipeline/calculix_export.h"
#include "pipeline/export_step.h"
#include "pipeline/responses.h"
#include "pipeline/results.h"
#include "pipeline/stored_case.h"

namespace meniscus {

namespace {

namespace fs = std::filesystem;

/// The case of the study with its resolution changed to `edge`.
Case at_edge(Case input, std::optional<double> edge) {
  if (edge) {
    input.resolution.fea = *edge;
    input.resolution.film = *edge / std::exp2(input.resolution.refinements);
  }
  return input;
}

std::string extension(const ExportOptions& options) {
  return options.format == "step-faceted" ? "step" : options.format;
}

}  // namespace

fs::path export_part(const fs::path& folder, const ExportOptions& options) {
  const StudyStore store = StudyStore::read(folder.string());
  const Case input = at_edge(restore_case(store.meta()), options.edge);
  const std::vector<EvaluationRecord> records = store.all();
  const VectorX design = answer_of_run(input, records, folder);
  // A STEP file's faces are as true as the film behind them.
  const bool step =
      options.format == "step" || options.format == "step-faceted";
  const double edge = options.edge.value_or(step ? input.resolution.film
                                                 : input.resolution.fea);
  fs::path file =
      options.out.empty()
          ? folder / fmt::format("part_{:g}.{}", edge, extension(options))
          : options.out;
  if (options.format == "stl") {
    const EvaluatedCase numbers = evaluate(input, design);
    write_stl(file, settle_again(numbers.film_system, edge),
              {.name = input.title, .unit = input.units.length});
    return file;
  }
  if (step) {
    const EvaluatedCase numbers = evaluate(input, design);
    export_step(file, numbers.film_system,
                {.title = input.title,
                 .unit = input.units.length,
                 .edge = edge,
                 .faceted = options.format == "step-faceted",
                 .monitor = options.monitor});
    return file;
  }
  const ForwardModel model(input, {.monitor = options.monitor});
  EvaluationFields fields;
  const Evaluation evaluation =
      model.failure() ? model.frozen() : model.evaluate(design, &fields);
  if (evaluation.failure) {
    throw MeshError(fmt::format("no part at edge {:g}: {}", edge,
                                evaluation.failure->message));
  }
  if (options.format == "inp") {
    CalculixDeck deck = calculix_deck_of(input, fields.inputs, fields.mesh);
    deck.comments.insert(deck.comments.begin(),
                         "Meniscus " + options.program_version);
    for (std::size_t k = 0; k < input.design.size(); ++k) {
      deck.comments.push_back(
          fmt::format("{} = {}", input.design[k].name,
                      design[static_cast<Eigen::Index>(k)]));
    }
    write_calculix_inp(file, fields.mesh, deck);
  } else if (options.format == "vtu") {
    fields.stresses =
        part_stresses(fields.mesh, fields.inputs, fields.solution);
    write_part(file, input, fields);
  } else {
    throw InvalidInput(fmt::format(
        "format '{}' is not known; there are stl, step, step-faceted, inp, vtu",
        options.format));
  }
  return file;
}

}  // namespace meniscus
