/// The exact gradient of responses by the design variables: the adjoint of
/// ForwardModel::evaluate(), stage by stage backwards (docs/theory.md).
#pragma once

#include <functional>
#include <optional>
#include <vector>

#include "mesh_tet/quadratic.h"
#include "pipeline/case_data/case.h"
#include "pipeline/forward/responses.h"

namespace meniscus::forward {

/// Rows are responses, columns design variables.
struct DesignGradient {
  Eigen::MatrixXd jacobian;
  int solves = 0;  // adjoint ones
  double seconds = 0.0;
  std::optional<Failure> failure;  // an adjoint solve did not converge
};

/// Derivatives of a response by what makes the part's surface.
struct SurfaceGradient {
  Points film;        // by the film's vertices
  VectorX thickness;  // by the walls' thickness; empty without walls
};

/// The evaluated design, on loan.
struct GradientInput {
  const case_data::Case& input;
  const ResponseInput& fields;
  const VectorX& responses;  // their values
  const elastic::ElasticModel& elasticity;
  const equations::ElasticState& elastic_state;
  /// From a gradient by all nodes of the mesh to what the surface was made
  /// from.
  std::function<SurfaceGradient(const Points&)> to_film;
};

/// `wanted`: indices of responses, a row each. Costs one linear solve per
/// wanted response that depends on displacements (none for compliance), and
/// next to nothing per design variable. The same bits for any number of
/// threads. Throws InvalidInput for responses without derivatives, and where
/// an expression of the case has none.
DesignGradient design_gradient(const GradientInput& input,
                               const std::vector<int>& wanted);

}  // namespace meniscus::forward
