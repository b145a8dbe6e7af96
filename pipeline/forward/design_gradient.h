/// The exact gradient of responses by the design variables: the adjoint of
/// ForwardModel::evaluate(), stage by stage backwards (docs/theory.md).
#pragma once

#include <optional>
#include <vector>

#include "pipeline/case_data/case.h"
#include "pipeline/responses/responses.h"

namespace meniscus::forward {

/// Rows are responses, columns design variables.
struct DesignGradient {
  Eigen::MatrixXd jacobian;
  int solves = 0;  // adjoint ones
  double seconds = 0.0;
  std::optional<Failure> failure;  // an adjoint solve did not converge
};

struct FrozenPart;

/// The evaluated design, on loan but for the context.
struct GradientInput {
  const FrozenPart& part;
  responses::ResponseContext context;
  const VectorX& responses;  // their values
  const equations::ElasticState& elastic_state;
};

/// `responses`: indices, a row each. Costs one linear solve per response that
/// depends on displacements (none for compliance), and
/// next to nothing per design variable. The same bits for any number of
/// threads. Throws InvalidInput for responses without derivatives, and where
/// an expression of the case has none.
DesignGradient design_gradient(const GradientInput& input,
                               const std::vector<int>& responses);

}  // namespace meniscus::forward
