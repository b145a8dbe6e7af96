/// The Hessian of a film on a chain of nested refinements: a V-cycle whose
/// coarse matrices are Galerkin products, gathered facet by facet (each coarse
/// facet sums its four children), and whose smoother is one Gauss-Seidel
/// sweep down and one up, in single precision (Briggs, Henson, McCormick, A
/// Multigrid Tutorial, 2000).
#pragma once

#include <memory>
#include <vector>

#include "core/math/linear_solve.h"
#include "evolve/energy/energy.h"

namespace meniscus::settle {

/// One step of the chain: the energy of a level, and the ends of the edges on
/// which its vertices beyond the coarser level's were born.
struct FilmLevel {
  const energy::FilmEnergy* energy = nullptr;
  std::vector<Edge> parents;  // empty on the coarsest level
};

/// True where facets 4f..4f+3 of `fine` replace facet f of `coarse`.
bool is_nested(const energy::FilmEnergy& coarse, const energy::FilmEnergy& fine,
               const std::vector<Edge>& parents);

class FilmMultigrid {
 public:
  /// `levels`, coarsest first, must outlive this. At least one.
  explicit FilmMultigrid(const std::vector<FilmLevel>& levels);
  ~FilmMultigrid();

  /// Takes the Hessian's elements on the finest level, along `directions`;
  /// `metric`: lumped areas. A multiple of the metric, at least `least_shift`,
  /// is added to the preconditioner (not to multiply()) until it is positive
  /// on the coarsest level. False when it cannot be made so.
  bool refresh(const Points& directions, const std::vector<double>& elements,
               const VectorX& metric, double least_shift);

  /// Hessian x vector.
  VectorX multiply(const VectorX& x) const;
  /// One V-cycle: a symmetric positive approximation of the inverse.
  VectorX precondition(const VectorX& right) const;
  /// A vector of the coarsest level's unknowns on the finest.
  VectorX prolong(const VectorX& coarse) const;
  double shift() const { return shift_; }

 private:
  struct Level;
  void transfer_weights(std::size_t fine);
  void gather(std::size_t fine, const std::vector<double>& fine_elements,
              std::vector<double>& coarse_elements) const;
  bool factor_coarsest(const SparseMatrix& matrix, double least_shift);
  void cycle(std::size_t level) const;

  std::vector<FilmLevel> chain_;
  std::vector<std::unique_ptr<Level>> levels_;
  std::unique_ptr<SymmetricFactor> coarsest_;
  std::vector<double> fine_values_;  // of the finest level's full matrix
  double shift_ = 0.0;
};

}  // namespace meniscus::settle
