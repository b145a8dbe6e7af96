#include "pipeline/export_part.h"

#include <fmt/format.h>

#include "fea/loads.h"
#include "io/stl.h"
#include "io/vtk_files.h"
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

}  // namespace

CalculixDeck calculix_deck_of(const Case& input, const EvaluationFields& fields,
                              const VectorX& design,
                              const std::string& program_version) {
  CalculixDeck deck;
  deck.comments = {"Meniscus " + program_version, "case: " + input.title,
                   "units: " + input.units.name};
  for (std::size_t k = 0; k < input.design.size(); ++k) {
    deck.comments.push_back(fmt::format("{} = {}", input.design[k].name,
                                        design[static_cast<Eigen::Index>(k)]));
  }
  for (const Material& m : fields.inputs.materials) {
    deck.materials.push_back({.name = m.name,
                              .youngs_modulus = m.youngs_modulus,
                              .poisson_ratio = m.poisson_ratio,
                              .density = m.density});
  }
  for (const LoadCase& load_case : fields.inputs.load_cases) {
    DeckStep step{.name = load_case.name};
    for (const Support& s : load_case.supports) {
      step.supports.push_back({.surface = s.surface,
                               .fix_x = s.fix_x,
                               .fix_y = s.fix_y,
                               .fix_z = s.fix_z});
    }
    // CalculiX has no surface load along a given direction; it has pressure,
    // which is written as such.
    LoadCase forces = load_case;
    forces.pressures.clear();
    step.nodal_forces = nodal_forces(fields.mesh, forces);
    for (const SurfacePressure& p : load_case.pressures) {
      step.pressures.push_back({p.surface, p.pressure});
    }
    deck.steps.push_back(std::move(step));
  }
  return deck;
}

fs::path export_part(const fs::path& folder, const ExportOptions& options) {
  const StudyStore store = StudyStore::read(folder.string());
  const Case input = at_edge(restore_case(store.meta()), options.edge);
  const std::vector<EvaluationRecord> records = store.all();
  const VectorX design = best_record(input, records).inputs;
  const double edge = options.edge.value_or(input.resolution.fea);
  const fs::path file =
      options.out.empty()
          ? folder / fmt::format("part_{:g}.{}", edge, options.format)
          : options.out;
  if (options.format == "stl") {
    const EvaluatedCase numbers = evaluate(input, design);
    write_stl(file, settle_again(numbers.film_system, edge),
              {.name = input.title, .unit = input.units.length});
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
    write_calculix_inp(
        file, fields.mesh,
        calculix_deck_of(input, fields, design, options.program_version));
  } else if (options.format == "vtu") {
    write_part(file, input, fields);
  } else {
    throw InvalidInput(fmt::format(
        "format '{}' is not known; there are stl, inp, vtu", options.format));
  }
  return file;
}

}  // namespace meniscus
