/// The motions of the paper (Swanson, Brakke, Breen 2009) and of Surface
/// Evolver: gradient descent with the best scale, and conjugate gradients.
/// Slow beside Newton's method and kept for those who want them by name: every
/// step lowers the energy.
#pragma once

#include <optional>

#include "core/monitor.h"
#include "evolve/energy/energy.h"

namespace meniscus::settle {

enum class DescentMethod {
  Gradient,           // along minus the gradient in the metric
  ConjugateGradients  // Polak, Ribiere 1969, restarted where it would climb
};

enum class DescentMetric {
  LumpedArea,  // motion = force per area: does not depend on the triangles
  Unit         // motion = force, as Surface Evolver moves vertices
};

struct DescentOptions {
  DescentMethod method = DescentMethod::Gradient;
  DescentMetric metric = DescentMetric::LumpedArea;
  int max_steps = 1000;
  /// Of the energy and the volumes, line searches included; where films are bad
  /// a step takes hundreds. 0: no limit.
  long max_evaluations = 0;
  double residual_bound = 0.0;      // [force], max norm along the directions
  double volume_tolerance = 1e-10;  // relative, restored after every step
  // Volumes that are off at the start are approached by heights of at most
  // this [length] and then held; 0: held as they are. Empty: brought to their
  // targets.
  std::optional<double> most_restore;
  Monitor* monitor = nullptr;
};

struct DescentReport {
  bool converged = false;
  int steps = 0;
  long evaluations = 0;
  std::vector<double> energies;  // at the start and after every step
  double residual = 0.0;         // [force]
  double scale = 0.0;            // the last one: motion / (force in the metric)
  VectorX pressure;              // one per functional
  std::string message;
};

/// Moves `points` by heights along fixed `directions` (one per unknown)
/// downhill at the targets' volumes and pressures. The scale of each step is
/// doubled or halved until the energy is bracketed, then taken at the minimum
/// of the parabola through three points. Stops where no scale lowers the
/// energy beyond rounding. Throws Interrupted with `points` where the descent
/// was.
DescentReport descend(const energy::FilmEnergy& energy,
                      const films::FilmTargets& targets,
                      const Points& directions, Points& points,
                      const DescentOptions& options);

}  // namespace meniscus::settle
