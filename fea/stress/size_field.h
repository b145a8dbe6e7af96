/// Element sizes that would bring the error down to what is asked.
#pragma once

#include <functional>
#include <memory>
#include <vector>

#include "fea/stress/error_estimate.h"

namespace meniscus::stress {

struct SizeFieldOptions {
  double relative_error = 0.02;  // wanted of EnergyError::relative(); > 0
  double most_refinement = 4.0;  // old edge over new edge, at most; >= 1
  double most_coarsening = 2.0;  // new edge over old edge, at most; >= 1
  double growth = 0.5;           // rise of the edge length per length; > 0
};

/// Edge lengths at the corners of a mesh, changing by no more than `growth`
/// along any edge of it.
struct SizeField {
  Points points;               // the corners [length]
  std::vector<double> length;  // per corner [length]
  double growth = 0.5;
  double elements = 0.0;  // that a mesh of these sizes has, about
  double error = 0.0;     // its energy-norm error, predicted; above what was
                          // asked where most_refinement holds it back

  /// The length at any place: of the nearest corner, plus growth times its
  /// distance. Owns what it needs; safe to call from several threads.
  std::function<double(const Vec3&)> function() const;
};

/// The sizes with the fewest elements whose error is that asked, for an error
/// that falls as h^p in each element, p the element's order (Fuenmayor and
/// Oliver, Criteria to achieve nearly optimal meshes in the h-adaptive finite
/// element method, 1996): in d = 3 dimensions each edge is divided by
/// c |e|^(2 / (2 p + d)). Throws InvalidInput for options out of range.
SizeField size_field(const TetMesh& mesh, const EnergyError& error,
                     const SizeFieldOptions& options = {});

}  // namespace meniscus::stress
