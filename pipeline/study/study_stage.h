/// A study on one frozen model, from its initial design to its answer without
/// files or errors (internal to run_study()).
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "pipeline/store/refreeze.h"
#include "pipeline/study/design_evaluator.h"
#include "pipeline/study/match_targets.h"
#include "pipeline/study/run_kind.h"
#include "pipeline/study/study.h"

namespace meniscus::study {

struct StageModel {
  std::string name = store::kStudyModel;  // in the database
  double edge_factor = 1.0;               // as in ForwardModelOptions
  /// Responses that a match's residuals are measured by; none: those of the
  /// initial design.
  std::optional<VectorX> reference = {};
};

class StudyStage {
 public:
  /// Freezes the model and evaluates the initial design. All references must
  /// outlive the stage; throws what ForwardModel's constructor throws.
  StudyStage(const case_data::Case& input, store::StudyStore& store,
             const StudyOptions& options, const StageModel& model = {});

  /// Why it cannot begin; then nothing below may be asked but evaluator().
  const std::optional<Failure>& failure() const { return failure_; }
  /// The initial design, or what there is of it.
  const forward::Evaluation& start() const { return start_; }

  /// Does what the case's study asks, from options.start where that can be
  /// evaluated, else from the initial design. `Leave::Early`: ends it, without
  /// convergence, once it is clear that find_refreeze() will want a new
  /// model; a second call then does the rest. `reach`: how near to the start a
  /// minimisation stays, x the ranges of the variables.
  enum class Leave { Late, Early };
  void conduct(Leave leave = Leave::Late, double reach = 1.0);
  /// The outcome of a study on another model, with the objective and the
  /// constraints that its best design, which this model is frozen at, has
  /// here, by the bounds of `asked`. Converged it stays where all is kept.
  void judge(const StudyOutcome& found, const case_data::Case& asked);
  /// What a new model is wanted for, as things stand.
  std::optional<store::Refreeze> wanted(const VectorX& best,
                                        bool converged) const;
  const StudyOutcome& outcome() const { return outcome_; }
  /// Of a sweep, its designs; and its outcome by records of them, in their
  /// order, of several models.
  std::vector<VectorX> swept() const;
  StudyOutcome sum_up(const std::vector<store::EvaluationRecord>& records);
  /// Ends it from outside, with that outcome.
  void leave(StudyOutcome outcome);
  /// Of the designs that it has asked for.
  std::vector<store::EvaluationRecord> records() const {
    return store_.some(asked_);
  }
  /// Designs that the stage has asked for.
  int evaluations() const { return static_cast<int>(asked_.size()); }
  bool stopped_early() const { return left_early_; }

  const std::string& model_name() const { return model_.name; }
  DesignEvaluator& evaluator() { return evaluator_; }
  const DesignEvaluator& evaluator() const { return evaluator_; }
  /// True for a design that this model has evaluated with success.
  bool was_answered(const VectorX& design) const {
    const auto record = store_.find(model_.name, design);
    return record && !record->failure;
  }
  /// Of a match, else null.
  const MatchTargets* targets() const {
    return targets_ ? &*targets_ : nullptr;
  }

 private:
  VectorX begin();

  void count(const store::EvaluationRecord& record);
  void stop_if_beyond(const store::EvaluationRecord& record);

  const case_data::Case& input_;
  const store::StudyStore& store_;
  // Numbers in the database of designs asked for, each once: not all that it
  // holds, which on a resumed run knows what comes later.
  std::vector<int> asked_;
  const StudyOptions& options_;
  StageModel model_;
  DesignEvaluator evaluator_;
  std::optional<Failure> failure_;
  forward::Evaluation start_;
  std::optional<MatchTargets> targets_;
  StudyOutcome outcome_;
  bool left_early_ = false;
  int beyond_ = 0;  // designs that the study has asked for
};

/// The same study on a model whose edges are study.coarse_first as long, for
/// the answer that the study on the case's own model starts from. `best` is
/// empty where it has none; `message` says why.
struct CoarseStage {
  std::optional<VectorX> best;
  CoarseFigures figures;
  forward::StageSeconds seconds;
};
CoarseStage run_coarse_stage(const case_data::Case& input,
                             store::StudyStore& store,
                             const StudyOptions& options);

}  // namespace meniscus::study
