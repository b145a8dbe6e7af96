/// The match of a film to a scan, distance by distance.
#pragma once

#include "optimize/problem.h"
#include "pipeline/case_data/case.h"
#include "pipeline/forward/forward_model.h"
#include "pipeline/responses/scans.h"

namespace meniscus::study {

/// The residuals behind such a response, for least squares: distances over the
/// root of their number, so that the sum of squares is the mean square. Films
/// are settled for themselves; they have the bits of an evaluation's.
class ScanMatch {
 public:
  /// Both must outlive this.
  ScanMatch(const case_data::Case& input, const forward::ForwardModel& model,
            int response);

  VectorX residuals(const VectorX& design);
  /// By every design variable; a film that has no derivatives is a failure.
  optimize::JacobianAnswer jacobian(const VectorX& design);

 private:
  struct Settled {
    VectorX design;
    case_data::EvaluatedCase inputs;
    settle::FilmState film;
    scan::ScanDistances distances;
  };
  const Settled& settled(const VectorX& design);

  const case_data::Case& input_;
  const forward::ForwardModel& model_;
  const case_data::ResponseEntry& response_;
  Settled last_;
};

}  // namespace meniscus::study
