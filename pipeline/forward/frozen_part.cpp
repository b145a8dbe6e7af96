#include "pipeline/forward/frozen_part.h"

#include <algorithm>
#include <array>
#include <functional>

#include <fmt/format.h>

#include "core/timer.h"
#include "evolve/energy/constrained_hessian.h"
#include "mesh_tet/quadratic.h"
#include "pipeline/case_films/film_advice.h"
#include "pipeline/case_films/film_options.h"
#include "pipeline/case_films/film_start.h"
#include "pipeline/forward/fillets.h"
#include "pipeline/forward/planes_kept.h"
#include "pipeline/forward/walls.h"
#include "pipeline/forward/work_estimate.h"

namespace meniscus::forward {

namespace {

// TetGen now and then leaves a flat element; another edge, and it does not.
constexpr std::array<double, 3> kEdgeFactors = {1.0, 1.1, 0.9};

// Rise of an edge's middle over its length, from which its facets are halved:
// that of an arc of 50 degrees.
constexpr double kTightRise = 0.11;

const walls::ThickWall& first_with_findings(const walls::WallModel& walls) {
  return *std::find_if(
      walls.walls().begin(), walls.walls().end(),
      [](const walls::ThickWall& wall) { return !wall.findings.empty(); });
}

/// Adds to the start's failure what was found to help; for models whose
/// failures are told.
void advise(const case_data::EvaluatedCase& inputs,
            const ForwardModelOptions& options, Monitor& monitor,
            FrozenPart& part) {
  if (!(options.edge_factor > 1.0)) {
    const StageMeter meter;
    Failure& failure = *part.start.failure;
    const std::string advice = case_films::tried_advice(
        part.input, inputs, failure,
        {.edge = inputs.fea_edge,
         .refinements = case_films::film_refinements(part.input),
         .findings = part.findings,
         .monitor = &monitor});
    failure.message += advice.empty() ? "" : "; " + advice;
    meter.add_to(part.start.seconds.film, part.start.operations.film);
  }
}

bool freeze_film(const case_data::EvaluatedCase& inputs,
                 const ForwardModelOptions& options, Monitor& monitor,
                 FrozenPart& part) {
  const StageMeter meter;
  Evaluation& start = part.start;
  const double edge = inputs.fea_edge * options.edge_factor;
  const WorkEstimate work = estimate_work(part.input, inputs, edge);
  monitor.progress({.stage = "film",
                    .detail = work.elements > 1.0
                                  ? "settling the start of " + text_of(work)
                                  : std::string("settling the start")});
  require_work(work, edge);
  part.film.emplace(case_films::freeze_films(
      part.input, inputs,
      {.edge = edge,
       .refinements = case_films::film_refinements(part.input),
       .monitor = &monitor}));
  const settle::FilmState& film = part.film->reference();
  start.film = film.report;
  start.failure = film.failure;
  if (!start.failure && !part.input.symmetry.empty()) {
    start.failure =
        beyond_planes(part.input, part.film->fine_mesh(film.points));
  }
  if (!start.failure) {
    part.fillets = fillet_model(part.input, inputs, *part.film, film.points,
                                start.failure);
  }
  if (!start.failure && !inputs.walls.empty()) {
    monitor.progress({.stage = "film", .detail = "thickening the films"});
    part.walls.emplace(wall_model(inputs, *part.film, film.points));
    start.failure = wall_failure(inputs, *part.walls);
    if (!start.failure) {
      start.failure =
          beyond_planes(part.input, part.surface(inputs, film.points).base);
    } else {
      const walls::ThickWall& wall = first_with_findings(*part.walls);
      part.unfilled = wall.surface;
      part.findings = wall.findings;
    }
  }
  meter.add_to(start.seconds.film, start.operations.film);
  return !start.failure;
}

/// Marks facets that span so much of the film's curvature that their elements
/// would fold at the next design.
std::vector<char> tight_facets(const case_data::EvaluatedCase& inputs,
                               const FrozenPart& part) {
  const QuadraticSurface surface =
      part.surface(inputs, part.film->reference().points);
  if (part.walls) {  // thin: their rims turn within one facet
    return std::vector<char>(surface.base.facets.size(), 0);
  }
  const Points& points = surface.base.points;
  std::vector<char> tight;
  tight.reserve(surface.facet_edges.size());
  for (std::size_t f = 0; f < surface.facet_edges.size(); ++f) {
    // Out of the facet: along it, middles may lie where they will.
    const Vec3 normal =
        area_vector2(surface.base, static_cast<int>(f)).normalized();
    const Triangle& edges = surface.facet_edges[f];
    tight.push_back(std::any_of(edges.begin(), edges.end(), [&](int i) {
      const auto [a, b] = surface.edges[i];
      const Vec3 rise = surface.mid[i] - 0.5 * (points[a] + points[b]);
      return std::abs(rise.dot(normal)) >
             kTightRise * (points[b] - points[a]).norm();
    }));
  }
  return tight;
}

void split_facets(const std::vector<char>& marked, FrozenPart& part) {
  if (std::find(marked.begin(), marked.end(), 1) == marked.end()) {
    return;
  }
  if (part.walls) {
    part.walls->split_facets(marked);
  } else {
    part.film->split_facets(marked);
  }
}

bool fill_surface(const case_data::EvaluatedCase& inputs,
                  mesh_tet::TetrahedralizeOptions options, Monitor& monitor,
                  FrozenPart& part) {
  const StageMeter meter;
  Evaluation& start = part.start;
  const QuadraticSurface surface =
      part.surface(inputs, part.film->reference().points);
  const double edge = options.edge.value_or(mean_edge_length(surface.base));
  const WorkEstimate work = estimate_work(enclosed_volume(surface.base),
                                          surface.base.facets.size(), edge);
  monitor.progress(
      {.stage = "mesh", .detail = "filling the surface, " + text_of(work)});
  require_work(work, edge);
  if (part.walls) {
    options.inside = part.walls->middles();
  }
  mesh_tet::Tetrahedralization filled =
      mesh_tet::tetrahedralize(surface.base, options);
  if (filled.failure && !options.inside.empty()) {
    options.inside.clear();  // one element across is better than none
    filled = mesh_tet::tetrahedralize(surface.base, options);
  }
  if (filled.failure) {
    start.failure = filled.failure;
    part.unfilled = surface.base;
    part.findings = std::move(filled.findings);
  } else {
    part.motion.emplace(filled.mesh,
                        static_cast<int>(surface.base.points.size()));
    part.curve_edge.clear();
    part.base_mesh =
        mesh_tet::make_quadratic(filled.mesh, surface, &part.curve_edge);
    start.tet = figures_of(part.base_mesh, filled.quality);
  }
  meter.add_to(start.seconds.mesh, start.operations.mesh);
  return !start.failure;
}

bool freeze_elasticity(const case_data::EvaluatedCase& inputs, Monitor& monitor,
                       FrozenPart& part) {
  const StageMeter meter;
  Evaluation& start = part.start;
  monitor.progress({.stage = "fea",
                    .detail = fmt::format("{} ten-node tetrahedra",
                                          part.base_mesh.element_count())});
  try {
    part.elasticity.emplace(
        part.base_mesh, inputs.materials, inputs.load_cases,
        equations::ElasticOptions{.solver = part.input.analysis.solver,
                                  .processes = part.input.analysis.processes,
                                  .monitor = &monitor});
    start.fea = part.elasticity->base_solution().report;
    start.failure = part.elasticity->base_solution().failure;
  } catch (const SolverError& error) {
    start.failure = Failure{FailureKind::SolverFailed, error.what()};
  } catch (const MeshError& error) {
    start.failure = Failure{FailureKind::ElementsInverted, error.what()};
  }
  meter.add_to(start.seconds.fea, start.operations.fea);
  return !start.failure;
}

/// Where the modes are counted that other designs' are followed from.
bool freeze_modes(const case_data::EvaluatedCase& inputs, Monitor& monitor,
                  FrozenPart& part) {
  const StageMeter meter;
  part.base_modes = responses::find_response_modes(
      {.input = part.input,
       .inputs = inputs,
       .mesh = part.base_mesh,
       .solution = part.elasticity->base_solution(),
       .model = &*part.elasticity,
       .monitor = &monitor});
  meter.add_to(part.start.seconds.fea, part.start.operations.fea);
  part.start.failure = part.base_modes.failure;
  return !part.start.failure;
}

/// Of shells likewise, whose equations nothing else freezes.
void freeze_shell_modes(const case_data::EvaluatedCase& inputs,
                        Monitor& monitor, FrozenPart& part) {
  if (!responses::asks_for_modes(part.input)) {
    return;
  }
  const StageMeter meter;
  const std::shared_ptr<shells::ShellPart> shell =
      part.shell_part(inputs, part.film->reference().points, {});
  const equations::ElasticSolution solution =
      shells::solve_shell(inputs, *shell, &monitor);
  part.start.failure = solution.failure;
  if (!part.start.failure) {
    part.base_modes = responses::find_response_modes({.input = part.input,
                                                      .inputs = inputs,
                                                      .mesh = shell->skin,
                                                      .solution = solution,
                                                      .shell = shell.get(),
                                                      .monitor = &monitor});
    part.start.failure = part.base_modes.failure;
  }
  meter.add_to(part.start.seconds.fea, part.start.operations.fea);
}

bool freeze_pairs(FrozenPart& part) {
  try {
    part.pairs = responses::thickness_pairs_of(part.input, part.base_mesh);
  } catch (const InvalidInput& error) {  // a solid that is thin nowhere
    part.start.failure = Failure{FailureKind::NotANumber, error.what()};
  }
  return !part.start.failure;
}

AdaptedState adapted_state(const case_data::EvaluatedCase& inputs,
                           const FrozenPart& part) {
  EvaluationFields fields;
  fields.mesh = part.base_mesh;
  fields.inputs = inputs;
  fields.solution = part.elasticity->base_solution();
  fields.stresses = part_stresses(fields.mesh, inputs, fields.solution);
  fields.exclusion = part.exclusion;
  const VectorX values = responses::respond(
      part.input, part.context(inputs, part.film->reference(), fields.mesh,
                               fields.solution, part.base_modes));
  return {.tet = part.start.tet,
          .dofs = part.start.fea.dofs,
          .responses = values,
          .errors = estimate_element_errors(part.input, fields, values,
                                            *part.elasticity)};
}

/// Facets and elements anew as `plan` says.
bool refine_mesh(const case_data::EvaluatedCase& inputs,
                 const RefinementPlan& plan, Monitor& monitor,
                 FrozenPart& part) {
  const double edge = mean_edge_length(
      part.surface(inputs, part.film->reference().points).base);
  std::vector<char> split = tight_facets(inputs, part);
  std::transform(split.begin(), split.end(), plan.split.begin(), split.begin(),
                 std::bit_or<char>());
  split_facets(split, part);
  std::optional<Failure>& failure = part.start.failure;
  for (const double factor : kEdgeFactors) {
    failure.reset();
    if (fill_surface(inputs,
                     {.edge = factor * edge,
                      .size = plan.size,
                      .radius_edge_ratio = kGradedRadiusEdge,
                      .min_dihedral_deg = kGradedDihedral,
                      .monitor = &monitor},
                     monitor, part)) {
      return true;
    }
  }
  failure->message = "the adapted mesh (analysis.adapt): " + failure->message;
  return false;
}

/// A finer mesh where the first one errs, and the elasticity on it.
void adapt(const case_data::EvaluatedCase& inputs, Monitor& monitor,
           FrozenPart& part) {
  const Timer timer;
  Evaluation& start = part.start;
  monitor.progress({.stage = "adapt", .detail = "errors of the first mesh"});
  Adaptation round{.before = adapted_state(inputs, part), .after = {}};
  start.seconds.fea += timer.seconds();
  start.failure = round.before.errors.failure;
  if (start.failure ||
      !refine_mesh(inputs,
                   plan_refinement(part.base_mesh, round.before.errors.share),
                   monitor, part)) {
    return;
  }
  part.exclusion =
      choose_exclusion(part.input, part.base_mesh, EmptyZones::Allowed);
  if (!freeze_pairs(part) || !freeze_elasticity(inputs, monitor, part) ||
      !freeze_modes(inputs, monitor, part)) {
    return;
  }
  const Timer after_timer;
  round.after = adapted_state(inputs, part);
  start.seconds.fea += after_timer.seconds();
  start.failure = round.after.errors.failure;
  part.adaptation = std::move(round);
}

/// All that is frozen of them are their facets on the film.
void freeze_shells(const case_data::EvaluatedCase& inputs, FrozenPart& part) {
  const StageMeter meter;
  part.shells.emplace(part.input, inputs, *part.film);
  const QuadraticSurface surface =
      part.shells->surface(part.film->reference().points);
  part.start.tet = figures_of(surface);
  require_shell_work(surface.base.facets.size(), inputs.fea_edge,
                     case_data::has_solids(part.input));
  meter.add_to(part.start.seconds.mesh, part.start.operations.mesh);
}

/// Where shells' edges lie on the solids.
bool tie_shells(const case_data::EvaluatedCase& inputs, FrozenPart& part) {
  const StageMeter meter;
  try {
    const std::shared_ptr<shells::ShellPart> shell =
        part.shells->part(inputs, part.film->reference().points);
    part.tie = std::make_shared<joint::EdgeTie>(
        joint::tie_edges(part.base_mesh, shell->mesh, shell->sections));
    part.start.tet = joint_figures(part.start.tet, shell->mesh);
  } catch (const InvalidInput& error) {
    part.start.failure = Failure{FailureKind::SolverFailed, error.what()};
  }
  meter.add_to(part.start.seconds.mesh, part.start.operations.mesh);
  return !part.start.failure;
}

Monitor& monitor_of(const ForwardModelOptions& options) {
  return options.monitor != nullptr ? *options.monitor : silent_monitor();
}

bool fill_film(const case_data::EvaluatedCase& inputs,
               const ForwardModelOptions& options, FrozenPart& part) {
  Monitor& monitor = monitor_of(options);
  if (!freeze_film(inputs, options, monitor, part)) {
    return false;
  }
  if (!inputs.shells.empty()) {
    freeze_shells(inputs, part);
    if (!case_data::has_solids(part.input)) {
      return true;
    }
  }
  if (!part.input.analysis.adapt) {  // else with the facets that err
    split_facets(tight_facets(inputs, part), part);
  }
  return fill_surface(inputs, {.monitor = &monitor}, monitor, part) &&
         (!part.shells || tie_shells(inputs, part));
}

/// Where the film is there and its facets make no sound surface: the same film
/// from first facets instead of followed ones; and for walls, whose creases
/// depend on how facets fall there, from some a little smaller.
bool fill_other_facets(const case_data::EvaluatedCase& inputs,
                       const ForwardModelOptions& options, FrozenPart& part) {
  constexpr double kSmaller = 0.97;
  if (case_films::is_of_films(*part.start.failure)) {
    return false;
  }
  std::vector<double> edges;
  if (!part.input.earlier_freezes.empty() || !part.input.way.empty()) {
    edges.push_back(1.0);
  }
  if (part.walls) {
    edges.push_back(kSmaller);
  }
  return std::any_of(edges.begin(), edges.end(), [&](double edge) {
    FrozenPart anew{.input = part.input,
                    .monitor = part.monitor,
                    .start = part.start,
                    .scans = part.scans};
    anew.input.earlier_freezes.clear();
    anew.input.way.clear();
    anew.start.failure.reset();
    ForwardModelOptions own = options;
    own.edge_factor *= edge;
    bool filled = false;
    const std::string prevented =
        what_prevents([&] { filled = fill_film(inputs, own, anew); });
    if (!prevented.empty() || !filled ||
        !case_films::is_same_film(part.film->reference().report,
                                  anew.film->reference().report)) {
      part.start.seconds = anew.start.seconds;
      part.start.operations = anew.start.operations;
      return false;
    }
    anew.input.earlier_freezes = part.input.earlier_freezes;
    anew.input.way = part.input.way;
    part = std::move(anew);
    return true;
  });
}

bool film_and_mesh(const case_data::EvaluatedCase& inputs,
                   const ForwardModelOptions& options, FrozenPart& part) {
  if (fill_film(inputs, options, part) ||
      fill_other_facets(inputs, options, part)) {
    return true;
  }
  Monitor& monitor = monitor_of(options);
  if (!part.walls) {
    advise(inputs, options, monitor, part);
  }
  return false;
}

}  // namespace

TetFigures figures_of(const TetMesh& mesh,
                      const mesh_tet::TetQuality& quality) {
  return {.nodes = static_cast<int>(mesh.nodes.size()),
          .elements = mesh.element_count(),
          .min_dihedral_deg = quality.min_dihedral_deg,
          .max_dihedral_deg = quality.max_dihedral_deg};
}

TetFigures figures_of(const QuadraticSurface& surface) {
  return {.nodes =
              static_cast<int>(surface.base.points.size() + surface.mid.size()),
          .elements = static_cast<int>(surface.base.facets.size())};
}

TetFigures joint_figures(TetFigures solid, const shell::ShellMesh& shell) {
  solid.nodes += static_cast<int>(shell.nodes.size());
  solid.facets = static_cast<int>(shell.facets.size());
  return solid;
}

Points FrozenPart::rounded(const case_data::EvaluatedCase& inputs,
                           const Points& points) const {
  return fillets ? fillets->rounded(points, inputs.film_system) : points;
}

QuadraticSurface FrozenPart::surface(const case_data::EvaluatedCase& inputs,
                                     const Points& points) const {
  if (shells && !case_data::has_solids(input)) {
    return shells->surface(points);
  }
  return walls ? walls->surface(points, walls->numbers(inputs.walls))
               : film->surface(rounded(inputs, points));
}

SurfaceGradient FrozenPart::to_surface(const case_data::EvaluatedCase& inputs,
                                       const Points& points,
                                       const TetMesh& mesh,
                                       const Points& by_nodes) const {
  const mesh_tet::QuadraticGradient by =
      mesh_tet::transpose_quadratic(mesh, by_nodes, curve_edge);
  const Points by_corners = motion->transpose(by.corners);
  if (!walls) {
    Points by_rounded = film->transpose_surface(by_corners, by.mid);
    if (!fillets) {
      return {std::move(by_rounded), {}, VectorX()};
    }
    fillets::FilletGradient gradient =
        fillets->transpose(points, inputs.film_system, by_rounded);
    return {std::move(gradient.film), {}, std::move(gradient.radius)};
  }
  walls::WallGradient gradient = walls->transpose(
      points, walls->numbers(inputs.walls), by_corners, by.mid);
  return {std::move(gradient.film), std::move(gradient.thickness), VectorX()};
}

std::shared_ptr<shells::ShellPart> FrozenPart::shell_part(
    const case_data::EvaluatedCase& inputs, const Points& points,
    const TetMesh& solid) const {
  std::shared_ptr<shells::ShellPart> part = shells->part(inputs, points);
  if (tie) {
    part->solid = {.mesh = solid,
                   .materials = {inputs.materials.begin(),
                                 inputs.materials.begin() + part->first_layer},
                   .tie = tie};
  }
  return part;
}

responses::ResponseContext FrozenPart::context(
    const case_data::EvaluatedCase& inputs, const settle::FilmState& film_state,
    const TetMesh& mesh, const equations::ElasticSolution& solution,
    const responses::ResponseModes& modes,
    const shells::ShellPart* shell) const {
  return {inputs,      mesh,   solution, exclusion.what, &*film,
          &film_state, &pairs, &scans,   &modes,         shell};
}

bool freeze_mesh(const ForwardModelOptions& options, FrozenPart& part) {
  part.start.design = case_data::initial_design(part.input);
  return film_and_mesh(case_data::evaluate(part.input, part.start.design),
                       options, part);
}

void freeze_part(const ForwardModelOptions& options, FrozenPart& part) {
  part.start.design = case_data::initial_design(part.input);
  const case_data::EvaluatedCase inputs =
      case_data::evaluate(part.input, part.start.design);
  if (!film_and_mesh(inputs, options, part)) {
    return;
  }
  Monitor& monitor = monitor_of(options);
  if (part.shells) {
    freeze_shell_modes(inputs, monitor, part);
    return;
  }
  part.exclusion = choose_exclusion(
      part.input, part.base_mesh,
      options.edge_factor > 1.0 ? EmptyZones::Allowed : EmptyZones::Refused);
  if (freeze_pairs(part) && freeze_elasticity(inputs, monitor, part) &&
      freeze_modes(inputs, monitor, part) && part.input.analysis.adapt) {
    try {
      adapt(inputs, monitor, part);
    } catch (const energy::ModesNotFound& error) {
      part.start.failure = Failure{FailureKind::SolverFailed, error.what()};
    }
  }
}

}  // namespace meniscus::forward
