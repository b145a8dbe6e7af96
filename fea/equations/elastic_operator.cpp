#include "fea/equations/elastic_operator.h"

#include <algorithm>

#include <fmt/format.h>

#include "core/error.h"
#include "fea/equations/elastic_system.h"
#include "fea/equations/held_solver.h"

namespace meniscus::equations {

namespace {

/// They precondition, and nothing else: the answer does not see their error.
constexpr double kPinMotions = 1e-6;

}  // namespace

VectorX to_solver(const solver::NodeOrder& order, const VectorX& v) {
  VectorX w(v.size());
  for (std::size_t i = 0; i < order.to_mesh.size(); ++i) {
    w.segment<3>(static_cast<Eigen::Index>(3 * i)) =
        v.segment<3>(3L * order.to_mesh[i]);
  }
  return w;
}

VectorX to_mesh(const solver::NodeOrder& order, const VectorX& v) {
  VectorX w(v.size());
  for (std::size_t i = 0; i < order.to_mesh.size(); ++i) {
    w.segment<3>(3L * order.to_mesh[i]) =
        v.segment<3>(static_cast<Eigen::Index>(3 * i));
  }
  return w;
}

ElasticOperator ElasticSystem::operator_at(
    const TetMesh& mesh, const std::vector<loads::LoadCase>& load_cases,
    int load_case, const std::vector<element::Material>* materials) const {
  const auto group =
      std::find_if(groups_.begin(), groups_.end(), [load_case](const Group& g) {
        return std::find(g.cases.begin(), g.cases.end(), load_case) !=
               g.cases.end();
      });
  if (group == groups_.end()) {
    throw InvalidInput(fmt::format("elasticity: load case {} of {}", load_case,
                                   load_cases.size()));
  }
  const loads::LoadCase& loads = load_cases[load_case];
  const supports::Restraints restraints =
      supports::make_restraints(mesh, loads, base_.order);
  if (!supports::alike(restraints, group->restraints)) {
    throw SolverError(fmt::format(
        "load case '{}': the directions in which its supports hold the nodes "
        "are no longer the base design's",
        loads.name));
  }
  const RegionMaterials regions =
      materials != nullptr ? base_.of_design(mesh, *materials) : base_.regions;
  ElasticOperator result{.table = &shared_->table,
                         .order = &base_.order,
                         .preconditioner = group->preconditioner.get(),
                         .materials = regions.materials,
                         .K = {},
                         .freedom = restraints.freedom,
                         .pins = restraints.pins,
                         .pin_motions = {},
                         .x = base_.solver_points(mesh)};
  if (const auto failure = assemble(mesh, regions.laws, result.K)) {
    throw MeshError(failure->message);
  }
  supports::add_springs(shared_->table.pattern, restraints.springs, result.K);
  HeldSolver solver({.pattern = shared_->table.pattern,
                     .matrix = result.K,
                     .preconditioner = *group->preconditioner,
                     .restraints = restraints,
                     .tolerance = kPinMotions,
                     .max_iterations = base_.options.max_iterations,
                     .monitor = base_.options.monitor != nullptr
                                    ? *base_.options.monitor
                                    : silent_monitor(),
                     .patience = patience()});
  result.pin_motions = find_pin_motions(result.x, solver);
  return result;
}

}  // namespace meniscus::equations
