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

void check_right_hand_sides(const KeptState& state,
                            const std::vector<int>& load_cases,
                            const std::vector<VectorX>& right) {
  if (load_cases.size() != right.size()) {
    throw InvalidInput(
        fmt::format("adjoint of elasticity: {} load cases for {} right-hand "
                    "sides",
                    load_cases.size(), right.size()));
  }
  const auto size = static_cast<Eigen::Index>(3 * state.x.size());
  for (std::size_t k = 0; k < right.size(); ++k) {
    const auto load_case = static_cast<std::size_t>(load_cases[k]);
    if (load_case >= state.names.size()) {
      throw InvalidInput(
          fmt::format("adjoint of elasticity: load case {} of "
                      "{}",
                      load_cases[k], state.names.size()));
    }
    if (right[k].size() != size || !right[k].allFinite()) {
      throw InvalidInput(fmt::format(
          "adjoint of load case '{}': a right-hand side of {} numbers must be "
          "finite and 3 for each of {} nodes",
          state.names[load_case], right[k].size(), state.x.size()));
    }
  }
}

void finish_solution(const KeptState& state, const KeptState::Group& group,
                     const std::string& name, const VectorX& diagonal,
                     const VectorX& g, const VectorX& lambda,
                     const solver::CgColumn& column, std::size_t at,
                     AdjointSolution& result) {
  const Equilibrium equilibrium = check_equilibrium(
      {state.x, g,
       solver::internal_forces(*state.table, state.x, state.laws, lambda),
       supports::spring_forces(group.restraints.springs, lambda), lambda,
       group.restraints, diagonal});
  result.lambda[at] = to_mesh(*state.order, lambda);
  result.reactions[at] = to_mesh(*state.order, equilibrium.reactions);
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

/// The right-hand sides `open` of one group, in step.
void solve_group(const KeptState& state, const KeptState::Group& group,
                 const std::vector<std::size_t>& open,
                 const std::vector<int>& load_cases,
                 const std::vector<VectorX>& right_hand_sides,
                 AdjointSolution& result) {
  const supports::SpringBlocks& springs = group.restraints.springs;
  const bool plain = springs.at.empty();
  const solver::BlockMatrix<double> sprung =
      plain ? solver::BlockMatrix<double>{}
            : supports::sprung_matrix(state.table->pattern, state.matrix,
                                      springs);
  const solver::BlockMatrix<double>& matrix = plain ? state.matrix : sprung;
  const VectorX diagonal = solver::diagonal_of(matrix);
  HeldSolver solver({.pattern = state.table->pattern,
                     .matrix = matrix,
                     .preconditioner = group.solved.factor != nullptr
                                           ? *group.solved.factor
                                           : *group.preconditioner,
                     .restraints = group.restraints,
                     .tolerance = state.tolerance,
                     .max_iterations = state.max_iterations,
                     .monitor = *state.monitor,
                     .patience = state.patience});
  for (std::size_t first = 0; first < open.size();
       first += solver::kMostColumns) {
    std::vector<VectorX> right;
    right.reserve(solver::kMostColumns);
    for (std::size_t k = first;
         k < std::min(first + solver::kMostColumns, open.size()); ++k) {
      right.push_back(to_solver(*state.order, right_hand_sides[open[k]]));
    }
    std::vector<VectorX> lambda(right.size(),
                                VectorX::Zero(right.front().size()));
    const std::vector<solver::CgColumn> columns = solver.solve(right, lambda);
    for (std::size_t k = 0; k < right.size(); ++k) {
      release_pins(group.solved.pins, solver, right[k], lambda[k]);
      const std::size_t at = open[first + k];
      finish_solution(state, group,
                      state.names[static_cast<std::size_t>(load_cases[at])],
                      diagonal, right[k], lambda[k], columns[k], at, result);
    }
  }
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
                              std::vector<SolvedGroup> solved) const {
  KeptState state{.table = &shared_->table,
                  .order = &base_.order,
                  .monitor = base_.options.monitor != nullptr
                                 ? base_.options.monitor
                                 : &silent_monitor(),
                  .laws = std::move(laws),
                  .tolerance = base_.options.tolerance,
                  .max_iterations = base_.options.max_iterations,
                  .patience = patience(),
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
         .solved = std::move(solved[g]),
         .preconditioner = group.preconditioner.get()});
  }
  state.names.reserve(load_cases.size());
  for (const loads::LoadCase& load_case : load_cases) {
    state.names.push_back(load_case.name);
  }
  return state;
}

AdjointSolution solve_adjoints(const KeptState& state,
                               const std::vector<int>& load_cases,
                               const std::vector<VectorX>& right_hand_sides) {
  const Timer timer;
  check_right_hand_sides(state, load_cases, right_hand_sides);
  AdjointSolution result;
  result.lambda.resize(right_hand_sides.size());
  result.reactions.resize(right_hand_sides.size());
  for (const KeptState::Group& group : state.groups) {
    std::vector<std::size_t> open;
    for (std::size_t k = 0; k < load_cases.size(); ++k) {
      if (std::find(group.cases.begin(), group.cases.end(), load_cases[k]) !=
          group.cases.end()) {
        open.push_back(k);
      }
    }
    if (!open.empty()) {
      solve_group(state, group, open, load_cases, right_hand_sides, result);
    }
  }
  result.seconds = timer.seconds();
  return result;
}

}  // namespace meniscus::equations
