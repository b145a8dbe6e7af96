#include "fea/shell/shell_system.h"

#include <fmt/format.h>

#include "core/error.h"
#include "fea/shell/facet_geometric.h"
#include "fea/shell/facet_loads.h"
#include "fea/shell/shell_held.h"

namespace meniscus::shell {

ShellSystem::ShellSystem(const ShellMesh& mesh,
                         const std::vector<Section>& sections,
                         const std::vector<NodeSupport>& supports,
                         const FacetRule& rule,
                         const ShellFactorOptions& options,
                         const std::vector<GroundSpring>& springs)
    : mesh_(mesh),
      sections_(sections),
      rule_(rule),
      stiffness_(mesh, sections, rule, springs),
      freedom_(static_cast<int>(mesh.nodes.size()), supports),
      assembly_(mesh_, freedom_) {
  check_held(mesh_, freedom_, springs);
  factor_.emplace(
      mesh_, freedom_, [this](int facet) { return stiffness_.of(facet); },
      options);
}

SparseMatrix ShellSystem::stiffness() const {
  return assembly_.sum([this](int facet) { return stiffness_.of(facet); });
}

ShellSolution ShellSystem::solve(const ShellLoads& loads) const {
  const VectorX f = nodal_forces(mesh_, sections_, loads);
  VectorX right = f;
  const VectorX held = freedom_.held_values();
  if (!held.isZero(0.0)) {
    right -= stiffness_.times(held);
  }
  ShellSolution solution;
  solution.displacement =
      freedom_.expand(factor_->solve(freedom_.restrict(right)));
  const VectorX inner = stiffness_.times(solution.displacement);
  solution.reaction = inner - f;
  solution.strain_energy = 0.5 * solution.displacement.dot(inner);
  return solution;
}

VectorX ShellSystem::solve_forces(const VectorX& forces) const {
  return freedom_.expand(factor_->solve(freedom_.restrict(forces))) -
         freedom_.held_values();
}

SparseMatrix ShellSystem::geometric(const ShellLoads& loads,
                                    const VectorX& displacement) const {
  const std::vector<FacetLoad> own = facet_loads(mesh_, loads);
  return assembly_.sum([&](int facet) {
    return facet_geometric(facet_of(mesh_, sections_, stiffness_.laws(), facet),
                           loads, own[facet],
                           numbers_of(mesh_, facet, displacement));
  });
}

SparseMatrix ShellSystem::mass() const {
  return assembly_.sum([this](int facet) {
    return facet_mass(facet_of(mesh_, sections_, stiffness_.laws(), facet),
                      rule_);
  });
}

}  // namespace meniscus::shell
