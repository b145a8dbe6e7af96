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

/// The four stages, to be called in this order, once each, with
/// ForwardModel::part() of a model that has not failed. False when the design
/// has failed; evaluation.failure then says why, and those that follow must not
/// be called. Pure but for `staged`; may run in several threads.
bool settle_film(const FrozenPart& part, const VectorX& design,
                 StagedDesign& staged);
bool move_mesh(const FrozenPart& part, StagedDesign& staged);
bool solve_elasticity(const FrozenPart& part, KeepStiffness keep,
                      StagedDesign& staged);
bool compute_responses(const FrozenPart& part, StagedDesign& staged);

/// The first stage with a film that was frozen without elements; `monitor` may
/// be null.
bool settle_film(const case_data::Case& input, const frozen::FilmModel& film,
                 const VectorX& design, Monitor* monitor, StagedDesign& staged);

/// The first two of them for those who want the mesh alone, the same bits as
/// with a model: nothing is solved, but with analysis.adapt, where errors
/// choose the mesh. False, and evaluation.failure why, when there is none.
/// Throws what ForwardModel throws.
bool mesh_design(const case_data::Case& input, const VectorX& design,
                 Monitor* monitor, StagedDesign& staged);

}  // namespace meniscus::forward
