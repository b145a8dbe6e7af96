/// Spines: middle lines along which a liquid is held, so that arms of any
/// length stand where a film under tension alone falls apart (docs/theory.md,
/// Spines).
#pragma once

#include <array>
#include <string>
#include <vector>

#include "core/types.h"

namespace meniscus::films {

struct SpineSpec {
  std::string name;
  std::string body;    // of the liquid that it holds
  Points points;       // along it, two or more [length]
  bool smooth = true;  // a cubic through them, periodic where the last is the
                       // first; else straight pieces
  std::vector<double> radii;  // of a straight arm, one per point, > 0
  double tension = 1.0;       // of the film that rests there, > 0
};

/// A point of a spine as fixed weights of the spine's own points: what does
/// not change with the design.
struct SpineSample {
  VectorX place;        // of the points: c(u)
  VectorX slope;        // of the points: dc/du
  VectorX radius;       // of the radii
  double step = 0.0;    // of u; beyond an end: in radii
  double beyond = 0.0;  // how far beyond the last point (below 0: the first),
                        // along the tangent there [radii]
};

/// Where a spine is sampled.
struct SpineSampling {
  std::string name;                 // of the spine
  int body = 0;                     // index
  std::array<bool, 2> beyond = {};  // does it go on past its first, last point
  bool closed = false;              // its last point is its first
  std::vector<SpineSample> samples;
};

/// A point that attracts liquid: energy per volume of its body
///   - strength (|x - at|^2 + core2)^(-5/2).
struct Pole {
  Vec3 at = Vec3::Zero();  // [length]
  double strength = 0.0;   // [force length^3]
  double core2 = 1.0;      // square of the core, > 0 [length^2]
};

}  // namespace meniscus::films
