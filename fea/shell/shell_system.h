/// K u = f of one shell: factored, solved.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "core/math/linear_solve.h"
#include "fea/shell/facet_loads.h"
#include "fea/shell/shell_assembly.h"
#include "fea/shell/shell_factor.h"
#include "fea/shell/shell_loads.h"
#include "fea/shell/shell_mesh.h"
#include "fea/shell/shell_stiffness.h"
#include "fea/shell/shell_supports.h"

namespace meniscus::shell {

struct ShellSolution {
  VectorX displacement;  // 6 per node: displacement, rotation [length], [rad]
  VectorX reaction;      // 6 per node: force, moment of what holds it, but
                         // for springs
  double strain_energy =
      0.0;  // u . K u / 2, with that of springs; of loads of temperature
            // without what free expansion would store
};

/// Stiffness with its factor for any number of load cases. Mesh and sections
/// are kept by reference.
class ShellSystem {
 public:
  /// Throws MeshError and InvalidInput as check_shell(), laminate_law() and
  /// ShellFreedom, or ShellStiffness of the springs, do; SolverError where
  /// something is free to move, or memory runs out.
  ShellSystem(const ShellMesh& mesh, const std::vector<Section>& sections,
              const std::vector<NodeSupport>& supports,
              const FacetRule& rule = facet_rule(),
              const ShellFactorOptions& options = {},
              const std::vector<GroundSpring>& springs = {},
              const std::vector<RigidRim>& rims = {},
              const std::vector<ShellLoads>& loads = {});

  /// Of the loads that it was made with: all at once and with the factor, for
  /// less than solve() takes where the shell is large.
  const std::vector<ShellSolution>& solutions() const { return solutions_; }

  ShellSolution solve(const ShellLoads& loads) const;

  /// Solves for loads of the caller's, 6 per node; what is held is held at 0:
  /// the adjoint of a functional's derivative.
  VectorX solve_forces(const VectorX& forces) const;

  /// K u of all nodes, 6 numbers each, as `u` has.
  VectorX stiffness_times(const VectorX& u) const {
    return stiffness_.times(u);
  }

  const ShellFreedom& freedom() const { return freedom_; }
  const ShellFactor& factor() const { return *factor_; }
  /// Stiffness on the unknowns, lower triangle; assembled anew.
  SparseMatrix stiffness() const;
  /// Mass on the same unknowns.
  SparseMatrix mass() const;
  /// Geometric stiffness (facet_geometric.h) of a solution under its loads, on
  /// the same unknowns: K x = -lambda K_g x at the factor lambda of the loads
  /// under which the shell buckles.
  SparseMatrix geometric(const ShellLoads& loads,
                         const VectorX& displacement) const;

  /// M x and K_g x of all nodes, 6 numbers each, as `x` has.
  VectorX mass_times(const VectorX& x) const;
  VectorX geometric_times(const ShellLoads& loads, const VectorX& displacement,
                          const VectorX& x) const;

 private:
  MatrixOfFacet mass_of() const;
  /// `own`: the loads' facets, on loan.
  MatrixOfFacet geometric_of(const ShellLoads& loads,
                             const std::vector<FacetLoad>& own,
                             const VectorX& displacement) const;
  MatrixOfFacet seated(MatrixOfFacet matrix) const;
  VectorX right_side(const VectorX& forces) const;
  ShellSolution solution(const VectorX& forces, const VectorX& x) const;

  const ShellMesh& mesh_;
  const std::vector<Section>& sections_;
  const FacetRule& rule_;
  ShellStiffness stiffness_;
  ShellFreedom freedom_;
  ShellMesh seats_;  // the mesh on them
  ShellAssembly assembly_;
  std::optional<ShellFactor> factor_;
  std::vector<ShellSolution> solutions_;
};

}  // namespace meniscus::shell
