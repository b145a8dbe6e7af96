/// The parts of ElasticModel: what a base design fixes once, and the solve.
#pragma once

#include <memory>
#include <optional>
#include <vector>

#include "fea/equations/elastic_base.h"
#include "fea/equations/elastic_operator.h"
#include "fea/equations/elastic_solution.h"
#include "fea/equations/kept_state.h"
#include "fea/equations/pin_motions.h"
#include "fea/solver/assembly.h"
#include "fea/solver/multigrid.h"
#include "fea/solver/preconditioner.h"

namespace meniscus::equations {

class ElasticSystem {
 public:
  /// Checks the input, orders the mesh, assembles the base's stiffness into
  /// `matrix` and builds the preconditioners from it.
  ElasticSystem(const TetMesh& base,
                const std::vector<element::Material>& materials,
                const std::vector<loads::LoadCase>& load_cases,
                const ElasticOptions& options,
                solver::BlockMatrix<double>& matrix);

  const ElasticBase& base() const { return base_; }

  /// The stiffness of `mesh`, or why there is none.
  std::optional<Failure> assemble(const TetMesh& mesh,
                                  const std::vector<element::ElasticLaw>& laws,
                                  solver::BlockMatrix<double>& matrix) const;

  /// Solves all load cases; `start`: a solution to begin from, or null.
  /// `solved`, if not null, is given what keep() takes.
  ElasticSolution solve(const TetMesh& mesh,
                        const std::vector<loads::LoadCase>& load_cases,
                        const RegionMaterials& regions,
                        const solver::BlockMatrix<double>& matrix,
                        const ElasticSolution* start,
                        std::vector<SolvedGroup>* solved = nullptr) const;

  /// What adjoints need of a design that was solved.
  KeptState keep(const TetMesh& mesh,
                 const std::vector<loads::LoadCase>& load_cases,
                 std::vector<element::ElasticLaw> laws,
                 solver::BlockMatrix<double> matrix,
                 std::vector<SolvedGroup> solved) const;

  /// See ElasticModel::operator_at().
  ElasticOperator operator_at(
      const TetMesh& mesh, const std::vector<loads::LoadCase>& load_cases,
      int load_case, const std::vector<element::Material>* materials) const;

 private:
  /// Load cases that are held alike share a preconditioner.
  struct Group {
    std::vector<int> cases;
    supports::Restraints restraints;  // at the base
    // With springs; else the shared ones serve.
    std::unique_ptr<solver::SmootherMatrix> smoother;
    std::unique_ptr<solver::SmootherMatrix> corner_smoother;
    std::unique_ptr<solver::Preconditioner> preconditioner;
  };

  /// What the preconditioners point to; its address never changes.
  struct Shared {
    solver::ElementTable table;
    solver::SmootherMatrix smoother;
    // Of ten-node elements:
    solver::BlockPattern corner_pattern;
    solver::SmootherMatrix corner_smoother;
    solver::CornerMap map;
  };

  void order_mesh(const TetMesh& base);
  void group_supports(const TetMesh& base,
                      const std::vector<loads::LoadCase>& load_cases);
  void build_multigrid(const TetMesh& base,
                       const std::vector<loads::LoadCase>& load_cases,
                       const solver::BlockMatrix<double>& matrix);
  solver::CornerMesh build_corners(const TetMesh& base,
                                   solver::BlockMatrix<double>& matrix);
  void build_preconditioners(const TetMesh& base,
                             const std::vector<loads::LoadCase>& load_cases,
                             const solver::BlockMatrix<double>& matrix);
  /// What the groups of one design share.
  struct Design {
    const TetMesh& mesh;
    const std::vector<loads::LoadCase>& load_cases;
    const std::vector<element::ElasticLaw>& laws;
    const ElasticSolution* start;  // or null
    Points x;                      // of solver's nodes [length]
    std::vector<VectorX> f;        // of all load cases [force]
  };
  /// Of the preconditioners (HeldEquations).
  int patience() const;
  PinMotions solve_group(const Design& design, const std::vector<int>& cases,
                         const solver::BlockMatrix<double>& matrix,
                         HeldSolver& solver, ElasticSolution& result) const;

  ElasticBase base_;
  std::unique_ptr<Shared> shared_;
  std::vector<Group> groups_;
  bool multigrid_ = false;
};

}  // namespace meniscus::equations
