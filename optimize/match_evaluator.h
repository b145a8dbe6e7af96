/// The one place where a match calls its function: remembers every answer,
/// keeps the incumbent, counts, watches the limits, and stands between our
/// exceptions and the libraries that must not see them.
#pragma once

#include <cstdint>
#include <exception>
#include <map>
#include <vector>

#include "core/timer.h"
#include "optimize/problem.h"

namespace meniscus {

class MatchEvaluator {
 public:
  enum class Halt { None, Converged, Evaluations, Time, Exception };

  /// Keeps references to all three; throws InvalidInput for bad bounds, start
  /// or options.
  MatchEvaluator(const std::vector<Variable>& variables,
                 const ResidualFunction& function, const MatchOptions& options);

  /// The answer at x (moved into the bounds), from memory if it was asked
  /// before; null once halted, and then the caller leaves its library. Never
  /// throws: what the function throws is kept for rethrow().
  const ResidualAnswer* evaluate(const VectorX& x,
                                 EvaluationPhase phase) noexcept;
  void rethrow() const;

  Halt halt() const { return halt_; }
  const std::vector<Variable>& variables() const { return variables_; }
  const MatchOptions& options() const { return options_; }
  Eigen::Index size() const { return ranges_.size(); }
  const VectorX& ranges() const { return ranges_; }  // upper - lower
  VectorX start() const;
  VectorX lower() const;
  VectorX upper() const;

  bool has_best() const { return best_x_.size() > 0; }
  const VectorX& best() const { return best_x_; }
  const ResidualAnswer& best_answer() const { return best_answer_; }
  double worst_cost() const { return worst_cost_; }  // of those that answered
  int evaluations() const { return evaluations_; }
  int failed_evaluations() const { return failed_; }
  const Failure& last_failure() const { return last_failure_; }
  Eigen::Index residual_count() const { return residual_count_; }
  /// True when every answer so far had the same residuals, bit for bit.
  bool all_answers_equal() const { return all_equal_; }
  std::string describe(const VectorX& x) const;  // "a = 1, b = 2"

 private:
  using Key = std::vector<std::uint64_t>;

  const ResidualAnswer* ask(const VectorX& x, EvaluationPhase phase);
  bool limit_reached();
  void check(ResidualAnswer& answer);
  void account(const VectorX& x, const ResidualAnswer& answer);

  const std::vector<Variable>& variables_;
  const ResidualFunction& function_;
  const MatchOptions& options_;
  Monitor& monitor_;
  Timer timer_;
  VectorX ranges_;
  std::map<Key, ResidualAnswer> memory_;
  Halt halt_ = Halt::None;
  std::exception_ptr exception_;
  VectorX best_x_;
  ResidualAnswer best_answer_;
  VectorX first_residuals_;
  bool all_equal_ = true;
  double worst_cost_ = 0.0;
  int evaluations_ = 0;
  int failed_ = 0;
  Failure last_failure_;
  Eigen::Index residual_count_ = 0;
};

double cost_of(const ResidualAnswer& answer);         // |r|^2 / 2
double worst_mismatch(const ResidualAnswer& answer);  // largest |mismatch|

}  // namespace meniscus
