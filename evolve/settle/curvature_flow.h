/// Implicit mean curvature flow at given volumes: what brings a raw, kinked
/// start near to equilibrium, where Newton takes over.
#pragma once

#include <functional>

#include "core/monitor.h"
#include "evolve/energy/energy.h"

namespace meniscus::settle {

struct FlowOptions {
  int max_steps = 30;
  double smoothing = 3.0;       // first step smooths over this many edges
  double energy_change = 1e-4;  // stop: relative change of energy per step,
                                // once places where lines meet are at rest too
  double most_motion = 0.0;     // of a vertex per step [length]; 0: no bound
  bool short_volume_steps = false;  // a step that fails is tried again with
                                    // less of the volume's way, too
  /// Asked after every step; true stops: the film tears.
  std::function<bool(const energy::FilmEnergy&, const Points&)> torn = {};
  Monitor* monitor = nullptr;
};

struct FlowReport {
  int steps = 0;
  bool torn = false;
  bool settled = false;  // volumes reached and the energy at rest
};

/// Steps (M / tau + L) dx = -dE/dx + sum p dV/dx with L the cotangent
/// Laplacian of the current film (Pinkall, Polthier 1993; Desbrun et al.
/// 1999) and pressures such that the volumes come nearer to the targets by at
/// most 15 % a step. tau grows while the energy falls and shrinks otherwise.
/// Vertices move in all directions; facets that thin below 10 degrees are
/// averaged; remesh afterwards. Deterministic.
FlowReport flow_to_rest(films::FilmComplex& complex,
                        const FlowOptions& options);

}  // namespace meniscus::settle
