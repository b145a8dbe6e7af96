/// One frozen model with the study database in front of it: the place that the
/// kinds of study ask for designs. What they have evaluated is remembered there
/// alone; of one design, the last, this holds all that was computed.
#pragma once

#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "optimize/problem.h"
#include "pipeline/forward/design_stages.h"
#include "pipeline/forward/forward_model.h"
#include "pipeline/store/study_store.h"
#include "pipeline/study/progress_tracker.h"
#include "pipeline/study/study_monitor.h"

namespace meniscus::study {

struct DesignEvaluatorOptions {
  std::string model =
      store::kStudyModel;       // the frozen model's name in the database
  double edge_factor = 1.0;     // as in ForwardModelOptions
  bool with_gradients = false;  // keep what gradient() needs of each design:
                                // memory for a second solve saved
  int jobs = 1;                 // designs side by side where several are asked
                                // at once, 1 to kMostJobs; no effect on what
                                // is found. Each needs the memory of one
  // evaluation beside the model (docs/performance)
  double time_limit = 0.0;      // what the listener's estimate counts to [s]
  StudyListener listener = {};  // as in StudyOptions
  Monitor* monitor = nullptr;   // not owned, outlives this; for several jobs
                                // it must bear calls from several threads
};

/// What the study has asked for, found in the database or computed.
struct EvaluationCounts {
  int evaluations = 0;
  int failed = 0;
  int gradients = 0;
};

/// A design that the database holds is read and not computed; one that it does
/// not hold is computed and written before the next is begun. All of it throws
/// Interrupted once the monitor asks to stop, IoError what the database
/// refuses.
class DesignEvaluator {
 public:
  /// Freezes the model; throws what ForwardModel's constructor throws. Both
  /// references must outlive the evaluator. When model().failure() is set
  /// nothing may be asked.
  DesignEvaluator(const case_data::Case& input, store::StudyStore& store,
                  DesignEvaluatorOptions options = {});
  DesignEvaluator(const DesignEvaluator&) = delete;
  DesignEvaluator& operator=(const DesignEvaluator&) = delete;

  const forward::ForwardModel& model() const { return model_; }

  /// Larger is worse, of the responses; new records then hold it as `mismatch`.
  void set_mismatch(std::function<double(const VectorX& responses)> mismatch) {
    mismatch_ = std::move(mismatch);
  }

  /// Told of each design that evaluate() has found, stored or not; what it
  /// throws passes through.
  void set_observer(std::function<void(const store::EvaluationRecord&)> watch) {
    watch_ = std::move(watch);
  }

  /// `phase`: what the design is for, as the record tells it when it is new.
  store::EvaluationRecord evaluate(const VectorX& design,
                                   const std::string& phase);

  /// The same for each of `designs`, side by side; what the database lacks is
  /// written in their order. Fewer, the first ones, when the time is up.
  std::vector<store::EvaluationRecord> evaluate_all(
      const std::vector<VectorX>& designs, const std::string& phase);

  /// Computes those that the database lacks, as evaluate_all() does, and counts
  /// nothing: they will be asked for one by one.
  void prefetch(const std::vector<VectorX>& designs, const std::string& phase);

  /// From now on evaluate_all() and prefetch() have so many seconds; 0: all
  /// the time there is.
  void limit_time(double seconds);

  /// d response / d design at a design that has been evaluated: rows by
  /// response, NaN in those not among `responses` (indices).
  optimize::JacobianAnswer gradient(const VectorX& design,
                                    const std::vector<int>& responses);

  /// The evaluation with the meshes behind it (all that evaluate() left when
  /// it was the last one, else computed once more) and no record.
  forward::Evaluation with_fields(const VectorX& design,
                                  forward::EvaluationFields& fields);

  const EvaluationCounts& counts() const { return counts_; }
  void reset_counts() { counts_ = {}; }
  /// Summed over freeze, evaluations and gradients that were computed.
  const forward::StageSeconds& seconds() const { return seconds_; }

 private:
  bool is_last(const VectorX& design) const {
    return last_.evaluation.design.size() == design.size() &&
           last_.evaluation.design == design;
  }
  /// Computes the design, which is the last one from then on.
  void compute_last(const VectorX& design, forward::KeepStiffness keep);
  /// Those that the database lacks, each once, in order.
  std::vector<VectorX> missing(const std::vector<VectorX>& designs) const;
  void compute(const std::vector<VectorX>& designs, const std::string& phase);
  store::EvaluationRecord keep(const forward::Evaluation& evaluation,
                               const std::string& phase);

  const case_data::Case& input_;
  store::StudyStore& store_;
  DesignEvaluatorOptions options_;
  StudyMonitor monitor_;  // the model's too
  std::optional<StudyMonitor::Clock::time_point> deadline_;
  forward::ForwardModel model_;
  std::function<double(const VectorX&)> mismatch_;
  std::function<void(const store::EvaluationRecord&)> watch_;
  EvaluationCounts counts_;
  forward::StageSeconds seconds_;
  ProgressTracker tracker_;
  // The design computed last, side by side ones aside, so that its gradient or
  // its meshes need no second evaluation; no stiffness unless it was kept.
  forward::StagedDesign last_;
};

}  // namespace meniscus::study
