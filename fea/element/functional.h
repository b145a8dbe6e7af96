/// A number of a mesh and of the displacement on it, with its partial
/// derivatives: what the adjoint method starts from (docs/theory.md).
#pragma once

#include <vector>

#include "core/types.h"

namespace meniscus::element {

enum class Derivatives { None, All };

struct Functional {
  double value = 0.0;
  /// By node positions, the displacement held: one per node [value/length].
  Points by_nodes;
  /// By the displacement, the nodes held: 3 per node [value/length]. Empty
  /// where the displacement has no part in the number.
  VectorX by_displacement;
  /// By the load case's temperature at each node, nodes and displacement held
  /// [value/temperature]. Empty without a temperature; what its field changes
  /// where nodes move is in by_nodes already.
  VectorX by_temperature;
  /// By Young's modulus of each region, nodes and displacement held
  /// [value/pressure]; 0 for orthotropic ones. Empty where it has no part.
  std::vector<double> by_modulus;
};

/// Of a number that depends on a direction, too. The direction may have any
/// length but 0: it is made unit.
struct DirectedFunctional : Functional {
  Vec3 by_direction = Vec3::Zero();  // by the direction as given [value/length]
};

}  // namespace meniscus::element
