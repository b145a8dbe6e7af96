/// The frozen models that a study goes through, from the case's own to that of
/// its answer (internal to run_study()).
#pragma once

#include <limits>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "core/timer.h"
#include "pipeline/case_data/case.h"
#include "pipeline/store/refreeze.h"
#include "pipeline/store/study_store.h"
#include "pipeline/study/study.h"
#include "pipeline/study/study_stage.h"

namespace meniscus::study {

class StudyModels {
 public:
  /// `options.time_limit` [s] is that of the whole study and counts from here.
  /// All references must outlive it.
  StudyModels(const case_data::Case& input, store::StudyStore& store,
              const StudyOptions& options);

  /// The study on a coarser model, whose answer is where the case's own starts;
  /// nothing where study.coarse_first does not ask for it.
  std::optional<CoarseFigures> run_coarse();
  /// Freezes the case's own model, at its initial design.
  void freeze();
  /// Conducts the stage, and on each new model where it has left the reach of
  /// the last.
  void conduct();
  /// The designs of a sweep at which films join in another way, on models that
  /// are frozen anew there, each for as many of them as it serves.
  void sweep_rejoined();
  /// Goes on with a new model where the study has left the reach of the last;
  /// false when there is none.
  bool refreeze();
  /// Goes on with a model frozen at the stage's answer; false where there is
  /// none.
  bool go_on_at_answer();
  /// Goes on with the model of best_kept() again; false where there is none.
  bool go_on_at_best_kept();
  /// The stage changes places with the one before it, of a study that holds
  /// margins; its next search starts from `design`.
  void go_back(const VectorX& design);
  bool may_go_back() const { return before_.stage != nullptr; }
  void start_at(const VectorX& design) { options_.start = design; }
  /// Whether the last model that was wanted has no film at its design.
  bool lost_film() const { return lost_film_; }
  /// The start of a model that only looks at a design: the study's answer is
  /// not of it. Nothing where it cannot be frozen.
  std::optional<forward::Evaluation> look_at(const VectorX& design,
                                             int evaluation,
                                             const std::string& reason);
  /// What the study goes on with may take the evaluations, at most so many, and
  /// the time that are left.
  static constexpr int kNoLimit = std::numeric_limits<int>::max();
  void limit_to_what_is_left(int most = kNoLimit);

  /// Null before freeze().
  StudyStage* stage() { return now_.stage.get(); }
  const StudyStage* stage() const { return now_.stage.get(); }
  const case_data::Case& input() const { return input_; }
  store::StudyStore& store() { return store_; }
  const StudyOptions& options() const { return options_; }
  /// What the stage's model is frozen of, with the bounds that the search
  /// keeps.
  case_data::Case& working() { return now_.frozen ? *now_.frozen : case_; }
  bool may_refreeze() const;
  int evaluations_left() const {
    return input_.study.max_evaluations - earlier_evaluations_ -
           (before_.stage ? before_.stage->evaluations() : 0) -
           now_.stage->evaluations();
  }
  /// The stage seeks designs, and its model is frozen at another than its
  /// answer.
  bool has_dragged_answer() const;
  /// Of a minimum's models the one whose own design keeps every bound of the
  /// case with the least objective; its number in the database.
  std::optional<int> best_kept() const {
    return kept_ ? std::optional(kept_->at.evaluation) : std::nullopt;
  }
  /// Its answer in the database.
  store::EvaluationRecord answer() const;

  void log(const std::string& message) const {
    monitor().log(Severity::Info, message);
  }
  void warn(std::string warning) { warnings_.push_back(std::move(warning)); }
  /// What the models add to the result: warnings, later models, their time and
  /// gradients.
  void add_to(RunResult& result) const;
  double elapsed_seconds() const { return timer_.seconds(); }

 private:
  /// A stage, and what its model is frozen of where that is not case_.
  struct Model {
    std::unique_ptr<case_data::Case> frozen;
    std::unique_ptr<StudyStage> stage;
  };
  std::optional<Model> model_at(store::Refreeze& wanted,
                                const case_data::Case& from);
  bool is_better_than(const Model& other) const;
  void conduct_in_reach();
  bool pops_on_the_way() const;
  /// Goes on beyond designs at which films join in another way, where those
  /// beside the best one are; false where there are none, or nothing better is
  /// found.
  bool search_rejoined();
  /// `from`: the case that its model is frozen of, but for the design.
  bool go_on_at(store::Refreeze wanted, const case_data::Case& from);
  void take_swept(const std::vector<store::EvaluationRecord>& records,
                  const std::map<std::string, case_data::Case>& frozen);
  void note_kept();
  std::unique_ptr<StudyStage> stage_at(const store::Refreeze& refreeze,
                                       const std::string& name,
                                       const case_data::Case& input);
  struct KeptStart {
    case_data::Case frozen;  // what its model is frozen of
    store::Refreeze at;
  };
  void end(Model model);
  void update_time_limit();
  Monitor& monitor() const {
    return options_.monitor != nullptr ? *options_.monitor : silent_monitor();
  }

  const case_data::Case& input_;
  case_data::Case case_;  // with the bounds that the search keeps
  store::StudyStore& store_;
  StudyOptions options_;  // its start and time as stages leave them
  double limit_;          // [s], 0: none
  Timer timer_;
  Model now_;
  std::optional<KeptStart> kept_;
  Model before_;       // where a study may go back to it
  VectorX reference_;  // responses of the initial design
  forward::StageSeconds earlier_seconds_;
  int earlier_gradients_ = 0;  // of stages before this one
  int earlier_evaluations_ = 0;
  bool lost_film_ = false;
  std::vector<store::Refreeze> refrozen_;
  std::vector<std::string> warnings_;
};

}  // namespace meniscus::study
