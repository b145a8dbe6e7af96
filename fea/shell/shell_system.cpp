#include "fea/shell/shell_system.h"

#include <fmt/format.h>

#include "core/error.h"
#include "core/parallel_for.h"
#include "fea/shell/facet_geometric.h"
#include "fea/shell/facet_loads.h"
#include "fea/shell/shell_held.h"

namespace meniscus::shell {

namespace {

std::vector<LaminateLaw> checked_laws(const ShellMesh& mesh,
                                      const std::vector<Section>& sections) {
  check_shell(mesh, sections);
  return laminate_laws(sections);
}

}  // namespace

ShellSystem::ShellSystem(const ShellMesh& mesh,
                         const std::vector<Section>& sections,
                         const std::vector<NodeSupport>& supports,
                         const FacetRule& rule,
                         const ShellFactorOptions& options)
    : mesh_(mesh),
      sections_(sections),
      rule_(rule),
      laws_(checked_laws(mesh, sections)),
      freedom_(static_cast<int>(mesh.nodes.size()), supports),
      assembly_(mesh_, freedom_) {
  check_held(mesh_, freedom_);
  factor_.emplace(
      mesh_, freedom_, [this](int facet) { return stiffness_of(facet); },
      options);
}

FacetMatrix ShellSystem::stiffness_of(int facet) const {
  return condensed(
      whole_stiffness(facet_of(mesh_, sections_, laws_, facet), rule_));
}

SparseMatrix ShellSystem::stiffness() const {
  return assembly_.sum([this](int facet) { return stiffness_of(facet); });
}

VectorX ShellSystem::stiffness_times(const VectorX& u) const {
  std::vector<FacetVector> forces(mesh_.facets.size());
  parallel_for(static_cast<std::ptrdiff_t>(forces.size()),
               [&](std::ptrdiff_t k) {
                 const auto facet = static_cast<int>(k);
                 forces[k] = stiffness_of(facet) * numbers_of(mesh_, facet, u);
               });
  VectorX f = VectorX::Zero(u.size());
  for (std::size_t k = 0; k < forces.size(); ++k) {
    for (int i = 0; i < kNodes; ++i) {
      f.segment<6>(6L * mesh_.facets[k][i]) += forces[k].segment<6>(6 * i);
    }
  }
  return f;
}

ShellSolution ShellSystem::solve(const ShellLoads& loads) const {
  const VectorX f = nodal_forces(mesh_, sections_, loads);
  VectorX right = f;
  const VectorX held = freedom_.held_values();
  if (!held.isZero(0.0)) {
    right -= stiffness_times(held);
  }
  ShellSolution solution;
  solution.displacement =
      freedom_.expand(factor_->solve(freedom_.restrict(right)));
  const VectorX inner = stiffness_times(solution.displacement);
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
    return facet_geometric(facet_of(mesh_, sections_, laws_, facet), loads,
                           own[facet], numbers_of(mesh_, facet, displacement));
  });
}

SparseMatrix ShellSystem::mass() const {
  return assembly_.sum([this](int facet) {
    return facet_mass(facet_of(mesh_, sections_, laws_, facet), rule_);
  });
}

}  // namespace meniscus::shell
