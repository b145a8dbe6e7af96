#include "fea/distributed/petsc_solve.h"

#include <algorithm>
#include <cmath>
#include <petscksp.h>

namespace meniscus::distributed::petsc {

namespace {

/// What the convergence test needs; its address stays with the solver.
struct Progress {
  Vec f = nullptr;
  double tolerance = 0.0;
  double error = 0.0;  // latest
};

/// u . f is the energy u . A u of a solution; steps only add to it.
PetscErrorCode has_converged(KSP solver, PetscInt /*step*/, PetscReal norm,
                             KSPConvergedReason* reason, void* context) {
  auto& progress = *static_cast<Progress*>(context);
  Vec u = nullptr;
  PetscScalar energy = 0.0;
  PetscFunctionBeginUser;
  PetscCall(KSPGetSolution(solver, &u));
  PetscCall(VecDot(u, progress.f, &energy));
  *reason = KSP_CONVERGED_ITERATING;
  progress.error = energy > 0.0 ? norm / std::sqrt(energy) : HUGE_VAL;
  if (!std::isfinite(norm)) {
    *reason = KSP_DIVERGED_NANORINF;
  } else if (progress.error <= progress.tolerance) {
    *reason = KSP_CONVERGED_RTOL;
  }
  PetscFunctionReturn(0);
}

void default_option(const char* name, const char* value) {
  PetscBool given = PETSC_FALSE;
  check(PetscOptionsHasName(nullptr, nullptr, name, &given));
  if (given == PETSC_FALSE) {
    check(PetscOptionsSetValue(nullptr, name, value));
  }
}

/// Plain aggregation in W-cycles: smoothed aggregation needs fewer iterations,
/// but PETSc's product P^T A P then takes twice the memory of A, in two
/// processes more each than in one alone. In one process that product knows
/// no way of its own to save memory.
void choose_multigrid(bool alone) {
  default_option("-pc_gamg_agg_nsmooths", "0");
  default_option("-pc_mg_cycle_type", "w");
  default_option("-pc_gamg_coarse_eq_limit", "1000");
  if (!alone) {
    default_option("-matptap_via", "allatonce");
  }
}

CaseEnd end_of(KSPConvergedReason reason) {
  if (reason > 0) {
    return CaseEnd::Converged;
  }
  switch (reason) {
    case KSP_DIVERGED_ITS:
      return CaseEnd::TooManyIterations;
    case KSP_DIVERGED_INDEFINITE_PC:
    case KSP_DIVERGED_INDEFINITE_MAT:
    case KSP_DIVERGED_PC_FAILED:
    case KSP_DIVERGED_BREAKDOWN:
      return CaseEnd::NotPositive;
    default:
      return CaseEnd::NotFinite;
  }
}

double now() { return MPI_Wtime(); }

class Solver {
 public:
  explicit Solver(const Piece& piece);
  ~Solver();
  Solver(const Solver&) = delete;
  Solver& operator=(const Solver&) = delete;

  SolvedPiece run();

 private:
  void attach_rigid_motions();
  SolvedColumn solve_case(const PieceGroup& group, std::size_t c);
  /// `values` of own nodes, held directions taken off.
  void fill(Vec vector, const PieceGroup& group,
            const std::vector<double>& values);
  std::vector<double> values_of(Vec vector) const;
  /// P v on held nodes.
  void project(const PieceGroup& group, double* v) const;

