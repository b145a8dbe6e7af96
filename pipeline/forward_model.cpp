#include "pipeline/forward_model.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "core/timer.h"
#include "fea/petsc_child.h"
#include "mesh_tet/mesh_motion.h"
#include "mesh_tet/motion_check.h"
#include "mesh_tet/quadratic.h"
#include "mesh_tet/tet_quality.h"
#include "mesh_tet/tetrahedralize.h"
#include "pipeline/adaptation.h"
#include "pipeline/film_options.h"
#include "pipeline/responses.h"
#include "pipeline/walls.h"

namespace meniscus {

namespace {

// TetGen now and then leaves a flat element; another edge, and it does not.
constexpr std::array<double, 3> kEdgeFactors = {1.0, 1.1, 0.9};

TetFigures figures(const TetMesh& mesh, const TetQuality& quality) {
  return {.nodes = static_cast<int>(mesh.nodes.size()),
          .elements = mesh.element_count(),
          .min_dihedral_deg = quality.min_dihedral_deg,
          .max_dihedral_deg = quality.max_dihedral_deg};
}

Failure not_a_number(const Case& input, const VectorX& responses) {
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

struct ForwardModel::Impl {
  Case input;
  Evaluation frozen;
  SurfaceMesh unfilled;
  std::vector<Finding> findings;
  std::optional<FilmModel> film;
  TetMesh base_mesh;  // ten-node, at the initial design
  std::vector<char> curve_edge;
  std::optional<MeshMotion> motion;
  std::optional<ElasticModel> elasticity;
  Exclusion exclusion;
  ThicknessPairs pairs;
  std::optional<Adaptation> adaptation;
  Monitor* watcher = nullptr;  // of evaluations

  void freeze(const ForwardModelOptions& options);
  bool freeze_film(const EvaluatedCase& inputs,
                   const ForwardModelOptions& options, Monitor& monitor);
  bool freeze_mesh(const TetrahedralizeOptions& options, Monitor& monitor);
  bool freeze_elasticity(const EvaluatedCase& inputs, Monitor& monitor);
  bool freeze_pairs();
  bool adapt(const EvaluatedCase& inputs, Monitor& monitor);
  AdaptedState state(const EvaluatedCase& inputs) const;
  VectorX responses(const EvaluatedCase& inputs, const FilmState& film_state,
                    const TetMesh& mesh, const ElasticSolution& solution) const;
  Points to_film(const TetMesh& mesh, const Points& by_nodes) const;
  bool place_nodes(const QuadraticSurface& surface, TetMesh& mesh,
                   Evaluation& result) const;
  bool solve(const TetMesh& mesh, const EvaluatedCase& inputs,
             ElasticSolution& solution, ElasticState* keep,
             Evaluation& result) const;
};

bool ForwardModel::Impl::freeze_film(const EvaluatedCase& inputs,
                                     const ForwardModelOptions& options,
                                     Monitor& monitor) {
  const Timer timer;
  monitor.progress({.stage = "film", .detail = "settling the start"});
  film.emplace(FilmModel::freeze(inputs.film_system,
                                 {.edge = inputs.fea_edge * options.edge_factor,
                                  .refinements = film_refinements(input),
                                  .monitor = &monitor}));
  frozen.film = film->reference().report;
  frozen.failure = film->reference().failure;
  frozen.seconds.film = timer.seconds();
  return !frozen.failure;
}

bool ForwardModel::Impl::freeze_mesh(const TetrahedralizeOptions& options,
                                     Monitor& monitor) {
  const Timer timer;
  monitor.progress({.stage = "mesh", .detail = "filling the surface"});
  const QuadraticSurface surface = film->surface(film->reference().points);
  Tetrahedralization filled = tetrahedralize(surface.base, options);
  if (filled.failure) {
    frozen.failure = filled.failure;
    unfilled = surface.base;
    findings = std::move(filled.findings);
  } else {
    motion.emplace(filled.mesh, static_cast<int>(surface.base.points.size()));
    curve_edge.clear();
    base_mesh = make_quadratic(filled.mesh, surface, &curve_edge);
    frozen.tet = figures(base_mesh, filled.quality);
  }
  frozen.seconds.mesh += timer.seconds();
  return !frozen.failure;
}

bool ForwardModel::Impl::freeze_elasticity(const EvaluatedCase& inputs,
                                           Monitor& monitor) {
  const Timer timer;
  monitor.progress({.stage = "fea",
                    .detail = fmt::format("{} ten-node tetrahedra",
                                          base_mesh.element_count())});
  try {
    elasticity.emplace(base_mesh, inputs.materials, inputs.load_cases,
                       ElasticOptions{.solver = input.analysis.solver,
                                      .processes = input.analysis.processes,
                                      .monitor = &monitor});
    frozen.fea = elasticity->base_solution().report;
    frozen.failure = elasticity->base_solution().failure;
  } catch (const SolverError& error) {
    frozen.failure = Failure{FailureKind::SolverFailed, error.what()};
  } catch (const MeshError& error) {
    frozen.failure = Failure{FailureKind::ElementsInverted, error.what()};
  }
  frozen.seconds.fea += timer.seconds();
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

VectorX ForwardModel::Impl::responses(const EvaluatedCase& inputs,
                                      const FilmState& film_state,
                                      const TetMesh& mesh,
                                      const ElasticSolution& solution) const {
  return respond(input, {inputs, mesh, solution, exclusion.element, &*film,
                         &film_state, &pairs});
}

/// From a gradient by all nodes of the mesh to that by the film's vertices.
Points ForwardModel::Impl::to_film(const TetMesh& mesh,
                                   const Points& by_nodes) const {
  const QuadraticGradient by = transpose_quadratic(mesh, by_nodes, curve_edge);
  return film->transpose_surface(motion->transpose(by.corners), by.mid);
}

AdaptedState ForwardModel::Impl::state(const EvaluatedCase& inputs) const {
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
bool ForwardModel::Impl::adapt(const EvaluatedCase& inputs, Monitor& monitor) {
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
      mean_edge_length(film->surface(film->reference().points).base);
  film->split_facets(plan.split);
  for (const double factor : kEdgeFactors) {
    frozen.failure.reset();
    if (freeze_mesh({.edge = factor * edge,
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
  frozen.design = initial_design(input);
  const EvaluatedCase inputs = meniscus::evaluate(input, frozen.design);
  if (!freeze_film(inputs, options, monitor) ||
      !freeze_mesh({.monitor = &monitor}, monitor)) {
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

bool ForwardModel::Impl::place_nodes(const QuadraticSurface& surface,
                                     TetMesh& mesh, Evaluation& result) const {
  move_quadratic(mesh, motion->move(surface.base.points), surface, curve_edge);
  TetQuality quality;
  result.failure = check_moved(mesh, {}, &quality);
  result.tet = figures(mesh, quality);
  return !result.failure;
}

bool ForwardModel::Impl::solve(const TetMesh& mesh, const EvaluatedCase& inputs,
                               ElasticSolution& solution, ElasticState* keep,
                               Evaluation& result) const {
  const Timer timer;
  try {
    solution = elasticity->solve(mesh, inputs.load_cases, keep);
  } catch (const InvalidInput& error) {
    // A load or support that this design's surface cannot take.
    result.failure = Failure{FailureKind::SolverFailed, error.what()};
    return false;
  }
  result.fea = solution.report;
  result.seconds.fea = timer.seconds();
  result.failure = solution.failure;
  return !result.failure;
}

void require_solver(const Case& input) {
  if (input.analysis.solver == SolverKind::Distributed) {
    require_petsc();
  }
}

ForwardModel::ForwardModel(const Case& input,
                           const ForwardModelOptions& options)
    : impl_(std::make_unique<Impl>()) {
  refuse_walls(input);
  require_solver(input);
  impl_->input = input;
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

const ElasticModel& ForwardModel::elasticity() const {
  return *impl_->elasticity;
}

const Adaptation* ForwardModel::adaptation() const {
  return impl_->adaptation ? &*impl_->adaptation : nullptr;
}

Evaluation ForwardModel::evaluate(const VectorX& design,
                                  EvaluationFields* fields,
                                  AdjointState* adjoint) const {
  Evaluation result;
  result.design = design;
  EvaluatedCase inputs;
  try {
    inputs = meniscus::evaluate(impl_->input, design);
  } catch (const InvalidInput& error) {
    // Numbers that hold at the ends of the bounds may fail between them.
    result.failure = Failure{FailureKind::NotANumber, error.what()};
    return result;
  }

  Timer film_timer;
  FilmState film_state =
      impl_->film->settle(inputs.film_system, {.monitor = impl_->watcher});
  result.film = film_state.report;
  result.seconds.film = film_timer.seconds();
  if (film_state.failure) {
    result.failure = film_state.failure;
    return result;
  }

  Timer mesh_timer;
  const QuadraticSurface surface = impl_->film->surface(film_state.points);
  TetMesh mesh = impl_->base_mesh;
  const bool placed = impl_->place_nodes(surface, mesh, result);
  result.seconds.mesh = mesh_timer.seconds();
  if (!placed) {
    return result;
  }

  ElasticSolution solution;
  ElasticState* keep = adjoint != nullptr ? &adjoint->elastic : nullptr;
  if (!impl_->solve(mesh, inputs, solution, keep, result)) {
    return result;
  }
  try {
    result.responses = impl_->responses(inputs, film_state, mesh, solution);
  } catch (const InvalidInput& error) {  // an expression of place
    result.failure = Failure{FailureKind::NotANumber, error.what()};
    return result;
  }
  if (!result.responses.allFinite()) {
    result.failure = not_a_number(impl_->input, result.responses);
    result.responses.resize(0);
    return result;
  }
  if (fields != nullptr) {
    *fields = {.film = impl_->film->fine_mesh(film_state.points),
               .boundary = impl_->film->boundary(film_state.points),
               .surface = surface,
               .mesh = std::move(mesh),
               .solution = std::move(solution),
               .inputs = inputs,
               .exclusion = impl_->exclusion};
  }
  if (adjoint != nullptr) {
    adjoint->film = std::move(film_state);
  }
  return result;
}

DesignGradient ForwardModel::gradient(const Evaluation& evaluation,
                                      const EvaluationFields& fields,
                                      const AdjointState& adjoint,
                                      const std::vector<int>& wanted) const {
  const ResponseInput responses{
      fields.inputs, fields.mesh,   fields.solution, fields.exclusion.element,
      &*impl_->film, &adjoint.film, &impl_->pairs};
  try {
    return design_gradient({impl_->input, responses, evaluation.responses,
                            *impl_->elasticity, adjoint.elastic,
                            [&](const Points& by_nodes) {
                              return impl_->to_film(fields.mesh, by_nodes);
                            }},
                           wanted);
  } catch (const InvalidInput& error) {
    DesignGradient none;
    none.failure = Failure{FailureKind::NotANumber, error.what()};
    return none;
  }
}

}  // namespace meniscus
