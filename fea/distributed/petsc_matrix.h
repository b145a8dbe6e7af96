/// The stiffness matrix of one group of load cases, its rows spread over the
/// processes.
#pragma once

#include <petscmat.h>

#include "fea/distributed/petsc_piece.h"

namespace meniscus::distributed::petsc {

/// Throws std::runtime_error unless `error` is none; PETSc has printed it.
void check(PetscErrorCode error);

/// Owns an AIJ matrix with blocks of 3 whose rows are the piece's own nodes,
/// preallocated exactly: GAMG of PETSc 3.18 refuses block formats.
class StiffnessMatrix {
 public:
  explicit StiffnessMatrix(const Piece& piece);
  ~StiffnessMatrix();
  StiffnessMatrix(const StiffnessMatrix&) = delete;
  StiffnessMatrix& operator=(const StiffnessMatrix&) = delete;

  /// P (K + S) P + s (I - P), P the projector onto free directions, s a held
  /// node's own stiffness.
  void assemble(const PieceGroup& group);

  Mat get() const { return matrix_; }

 private:
  template <int Nodes>
  void add_elements();
  void add_springs(const PieceGroup& group);
  void add_held(const PieceGroup& group);

  const Piece& piece_;
  std::vector<PetscInt> id_;  // of local nodes in the whole part
  Mat matrix_ = nullptr;
  const double* projector_ = nullptr;  // the group's
  std::vector<int> held_;              // per local node: which, or -1
  std::vector<double> own_stiffness_;  // per held node
};

}  // namespace meniscus::distributed::petsc
