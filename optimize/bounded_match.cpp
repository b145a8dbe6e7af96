#include "optimize/bounded_match.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "optimize/differences.h"
#include "optimize/quadratic/failed_points.h"
#include "optimize/quadratic/quadratic_program.h"

namespace meniscus::optimize {
namespace {

constexpr double kFirstBox = 1.0;  // x the ranges
// Part of the promised gain of the cost, as in optimize/trust_region.cpp.
constexpr double kTaken = 1e-4;
constexpr double kGoodModel = 0.75;
constexpr double kPoorModel = 0.25;
constexpr double kEdgeOfBox = 0.9;
// A promise below this part of the cost is the end.
constexpr double kNothingLeft = 1e-9;
// Curvature of directions that the residuals do not feel, x the largest: they
// stay where they are. More, where that is too little for a step.
constexpr std::array<double, 3> kUnfelt = {1e-9, 1e-6, 1e-3};
// A step that left this part of |r| shows that the Jacobian is good: the next
// comes by Broyden's update.
constexpr double kGoodReduction = 0.25;

class BoundedMatch {
 public:
  BoundedMatch(MatchEvaluator& evaluator, const VectorX& start)
      : evaluator_(evaluator), ranges_(evaluator.ranges()), x_(start) {}

  BackendResult run();

 private:
  bool differentiate();
  void update(const VectorX& x, const VectorX& residuals);
  VectorX step() const;
  enum class Move { Taken, Refused, Failed, Halted };
  Move attempt(const VectorX& step);
  void adjust(Move move, double length);

