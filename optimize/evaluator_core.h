/// What every search shares where it calls its function: the bounds, the
/// count, the limits, the memory, and the wall between our exceptions and the
/// libraries that must not see them.
#pragma once

#include <algorithm>
#include <bit>
#include <cstdint>
#include <exception>
#include <map>
#include <utility>
#include <vector>

#include "core/timer.h"
#include "optimize/problem.h"

namespace meniscus::optimize {

/// "limit of 120 evaluations", "... (99 before, 21 here)".
std::string limit_text(int evaluations, int earlier);
/// "21 evaluations", "... on its model" where there were earlier ones.
std::string evaluations_text(int evaluations, int earlier);

/// Throws InvalidInput, naming it, for a variable with bounds or an initial
/// value that cannot be, and when there is none; equal bounds pass.
void check_variables(const std::vector<Variable>& variables, const char* study);

/// Designs nearer than this in every variable, x its range, are one to a search
/// that is to end at `tolerance`: no such step gains anything.
inline double same_design_at(double tolerance) {
  return std::clamp(1e-2 * tolerance, 1e-10, 1e-7);
}

struct EvaluationLimits {
  const char* study = "";  // "match", "minimize": named in messages
  int max_evaluations = 1;
  double time_limit = 0.0;       // [s], 0: none
  double difference_step = 0.0;  // x range, in (0, 0.5]
  Monitor* monitor = nullptr;
  std::function<void(EvaluationPhase)> announce = {};
  std::function<void(const std::vector<VectorX>&)> prefetch = {};
};

/// Answers by point, compared bit by bit.
template <class Answer>
class AnswerMemory {
 public:
  /// Null when unknown. Pointers stay valid.
  Answer* find(const VectorX& x) {
    const auto known = answers_.find(key_of(x));
    return known == answers_.end() ? nullptr : &known->second;
  }
  Answer& keep(const VectorX& x, Answer answer) {
    points_.push_back(x);
    return answers_.emplace(key_of(x), std::move(answer)).first->second;
  }
  /// The first point asked that is within `distance` of x in every variable
  /// [ranges], or x.
  VectorX place(const VectorX& x, const VectorX& ranges,
                double distance) const {
    for (const VectorX& point : points_) {
      if (((point - x).cwiseAbs().array() <= distance * ranges.array()).all()) {
        return point;
      }
    }
    return x;
  }

 private:
  using Key = std::vector<std::uint64_t>;
  static Key key_of(const VectorX& x);

  std::map<Key, Answer> answers_;
  std::vector<VectorX> points_;  // in the order asked
};

class EvaluatorCore {
 public:
  enum class Halt {
    None,
    Converged,
    Constant,
    Stage,
    Evaluations,
    Time,
    Exception
  };

  Halt halt() const { return halt_; }
  bool halted() const { return halt_ != Halt::None; }
  /// Throws what ended the search, if something did.
  void rethrow() const;

  const std::vector<Variable>& variables() const { return variables_; }
  const EvaluationLimits& limits() const { return limits_; }
  Eigen::Index size() const { return ranges_.size(); }
  const VectorX& ranges() const { return ranges_; }  // units of the variables
  VectorX start() const;
  VectorX lower() const;
  VectorX upper() const;
  int evaluations() const { return evaluations_; }
  int failed_evaluations() const { return failed_; }
  int gradient_evaluations() const { return gradients_; }
  int evaluations_left() const {
    return limits_.max_evaluations - evaluations_;
  }
  const Failure& last_failure() const { return last_failure_; }
  /// "a = 1, b = 2"; of a group "t = 1 to 3" or "t = 1 each".
  std::string describe(const VectorX& x) const;
  /// The variables of x that stand at a bound, in words; "" when none does.
  std::string bounds_reached(const VectorX& x) const;
  /// ", 3 of which could not be evaluated (last: ...)"; "" when none failed.
  std::string failures() const;

  /// Halts once this many evaluations are spent, until the stage is ended.
  void begin_stage(int evaluations) { stage_ = evaluations; }
  void end_stage();

 protected:
  /// Throws InvalidInput for bad bounds, start or limits.
  EvaluatorCore(std::vector<Variable> variables, EvaluationLimits limits);
  ~EvaluatorCore() = default;

  /// work(), or a default when halted; what it throws halts and is kept.
  template <class Work>
  auto guarded(const Work& work) noexcept -> decltype(work());
  VectorX inside(const VectorX& x) const;  // the bounds; -0 becomes 0
  /// To be called before the function is; false at a limit, then halted.
  bool begin(EvaluationPhase phase);
  void count_failure(const VectorX& x, const Failure& failure);
  void report_progress(const std::string& detail);
  void set_halt(Halt halt) { halt_ = halt; }

 private:
  /// Past the variables that are of the same group as i.
  Eigen::Index group_end(Eigen::Index i) const;

  std::vector<Variable> variables_;
  EvaluationLimits limits_;
  Monitor& monitor_;
  Timer timer_;
  VectorX ranges_;
  Halt halt_ = Halt::None;
  std::exception_ptr exception_;
  int stage_ = 0;  // 0: none
  int evaluations_ = 0;
  int failed_ = 0;
  int gradients_ = 0;
  Failure last_failure_;
};

template <class Answer>
auto AnswerMemory<Answer>::key_of(const VectorX& x) -> Key {
  Key key;
  key.reserve(static_cast<std::size_t>(x.size()));
  for (const double number : x) {
    key.push_back(std::bit_cast<std::uint64_t>(number));
  }
  return key;
}

template <class Work>
auto EvaluatorCore::guarded(const Work& work) noexcept -> decltype(work()) {
  if (!halted()) {
    try {
      return work();
    } catch (...) {
      exception_ = std::current_exception();
      halt_ = Halt::Exception;
    }
  }
  return {};
}

}  // namespace meniscus::optimize
