/// The iteration behind settle_along and settle_in_normals.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "core/monitor.h"
#include "evolve/energy/constrained_hessian.h"
#include "evolve/energy/energy.h"

namespace meniscus::settle {

enum class DirectionRule {
  Fixed,          // heights along given directions
  CurrentNormals  // directions are the film's normals, anew at every step
};

enum class NewtonAim {
  Minimum,     // shifts the Hessian until it is positive: runs downhill
  Equilibrium  // full Newton on the residual: ends at saddles as well
};

struct NewtonOptions {
  DirectionRule rule = DirectionRule::Fixed;
  NewtonAim aim = NewtonAim::Minimum;
  double residual_bound = 0.0;  // [force]
  double volume_tolerance = 1e-10;
  int max_iterations = 60;
  Monitor* monitor = nullptr;
};

struct NewtonResult {
  bool converged = false;
  std::string reason;  // when not converged
  Points points;
  VectorX heights;
  VectorX pressure;  // one per functional
  double residual = 0.0;
  int iterations = 0;
  int index = 0;
  double min_eigenvalue = 0.0;
  Vec3 mode_position = Vec3::Zero();  // where the lowest mode is largest
};

class FilmNewton {
 public:
  FilmNewton(const energy::FilmEnergy& energy,
             const films::FilmTargets& targets, const NewtonOptions& options);

  NewtonResult run(const Points& base, const Points& directions,
                   const VectorX& start);

 private:
  struct Trial {
    VectorX heights;
    Points points;
    double energy = 0.0;
    VectorX volume;
  };
  void evaluate();
  VectorX residual_of(const VectorX& pressure) const;
  double residual_norm() const;
  bool volumes_hold() const;
  VectorX missing(const VectorX& volume) const;
  double merit(const Trial& trial, const VectorX& pressure,
               double penalty) const;
  /// Empty, and why in refusal_, where a wall cannot be reached.
  std::optional<Trial> trial_at(const VectorX& heights);
  void compute_hessian();
  bool factorize();
  bool advance();
  bool search_down(const energy::ConstrainedHessian::Step& step,
                   const VectorX& residual);
  bool search_residual(const energy::ConstrainedHessian::Step& step);
  void accept(Trial&& trial);
  void polish(NewtonResult& result);
  double rounding() const;

  const energy::FilmEnergy& energy_;
  const films::FilmTargets& targets_;
  NewtonOptions options_;
  std::vector<int> held_;  // functionals whose value is given
  energy::ConstrainedHessian system_;
  SparseMatrix hessian_;
  Points base_;
  Points directions_;
  energy::FilmPaths paths_;
  Trial now_;
  VectorX gradient_;             // dE/dh
  Eigen::MatrixXd volumes_dh_;   // dV/dh, one column per functional
  Eigen::MatrixXd constraints_;  // held functionals, then rigid motions
  VectorX metric_;
  VectorX pressure_;
  double shift_ = 0.0;
  double base_shift_ = 0.0;
  double last_step_ = 1.0;
  std::string refusal_;  // of a step since the last one that was taken
};

}  // namespace meniscus::settle
