/// Newton's method on a nested refinement of a film that is settled on its
/// coarser levels: conjugate gradients on the space that keeps volumes and
/// rigid motions (projected, Gould, Hribar, Nocedal 2001), preconditioned by
/// multigrid, and the lowest eigenvalue by LOBPCG (Knyazev 2001).
#pragma once

#include <string>

#include "core/monitor.h"
#include "evolve/settle/multigrid.h"

namespace meniscus::settle {

struct NestedOptions {
  double residual_bound = 0.0;      // [force], max norm in the normal space
  double volume_tolerance = 1e-10;  // relative
  int max_iterations = 12;
  /// Stop earlier, once the residual fell by this factor; 0: go to the bound.
  double reduction = 0.0;
  Monitor* monitor = nullptr;
};

struct NestedResult {
  bool converged = false;
  std::string reason;  // when not converged
  Points points;
  VectorX pressure;  // one per functional
  double residual = 0.0;
  int iterations = 0;         // Newton steps
  int linear_iterations = 0;  // of conjugate gradients, in all
};

struct NestedModes {
  VectorX eigenvalues;           // ascending [force/length^3]
  Eigen::MatrixXd modes;         // one column each, along the directions
  Vec3 position = Vec3::Zero();  // where the lowest is largest
};

class NestedNewton {
 public:
  /// `levels` as for FilmMultigrid; the finest is the film's.
  NestedNewton(const std::vector<FilmLevel>& levels,
               const films::FilmTargets& targets);

  /// From `start` to a minimum near it. `pressure`: guess for the held
  /// functionals, may be empty. Not converged where it meets negative
  /// curvature or the residual does not fall.
  NestedResult run(const Points& start, const VectorX& pressure,
                   const NestedOptions& options);

  /// Lowest modes of the film that run() ended at, from guesses on the
  /// coarsest level (columns); as many as guesses.
  NestedModes lowest_modes(const Eigen::MatrixXd& coarse_guesses);

 private:
  struct Step {
    VectorX heights;
    VectorX pressure;  // of the held ones
    bool positive = true;
    int iterations = 0;
  };
  void evaluate(const Points& points);
  VectorX residual() const;
  double residual_norm(const VectorX& r) const;
  VectorX missing() const;
  bool volumes_hold(double tolerance) const;
  bool refresh();
  VectorX project(VectorX& right, VectorX& multipliers) const;
  Step solve(const VectorX& residual, const VectorX& missing, double factor);

  const energy::FilmEnergy& energy_;
  const films::FilmTargets& targets_;
  FilmMultigrid multigrid_;
  std::vector<int> held_;
  Points points_;
  Points directions_;
  Points slope_;  // of the energy
  std::vector<Points> functional_slope_;
  VectorX gradient_;
  Eigen::MatrixXd functional_;   // dF/dh, one column per functional
  Eigen::MatrixXd constraints_;  // held, then rigid motions
  Eigen::MatrixXd inverse_constraints_;
  Eigen::MatrixXd schur_inverse_;
  VectorX metric_;
  VectorX pressure_;
  VectorX values_;  // of the functionals
};

}  // namespace meniscus::settle
