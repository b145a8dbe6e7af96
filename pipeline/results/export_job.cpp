#include "pipeline/results/export_job.h"

#include <cmath>
#include <utility>

#include <fmt/format.h>

#include "core/error.h"
#include "pipeline/case_data/design_vectors.h"
#include "pipeline/case_films/film_options.h"
#include "pipeline/case_films/film_start.h"
#include "pipeline/forward/design_stages.h"
#include "pipeline/forward/fillets.h"
#include "pipeline/forward/walls.h"
#include "pipeline/forward/worst_cases.h"
#include "pipeline/shells/shell_body.h"
#include "pipeline/store/refreeze.h"
#include "pipeline/store/stored_case.h"
#include "pipeline/store/study_store.h"
#include "pipeline/whole/whole_part.h"

namespace meniscus::results {

namespace {

/// The case of the study with its resolution changed to `edge`.
case_data::Case at_edge(case_data::Case input, std::optional<double> edge) {
  if (edge) {
    input.resolution.fea = *edge;
    input.resolution.film = *edge / std::exp2(input.resolution.refinements);
  }
  return input;
}

}  // namespace

ExportJob::ExportJob(const std::filesystem::path& folder, Options options)
    : options_(std::move(options)) {
  const store::StudyStore store = store::StudyStore::read(folder.string());
  const std::vector<store::EvaluationRecord> records = store.all();
  case_data::Case input = store::restore_case(store.meta());
  design_ = store::answer_of_run(input, records, folder);
  input_ =
      at_edge(store::frozen_as_answered(std::move(input), records, design_),
              options_.edge);
  inputs_ = case_data::evaluate(input_, design_);
}

const SettledFilm& ExportJob::film() {
  if (film_) {
    return *film_;
  }
  const case_data::EvaluatedCase frozen =
      options_.edge
          ? inputs_
          : case_data::evaluate(input_, case_data::initial_design(input_));
  const frozen::FilmModelOptions options{
      .edge = options_.edge.value_or(frozen.fea_edge),
      .refinements = options_.edge ? 0 : case_films::film_refinements(input_),
      .monitor = options_.monitor};
  frozen::FilmModel model =
      options_.edge ? frozen::FilmModel::freeze(frozen.film_system, options)
                    : case_films::freeze_films(input_, frozen, options);
  settle::FilmState state = model.reference();
  if (!options_.edge && !state.failure) {
    state = model.settle(inputs_.film_system, {.monitor = options_.monitor});
  }
  if (state.failure) {
    throw MeshError(fmt::format("no film at edge {:g}: {}",
                                options_.edge.value_or(frozen.fea_edge),
                                state.failure->message));
  }
  film_.emplace(SettledFilm{std::move(model), std::move(state)});
  return *film_;
}

SurfaceMesh ExportJob::bodies_surface() {
  if (!input_.shells.empty()) {
    return shells::body_surface(shells::shell_body(*meshed().shell));
  }
  const SettledFilm& settled = film();
  const Points& points = settled.state.points;
  return whole::whole_surface(
      input_, inputs_.walls.empty()
                  ? settled.model.solids(forward::rounded_anew(
                        inputs_.film_system, settled.model, points))
                  : forward::boundary_of(inputs_, settled.model, points));
}

namespace {

MeshError no_part(const case_data::Case& input,
                  const std::optional<Failure>& failure) {
  return MeshError(fmt::format("no part at edge {:g}: {}", input.resolution.fea,
                               failure->message));
}

}  // namespace

const forward::EvaluationFields& ExportJob::meshed() {
  if (fields_ || meshed_) {
    return fields_ ? *fields_ : *meshed_;
  }
  forward::StagedDesign staged;
  if (!forward::mesh_design(input_, design_, options_.monitor, staged)) {
    throw no_part(input_, staged.evaluation.failure);
  }
  meshed_ = std::move(staged.fields);
  return *meshed_;
}

const forward::EvaluationFields& ExportJob::fields() {
  if (fields_) {
    return *fields_;
  }
  const forward::ForwardModel model(input_, {.monitor = options_.monitor});
  fields_.emplace();
  const forward::Evaluation evaluation =
      model.failure() ? model.frozen() : model.evaluate(design_, &*fields_);
  if (evaluation.failure) {
    throw no_part(input_, evaluation.failure);
  }
  forward::find_stresses(input_, *fields_);
  return *fields_;
}

io::FileNotes ExportJob::notes() const {
  io::FileNotes notes{.program = "Meniscus " + options_.program_version,
                      .title = input_.title,
                      .unit = input_.units.length,
                      .unit_system = input_.units.name,
                      .lines = {"case name: " + input_.name}};
  for (const case_data::DesignRow& row : case_data::design_rows(input_)) {
    const auto at = static_cast<Eigen::Index>(row.first);
    notes.lines.push_back(
        row.vector == nullptr
            ? fmt::format("{} = {}", row.name, design_[at])
            : fmt::format("{} = {}", row.label(),
                          case_data::row_text(input_, row, design_)));
  }
  return notes;
}

std::vector<std::string> ExportJob::body_names() {
  std::vector<std::string> names;
  if (!input_.shells.empty()) {
    return shells::body_names(*meshed().shell);
  }
  for (const case_data::BodyEntry& body : case_data::solid_bodies(input_)) {
    names.push_back(body.name);
  }
  return names;
}

}  // namespace meniscus::results
