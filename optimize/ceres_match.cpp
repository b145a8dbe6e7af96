#include "optimize/ceres_match.h"

#include <ceres/ceres.h>

#include "optimize/bounded_match.h"
#include "optimize/differences.h"

namespace meniscus::optimize {
namespace {

// A step that leaves at most this part of |r| shows that the Jacobian is good:
// the next one comes by rank-one update, which costs no evaluation.
constexpr double kGoodStep = 0.25;
// Relative change of cost below which nothing visible is gained.
constexpr double kCostTolerance = 1e-9;
// Relative size of a step that only moves rounding.
constexpr double kStepTolerance = 1e-12;
// Large: the first step is the full Gauss-Newton step.
constexpr double kFirstRadius = 1e8;
// Our limits are those of the evaluator.
constexpr int kManyIterations = 10000;

using RowMajor =
    Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;

// r near x: residuals + jacobian (x' - x).
struct Linearisation {
  VectorX x;
  VectorX residuals;
  Eigen::MatrixXd jacobian;
  bool secant = false;  // by rank-one update, not by differences
};

class MatchCost : public ceres::CostFunction {
 public:
  explicit MatchCost(MatchEvaluator& evaluator) : evaluator_(evaluator) {
    set_num_residuals(static_cast<int>(evaluator.residual_count()));
    mutable_parameter_block_sizes()->push_back(
        static_cast<int>(evaluator.size()));
  }

  bool Evaluate(double const* const* parameters, double* residuals,
                double** jacobians) const override {
    const Eigen::Map<const VectorX> x(parameters[0], evaluator_.size());
    Eigen::Map<VectorX> r(residuals, evaluator_.residual_count());
    const VectorX place = evaluator_.place(x);
    const ResidualAnswer* answer =
        finished() ? nullptr
                   : evaluator_.evaluate(place, EvaluationPhase::Step);
    held_up_ =
        held_up_ || answer == nullptr || answer->failure || at_bound(place);
    if (jacobians == nullptr || jacobians[0] == nullptr) {
      return answer != nullptr && !answer->failure && accept(place, *answer, r);
    }
    // Asked at accepted points only, so there is an answer unless the match is
    // over; then zeros end Ceres at once, where `false` makes it complain.
    Eigen::Map<RowMajor> jacobian(jacobians[0], r.size(), x.size());
    if (answer == nullptr || answer->failure || !linearise(place, *answer)) {
      r.setZero();
      jacobian.setZero();
    } else {
      r = answer->residuals;
      jacobian = last_.jacobian;
    }
    return true;
  }

  const Linearisation& last() const { return last_; }
  bool finished() const {
    return secant_failed_ || held_up_ || evaluator_.halted();
  }
  /// By a bound or a point that failed.
  bool held_up() const { return held_up_; }

 private:
  bool at_bound(const VectorX& x) const {
    return (x.array() <= evaluator_.lower().array()).any() ||
           (x.array() >= evaluator_.upper().array()).any();
  }

  // False for a point that is worse although the updated Jacobian promised
  // better: it has gone stale, and this run of Ceres ends.
  bool accept(const VectorX& x, const ResidualAnswer& answer,
              Eigen::Map<VectorX>& residuals) const {
    secant_failed_ = last_.secant && x != last_.x &&
                     cost_of(answer) >= 0.5 * last_.residuals.squaredNorm();
    residuals = answer.residuals;
    return !secant_failed_;
  }

  // Sets last_ at x; false once the evaluator has halted.
  bool linearise(const VectorX& x, const ResidualAnswer& answer) const {
    if (last_.x.size() > 0 && last_.x == x) {
      return true;
    }
    Linearisation next{x, answer.residuals, {}, false};
    if (const Eigen::MatrixXd* own = evaluator_.jacobian(x)) {
      next.jacobian = *own;
    } else if (last_.x.size() > 0 &&
               answer.residuals.norm() <= kGoodStep * last_.residuals.norm()) {
      next.jacobian = updated(x, answer.residuals);
      next.secant = true;
    } else {
      std::optional<Eigen::MatrixXd> differences = one_sided_differences(
          evaluator_, x, answer.residuals,
          [this](const VectorX& at) { return neighbour(at); });
      if (!differences) {
        return false;
      }
      next.jacobian = std::move(*differences);
    }
    last_ = std::move(next);
    return true;
  }

