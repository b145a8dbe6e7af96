/// ForwardModel::evaluate() one stage at a time, for those who look at what
/// lies between. evaluate() is these stages: they have the same bits.
#pragma once

#include "pipeline/forward_model.h"

namespace meniscus {

/// What the stages of one design have left so far.
struct StagedDesign {
  Evaluation evaluation;
  EvaluationFields fields;  // but for film and boundary, which are
                            // FilmModel::fine_mesh() and boundary()
  AdjointState adjoint;
};

/// The solve leaves the stiffness behind, for gradients, or it does not.
enum class KeepStiffness { No, Yes };

class DesignStages {
 public:
  /// `model` must not have failed and must outlive this.
  explicit DesignStages(const ForwardModel& model);

  /// The four stages, to be called in this order, once each. False when the
  /// design has failed; evaluation.failure then says why, and those that follow
  /// must not be called. Pure but for `staged`; may run in several threads.
  bool settle(const VectorX& design, StagedDesign& staged) const;
  bool place_mesh(StagedDesign& staged) const;  // surface and elements
  bool solve(StagedDesign& staged, KeepStiffness keep) const;
  bool respond(StagedDesign& staged) const;

 private:
  const ForwardModel& model_;
};

}  // namespace meniscus
