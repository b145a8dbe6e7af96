/// K u = f of solids and the shells that are tied to them: one matrix on the
/// unknowns of both, factored.
///
/// Vectors have the solid's 3 numbers per node and behind them the shell's 6.
/// With T the tie, which makes tied edges' numbers of the solid's, the matrix
/// is K_solid + T^T K_shell T.
#pragma once

#include <optional>
#include <vector>

#include "core/geometry/tet_mesh.h"
#include "core/math/linear_solve.h"
#include "fea/element/elastic_law.h"
#include "fea/element/material.h"
#include "fea/joint/edge_tie.h"
#include "fea/joint/tie_motion.h"
#include "fea/loads/load_case.h"
#include "fea/shell/shell_stiffness.h"
#include "fea/shell/shell_supports.h"
#include "fea/solver/assembly.h"
#include "fea/solver/free_matrix.h"
#include "fea/solver/node_order.h"
#include "fea/supports/restraints.h"

namespace meniscus::joint {

class JointSystem {
 public:
  /// `held`: what supports and springs the solid has, nothing enforced and no
  /// pins; `supports`: of the shell, of which those at tied nodes are left out,
  /// for these follow the solid. All but `held`, `supports` and `materials` are
  /// kept by reference. Throws MeshError and InvalidInput as their makers do,
  /// SolverError where something is free to move, or memory runs out.
  JointSystem(const TetMesh& solid,
              const std::vector<element::Material>& materials,
              const loads::LoadCase& held, const shell::ShellMesh& mesh,
              const std::vector<shell::Section>& sections,
              const std::vector<shell::NodeSupport>& supports,
              const EdgeTie& tie);

  int unknowns() const { return start_ + shell_.unknowns(); }

  /// u of forces on both; held ones are 0.
  VectorX solve(const VectorX& forces) const;

  /// What is left over, K u - f of both before they are tied: at free nodes of
  /// the shell 0, at tied ones what the solid holds them with. The solid's has
  /// that added, so that it is 0 where nothing holds the solid.
  VectorX residual(const VectorX& u, const VectorX& forces) const;

  /// The solid's part of a residual along directions that are held: reactions.
  VectorX reactions(const VectorX& residual) const;
  /// The largest of what should be 0 in a residual, over the size of `forces`.
  double imbalance(const VectorX& residual, const VectorX& forces) const;

 private:
  struct Column;
  void assemble_solid();
  std::vector<Column> columns_of(int shell_node) const;
  SparseMatrix shell_matrix() const;
  VectorX restrict(const VectorX& both) const;
  VectorX to_solid(const VectorX& shell_forces) const;

  const TetMesh& solid_;
  const shell::ShellMesh& mesh_;
  std::vector<element::ElasticLaw> laws_;
  shell::ShellStiffness stiffness_;
  std::vector<TieRow> rows_;
  std::vector<int> row_of_;  // per node of the shell; -1: not tied
  solver::NodeOrder order_;
  solver::ElementTable table_;
  Points x_;  // of solver's nodes
  supports::Restraints restraints_;
  solver::FreeUnknowns free_;
  shell::ShellFreedom shell_;
  int start_ = 0;  // first unknown of the shell
  std::optional<SymmetricFactor> factor_;
};

}  // namespace meniscus::joint
