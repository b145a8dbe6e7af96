#include "fea/shell/shell_system.h"

#include <utility>

#include "core/error.h"
#include "fea/shell/facet_geometric.h"
#include "fea/shell/rigid_rims.h"
#include "fea/shell/shell_held.h"

namespace meniscus::shell {

ShellSystem::ShellSystem(const ShellMesh& mesh,
                         const std::vector<Section>& sections,
                         const std::vector<NodeSupport>& supports,
                         const FacetRule& rule,
                         const ShellFactorOptions& options,
                         const std::vector<GroundSpring>& springs,
                         const std::vector<RigidRim>& rims)
    : mesh_(mesh),
      sections_(sections),
      rule_(rule),
      stiffness_(mesh, sections, rule, springs),
      freedom_(static_cast<int>(mesh.nodes.size()), supports, rims),
      seats_(on_seats(mesh, freedom_)),
      assembly_(seats_, freedom_) {
  check_held(mesh_, freedom_, springs);
  if (freedom_.unknowns() == 0) {
    throw InvalidInput(
        "supports and rigid rims leave no node of the shell free to move; hold "
        "less of it");
  }
  factor_.emplace(seats_, freedom_,
                  seated([this](int facet) { return stiffness_.of(facet); }),
                  options);
}

/// By the numbers of seats.
MatrixOfFacet ShellSystem::seated(MatrixOfFacet matrix) const {
  if (freedom_.rims().empty()) {
    return matrix;
  }
  return [this, matrix = std::move(matrix)](int facet) {
    return on_seats(freedom_, mesh_.facets[facet], matrix(facet));
  };
}

SparseMatrix ShellSystem::stiffness() const {
  return assembly_.sum(
      seated([this](int facet) { return stiffness_.of(facet); }));
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

MatrixOfFacet ShellSystem::geometric_of(const ShellLoads& loads,
                                        const std::vector<FacetLoad>& own,
                                        const VectorX& displacement) const {
  return [&, this](int facet) {
    return facet_geometric(facet_of(mesh_, sections_, stiffness_.laws(), facet),
                           loads, own[facet],
                           numbers_of(mesh_, facet, displacement));
  };
}

MatrixOfFacet ShellSystem::mass_of() const {
  return [this](int facet) {
    return facet_mass(facet_of(mesh_, sections_, stiffness_.laws(), facet),
                      rule_);
  };
}

SparseMatrix ShellSystem::geometric(const ShellLoads& loads,
                                    const VectorX& displacement) const {
  const std::vector<FacetLoad> own = facet_loads(mesh_, loads);
  return assembly_.sum(seated(geometric_of(loads, own, displacement)));
}

SparseMatrix ShellSystem::mass() const {
  return assembly_.sum(seated(mass_of()));
}

VectorX ShellSystem::mass_times(const VectorX& x) const {
  return facets_times(mesh_, mass_of(), x);
}

VectorX ShellSystem::geometric_times(const ShellLoads& loads,
                                     const VectorX& displacement,
                                     const VectorX& x) const {
  const std::vector<FacetLoad> own = facet_loads(mesh_, loads);
  return facets_times(mesh_, geometric_of(loads, own, displacement), x);
}

}  // namespace meniscus::shell
