#include "pipeline/forward/forward_model.h"

#include <algorithm>

#include <fmt/format.h>

#include "core/timer.h"
#include "fea/distributed/petsc_child.h"
#include "mesh_tet/quadratic.h"
#include "pipeline/case_data/film_options.h"
#include "pipeline/case_data/film_start.h"
#include "pipeline/forward/forward_model_impl.h"
#include "pipeline/forward/stage_meter.h"
#include "pipeline/forward/walls.h"

namespace meniscus::forward {

namespace {

// TetGen now and then leaves a flat element; another edge, and it does not.
constexpr std::array<double, 3> kEdgeFactors = {1.0, 1.1, 0.9};

const walls::ThickWall& first_with_findings(const walls::WallModel& walls) {
  return *std::find_if(
      walls.walls().begin(), walls.walls().end(),
      [](const walls::ThickWall& wall) { return !wall.findings.empty(); });
}

}  // namespace

bool ForwardModel::Impl::freeze_film(const case_data::EvaluatedCase& inputs,
                                     const ForwardModelOptions& options,
                                     Monitor& monitor) {
  const StageMeter meter;
  monitor.progress({.stage = "film", .detail = "settling the start"});
  film.emplace(case_data::freeze_films(
      input, inputs,
      {.edge = inputs.fea_edge * options.edge_factor,
       .refinements = case_data::film_refinements(input),
       .monitor = &monitor}));
  frozen.film = film->reference().report;
  frozen.failure = film->reference().failure;
  if (!frozen.failure && !inputs.walls.empty()) {
    monitor.progress({.stage = "film", .detail = "thickening the films"});
    walls.emplace(wall_model(inputs, *film, film->reference().points));
    frozen.failure = wall_failure(inputs, *walls);
    if (frozen.failure) {
      const walls::ThickWall& wall = first_with_findings(*walls);
      unfilled = wall.surface;
      findings = wall.findings;
    }
  }
  meter.add_to(frozen.seconds.film, frozen.operations.film);
  return !frozen.failure;
}

QuadraticSurface ForwardModel::Impl::surface(
    const case_data::EvaluatedCase& inputs, const Points& film_points) const {
  return walls ? walls->surface(film_points, walls->thickness(inputs.walls))
               : film->surface(film_points);
}

bool ForwardModel::Impl::freeze_mesh(
    const case_data::EvaluatedCase& inputs,
    const mesh_tet::TetrahedralizeOptions& options, Monitor& monitor) {
  const StageMeter meter;
  monitor.progress({.stage = "mesh", .detail = "filling the surface"});
  const QuadraticSurface surface =
      this->surface(inputs, film->reference().points);
  mesh_tet::Tetrahedralization filled =
      mesh_tet::tetrahedralize(surface.base, options);
  if (filled.failure) {
    frozen.failure = filled.failure;
    unfilled = surface.base;
    findings = std::move(filled.findings);
  } else {
    motion.emplace(filled.mesh, static_cast<int>(surface.base.points.size()));
    curve_edge.clear();
    base_mesh = mesh_tet::make_quadratic(filled.mesh, surface, &curve_edge);
    frozen.tet = figures_of(base_mesh, filled.quality);
  }
  meter.add_to(frozen.seconds.mesh, frozen.operations.mesh);
  return !frozen.failure;
}

bool ForwardModel::Impl::freeze_elasticity(
    const case_data::EvaluatedCase& inputs, Monitor& monitor) {
  const StageMeter meter;
  monitor.progress({.stage = "fea",
                    .detail = fmt::format("{} ten-node tetrahedra",
                                          base_mesh.element_count())});
  try {
    elasticity.emplace(
        base_mesh, inputs.materials, inputs.load_cases,
        equations::ElasticOptions{.solver = input.analysis.solver,
                                  .processes = input.analysis.processes,
                                  .monitor = &monitor});
    frozen.fea = elasticity->base_solution().report;
    frozen.failure = elasticity->base_solution().failure;
  } catch (const SolverError& error) {
    frozen.failure = Failure{FailureKind::SolverFailed, error.what()};
  } catch (const MeshError& error) {
    frozen.failure = Failure{FailureKind::ElementsInverted, error.what()};
  }
  meter.add_to(frozen.seconds.fea, frozen.operations.fea);
  return !frozen.failure;
}

bool ForwardModel::Impl::freeze_pairs() {
  try {
    pairs = thickness_pairs_of(input, base_mesh);
  } catch (const InvalidInput& error) {  // a solid that is thin nowhere
    frozen.failure = Failure{FailureKind::NotANumber, error.what()};
  }
  return !frozen.failure;
}

VectorX ForwardModel::Impl::responses(
    const case_data::EvaluatedCase& inputs, const settle::FilmState& film_state,
    const TetMesh& mesh, const equations::ElasticSolution& solution) const {
  return respond(input, {inputs, mesh, solution, exclusion.element, &*film,
                         &film_state, &pairs, &scans});
}

AdaptedState ForwardModel::Impl::state(
    const case_data::EvaluatedCase& inputs) const {
  EvaluationFields fields;
  fields.mesh = base_mesh;
  fields.inputs = inputs;
  fields.solution = elasticity->base_solution();
  fields.stresses = part_stresses(fields.mesh, inputs, fields.solution);
  fields.exclusion = exclusion;
  const VectorX values =
      responses(inputs, film->reference(), fields.mesh, fields.solution);
  return {
      .tet = frozen.tet,
      .dofs = frozen.fea.dofs,
      .responses = values,
      .errors = estimate_element_errors(input, fields, values, *elasticity)};
}

/// A finer mesh where the first one errs, and the elasticity on it.
bool ForwardModel::Impl::adapt(const case_data::EvaluatedCase& inputs,
                               Monitor& monitor) {
  const Timer timer;
  monitor.progress({.stage = "adapt", .detail = "errors of the first mesh"});
  Adaptation round{.before = state(inputs), .after = {}};
  frozen.seconds.fea += timer.seconds();
  if (round.before.errors.failure) {
    frozen.failure = round.before.errors.failure;
    return false;
  }
  const RefinementPlan plan =
      plan_refinement(base_mesh, round.before.errors.share);
  const double edge =
      mean_edge_length(surface(inputs, film->reference().points).base);
  if (walls) {
    walls->split_facets(plan.split);
  } else {
    film->split_facets(plan.split);
  }
  for (const double factor : kEdgeFactors) {
    frozen.failure.reset();
    if (freeze_mesh(inputs,
                    {.edge = factor * edge,
                     .size = plan.size,
                     .radius_edge_ratio = kGradedRadiusEdge,
                     .min_dihedral_deg = kGradedDihedral,
                     .monitor = &monitor},
                    monitor)) {
      break;
    }
  }
  if (frozen.failure) {
    frozen.failure->message =
        "the adapted mesh (analysis.adapt): " + frozen.failure->message;
    return false;
  }
  exclusion = choose_exclusion(input, base_mesh, EmptyZones::Allowed);
  if (!freeze_pairs() || !freeze_elasticity(inputs, monitor)) {
    return false;
  }
  const Timer after_timer;
  round.after = state(inputs);
  frozen.seconds.fea += after_timer.seconds();
  frozen.failure = round.after.errors.failure;
  adaptation = std::move(round);
  return !frozen.failure;
}

void ForwardModel::Impl::freeze(const ForwardModelOptions& options) {
  Monitor& monitor =
      options.monitor != nullptr ? *options.monitor : silent_monitor();
  frozen.design = case_data::initial_design(input);
  const case_data::EvaluatedCase inputs =
      meniscus::case_data::evaluate(input, frozen.design);
  if (!freeze_film(inputs, options, monitor) ||
      !freeze_mesh(inputs, {.monitor = &monitor}, monitor)) {
    return;
  }
  exclusion = choose_exclusion(
      input, base_mesh,
      options.edge_factor > 1.0 ? EmptyZones::Allowed : EmptyZones::Refused);
  if (freeze_pairs() && freeze_elasticity(inputs, monitor) &&
      input.analysis.adapt) {
    adapt(inputs, monitor);
  }
}

void require_solver(const case_data::Case& input) {
  if (input.analysis.solver == equations::SolverKind::Distributed) {
    distributed::require_petsc();
  }
}

ForwardModel::ForwardModel(const case_data::Case& input,
                           const ForwardModelOptions& options)
    : impl_(std::make_unique<Impl>()) {
  refuse_walls(input);
  require_solver(input);
  impl_->input = input;
  impl_->scans = read_scans(input);
  impl_->watcher = options.monitor;
  impl_->freeze(options);
}

ForwardModel::~ForwardModel() = default;
ForwardModel::ForwardModel(ForwardModel&&) noexcept = default;
ForwardModel& ForwardModel::operator=(ForwardModel&&) noexcept = default;

const SurfaceMesh& ForwardModel::unfilled_surface() const {
  return impl_->unfilled;
}

const std::vector<Finding>& ForwardModel::findings() const {
  return impl_->findings;
}

const std::optional<Failure>& ForwardModel::failure() const {
  return impl_->frozen.failure;
}

const Evaluation& ForwardModel::frozen() const { return impl_->frozen; }

const frozen::FilmModel& ForwardModel::film() const { return *impl_->film; }

const walls::WallModel* ForwardModel::walls() const {
  return impl_->walls ? &*impl_->walls : nullptr;
}

QuadraticSurface ForwardModel::surface(const case_data::EvaluatedCase& inputs,
                                       const Points& film_points) const {
  return impl_->surface(inputs, film_points);
}

SurfaceMesh ForwardModel::boundary(const case_data::EvaluatedCase& inputs,
                                   const Points& film_points) const {
  const auto& walls = impl_->walls;
  return walls ? walls->fine(film_points, walls->thickness(inputs.walls))
               : impl_->film->boundary(film_points);
}

const Scans& ForwardModel::scans() const { return impl_->scans; }

const elastic::ElasticModel& ForwardModel::elasticity() const {
  return *impl_->elasticity;
}

const Adaptation* ForwardModel::adaptation() const {
  return impl_->adaptation ? &*impl_->adaptation : nullptr;
}

}  // namespace meniscus::forward