  MatchEvaluator& evaluator_;
  VectorX ranges_;
  VectorX x_;
  VectorX residuals_;
  Eigen::MatrixXd jacobian_;  // d r / d (x / range)
  bool secant_ = false;       // kept up, not asked
  double radius_ = kFirstBox;
  double ratio_ = 0.0;
  int failures_ = 0;  // in a row
  quadratic::FailedPoints failed_;
};

// False once halted.
bool BoundedMatch::differentiate() {
  secant_ = false;
  if (const Eigen::MatrixXd* own = evaluator_.jacobian(x_)) {
    jacobian_ = *own * ranges_.asDiagonal();
    return true;
  }
  std::optional<Eigen::MatrixXd> found = one_sided_differences(
      evaluator_, x_, residuals_, [this](const VectorX& at) -> Neighbour {
        const ResidualAnswer* answer =
            evaluator_.evaluate(at, EvaluationPhase::Difference);
        if (answer == nullptr) {
          return {.halted = true};
        }
        return {.values = answer->failure ? nullptr : &answer->residuals};
      });
  if (!found) {
    return false;
  }
  jacobian_ = *found * ranges_.asDiagonal();
  return true;
}

VectorX BoundedMatch::step() const {
  quadratic::QuadraticProgram program;
  const Eigen::MatrixXd hessian = jacobian_.transpose() * jacobian_;
  const double largest = hessian.diagonal().maxCoeff();
  program.slope = jacobian_.transpose() * residuals_;
  program.low = (evaluator_.lower() - x_)
                    .cwiseQuotient(ranges_)
                    .cwiseMax(-radius_)
                    .cwiseMin(0.0);
  program.high = (evaluator_.upper() - x_)
                     .cwiseQuotient(ranges_)
                     .cwiseMin(radius_)
                     .cwiseMax(0.0);
  program.rows.resize(0, ranges_.size());
  failed_.cut(x_, ranges_, radius_, program);
  for (const double unfelt : kUnfelt) {
    program.hessian = hessian;
    program.hessian.diagonal().array() +=
        largest > 0.0 ? unfelt * largest : 1.0;
    const std::optional<quadratic::QuadraticAnswer> found =
        quadratic::solve_quadratic(program);
    const double promised =
        !found ? 0.0
               : residuals_.squaredNorm() -
                     (residuals_ + jacobian_ * found->step).squaredNorm();
    if (promised > kNothingLeft * residuals_.squaredNorm()) {
      return found->step;
    }
  }
  return VectorX::Zero(ranges_.size());
}

// Broyden, as in optimize/ceres_match.cpp.
void BoundedMatch::update(const VectorX& x, const VectorX& residuals) {
  const VectorX d = (x - x_).cwiseQuotient(ranges_);
  jacobian_ += (residuals - residuals_ - jacobian_ * d) * d.transpose() /
               d.squaredNorm();
  secant_ = true;
}

BoundedMatch::Move BoundedMatch::attempt(const VectorX& step) {
  const VectorX x = evaluator_.place(x_ + step.cwiseProduct(ranges_));
  const ResidualAnswer* answer = evaluator_.evaluate(x, EvaluationPhase::Step);
  if (answer == nullptr) {
    return Move::Halted;
  }
  if (answer->failure) {
    failed_.add(x);
    return Move::Failed;
  }
  const double before = 0.5 * residuals_.squaredNorm();
  const double promised =
      before - 0.5 * (residuals_ + jacobian_ * step).squaredNorm();
  ratio_ = promised > 0.0 ? (before - cost_of(*answer)) / promised : 0.0;
  if (ratio_ < kTaken) {
    return Move::Refused;
  }
  failed_.passed(x_, ranges_, x);
  const bool good =
      answer->residuals.norm() <= kGoodReduction * residuals_.norm();
  if (good) {
    update(x, answer->residuals);
  }
  const bool own = evaluator_.jacobian(x) != nullptr;
  if (evaluator_.halted()) {
    return Move::Halted;
  }
  x_ = x;
  residuals_ = answer->residuals;
  if ((own || !good) && !differentiate()) {
    return Move::Halted;
  }
  return Move::Taken;
}

void BoundedMatch::adjust(Move move, double length) {
  if (move == Move::Failed) {
    radius_ = failures_++ == 0 ? length : 0.5 * length;
    return;
  }
  failures_ = 0;
  if (move == Move::Refused) {
    radius_ = (ratio_ < 0.0 ? 0.25 : 0.5) * length;
  } else if (ratio_ < kPoorModel) {
    radius_ = 0.5 * length;
  } else if (ratio_ > kGoodModel && length >= kEdgeOfBox * radius_) {
    radius_ = std::min(1.0, 2.0 * radius_);
  }
}

BackendResult BoundedMatch::run() {
  BackendResult result;
  x_ = evaluator_.place(x_);
  const ResidualAnswer* first = evaluator_.evaluate(x_, EvaluationPhase::Step);
  if (first == nullptr || first->failure) {
    return result;
  }
  residuals_ = first->residuals;
  if (!differentiate()) {
    return result;
  }
  GainWatch watch(evaluator_);
  result.message = "the cost no longer changes";
  while (true) {
    const VectorX d = step();
    const double length = d.cwiseAbs().maxCoeff();
    const double cost = 0.5 * residuals_.squaredNorm();
    const double promised =
        cost - 0.5 * (residuals_ + jacobian_ * d).squaredNorm();
    const bool ends =
        length <= evaluator_.same_design() || promised <= kNothingLeft * cost;
    if (ends && secant_) {  // an updated Jacobian proves nothing
      if (!differentiate()) {
        break;
      }
      radius_ = std::max(radius_, length);
      continue;
    }
    if (ends || watch.idle()) {
      break;
    }
    const Move move = attempt(d);
    ++result.iterations;
    if (move == Move::Halted) {
      break;
    }
    adjust(move, length);
    if (move == Move::Refused && secant_ && !differentiate()) {
      break;
    }
  }
  result.jacobian = jacobian_ * ranges_.cwiseInverse().asDiagonal();
  return result;
}

}  // namespace

GainWatch::GainWatch(const MatchEvaluator& evaluator) : evaluator_(evaluator) {
  idle();
}

bool GainWatch::idle() {
  // A match that cannot be met ends in a flat valley, where a method would
  // wander for long.
  constexpr double kVisibleGain = 1e-4;
  constexpr int kPatience = 8;
  constexpr int kPatiencePerVariable = 4;
  const double best = cost_of(evaluator_.best_answer());
  if (!(best >= (1.0 - kVisibleGain) * gained_)) {
    gained_ = best;
    gained_at_ = evaluator_.evaluations();
  }
  return evaluator_.evaluations() - gained_at_ >
         kPatience + kPatiencePerVariable * static_cast<int>(evaluator_.size());
}

BackendResult bounded_match(MatchEvaluator& evaluator, const VectorX& start) {
  return BoundedMatch(evaluator, start).run();
}

}  // namespace meniscus::optimize
