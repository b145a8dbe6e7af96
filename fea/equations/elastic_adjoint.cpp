#include "fea/equations/elastic_adjoint.h"

#include <algorithm>

#include <fmt/format.h>

#include "core/timer.h"
#include "fea/equations/elastic_operator.h"
#include "fea/equations/elastic_system.h"
#include "fea/equations/equilibrium_check.h"
#include "fea/equations/held_solver.h"
#include "fea/equations/kept_state.h"

namespace meniscus::equations {

namespace {

const KeptState::Group& group_of(const KeptState& state, int load_case) {
  for (const KeptState::Group& group : state.groups) {
    if (std::find(group.cases.begin(), group.cases.end(), load_case) !=
        group.cases.end()) {
      return group;
    }
  }
  throw InvalidInput(fmt::format("adjoint of elasticity: load case {} of {}",
                                 load_case, state.names.size()));
}

void check_right_hand_sides(const KeptState& state, const std::string& name,
                            const std::vector<VectorX>& right) {
  const auto size = static_cast<Eigen::Index>(3 * state.x.size());
  for (const VectorX& g : right) {
    if (g.size() != size || !g.allFinite()) {
      throw InvalidInput(fmt::format(
          "adjoint of load case '{}': a right-hand side of {} numbers must be "
          "finite and 3 for each of {} nodes",
          name, g.size(), state.x.size()));
    }
  }
}

void finish_solution(const KeptState& state, const KeptState::Group& group,
                     const std::string& name, const VectorX& diagonal,
                     const VectorX& g, const VectorX& lambda,
                     const solver::CgColumn& column, AdjointSolution& result) {
  const Equilibrium equilibrium = check_equilibrium(
      {state.x, g,
       solver::internal_forces(*state.table, state.x, state.laws, lambda),
       supports::spring_forces(group.restraints.springs, lambda), lambda,
       group.restraints, diagonal});
  result.lambda.push_back(to_mesh(*state.order, lambda));
  result.reactions.push_back(to_mesh(*state.order, equilibrium.reactions));
  result.iterations = std::max(result.iterations, column.iterations);
  result.residual = std::max(result.residual, equilibrium.residual);
  if (result.failure || g.isZero(0.0)) {
    return;
  }
  if (column.end != solver::CgEnd::Converged) {
    result.failure = Failure{
        FailureKind::SolverFailed,
        fmt::format("load case '{}': its adjoint does not converge in {} "
                    "iterations (relative error {:.2e})",
                    name, column.iterations, column.error)};
    return;
  }
  result.failure =
      check_residual(equilibrium, state.tolerance, name + " (adjoint)");
}

}  // namespace

ElasticState::ElasticState() = default;
ElasticState::~ElasticState() = default;
ElasticState::ElasticState(ElasticState&&) noexcept = default;
ElasticState& ElasticState::operator=(ElasticState&&) noexcept = default;

KeptState ElasticSystem::keep(const TetMesh& mesh,
                              const std::vector<loads::LoadCase>& load_cases,
                              std::vector<element::ElasticLaw> laws,
                              solver::BlockMatrix<double> matrix,
                              std::vector<PinMotions> pins) const {
  KeptState state{.table = &shared_->table,
                  .order = &base_.order,
                  .monitor = base_.options.monitor != nullptr
                                 ? base_.options.monitor
                                 : &silent_monitor(),
                  .laws = std::move(laws),
                  .tolerance = base_.options.tolerance,
                  .max_iterations = base_.options.max_iterations,
                  .groups = {},
                  .names = {},
                  .matrix = std::move(matrix),
                  .x = base_.solver_points(mesh)};
  state.groups.reserve(groups_.size());
  for (std::size_t g = 0; g < groups_.size(); ++g) {
    const Group& group = groups_[g];
    state.groups.push_back(
        {.cases = group.cases,
         .restraints = supports::make_restraints(
             mesh, load_cases[group.cases.front()], base_.order),
         .pins = std::move(pins[g]),
         .preconditioner = group.preconditioner.get()});
  }
  state.names.reserve(load_cases.size());
  for (const loads::LoadCase& load_case : load_cases) {
    state.names.push_back(load_case.name);
  }
  return state;
}

AdjointSolution solve_adjoint(const KeptState& state, int load_case,
                              const std::vector<VectorX>& right_hand_sides) {
  const Timer timer;
  const KeptState::Group& group = group_of(state, load_case);
  const std::string& name = state.names[static_cast<std::size_t>(load_case)];
  check_right_hand_sides(state, name, right_hand_sides);
  const supports::SpringBlocks& springs = group.restraints.springs;
  const bool plain = springs.at.empty();
  const solver::BlockMatrix<double> sprung =
      plain ? solver::BlockMatrix<double>{}
            : supports::sprung_matrix(state.table->pattern, state.matrix,
                                      springs);
  const solver::BlockMatrix<double>& matrix = plain ? state.matrix : sprung;
  const VectorX diagonal = solver::diagonal_of(matrix);
  AdjointSolution result;
  HeldSolver solver({.pattern = state.table->pattern,
                     .matrix = matrix,
                     .preconditioner = *group.preconditioner,
                     .restraints = group.restraints,
                     .tolerance = state.tolerance,
                     .max_iterations = state.max_iterations,
                     .monitor = *state.monitor});
  const std::size_t count = right_hand_sides.size();
  for (std::size_t first = 0; first < count; first += solver::kMostColumns) {
    std::vector<VectorX> right;
    right.reserve(solver::kMostColumns);
    for (std::size_t k = first;
         k < std::min(first + solver::kMostColumns, count); ++k) {
      right.push_back(to_solver(*state.order, right_hand_sides[k]));
    }
    std::vector<VectorX> lambda(right.size(),
                                VectorX::Zero(right.front().size()));
    const std::vector<solver::CgColumn> columns = solver.solve(right, lambda);
    for (std::size_t k = 0; k < right.size(); ++k) {
      release_pins(group.pins, solver, right[k], lambda[k]);
      finish_solution(state, group, name, diagonal, right[k], lambda[k],
                      columns[k], result);
    }
  }
  result.seconds = timer.seconds();
  return result;
}

}  // namespace meniscus::equations