  // Broyden: the smallest change of J, variables measured by their ranges,
  // that agrees with the last step.
  Eigen::MatrixXd updated(const VectorX& x, const VectorX& residuals) const {
    const VectorX step = x - last_.x;
    const VectorX dual = step.cwiseQuotient(evaluator_.ranges().cwiseAbs2());
    const VectorX error = residuals - last_.residuals - last_.jacobian * step;
    return last_.jacobian + error * dual.transpose() / dual.dot(step);
  }

  Neighbour neighbour(const VectorX& x) const {
    const ResidualAnswer* answer =
        evaluator_.evaluate(x, EvaluationPhase::Difference);
    if (answer == nullptr) {
      return {.halted = true};
    }
    return {.values = answer->failure ? nullptr : &answer->residuals};
  }

  MatchEvaluator& evaluator_;
  // Ceres sees a function; what it costs to be one is kept beside.
  mutable Linearisation last_;
  mutable bool secant_failed_ = false;
  mutable bool held_up_ = false;
};

class StopWhenFinished : public ceres::IterationCallback {
 public:
  StopWhenFinished(const MatchCost& cost, const MatchEvaluator& evaluator)
      : cost_(cost), watch_(evaluator) {}

  ceres::CallbackReturnType operator()(
      const ceres::IterationSummary& /*summary*/) override {
    if (cost_.finished()) {
      return ceres::SOLVER_ABORT;
    }
    return watch_.idle() ? ceres::SOLVER_TERMINATE_SUCCESSFULLY
                         : ceres::SOLVER_CONTINUE;
  }

 private:
  const MatchCost& cost_;
  GainWatch watch_;
};

ceres::Solver::Options solver_options() {
  ceres::Solver::Options options;
  options.minimizer_type = ceres::TRUST_REGION;
  options.trust_region_strategy_type = ceres::LEVENBERG_MARQUARDT;
  options.linear_solver_type = ceres::DENSE_QR;
  options.num_threads = 1;
  options.logging_type = ceres::SILENT;
  options.max_num_iterations = kManyIterations;
  options.initial_trust_region_radius = kFirstRadius;
  options.max_trust_region_radius = 1e20;
  options.function_tolerance = kCostTolerance;
  options.parameter_tolerance = kStepTolerance;
  options.gradient_tolerance = 0.0;
  return options;
}

const char* ceres_words(ceres::TerminationType type) {
  switch (type) {
    case ceres::CONVERGENCE:
    case ceres::USER_SUCCESS:
      return "the cost no longer changes";
    case ceres::NO_CONVERGENCE:
      return "the iterations ran out";
    default:
      return "no step is an improvement";
  }
}

}  // namespace

BackendResult ceres_match(MatchEvaluator& evaluator, const VectorX& start) {
  BackendResult result;
  VectorX x = start;
  // A run that ends on an updated Jacobian has not proved anything: run again
  // from the incumbent on fresh differences. Updates follow only on a step
  // that cut |r| by kGoodStep, so this ends.
  for (bool again = true; again;) {
    MatchCost cost(evaluator);
    StopWhenFinished callback(cost, evaluator);
    ceres::Solver::Options options = solver_options();
    options.callbacks.push_back(&callback);
    ceres::Problem::Options ownership;
    ownership.cost_function_ownership = ceres::DO_NOT_TAKE_OWNERSHIP;
    ceres::Problem problem(ownership);
    problem.AddResidualBlock(&cost, nullptr, x.data());
    for (int j = 0; j < static_cast<int>(x.size()); ++j) {
      const auto& variable = evaluator.variables()[static_cast<std::size_t>(j)];
      problem.SetParameterLowerBound(x.data(), j, variable.lower);
      problem.SetParameterUpperBound(x.data(), j, variable.upper);
    }
    ceres::Solver::Summary summary;
    ceres::Solve(options, &problem, &summary);
    result.iterations += summary.num_successful_steps;
    result.jacobian = cost.last().jacobian;
    result.message = ceres_words(summary.termination_type);
    if (cost.held_up() && !evaluator.halted()) {
      const BackendResult rest = bounded_match(evaluator, evaluator.best());
      result.iterations += rest.iterations;
      result.jacobian = rest.jacobian;
      result.message = rest.message;
      return result;
    }
    again = !evaluator.halted() && cost.last().secant;
    x = evaluator.best();
  }
  return result;
}

}  // namespace meniscus::optimize
