#include "pipeline/forward/design_stages.h"

#include <cmath>

#include <fmt/format.h>

#include "evolve/energy/constrained_hessian.h"
#include "mesh_tet/motion_check.h"
#include "mesh_tet/quadratic.h"
#include "pipeline/forward/fillets.h"
#include "pipeline/forward/frozen_part.h"
#include "pipeline/forward/planes_kept.h"
#include "pipeline/forward/walls.h"
#include "pipeline/shells/joint_part.h"

namespace meniscus::forward {

namespace {

/// As many as the responses take.
std::optional<Failure> find_modes(const FrozenPart& part,
                                  StagedDesign& staged) {
  const StageMeter meter;
  responses::ResponseModes& modes = staged.fields.response_modes;
  modes = responses::find_response_modes(
      {.input = part.input,
       .inputs = staged.fields.inputs,
       .mesh = staged.fields.mesh,
       .solution = staged.fields.solution,
       .model = part.elasticity ? &*part.elasticity : nullptr,
       .shell = staged.fields.shell.get(),
       .base = &part.base_modes,
       .monitor = part.monitor});
  meter.add_to(staged.evaluation.seconds.fea, staged.evaluation.operations.fea);
  return modes.failure;
}

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

bool settle_film(const case_data::Case& input, const frozen::FilmModel& film,
                 const VectorX& design, Monitor* monitor,
                 StagedDesign& staged) {
  Evaluation& result = staged.evaluation;
  result.design = design;
  try {
    staged.fields.inputs = case_data::evaluate(input, design);
  } catch (const InvalidInput& error) {
    // Numbers that hold at the ends of the bounds may fail between them.
    result.failure = Failure{FailureKind::NotANumber, error.what()};
    return false;
  }
  const StageMeter meter;
  settle::FilmState& state = staged.adjoint.film;
  state = film.settle(staged.fields.inputs.film_system, {.monitor = monitor});
  result.film = state.report;
  meter.add_to(result.seconds.film, result.operations.film);
  result.failure = state.failure;
  if (!result.failure && !input.symmetry.empty()) {
    result.failure = beyond_planes(input, film.fine_mesh(state.points));
  }
  return !result.failure;
}

bool settle_film(const FrozenPart& part, const VectorX& design,
                 StagedDesign& staged) {
  return settle_film(part.input, *part.film, design, part.monitor, staged);
}

namespace {

bool move_shell(const FrozenPart& part, StagedDesign& staged) {
  const StageMeter meter;
  Evaluation& result = staged.evaluation;
  EvaluationFields& fields = staged.fields;
  try {
    fields.shell =
        part.shell_part(fields.inputs, staged.adjoint.film.points, fields.mesh);
    if (part.tie) {
      result.tet = joint_figures(result.tet, fields.shell->mesh);
      fields.mesh = shells::joint_mesh(fields.mesh, fields.shell->skin);
    } else {
      fields.surface = part.shells->surface(staged.adjoint.film.points);
      result.tet = figures_of(fields.surface);
      fields.mesh = fields.shell->skin;
    }
  } catch (const InvalidInput& error) {  // a thickness that is not above 0
    result.failure = Failure{FailureKind::NotANumber, error.what()};
  } catch (const MeshError& error) {
    result.failure = Failure{FailureKind::ElementsInverted, error.what()};
  }
  meter.add_to(result.seconds.mesh, result.operations.mesh);
  return !result.failure;
}

bool move_solids(const FrozenPart& part, StagedDesign& staged) {
  Evaluation& result = staged.evaluation;
  const StageMeter meter;
  QuadraticSurface& surface = staged.fields.surface;
  try {
    surface = part.surface(staged.fields.inputs, staged.adjoint.film.points);
  } catch (const InvalidInput& error) {
    // A ball that does not fit, or a thickness that is not above 0.
    result.failure = part.fillets
                         ? fillet_failure(part.input, error)
                         : Failure{FailureKind::NotANumber, error.what()};
    return false;
  }
  if (part.walls) {
    result.failure = beyond_planes(part.input, surface.base);
    if (result.failure) {
      return false;
    }
  }
  TetMesh& mesh = staged.fields.mesh;
  mesh = part.base_mesh;
  mesh_tet::move_quadratic(mesh, part.motion->move(surface.base.points),
                           surface, part.curve_edge);
  mesh_tet::TetQuality quality;
  result.failure = mesh_tet::check_moved(mesh, {}, &quality);
  result.tet = figures_of(mesh, quality);
  meter.add_to(result.seconds.mesh, result.operations.mesh);
  return !result.failure;
}

equations::ElasticSolution solve_part(const FrozenPart& part,
                                      KeepStiffness keep,
                                      StagedDesign& staged) {
  const case_data::EvaluatedCase& inputs = staged.fields.inputs;
  if (part.shells) {
    shells::ShellPart& shell = *staged.fields.shell;
    return part.tie ? shells::solve_joint(inputs, shell)
                    : shells::solve_shell(inputs, shell, part.monitor);
  }
  return part.elasticity->solve(
      staged.fields.mesh, inputs.load_cases, inputs.materials,
      keep == KeepStiffness::Yes ? &staged.adjoint.elastic : nullptr);
}

}  // namespace

bool move_mesh(const FrozenPart& part, StagedDesign& staged) {
  const bool has_solids = !part.shells || part.tie;
  return (!has_solids || move_solids(part, staged)) &&
         (!part.shells || move_shell(part, staged));
}

bool solve_elasticity(const FrozenPart& part, KeepStiffness keep,
                      StagedDesign& staged) {
  Evaluation& result = staged.evaluation;
  const StageMeter meter;
  equations::ElasticSolution& solution = staged.fields.solution;
  try {
    solution = solve_part(part, keep, staged);
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

bool compute_responses(const FrozenPart& part, StagedDesign& staged) {
  Evaluation& result = staged.evaluation;
  EvaluationFields& fields = staged.fields;
  result.failure = find_modes(part, staged);
  if (result.failure) {
    return false;
  }
  try {
    result.responses = responses::respond(
        part.input, part.context(fields.inputs, staged.adjoint.film,
                                 fields.mesh, fields.solution,
                                 fields.response_modes, fields.shell.get()));
  } catch (const InvalidInput& error) {  // an expression of place
    result.failure = Failure{FailureKind::NotANumber, error.what()};
    return false;
  } catch (const energy::ModesNotFound& error) {
    result.failure = Failure{FailureKind::SolverFailed, error.what()};
    return false;
  }
  if (!result.responses.allFinite()) {
    result.failure = not_a_number(part.input, result.responses);
    result.responses.resize(0);
    return false;
  }
  fields.exclusion = part.exclusion;
  fields.start_edge = part.film->start_edge();
  return true;
}

bool mesh_design(const case_data::Case& input, const VectorX& design,
                 Monitor* monitor, StagedDesign& staged) {
  if (input.analysis.adapt) {
    const ForwardModel model(input, {.monitor = monitor});
    staged.evaluation.failure = model.failure();
    return !model.failure() && settle_film(model.part(), design, staged) &&
           move_mesh(model.part(), staged);
  }
  refuse_walls(input);
  FrozenPart part;
  part.input = input;
  part.monitor = monitor;
  if (!freeze_mesh({.monitor = monitor}, part)) {
    staged.evaluation.failure = part.start.failure;
    return false;
  }
  return settle_film(part, design, staged) && move_mesh(part, staged);
}

}  // namespace meniscus::forward
