#include "pipeline/forward_model.h"

#include <fmt/format.h>

#include "core/timer.h"
#include "mesh_tet/mesh_motion.h"
#include "mesh_tet/motion_check.h"
#include "mesh_tet/quadratic.h"
#include "mesh_tet/tet_quality.h"
#include "mesh_tet/tetrahedralize.h"
#include "pipeline/responses.h"
#include "pipeline/walls.h"

namespace meniscus {

namespace {

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

  void freeze(const ForwardModelOptions& options);
  void freeze_mesh(const QuadraticSurface& surface, Monitor& monitor);
  bool place_nodes(const QuadraticSurface& surface, TetMesh& mesh,
                   Evaluation& result) const;
};

void ForwardModel::Impl::freeze_mesh(const QuadraticSurface& surface,
                                     Monitor& monitor) {
  Tetrahedralization filled =
      tetrahedralize(surface.base, {.monitor = &monitor});
  if (filled.failure) {
    frozen.failure = filled.failure;
    unfilled = surface.base;
    findings = std::move(filled.findings);
    return;
  }
  motion.emplace(filled.mesh, static_cast<int>(surface.base.points.size()));
  base_mesh = make_quadratic(filled.mesh, surface, &curve_edge);
  frozen.tet = figures(base_mesh, filled.quality);
}

void ForwardModel::Impl::freeze(const ForwardModelOptions& options) {
  Monitor& monitor =
      options.monitor != nullptr ? *options.monitor : silent_monitor();
  frozen.design = initial_design(input);
  const EvaluatedCase inputs = meniscus::evaluate(input, frozen.design);

  Timer film_timer;
  monitor.progress({.stage = "film", .detail = "settling the start"});
  film.emplace(FilmModel::freeze(inputs.film_system,
                                 {.edge = inputs.fea_edge * options.edge_factor,
                                  .refinements = input.resolution.refinements,
                                  .monitor = &monitor}));
  frozen.film = film->reference().report;
  frozen.seconds.film = film_timer.seconds();
  if (film->reference().failure) {
    frozen.failure = film->reference().failure;
    return;
  }

  Timer mesh_timer;
  monitor.progress({.stage = "mesh", .detail = "filling the surface"});
  freeze_mesh(film->surface(film->reference().points), monitor);
  frozen.seconds.mesh = mesh_timer.seconds();
  if (frozen.failure) {
    return;
  }

  Timer fea_timer;
  monitor.progress({.stage = "fea",
                    .detail = fmt::format("{} ten-node tetrahedra",
                                          base_mesh.element_count())});
  try {
    elasticity.emplace(base_mesh, inputs.materials, inputs.load_cases,
                       ElasticOptions{.monitor = &monitor});
    frozen.fea = elasticity->base_solution().report;
    frozen.failure = elasticity->base_solution().failure;
  } catch (const SolverError& error) {
    frozen.failure = Failure{FailureKind::SolverFailed, error.what()};
  } catch (const MeshError& error) {
    frozen.failure = Failure{FailureKind::ElementsInverted, error.what()};
  }
  frozen.seconds.fea = fea_timer.seconds();
}

bool ForwardModel::Impl::place_nodes(const QuadraticSurface& surface,
                                     TetMesh& mesh, Evaluation& result) const {
  move_quadratic(mesh, motion->move(surface.base.points), surface, curve_edge);
  TetQuality quality;
  result.failure = check_moved(mesh, {}, &quality);
  result.tet = figures(mesh, quality);
  return !result.failure;
}

ForwardModel::ForwardModel(const Case& input,
                           const ForwardModelOptions& options)
    : impl_(std::make_unique<Impl>()) {
  refuse_walls(input);
  impl_->input = input;
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

Evaluation ForwardModel::evaluate(const VectorX& design,
                                  EvaluationFields* fields) const {
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
  const FilmState film_state = impl_->film->settle(inputs.film_system);
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

  Timer fea_timer;
  ElasticSolution solution;
  try {
    solution = impl_->elasticity->solve(mesh, inputs.load_cases);
  } catch (const InvalidInput& error) {
    // A load or support that this design's surface cannot take.
    result.failure = Failure{FailureKind::SolverFailed, error.what()};
    return result;
  }
  result.fea = solution.report;
  result.seconds.fea = fea_timer.seconds();
  if (solution.failure) {
    result.failure = solution.failure;
    return result;
  }
  result.responses =
      respond(impl_->input, {inputs, film_state.report, mesh, solution});
  if (!result.responses.allFinite()) {
    result.failure = not_a_number(impl_->input, result.responses);
    result.responses.resize(0);
    return result;
  }
  if (fields != nullptr) {
    fields->film = impl_->film->fine_mesh(film_state.points);
    fields->surface = surface;
    fields->mesh = std::move(mesh);
    fields->solution = std::move(solution);
    fields->inputs = inputs;
  }
  return result;
}

}  // namespace meniscus
