#include "pipeline/forward/design_stages.h"

#include <cmath>

#include <fmt/format.h>

#include "mesh_tet/motion_check.h"
#include "mesh_tet/quadratic.h"
#include "pipeline/forward/forward_model_impl.h"
#include "pipeline/forward/stage_meter.h"
#include "pipeline/forward/walls.h"

namespace meniscus::forward {

namespace {

Failure not_a_number(const case_data::Case& input, const VectorX& responses) {
  Eigen::Index worst = 0;
  while (std::isfinite(responses[worst])) {
    ++worst;
  }
  return {FailureKind::NotANumber,
          fmt::format("response '{}' is {}",
                      input.responses[static_cast<std::size_t>(worst)].name,
                      responses[worst])};
}

}  // namespace

TetFigures figures_of(const TetMesh& mesh,
                      const mesh_tet::TetQuality& quality) {
  return {.nodes = static_cast<int>(mesh.nodes.size()),
          .elements = mesh.element_count(),
          .min_dihedral_deg = quality.min_dihedral_deg,
          .max_dihedral_deg = quality.max_dihedral_deg};
}

/// From a gradient by all nodes of the mesh to that by the film's vertices and
/// the walls' thickness.
SurfaceGradient ForwardModel::Impl::to_film(
    const case_data::EvaluatedCase& inputs, const Points& film_points,
    const TetMesh& mesh, const Points& by_nodes) const {
  const mesh_tet::QuadraticGradient by =
      mesh_tet::transpose_quadratic(mesh, by_nodes, curve_edge);
  const Points by_corners = motion->transpose(by.corners);
  if (!walls) {
    return {film->transpose_surface(by_corners, by.mid), VectorX()};
  }
  walls::WallGradient gradient = walls->transpose(
      film_points, walls->thickness(inputs.walls), by_corners, by.mid);
  return {std::move(gradient.film), std::move(gradient.thickness)};
}

DesignStages::DesignStages(const ForwardModel& model) : model_(model) {}

bool DesignStages::settle(const VectorX& design, StagedDesign& staged) const {
  return settle_on(*model_.impl_, design, staged);
}

bool DesignStages::place_mesh(StagedDesign& staged) const {
  return place_on(*model_.impl_, staged);
}

bool DesignStages::mesh_of(const case_data::Case& input, const VectorX& design,
                           Monitor* monitor, StagedDesign& staged) {
  if (input.analysis.adapt) {
    const ForwardModel model(input, {.monitor = monitor});
    const DesignStages stages(model);
    staged.evaluation.failure = model.failure();
    return !model.failure() && stages.settle(design, staged) &&
           stages.place_mesh(staged);
  }
  refuse_walls(input);
  ForwardModel::Impl model;
  model.input = input;
  model.watcher = monitor;
  Monitor& told = monitor != nullptr ? *monitor : silent_monitor();
  const case_data::EvaluatedCase inputs =
      meniscus::case_data::evaluate(input, case_data::initial_design(input));
  if (!model.freeze_film(inputs, {.monitor = monitor}, told) ||
      !model.freeze_mesh(inputs, {.monitor = &told}, told)) {
    staged.evaluation.failure = model.frozen.failure;
    return false;
  }
  return settle_on(model, design, staged) && place_on(model, staged);
}

bool DesignStages::settle_on(const ForwardModel::Impl& model,
                             const VectorX& design, StagedDesign& staged) {
  Evaluation& result = staged.evaluation;
  result.design = design;
  try {
    staged.fields.inputs = meniscus::case_data::evaluate(model.input, design);
  } catch (const InvalidInput& error) {
    // Numbers that hold at the ends of the bounds may fail between them.
    result.failure = Failure{FailureKind::NotANumber, error.what()};
    return false;
  }
  const StageMeter meter;
  settle::FilmState& film = staged.adjoint.film;
  film = model.film->settle(staged.fields.inputs.film_system,
                            {.monitor = model.watcher});
  result.film = film.report;
  meter.add_to(result.seconds.film, result.operations.film);
  result.failure = film.failure;
  return !result.failure;
}

bool DesignStages::place_on(const ForwardModel::Impl& model,
                            StagedDesign& staged) {
  Evaluation& result = staged.evaluation;
  const StageMeter meter;
  QuadraticSurface& surface = staged.fields.surface;
  try {
    surface = model.surface(staged.fields.inputs, staged.adjoint.film.points);
  } catch (const InvalidInput& error) {  // a thickness that is not above 0
    result.failure = Failure{FailureKind::NotANumber, error.what()};
    return false;
  }
  TetMesh& mesh = staged.fields.mesh;
  mesh = model.base_mesh;
  mesh_tet::move_quadratic(mesh, model.motion->move(surface.base.points),
                           surface, model.curve_edge);
  mesh_tet::TetQuality quality;
  result.failure = mesh_tet::check_moved(mesh, {}, &quality);
  result.tet = figures_of(mesh, quality);
  meter.add_to(result.seconds.mesh, result.operations.mesh);
  return !result.failure;
}

bool DesignStages::solve(StagedDesign& staged, KeepStiffness keep) const {
  Evaluation& result = staged.evaluation;
  const StageMeter meter;
  equations::ElasticSolution& solution = staged.fields.solution;
  try {
    solution = model_.elasticity().solve(
        staged.fields.mesh, staged.fields.inputs.load_cases,
        staged.fields.inputs.materials,
        keep == KeepStiffness::Yes ? &staged.adjoint.elastic : nullptr);
  } catch (const InvalidInput& error) {
    // A load or support that this design's surface cannot take.
    result.failure = Failure{FailureKind::SolverFailed, error.what()};
    return false;
  }
  result.fea = solution.report;
  meter.add_to(result.seconds.fea, result.operations.fea);
  result.failure = solution.failure;
  return !result.failure;
}

bool DesignStages::respond(StagedDesign& staged) const {
  const ForwardModel::Impl& model = *model_.impl_;
  Evaluation& result = staged.evaluation;
  EvaluationFields& fields = staged.fields;
  try {
    result.responses = model.responses(fields.inputs, staged.adjoint.film,
                                       fields.mesh, fields.solution);
  } catch (const InvalidInput& error) {  // an expression of place
    result.failure = Failure{FailureKind::NotANumber, error.what()};
    return false;
  }
  if (!result.responses.allFinite()) {
    result.failure = not_a_number(model.input, result.responses);
    result.responses.resize(0);
    return false;
  }
  fields.exclusion = model.exclusion;
  fields.start_edge = model.film->start_edge();
  return true;
}

Evaluation ForwardModel::evaluate(const VectorX& design,
                                  EvaluationFields* fields,
                                  AdjointState* adjoint) const {
  if (adjoint != nullptr) {
    *adjoint = {};  // as large as a stiffness matrix: not two at a time
  }
  const DesignStages stages(*this);
  StagedDesign staged;
  const auto keep = adjoint != nullptr ? KeepStiffness::Yes : KeepStiffness::No;
  if (!stages.settle(design, staged) || !stages.place_mesh(staged) ||
      !stages.solve(staged, keep) || !stages.respond(staged)) {
    return std::move(staged.evaluation);
  }
  if (fields != nullptr) {
    const Points& points = staged.adjoint.film.points;
    staged.fields.film = impl_->film->fine_mesh(points);
    staged.fields.boundary = boundary(staged.fields.inputs, points);
    *fields = std::move(staged.fields);
  }
  if (adjoint != nullptr) {
    *adjoint = std::move(staged.adjoint);
  }
  return std::move(staged.evaluation);
}

DesignGradient ForwardModel::gradient(const Evaluation& evaluation,
                                      const EvaluationFields& fields,
                                      const AdjointState& adjoint,
                                      const std::vector<int>& wanted) const {
  const ResponseInput responses{
      fields.inputs, fields.mesh,   fields.solution, fields.exclusion.element,
      &*impl_->film, &adjoint.film, &impl_->pairs,   &impl_->scans};
  try {
    return design_gradient({impl_->input, responses, evaluation.responses,
                            *impl_->elasticity, adjoint.elastic,
                            [&](const Points& by_nodes) {
                              return impl_->to_film(fields.inputs,
                                                    adjoint.film.points,
                                                    fields.mesh, by_nodes);
                            }},
                           wanted);
  } catch (const InvalidInput& error) {
    DesignGradient none;
    none.failure = Failure{FailureKind::NotANumber, error.what()};
    return none;
  }
}

}  // namespace meniscus::forward
