/// The finite elements' own part of the error of an evaluated design.
#pragma once

#include <optional>

#include "core/error.h"
#include "pipeline/forward/forward_model.h"

namespace meniscus::forward {

/// It knows nothing of the errors of films and of the meshed surface.
struct ElementErrors {
  double energy = 0.0;  // relative error in energy, of the worst load case
  /// Per response: what it would change by if the elements were exact, in its
  /// units; of max_von_mises, what its largest reading (peak_stress.h) is above
  /// it; of smooth extremes (thickness, distance, gap), what they are beside
  /// the sharp one; not a number where there is no estimate (von_mises_ks).
  VectorX responses;
  /// Per element: its share of all these errors, the mean over load cases (in
  /// energy) and responses; the sum is 1, or 0 where there is no error.
  std::vector<double> share;
  std::optional<Failure> failure;  // a dual solution's; then the rest is void
};

/// By recovered stresses, and dual weighting (fea/stress/error_estimate.h) of
/// what depends on displacements: one more solution per response, none for a
/// compliance; expressions by what they are made of. `responses`: their values;
/// `model`: the elasticity that solved `fields`, whose stresses must be there.
ElementErrors estimate_element_errors(const case_data::Case& input,
                                      const EvaluationFields& fields,
                                      const VectorX& responses,
                                      const elastic::ElasticModel& model);

}  // namespace meniscus::forward
