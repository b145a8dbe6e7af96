/// The stiffness of a part that supports need not hold, made positive definite
/// by a multiple of its mass. Springs count for nothing there: however soft
/// they are, their matrix stays well conditioned.
#pragma once

#include <memory>
#include <vector>

#include "fea/equations/elastic_operator.h"
#include "fea/solver/corner_mesh.h"
#include "fea/solver/multigrid.h"
#include "fea/supports/restraints.h"

namespace meniscus::modes {

class ShiftedSystem {
 public:
  /// `held`: its supports and springs count, its loads do not. Throws
  /// InvalidInput (arrays, materials, surfaces, no density anywhere) and
  /// MeshError (inverted element).
  ShiftedSystem(const TetMesh& mesh,
                const std::vector<element::Material>& materials,
                const loads::LoadCase& held);

  /// K + shift() M; must not outlive this.
  const equations::ElasticOperator& shifted() const { return operator_; }

  /// 0 where supports hold all parts [1/time^2].
  double shift() const { return shift_; }

  /// The rigid motions that supports leave, one a column, solver's numbering.
  const Eigen::MatrixXd& free_motions() const { return motions_; }

  /// Of these, how many the springs leave too.
  int unsprung_motions() const { return unsprung_; }

 private:
  void assemble_shifted(const TetMesh& mesh, const loads::LoadCase& held);
  void build_preconditioner(const TetMesh& mesh, const loads::LoadCase& held);

  std::vector<element::Material> materials_;
  std::vector<double> density_;
  solver::NodeOrder order_;
  solver::ElementTable table_;
  supports::Restraints restraints_;
  Eigen::MatrixXd motions_;
  int unsprung_ = 0;
  double shift_ = 0.0;
  equations::ElasticOperator operator_;
  // Of multigrid:
  solver::SmootherMatrix smoother_;
  solver::SmootherMatrix corner_smoother_;
  solver::CornerMesh corners_;
  std::unique_ptr<solver::Preconditioner> preconditioner_;
};

}  // namespace meniscus::modes
