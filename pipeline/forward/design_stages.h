/// ForwardModel::evaluate() one stage at a time, for those who look at what
/// lies between. evaluate() is these stages: they have the same bits.
#pragma once

#include "pipeline/forward/forward_model.h"

namespace meniscus::forward {

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

  /// The first two of them for those who want the mesh alone, the same bits as
  /// with a model: nothing is solved, but with analysis.adapt, where errors
  /// choose the mesh. What failed is in `staged.evaluation`. Throws what
  /// ForwardModel throws.
  static bool mesh_of(const case_data::Case& input, const VectorX& design,
                      Monitor* monitor, StagedDesign& staged);

 private:
  static bool settle_on(const ForwardModel::Impl& model, const VectorX& design,
                        StagedDesign& staged);
  static bool place_on(const ForwardModel::Impl& model, StagedDesign& staged);

  const ForwardModel& model_;
};

}  // namespace meniscus::forward
