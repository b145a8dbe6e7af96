/// A film's constrained Hessian at one place, factored: what stability, margins
/// and adjoints ask of a film that stands still.
#pragma once

#include <vector>

#include "evolve/energy/constrained_hessian.h"
#include "evolve/energy/energy.h"

namespace meniscus::energy {

class SaddleSystem {
 public:
  /// At `points`, along `paths`, under `pressure` (one per functional).
  /// `energy` must outlive this.
  SaddleSystem(const FilmEnergy& energy, const films::FilmTargets& targets,
               const Points& points, const FilmPaths& paths,
               const VectorX& pressure);

  /// False: the Hessian is not finite; nothing below may then be asked.
  bool factored() const { return factored_; }
  /// Functionals whose value is given.
  const std::vector<int>& held() const { return held_; }
  const ConstrainedHessian& system() const { return system_; }
  const SparseMatrix& hessian() const { return hessian_; }
  /// Gradients of the held functionals along the directions, then rigid
  /// motions.
  const Eigen::MatrixXd& constraints() const { return constraints_; }
  const VectorX& metric() const { return metric_; }  // lumped area
  /// Gradient of every functional by all vertices.
  const std::vector<Points>& functional_slopes() const { return slopes_; }

  /// ConstrainedHessian::solve, refined until nothing is left but rounding.
  ConstrainedHessian::Step solve(const VectorX& residual,
                                 const VectorX& missing) const;

 private:
  std::vector<int> held_;
  std::vector<Points> slopes_;
  VectorX metric_;
  Eigen::MatrixXd constraints_;
  SparseMatrix hessian_;
  ConstrainedHessian system_;
  bool factored_ = false;
};

}  // namespace meniscus::energy
