#include "fea/shell/shell_system.h"

#include <cstddef>
#include <utility>

#include "core/error.h"
#include "fea/shell/facet_geometric.h"
#include "fea/shell/rigid_rims.h"
#include "fea/shell/shell_held.h"

namespace meniscus::shell {

ShellSystem::ShellSystem(
    const ShellMesh& mesh, const std::vector<Section>& sections,
    const std::vector<NodeSupport>& supports, const FacetRule& rule,
    const ShellFactorOptions& options, const std::vector<GroundSpring>& springs,
    const std::vector<RigidRim>& rims, const std::vector<ShellLoads>& loads)
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
  Eigen::MatrixXd columns(freedom_.unknowns(), loads.size());
  std::vector<VectorX> forces;
  for (std::size_t k = 0; k < loads.size(); ++k) {
    forces.push_back(nodal_forces(mesh_, sections_, loads[k]));
    columns.col(static_cast<Eigen::Index>(k)) = right_side(forces.back());
  }
  factor_.emplace(seats_, freedom_,
                  seated([this](int facet) { return stiffness_.of(facet); }),
                  options, loads.empty() ? nullptr : &columns);
  for (std::size_t k = 0; k < loads.size(); ++k) {
    solutions_.push_back(
        solution(forces[k], columns.col(static_cast<Eigen::Index>(k))));
  }
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

/// On the unknowns, less what is held elsewhere than at 0.
VectorX ShellSystem::right_side(const VectorX& forces) const {
  const VectorX held = freedom_.held_values();
  return freedom_.restrict(
      held.isZero(0.0) ? forces : VectorX(forces - stiffness_.times(held)));
}

ShellSolution ShellSystem::solution(const VectorX& forces,
                                    const VectorX& x) const {
  ShellSolution solution;
  solution.displacement = freedom_.expand(x);
  const VectorX inner = stiffness_.times(solution.displacement);
  solution.reaction = inner - forces;
  solution.strain_energy = 0.5 * solution.displacement.dot(inner);
  return solution;
}

ShellSolution ShellSystem::solve(const ShellLoads& loads) const {
  const VectorX forces = nodal_forces(mesh_, sections_, loads);
  return solution(forces, factor_->solve(right_side(forces)));
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