  const Piece& piece_;
  StiffnessMatrix matrix_;
  KSP solver_ = nullptr;
  Vec f_ = nullptr;
  Vec u_ = nullptr;
  Progress progress_;
};

Solver::Solver(const Piece& piece) : piece_(piece), matrix_(piece) {
  choose_multigrid(piece.header.processes == 1);
  check(MatCreateVecs(matrix_.get(), &u_, &f_));
  attach_rigid_motions();
  check(KSPCreate(PETSC_COMM_WORLD, &solver_));
  check(KSPSetType(solver_, KSPCG));
  check(KSPSetNormType(solver_, KSP_NORM_NATURAL));
  progress_ = {.f = f_, .tolerance = piece.header.tolerance};
  check(KSPSetConvergenceTest(solver_, has_converged, &progress_, nullptr));
  check(KSPSetTolerances(solver_, piece.header.tolerance, PETSC_DEFAULT,
                         PETSC_DEFAULT,
                         static_cast<PetscInt>(piece.header.max_iterations)));
  PC preconditioner = nullptr;
  check(KSPGetPC(solver_, &preconditioner));
  check(PCSetType(preconditioner, PCGAMG));
  check(KSPSetFromOptions(solver_));
}

Solver::~Solver() {
  static_cast<void>(KSPDestroy(&solver_));
  static_cast<void>(VecDestroy(&f_));
  static_cast<void>(VecDestroy(&u_));
}

void Solver::attach_rigid_motions() {
  Vec x = nullptr;
  check(VecDuplicate(u_, &x));
  double* values = nullptr;
  check(VecGetArray(x, &values));
  std::copy_n(piece_.x.data(), 3 * piece_.header.own, values);
  check(VecRestoreArray(x, &values));
  MatNullSpace motions = nullptr;
  check(MatNullSpaceCreateRigidBody(x, &motions));
  check(MatSetNearNullSpace(matrix_.get(), motions));
  check(MatNullSpaceDestroy(&motions));
  check(VecDestroy(&x));
}

void Solver::project(const PieceGroup& group, double* v) const {
  using RowMat3 = Eigen::Matrix<double, 3, 3, Eigen::RowMajor>;
  for (std::size_t h = 0; h < group.held.size(); ++h) {
    if (group.held[h] < piece_.header.own) {
      Eigen::Map<Vec3> at(v + 3L * group.held[h]);
      at = (Eigen::Map<const RowMat3>(group.projector.data() + 9 * h) * at)
               .eval();
    }
  }
}

void Solver::fill(Vec vector, const PieceGroup& group,
                  const std::vector<double>& values) {
  double* at = nullptr;
  check(VecGetArray(vector, &at));
  std::copy(values.begin(), values.end(), at);
  project(group, at);
  check(VecRestoreArray(vector, &at));
}

std::vector<double> Solver::values_of(Vec vector) const {
  const double* at = nullptr;
  check(VecGetArrayRead(vector, &at));
  std::vector<double> values(at, at + 3 * piece_.header.own);
  check(VecRestoreArrayRead(vector, &at));
  return values;
}

SolvedColumn Solver::solve_case(const PieceGroup& group, std::size_t c) {
  SolvedColumn column;
  fill(f_, group, group.force[c]);
  double load = 0.0;
  check(VecNorm(f_, NORM_INFINITY, &load));
  check(VecZeroEntries(u_));
  if (load > 0.0) {  // else all of it is on held directions
    if (group.start) {
      fill(u_, group, group.displacement[c]);
    }
    check(KSPSetInitialGuessNonzero(solver_,
                                    group.start ? PETSC_TRUE : PETSC_FALSE));
    check(KSPSolve(solver_, f_, u_));
    KSPConvergedReason reason = KSP_CONVERGED_ITERATING;
    PetscInt steps = 0;
    check(KSPGetConvergedReason(solver_, &reason));
    check(KSPGetIterationNumber(solver_, &steps));
    column.result = {
        .end = end_of(reason), .iterations = steps, .error = progress_.error};
  }
  column.u = values_of(u_);
  project(group, column.u.data());
  return column;
}

SolvedPiece Solver::run() {
  SolvedPiece result;
  Vec diagonal = nullptr;
  check(VecDuplicate(u_, &diagonal));
  for (const PieceGroup& group : piece_.groups) {
    const double begin = now();
    matrix_.assemble(group);
    check(KSPSetOperators(solver_, matrix_.get(), matrix_.get()));
    check(KSPSetUp(solver_));
    const double ready = now();
    SolvedGroup solved;
    for (std::size_t c = 0; c < group.force.size(); ++c) {
      solved.columns.push_back(solve_case(group, c));
    }
    check(MatGetDiagonal(matrix_.get(), diagonal));
    solved.diagonal = values_of(diagonal);
    result.groups.push_back(std::move(solved));
    result.setup_seconds += ready - begin;
    result.solve_seconds += now() - ready;
  }
  check(VecDestroy(&diagonal));
  return result;
}

}  // namespace

SolvedPiece solve_piece(const Piece& piece) { return Solver(piece).run(); }

}  // namespace meniscus::distributed::petsc
