#include "pipeline/forward/forward_model.h"

#include <fmt/format.h>

#include "core/heed_stop.h"
#include "evolve/energy/constrained_hessian.h"
#include "fea/distributed/petsc_child.h"
#include "pipeline/forward/design_stages.h"
#include "pipeline/forward/frozen_part.h"
#include "pipeline/forward/walls.h"

namespace meniscus::forward {

void require_solver(const case_data::Case& input) {
  if (input.analysis.solver == equations::SolverKind::Distributed) {
    distributed::require_petsc();
  }
}

ForwardModel::ForwardModel(const case_data::Case& input,
                           const ForwardModelOptions& options)
    : part_(std::make_unique<FrozenPart>()) {
  const Heeding heeding(options.monitor);
  refuse_walls(input);
  require_solver(input);
  part_->input = input;
  part_->scans = responses::read_scans(input);
  part_->monitor = options.monitor;
  freeze_part(options, *part_);
}

Evaluation ForwardModel::evaluate(const VectorX& design,
                                  EvaluationFields* fields,
                                  AdjointState* adjoint) const {
  const Heeding heeding(part_->monitor);
  if (adjoint != nullptr) {
    *adjoint = {};  // as large as a stiffness matrix: not two at a time
  }
  StagedDesign staged;
  const auto keep = adjoint != nullptr ? KeepStiffness::Yes : KeepStiffness::No;
  if (!settle_film(*part_, design, staged) || !move_mesh(*part_, staged) ||
      !solve_elasticity(*part_, keep, staged) ||
      !compute_responses(*part_, staged)) {
    return std::move(staged.evaluation);
  }
  if (fields != nullptr) {
    const Points& points = staged.adjoint.film.points;
    staged.fields.film = part_->film->fine_mesh(points);
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
                                      const std::vector<int>& responses) const {
  const Heeding heeding(part_->monitor);
  try {
    return design_gradient(
        {*part_,
         part_->context(fields.inputs, adjoint.film, fields.mesh,
                        fields.solution, fields.response_modes,
                        fields.shell.get()),
         evaluation.responses, adjoint.elastic},
        responses);
  } catch (const InvalidInput& error) {
    DesignGradient none;
    none.failure = Failure{FailureKind::NotANumber, error.what()};
    return none;
  } catch (const ExpressionError& error) {
    DesignGradient none;
    none.failure =
        Failure{FailureKind::NotANumber,
                fmt::format("a field has no derivative by the design: {}",
                            error.what())};
    return none;
  } catch (const energy::ModesNotFound& error) {
    DesignGradient none;
    none.failure = Failure{FailureKind::SolverFailed, error.what()};
    return none;
  }
}

ForwardModel::~ForwardModel() = default;
ForwardModel::ForwardModel(ForwardModel&&) noexcept = default;
ForwardModel& ForwardModel::operator=(ForwardModel&&) noexcept = default;

const SurfaceMesh& ForwardModel::unfilled_surface() const {
  return part_->unfilled;
}

const std::vector<Finding>& ForwardModel::findings() const {
  return part_->findings;
}

const std::optional<Failure>& ForwardModel::failure() const {
  return part_->start.failure;
}

const Evaluation& ForwardModel::frozen() const { return part_->start; }

const frozen::FilmModel& ForwardModel::film() const { return *part_->film; }

bool ForwardModel::has_shells() const { return part_->shells.has_value(); }

const walls::WallModel* ForwardModel::walls() const {
  return part_->walls ? &*part_->walls : nullptr;
}

QuadraticSurface ForwardModel::surface(const case_data::EvaluatedCase& inputs,
                                       const Points& film_points) const {
  return part_->surface(inputs, film_points);
}

SurfaceMesh ForwardModel::boundary(const case_data::EvaluatedCase& inputs,
                                   const Points& film_points) const {
  const auto& walls = part_->walls;
  if (part_->shells && !part_->tie) {
    return part_->shells->surface(film_points).base;
  }
  return walls ? walls->fine(film_points, walls->numbers(inputs.walls))
               : part_->film->boundary(part_->rounded(inputs, film_points));
}

const responses::Scans& ForwardModel::scans() const { return part_->scans; }

const elastic::ElasticModel& ForwardModel::elasticity() const {
  return *part_->elasticity;
}

const Adaptation* ForwardModel::adaptation() const {
  return part_->adaptation ? &*part_->adaptation : nullptr;
}

}  // namespace meniscus::forward
