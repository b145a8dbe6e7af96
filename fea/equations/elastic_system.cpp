#include "fea/equations/elastic_system.h"

#include <algorithm>

#include <fmt/format.h>

#include "core/timer.h"
#include "fea/equations/held_solver.h"
#include "fea/loads/body_loads.h"
#include "fea/solver/block_kernels.h"
#include "fea/solver/corner_mesh.h"
#include "fea/supports/enforced.h"

namespace meniscus::equations {

ElasticSystem::ElasticSystem(const TetMesh& base,
                             const std::vector<element::Material>& materials,
                             const std::vector<loads::LoadCase>& load_cases,
                             const ElasticOptions& options,
                             solver::BlockMatrix<double>& matrix)
    : base_(base, materials, load_cases, options),
      shared_(std::make_unique<Shared>()) {
  order_mesh(base);
  group_supports(base, load_cases);
  if (const auto failure = assemble(base, base_.regions.laws, matrix)) {
    throw MeshError(failure->message);
  }
  build_preconditioners(base, load_cases, matrix);
}

void ElasticSystem::order_mesh(const TetMesh& base) {
  base_.order = solver::chunked_order(base);
  shared_->table = solver::make_element_table(
      base_.order.chunks, base.nodes_per_element(), base_.solver_elements(base),
      base_.solver_regions(base));
}

void ElasticSystem::group_supports(
    const TetMesh& base, const std::vector<loads::LoadCase>& load_cases) {
  for (HeldCases& held : group_alike(base, load_cases, base_.order)) {
    groups_.push_back({.cases = std::move(held.cases),
                       .restraints = std::move(held.restraints)});
  }
}

void ElasticSystem::build_preconditioners(
    const TetMesh& base, const std::vector<loads::LoadCase>& load_cases,
    const solver::BlockMatrix<double>& matrix) {
  multigrid_ = base_.options.solver == SolverKind::Multigrid ||
               (base_.options.solver == SolverKind::Automatic &&
                supports::free_unknowns(groups_.front().restraints) >
                    solver::kFactorUnknowns);
  if (multigrid_) {
    return build_multigrid(base, load_cases, matrix);
  }
  const solver::BlockPattern& pattern = shared_->table.pattern;
  for (Group& group : groups_) {
    const supports::Restraints& restraints = group.restraints;
    group.preconditioner =
        restraints.springs.at.empty()
            ? solver::make_direct(pattern, matrix, restraints.freedom)
            : solver::make_direct(
                  pattern,
                  supports::sprung_matrix(pattern, matrix, restraints.springs),
                  restraints.freedom);
  }
}

solver::CornerMesh ElasticSystem::build_corners(
    const TetMesh& base, solver::BlockMatrix<double>& matrix) {
  solver::CornerMesh corners = solver::make_corner_mesh(base, base_.order);
  if (const auto bad = meniscus::solver::assemble(corners.table, corners.x,
                                                  base_.regions.laws, matrix)) {
    throw MeshError(fmt::format(
        "element {}: its straight-sided corners enclose no positive volume; "
        "improve the mesh or choose the Cholesky solver",
        corners.element[*bad]));
  }
  shared_->map = std::move(corners.map);
  shared_->corner_pattern = corners.table.pattern;
  shared_->corner_smoother = solver::make_smoother_matrix(matrix);
  return corners;
}

void ElasticSystem::build_multigrid(
    const TetMesh& base, const std::vector<loads::LoadCase>& load_cases,
    const solver::BlockMatrix<double>& matrix) {
  // p-multigrid: below the ten-node matrix is the four-node one of the same
  // corners, below that smoothed aggregation (Vanek et al. 1996).
  const bool ten_nodes = base.order == 2;
  shared_->smoother = solver::make_smoother_matrix(matrix);
  solver::BlockMatrix<double> coarse;
  const Points x =
      ten_nodes ? build_corners(base, coarse).x : base_.solver_points(base);
  const solver::BlockPattern& pattern = shared_->table.pattern;
  // Springs stiffen both levels, so that the cycle knows K + S.
  for (Group& group : groups_) {
    const supports::SpringBlocks& springs = group.restraints.springs;
    const solver::BlockMatrix<double>* fine = &matrix;
    const solver::BlockMatrix<double>* corner = &coarse;
    solver::BlockMatrix<double> sprung;
    solver::BlockMatrix<double> sprung_corner;
    if (!springs.at.empty()) {
      sprung = supports::sprung_matrix(pattern, matrix, springs);
      fine = &sprung;
      group.smoother = std::make_unique<solver::SmootherMatrix>(
          solver::make_smoother_matrix(sprung));
    }
    if (!springs.at.empty() && ten_nodes) {
      sprung_corner = supports::sprung_matrix(
          shared_->corner_pattern, coarse,
          supports::corner_springs(base, load_cases[group.cases.front()],
                                   base_.order, shared_->map));
      corner = &sprung_corner;
      group.corner_smoother = std::make_unique<solver::SmootherMatrix>(
          solver::make_smoother_matrix(sprung_corner));
    }
    // Smoothers in single precision, shared where a group has no springs.
    const solver::SmootherMatrix* smoother =
        group.smoother ? group.smoother.get() : &shared_->smoother;
    const solver::SmootherMatrix* corner_smoother =
        group.corner_smoother ? group.corner_smoother.get()
                              : &shared_->corner_smoother;
    // One cycle per group of load cases that are held alike.
    solver::MultigridInput input{.nodal = {&pattern, fine, smoother, &x},
                                 .freedom = &group.restraints.freedom};
    if (ten_nodes) {
      input.nodal = {&shared_->corner_pattern, corner, corner_smoother, &x};
      input.fine_pattern = &pattern;
      input.fine_matrix = fine;
      input.fine_smoother = smoother;
      input.map = &shared_->map;
    }
    group.preconditioner = solver::make_multigrid(input);
  }
}

int ElasticSystem::patience() const {
  if (!multigrid_) {
    return solver::kFactorPatience;
  }
  return base_.options.solver == SolverKind::Multigrid
             ? base_.options.max_iterations
             : solver::multigrid_patience(
                   supports::free_unknowns(groups_.front().restraints));
}

std::optional<Failure> ElasticSystem::assemble(
    const TetMesh& mesh, const std::vector<element::ElasticLaw>& laws,
    solver::BlockMatrix<double>& matrix) const {
  if (auto failure = base_.bad_node(mesh)) {
    return failure;
  }
  const auto bad = meniscus::solver::assemble(
      shared_->table, base_.solver_points(mesh), laws, matrix);
  return bad ? std::optional<Failure>(base_.inverted(mesh, *bad))
             : std::nullopt;
}

ElasticSolution ElasticSystem::solve(
    const TetMesh& mesh, const std::vector<loads::LoadCase>& load_cases,
    const RegionMaterials& regions, const solver::BlockMatrix<double>& matrix,
    const ElasticSolution* start, std::vector<SolvedGroup>* solved) const {
  const Timer timer;
  ElasticSolution result;
  result.displacements.resize(load_cases.size());
  result.reactions.resize(load_cases.size());
  result.report.solver = !multigrid_       ? "cholmod"
                         : mesh.order == 1 ? "multigrid"
                                           : "p-multigrid";
  result.report.dofs = supports::free_unknowns(groups_.front().restraints);
  // Loads of all cases on the nodes of this mesh.
  const Design design{
      .mesh = mesh,
      .load_cases = load_cases,
      .laws = regions.laws,
      .start = start,
      .x = base_.solver_points(mesh),
      .f = base_.solver_forces(mesh, load_cases, regions.materials)};
  for (const Group& group : groups_) {
    // The projector P turns with the design, but must hold what the base held:
    // the preconditioner is that of the base.
    const supports::Restraints restraints =
        start == nullptr
            ? group.restraints
            : supports::make_restraints(mesh, load_cases[group.cases.front()],
                                        base_.order);
    if (!supports::alike(restraints, group.restraints)) {
      result.failure = ElasticBase::turned(load_cases[group.cases.front()]);
      return result;
    }
    // (K + S) u = f in the range of P, several right sides at once.
    const bool plain = restraints.springs.at.empty();
    const solver::BlockMatrix<double> sprung =
        plain ? solver::BlockMatrix<double>{}
              : supports::sprung_matrix(shared_->table.pattern, matrix,
                                        restraints.springs);
    HeldSolver solver({.pattern = shared_->table.pattern,
                       .matrix = plain ? matrix : sprung,
                       .preconditioner = *group.preconditioner,
                       .restraints = restraints,
                       .tolerance = base_.options.tolerance,
                       .max_iterations = base_.options.max_iterations,
                       .monitor = base_.options.monitor != nullptr
                                      ? *base_.options.monitor
                                      : silent_monitor(),
                       .patience = patience()});
    PinMotions motions = solve_group(design, group.cases,
                                     plain ? matrix : sprung, solver, result);
    if (solver.factor() != nullptr && multigrid_) {
      result.report.solver = "cholmod after multigrid";
    }
    if (solved != nullptr) {
      solved->push_back(
          {.pins = std::move(motions), .factor = solver.factor()});
    }
  }
  // With temperatures the energy is int s : C^-1 : s / 2, not f . u / 2.
  if (!result.failure && load_cases[0].temperature) {
    result.report.strain_energy =
        loads::strain_energy(mesh, regions.materials, result.displacements[0],
                             loads::temperature_change(mesh, load_cases[0]));
  }
  result.report.solve_seconds = timer.seconds();
  return result;
}

PinMotions ElasticSystem::solve_group(const Design& design,
                                      const std::vector<int>& cases,
                                      const solver::BlockMatrix<double>& matrix,
                                      HeldSolver& solver,
                                      ElasticSolution& result) const {
  const ElasticSolution* start = design.start;
  PinMotions pins = find_pin_motions(design.x, solver);
  // From the base solution or from 0, never from the call before: an
  // evaluation is a pure function of the design.
  std::vector<VectorX> right;
  std::vector<VectorX> enforced;
  std::vector<VectorX> u;
  for (const int c : cases) {
    right.push_back(design.f[c]);
    u.push_back(start != nullptr && !start->failure
                    ? to_solver(base_.order, start->displacements[c])
                    : VectorX(VectorX::Zero(design.f[c].size())));
    hold_pins(pins, solver.restraints(), design.x, u.back());
    enforced.push_back(
        supports::enforced_displacement(design.mesh, design.load_cases[c]));
    if (enforced.back().size() != 0) {
      enforced.back() = to_solver(base_.order, enforced.back());
      right.back() -= solver.product(enforced.back());
    }
  }
  const std::vector<solver::CgColumn> columns = solver.solve(right, u);
  // Reactions, balance and residual by elements; the diagonal bounds rounding.
  const VectorX diagonal = solver::diagonal_of(matrix);
  for (std::size_t k = 0; k < cases.size(); ++k) {
    const int c = cases[k];
    if (enforced[k].size() != 0) {
      u[k] += enforced[k];
    }
    release_pins(pins, solver, design.f[c], u[k]);
    finish_solution(base_, shared_->table,
                    {.load_case = c,
                     .name = design.load_cases[c].name,
                     .x = design.x,
                     .f = design.f[c],
                     .u = u[k],
                     .diagonal = diagonal,
                     .laws = design.laws,
                     .restraints = solver.restraints(),
                     .column = worse_of(columns[k], pins.column),
                     .enforced = enforced[k].size() != 0},
                    result);
  }
  return pins;
}

}  // namespace meniscus::equations
