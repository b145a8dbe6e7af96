#include "fea/distributed/distributed_system.h"

#include <algorithm>

#include <fmt/format.h>

#include "core/timer.h"
#include "fea/distributed/petsc_child.h"
#include "fea/equations/elastic_operator.h"
#include "fea/loads/body_loads.h"

namespace meniscus::distributed {

namespace {

/// Fewer are not worth a process.
constexpr int kLeastNodes = 100;

/// GAMG sees less of a long wave's error than our own cycles do: at the same
/// tolerance reactions miss the loads by 1e-9, where 1e-10 is to be expected.
constexpr double kStricter = 0.01;

double time_limit(const equations::ElasticOptions& options,
                  std::size_t unknowns, std::size_t load_cases) {
  constexpr double kStart = 600.0;   // [s]
  constexpr double kUnknown = 1e-3;  // about thirty times what was measured
  return options.time_limit.value_or(kStart +
                                     kUnknown * static_cast<double>(unknowns) *
                                         static_cast<double>(load_cases));
}

}  // namespace

DistributedSystem::DistributedSystem(
    const TetMesh& base, const std::vector<element::Material>& materials,
    const std::vector<loads::LoadCase>& load_cases,
    const equations::ElasticOptions& options)
    : base_(base, materials, load_cases, options) {
  if (options.processes < 1 || options.processes > equations::kMostProcesses) {
    throw InvalidInput(fmt::format("elasticity: {} processes; 1 to {} can work",
                                   options.processes,
                                   equations::kMostProcesses));
  }
  for (const loads::LoadCase& load_case : load_cases) {
    if (!load_case.pins.empty() || loads::enforces(load_case)) {
      throw InvalidInput(fmt::format(
          "load case '{}': the solver petsc knows no {}; choose another solver "
          "(analysis.solver)",
          load_case.name,
          load_case.pins.empty() ? "enforced displacements" : "rigid pins"));
    }
  }
  require_petsc();
  base_.order = solver::curve_order(base);
  table_ = solver::make_element_list(
      base_.order.chunks, base.nodes_per_element(), base_.solver_elements(base),
      base_.solver_regions(base));
  groups_ = equations::group_alike(base, load_cases, base_.order);
  if (const auto failure = bad_design(base, base_.solver_points(base))) {
    throw MeshError(failure->message);
  }
}

std::optional<Failure> DistributedSystem::bad_design(const TetMesh& mesh,
                                                     const Points& x) const {
  if (auto failure = base_.bad_node(mesh)) {
    return failure;
  }
  const auto bad = solver::first_bad_element(table_, x);
  return bad ? std::optional<Failure>(base_.inverted(mesh, *bad))
             : std::nullopt;
}

int DistributedSystem::processes() const {
  return std::clamp(table_.pattern.nodes / kLeastNodes, 1,
                    base_.options.processes);
}

std::optional<Failure> DistributedSystem::hold(
    const TetMesh& mesh, const std::vector<loads::LoadCase>& load_cases,
    bool is_base, std::vector<supports::Restraints>& restraints) const {
  for (const equations::HeldCases& group : groups_) {
    const loads::LoadCase& first = load_cases[group.cases.front()];
    restraints.push_back(
        is_base ? group.restraints
                : supports::make_restraints(mesh, first, base_.order));
    if (!supports::alike(restraints.back(), group.restraints)) {
      return equations::ElasticBase::turned(first);
    }
  }
  return std::nullopt;
}

std::vector<PetscGroup> DistributedSystem::grouped(
    const std::vector<supports::Restraints>& restraints,
    const std::vector<VectorX>& f, const std::vector<VectorX>& start) const {
  std::vector<PetscGroup> groups;
  for (std::size_t g = 0; g < groups_.size(); ++g) {
    PetscGroup group{.restraints = &restraints[g], .f = {}, .start = {}};
    for (const int c : groups_[g].cases) {
      group.f.push_back(&f[c]);
      if (!start.empty()) {
        group.start.push_back(&start[c]);
      }
    }
    groups.push_back(std::move(group));
  }
  return groups;
}

equations::ElasticSolution DistributedSystem::solve(
    const TetMesh& mesh, const std::vector<loads::LoadCase>& load_cases,
    const equations::RegionMaterials& regions,
    const equations::ElasticSolution* start) const {
  const Timer timer;
  equations::ElasticSolution result;
  result.displacements.resize(load_cases.size());
  result.reactions.resize(load_cases.size());
  result.report.solver = "petsc";
  result.report.dofs = supports::free_unknowns(groups_.front().restraints);
  const Points x = base_.solver_points(mesh);
  if ((result.failure = bad_design(mesh, x))) {
    return result;
  }
  // Right sides, and the base solution as start: no evaluation depends on
  // another one.
  const std::vector<VectorX> f =
      base_.solver_forces(mesh, load_cases, regions.materials);
  std::vector<VectorX> begin;
  for (std::size_t c = 0; start != nullptr && !start->failure && c < f.size();
       ++c) {
    begin.push_back(equations::to_solver(base_.order, start->displacements[c]));
  }
  // Projectors P on what the supports leave free, at this design.
  std::vector<supports::Restraints> restraints;
  if ((result.failure = hold(mesh, load_cases, start == nullptr, restraints))) {
    return result;
  }
  // Conjugate gradients on P (K + S) P + s (I - P) in other processes, to a
  // stricter tolerance so that reactions balance the loads.
  const PetscSolution solved = run_petsc(
      {.table = table_,
       .x = x,
       .laws = regions.laws,
       .groups = grouped(restraints, f, begin),
       .tolerance = kStricter * base_.options.tolerance,
       .max_iterations = base_.options.max_iterations},
      {.processes = processes(),
       .time_limit = time_limit(base_.options, 3 * x.size(), f.size()),
       .monitor = base_.options.monitor});
  result.report.process_memory = solved.process_memory;
  // Reactions, balance and true residual are found here, from the elements.
  for (std::size_t g = 0; g < groups_.size(); ++g) {
    const PetscGroupSolution& group = solved.groups[g];
    for (std::size_t k = 0; k < group.u.size(); ++k) {
      const int c = groups_[g].cases[k];
      equations::finish_solution(base_, table_,
                                 {.load_case = c,
                                  .name = load_cases[c].name,
                                  .x = x,
                                  .f = f[c],
                                  .u = group.u[k],
                                  .diagonal = group.diagonal,
                                  .laws = regions.laws,
                                  .restraints = restraints[g],
                                  .column = group.columns[k]},
                                 result);
    }
  }
  // Free expansion stores none: the energy is that of stresses, not f . u / 2.
  if (!result.failure && load_cases[0].temperature) {
    result.report.strain_energy =
        loads::strain_energy(mesh, regions.materials, result.displacements[0],
                             loads::temperature_change(mesh, load_cases[0]));
  }
  result.report.setup_seconds = solved.setup_seconds;
  result.report.solve_seconds = timer.seconds() - solved.setup_seconds;
  return result;
}

}  // namespace meniscus::distributed
