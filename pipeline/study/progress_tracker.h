/// Progress of a running study: an event after every evaluation, to terminals,
/// logs and those who watch its database.
#pragma once

#include <functional>
#include <optional>
#include <string>

#include "core/timer.h"
#include "core/units.h"
#include "pipeline/case_data/case.h"
#include "pipeline/store/study_store.h"

namespace meniscus::study {

/// How one design stands. Of a match `objective` is the largest mismatch; a
/// study that looks for nothing has none. `violation`: the largest of the
/// constraints, in bounds (pipeline/store/incumbent.h); none without
/// constraints.
struct DesignStatus {
  int evaluation = 0;
  std::optional<double> objective;
  std::optional<double> violation;
  std::string worst;  // the response that is off by it; empty: none is
};

struct EvaluationEvent {
  const store::EvaluationRecord* record = nullptr;  // the evaluation; on loan
  DesignStatus status;               // of it; empty where the design failed
  std::optional<DesignStatus> best;  // of this model, so far
  std::string objective_name;        // "mismatch", or a response
  ShownUnit objective_shown;         // to people
  int evaluations = 0;               // of this model, in the database
  int failed = 0;                    // of these
  std::optional<int> planned;        // evaluations in all, at most
  double elapsed = 0.0;              // since the study began [s]
  std::optional<double> left;  // [s], at most: to `planned` or to the limit
  std::string member;          // of a family
};

using StudyListener = std::function<void(const EvaluationEvent&)>;

/// Keeps what is known of the evaluations of one model, in their order.
class ProgressTracker {
 public:
  /// `model`: the one whose records count. `time_limit`: of the study from now
  /// [s], 0: none. `input` must outlive this.
  ProgressTracker(const case_data::Case& input, std::string model,
                  double time_limit = 0.0);

  /// Accounts for a record that was found in the database; of another model:
  /// nothing happens.
  void add(const store::EvaluationRecord& record);
  /// The same of one that was computed now. It must outlive the answer.
  EvaluationEvent add_new(const store::EvaluationRecord& record);
  /// How things stand, `record` being the last that was accounted for.
  EvaluationEvent event(const store::EvaluationRecord& record) const;

 private:
  DesignStatus merit_of(const store::EvaluationRecord& record) const;
  bool better(const DesignStatus& a, const DesignStatus& b) const;
  std::optional<double> time_left() const;

  const case_data::Case& input_;
  std::string model_;
  double time_limit_;
  std::optional<int> planned_;
  std::optional<DesignStatus> best_;
  int evaluations_ = 0;
  int failed_ = 0;
  int timed_ = 0;       // of them computed now
  double first_ = 0.0;  // when the first of these ended [s]
  Timer timer_;
};

/// "45 s", "3 min", "2 h"; rounded up.
std::string duration_text(double seconds);

/// "best so far 0.0119 t (evaluation 9), at most 2 min left": what follows an
/// evaluation's own line; may be empty.
std::string progress_text(const EvaluationEvent& event);

}  // namespace meniscus::study
