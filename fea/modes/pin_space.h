/// Among which displacements the modes of an eigenvalue problem are, rigid pins
/// or none.
#pragma once

#include <vector>

#include "fea/equations/elastic_operator.h"
#include "fea/solver/multi_vector.h"

namespace meniscus::modes {

/// What supports leave free, the nodes of each pin moving as a rigid body by
/// its motions that are not fixed. It is the sum of two spaces that K makes
/// orthogonal: displacements with the pins' nodes at rest, and what the part
/// does under the unit of each motion, Z of decision 0022. Solver's numbering.
class PinSpace {
 public:
  explicit PinSpace(const equations::ElasticOperator& op);

  bool has_pins() const { return !pins_.empty(); }

  /// Without the pins, whose nodes are free.
  const solver::NodeFreedom& freedom() const { return freedom_; }

  /// Motions of all pins that are not fixed.
  Eigen::Index motions() const { return Z_.cols(); }

  /// Of what keeps to freedom(), the nearest in the space: on a pin's nodes
  /// the nearest rigid motion. Of forces, what does work in it.
  void project(solver::ColumnsOut v) const;

  /// 0 on the pins' nodes.
  void hold(solver::ColumnsOut v) const;

  /// Adds Z (Z^T K Z)^-1 Z^T `forces`: with an inverse on what is left free
  /// where the pins rest, an inverse of K on the space.
  void add_motions(const solver::ColumnsIn& forces,
                   const solver::ColumnsOut& v) const;

 private:
  struct Pin {
    std::vector<int> nodes;
    Eigen::MatrixXd T;  // an orthonormal basis of their motions, 3 a node
  };

  solver::NodeFreedom freedom_;
  std::vector<Pin> pins_;
  solver::Columns Z_;
  Eigen::MatrixXd inverse_;  // of Z^T K Z
};

}  // namespace meniscus::modes
