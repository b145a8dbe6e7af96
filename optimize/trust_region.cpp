#include "optimize/trust_region.h"

#include <algorithm>
#include <cmath>

#include "optimize/quadratic/failed_points.h"
#include "optimize/quadratic/quadratic_program.h"

namespace meniscus::optimize {
namespace {

// Part of the promised gain of the merit that makes a step a good one, and a
// very good or poor model.
constexpr double kAccepted = 1e-4;
constexpr double kVeryGood = 0.75;
constexpr double kPoor = 0.25;
constexpr double kAtEdge = 0.9;  // of the box: a longer step was wanted
constexpr double kGrow = 2.0;
constexpr double kGrowBesideFailures = 1.25;
constexpr double kShorter = 0.5;
constexpr double kMuchShorter = 0.25;
// Powell's damping, and how far the first curvature may be off 1.
constexpr double kDamping = 0.2;
constexpr double kFirstCurvature = 1e4;
// Penalties are this much above the multipliers, and take this part of what the
// constraints gain.
constexpr double kAboveMultipliers = 1.5;
constexpr double kPenaltyPart = 0.5;
// Least misses are relaxed by this, so that rounding leaves room.
constexpr double kRoom = 1e-9;
// A constraint that a failed step was to bring this near to its bound, x its
// change, is what failed it; it is then thought to bend by this part of its
// change more, and by twice what was thought before.
constexpr double kBlamed = 0.1;
constexpr double kBend = 0.3;
constexpr double kMoreBend = 2.0;
constexpr double kForgotten = 0.5;  // of a bend, per step that shows less
constexpr int kBendRounds = 3;
constexpr int kMostCaution = 16;
constexpr double kBendSafety = 1.5;  // bends grow towards where parts fail
// A root-like value that was kept may be missed by this much: beyond, parts
// change fast and fail, and the way back is long.
constexpr double kMostMissed = 0.05;
// Changes of the merit below this, relative, are rounding.
constexpr double kRoundingOfMerit = 1e-13;
// Beside points that fail the search ends after so many evaluations, and one
// per variable, that gained less than this x the scale, or as part of the
// violation.
constexpr double kWorthIt = 1e-3;
constexpr int kPatience = 12;
// So it does where constraints stay missed by more than this x their scale.
constexpr double kMissedByMuch = 1e-2;

// By how much each side is missed, >= 0.
VectorX misses(const VectorX& values, const std::vector<char>& equation) {
  VectorX result = values.cwiseMax(0.0);
  for (Eigen::Index k = 0; k < values.size(); ++k) {
    if (equation[static_cast<std::size_t>(k)]) {
      result[k] = std::abs(values[k]);
    }
  }
  return result;
}

// The problem at a point, in units of the ranges and scales.
struct Linearised {
  VectorX x;
  double objective = 0.0;
  VectorX slope;
  VectorX sides;  // g_k
  Eigen::MatrixXd side_slopes;
};

struct Proposal {
  VectorX step;                 // x the ranges
  VectorX multipliers;          // per side, equations signed
  double objective_gain = 0.0;  // by the model
  VectorX missed;               // per side, by the model
  bool relaxed = false;         // not all sides can be kept in the box
};

class TrustRegion {
 public:
  TrustRegion(MinimizeEvaluator& evaluator, double radius)
      : evaluator_(evaluator),
        ranges_(evaluator.ranges()),
        radius_(radius),
        hessian_(
            Eigen::MatrixXd::Identity(evaluator.size(), evaluator.size())) {
    for (const ConstraintSide& side : evaluator.sides()) {
      equation_.push_back(side.equation ? 1 : 0);
    }
  }

  SearchResult run(const VectorX& start);

 private:
  enum class Outcome { Accepted, Rejected, Failed, Halted };

  bool linearise(const VectorX& x, Linearised& into);
  VectorX sides_at(const VectorX& values) const;
  std::optional<Proposal> propose(const VectorX& sides) const;
  std::optional<quadratic::QuadraticAnswer> solve_with_bends(
      quadratic::QuadraticProgram program,
      quadratic::QuadraticAnswer plain) const;
  void learn_bends(const VectorX& step, const VectorX& values);
  bool blame_constraints(const VectorX& step);
  quadratic::QuadraticProgram program_for(const VectorX& sides) const;
  double merit(double objective, const VectorX& sides) const {
    return objective + penalties_.dot(misses(sides, equation_));
  }
  void set_penalties(const Proposal& proposal);
  Outcome attempt(const Proposal& proposal);
  bool leaves_roots(const VectorX& sides) const;
  Outcome judge(const VectorX& x, const MinimizePoint& point, double promised);
  Outcome correct(const Proposal& proposal, const MinimizePoint& point,
                  double promised, Outcome first);
  void adjust_radius(Outcome outcome, double length);
  void update_hessian(const Linearised& before, const VectorX& multipliers);
  bool worth_going_on();

  MinimizeEvaluator& evaluator_;
  VectorX ranges_;
  double radius_;
  std::vector<char> equation_;
  Eigen::MatrixXd hessian_;
  bool first_update_ = true;
  VectorX penalties_;  // per side: one that is steep and hardly counts would
                       // spoil every step by the multiplier of another
  quadratic::FailedPoints failed_;
  VectorX bends_;     // per side: g is up to bend |d|^2 / 2 above its slope
  int cautious_ = 0;  // steps for which bends count, since a point failed
  int caution_ = 1;   // how many the next failure asks for, half
  int failures_in_a_row_ = 0;
  double ratio_ = 0.0;  // gained over promised, of the last step judged
  Linearised centre_;
  VectorX accepted_;
  double gained_objective_ = 0.0;
  double gained_violation_ = 0.0;
  int gained_at_ = 0;
  int failed_at_gain_ = 0;
};

VectorX TrustRegion::sides_at(const VectorX& values) const {
  const std::vector<ConstraintSide>& sides = evaluator_.sides();
  VectorX result(static_cast<Eigen::Index>(sides.size()));
  for (std::size_t k = 0; k < sides.size(); ++k) {
    result[static_cast<Eigen::Index>(k)] = sides[k].value(values);
  }
  return result;
}

// False once halted.
bool TrustRegion::linearise(const VectorX& x, Linearised& into) {
  const MinimizePoint* point = evaluator_.linearise(x);
  if (point == nullptr || evaluator_.halted()) {
    return false;
  }
  const double unit = evaluator_.objective_unit();
  const std::vector<ConstraintSide>& sides = evaluator_.sides();
  into.x = x;
  into.objective = point->values[0] / unit;
  into.slope = point->jacobian->row(0).transpose().cwiseProduct(ranges_) / unit;
  into.sides = sides_at(point->values);
  into.side_slopes.resize(into.sides.size(), ranges_.size());
  for (std::size_t k = 0; k < sides.size(); ++k) {
    into.side_slopes.row(static_cast<Eigen::Index>(k)) =
        sides[k].slope_factor(point->values) *
        point->jacobian->row(sides[k].row).cwiseProduct(ranges_.transpose());
  }
  return true;
}

// `sides`: values that the sides have without a step.
quadratic::QuadraticProgram TrustRegion::program_for(
    const VectorX& sides) const {
  quadratic::QuadraticProgram program{.hessian = hessian_,
                                      .slope = centre_.slope};
  program.low = (evaluator_.lower() - centre_.x)
                    .cwiseQuotient(ranges_)
                    .cwiseMax(-radius_)
                    .cwiseMin(0.0);
  program.high = (evaluator_.upper() - centre_.x)
                     .cwiseQuotient(ranges_)
                     .cwiseMin(radius_)
                     .cwiseMax(0.0);
  program.rows.resize(0, ranges_.size());
  for (Eigen::Index k = 0; k < sides.size(); ++k) {
    const VectorX row = centre_.side_slopes.row(k).transpose();
    program.add(row, -sides[k]);
    if (equation_[static_cast<std::size_t>(k)]) {
      program.add(-row, sides[k]);
    }
  }
  return program;
}

// What the sides bend by, from a step that answered.
void TrustRegion::learn_bends(const VectorX& step, const VectorX& values) {
  const VectorX above =
      sides_at(values) - centre_.sides - centre_.side_slopes * step;
  bends_ = (kForgotten * bends_).cwiseMax(2.0 / step.squaredNorm() * above);
}

// A step failed: true where it was to bring constraints to their bounds, near
// which parts fail most. Then these bend more than was thought, and it is for
// them to keep steps short.
bool TrustRegion::blame_constraints(const VectorX& step) {
  caution_ = std::min(2 * caution_, kMostCaution);
  cautious_ = caution_;
  bool blamed = false;
  const VectorX change = centre_.side_slopes * step;
  for (Eigen::Index k = 0; k < change.size(); ++k) {
    const bool reached =
        !equation_[static_cast<std::size_t>(k)] && change[k] > 0.0 &&
        centre_.sides[k] + change[k] + 0.5 * bends_[k] * step.squaredNorm() >
            -kBlamed * change[k];
    if (reached) {
      bends_[k] = std::max(kMoreBend * bends_[k],
                           2.0 * kBend * change[k] / step.squaredNorm());
      blamed = true;
    }
  }
  return blamed;
}

// The step whose end keeps the sides with their bends, by rounds of its own
// length.
std::optional<quadratic::QuadraticAnswer> TrustRegion::solve_with_bends(
    quadratic::QuadraticProgram program,
    quadratic::QuadraticAnswer plain) const {
  const VectorX limits = program.limits;
  for (int round = 0; round < kBendRounds; ++round) {
    Eigen::Index row = 0;
    for (Eigen::Index k = 0; k < bends_.size(); ++k, ++row) {
      if (equation_[static_cast<std::size_t>(k)]) {
        ++row;
        continue;
      }
      // A side that is kept may be brought half of the way; one that is missed
      // is to be kept by as much.
      const double most = limits[row] > 0.0 ? 0.5 * limits[row] : -limits[row];
      program.limits[row] =
          limits[row] -
          std::min(kBendSafety * 0.5 * bends_[k] * plain.step.squaredNorm(),
                   most);
    }
    const std::optional<quadratic::QuadraticAnswer> found =
        quadratic::solve_quadratic(program);
    if (!found) {
      return std::nullopt;
    }
    plain = *found;
  }
  return plain;
}

std::optional<Proposal> TrustRegion::propose(const VectorX& sides) const {
  quadratic::QuadraticProgram program = program_for(sides);
  const Eigen::Index own = program.limits.size();
  quadratic::QuadraticProgram cut = program;
  failed_.cut(centre_.x, ranges_, radius_, cut);
  Proposal proposal;
  std::optional<quadratic::QuadraticAnswer> found =
      quadratic::solve_quadratic(cut);
  if (found && cautious_ > 0) {
    found = solve_with_bends(cut, *found);
  }
  if (!found && own > 0) {
    // What cannot be kept, points that failed to keep away from among it, is
    // missed by as little as can be.
    const VectorX missed = quadratic::least_misses(cut);
    cut.limits += missed;
    cut.limits.array() += kRoom * (1.0 + missed.maxCoeff());
    proposal.relaxed = true;
    found = quadratic::solve_quadratic(cut);
  }
  if (!found) {  // rounding, of a model with curvatures of all sizes
    cut.hessian.diagonal().array() += cut.hessian.diagonal().maxCoeff();
    found = quadratic::solve_quadratic(cut);
  }
  if (!found) {
    return std::nullopt;
  }
  proposal.step = found->step;
  proposal.multipliers = VectorX::Zero(sides.size());
  Eigen::Index row = 0;
  for (Eigen::Index k = 0; k < sides.size(); ++k) {
    proposal.multipliers[k] = found->multipliers[row++];
    if (equation_[static_cast<std::size_t>(k)]) {
      proposal.multipliers[k] -= found->multipliers[row++];
    }
  }
  proposal.objective_gain =
      -(centre_.slope.dot(proposal.step) +
        0.5 * proposal.step.dot(hessian_ * proposal.step));
  proposal.missed =
      misses(sides + centre_.side_slopes * proposal.step, equation_);
  return proposal;
}

// M. J. D. Powell, A fast algorithm for nonlinearly constrained optimization
// calculations (1978): they follow the multipliers up at once, down by halves.
void TrustRegion::set_penalties(const Proposal& proposal) {
  if (!proposal.relaxed) {
    const VectorX wanted = kAboveMultipliers * proposal.multipliers.cwiseAbs();
    penalties_ = wanted.cwiseMax(0.5 * (penalties_ + wanted));
  }
  const VectorX closed = misses(centre_.sides, equation_) - proposal.missed;
  const double lacking =
      -proposal.objective_gain / kPenaltyPart - penalties_.dot(closed);
  const VectorX helped = closed.cwiseMax(0.0);
  if (lacking > 0.0 && helped.sum() > kRoom) {
    penalties_.array() +=
        lacking / helped.sum() * (helped.array() > 0.0).cast<double>();
  }
}

// True where a root-like side comes to be missed by much.
bool TrustRegion::leaves_roots(const VectorX& sides) const {
  const std::vector<ConstraintSide>& all = evaluator_.sides();
  for (std::size_t k = 0; k < all.size(); ++k) {
    const auto row = static_cast<Eigen::Index>(k);
    if (all[k].squared &&
        sides[row] > std::max(kMostMissed, centre_.sides[row])) {
      return true;
    }
  }
  return false;
}

TrustRegion::Outcome TrustRegion::judge(const VectorX& x,
                                        const MinimizePoint& point,
                                        double promised) {
  const double unit = evaluator_.objective_unit();
  const VectorX sides = sides_at(point.values);
  const double before = merit(centre_.objective, centre_.sides);
  const double after = merit(point.values[0] / unit, sides);
  const double rounding = kRoundingOfMerit * (1.0 + std::abs(before));
  ratio_ = promised <= rounding && after <= before + rounding
               ? 1.0
               : (before - after) / std::max(promised, rounding);
  if (leaves_roots(sides)) {
    ratio_ = 0.0;
    return Outcome::Rejected;
  }
  // The incumbent is where the search stands, whatever the merit says.
  const bool best = evaluator_.best() == x;
  if (ratio_ < kAccepted && !best) {
    return Outcome::Rejected;
  }
  if (x == centre_.x) {
    return Outcome::Rejected;
  }
  accepted_ = x;
  return Outcome::Accepted;
}

// The constraints' curvature along the step, taken off in a second one (A. R.
// Conn, N. I. M. Gould, P. L. Toint, Trust-Region Methods, 2000, 15.3.2.3).
// `first`: what the step without came to, which stands where this is no better.
// A step that is merely accepted at the edge of the box is corrected, too: else
// a curved constraint keeps the box as small as that curvature asks, and the
// search creeps along it.
TrustRegion::Outcome TrustRegion::correct(const Proposal& proposal,
                                          const MinimizePoint& point,
                                          double promised, Outcome first) {
  const VectorX curved =
      sides_at(point.values) - centre_.side_slopes * proposal.step;
  const std::optional<Proposal> again = propose(curved);
  if (!again || (again->step - proposal.step).cwiseAbs().maxCoeff() <=
                    evaluator_.same_design()) {
    return first;
  }
  const VectorX x =
      evaluator_.place(centre_.x + again->step.cwiseProduct(ranges_));
  const MinimizePoint* there = evaluator_.evaluate(x, EvaluationPhase::Step);
  if (there == nullptr) {
    return Outcome::Halted;
  }
  if (there->failure) {
    return first;
  }
  const double ratio = ratio_;
  const VectorX accepted = accepted_;
  const Outcome second = judge(x, *there, promised);
  if (first == Outcome::Accepted &&
      (second != Outcome::Accepted || ratio_ <= ratio)) {
    ratio_ = ratio;
    accepted_ = accepted;
    return first;
  }
  return second;
}

TrustRegion::Outcome TrustRegion::attempt(const Proposal& proposal) {
  set_penalties(proposal);
  const double promised =
      proposal.objective_gain +
      penalties_.dot(misses(centre_.sides, equation_) - proposal.missed);
  const VectorX x =
      evaluator_.place(centre_.x + proposal.step.cwiseProduct(ranges_));
  const MinimizePoint* point = evaluator_.evaluate(x, EvaluationPhase::Step);
  if (point == nullptr) {
    return Outcome::Halted;
  }
  if (point->failure) {
    if (blame_constraints(proposal.step)) {
      ++failures_in_a_row_;  // nothing else keeps the next one short
    } else {
      failed_.add(x);
    }
    return Outcome::Failed;
  }
  learn_bends(proposal.step, point->values);
  const Outcome outcome = judge(x, *point, promised);
  const bool held_back =
      outcome == Outcome::Rejected ||
      (ratio_ < kVeryGood &&
       proposal.step.cwiseAbs().maxCoeff() >= kAtEdge * radius_);
  return held_back && !equation_.empty()
             ? correct(proposal, *point, promised, outcome)
             : outcome;
}

void TrustRegion::update_hessian(const Linearised& before,
                                 const VectorX& multipliers) {
  const VectorX s = (centre_.x - before.x).cwiseQuotient(ranges_);
  VectorX y =
      centre_.slope - before.slope +
      (centre_.side_slopes - before.side_slopes).transpose() * multipliers;
  const double length = s.squaredNorm();
  if (!(length > 0.0) || !y.allFinite()) {
    return;
  }
  if (first_update_ && y.dot(s) > 0.0) {
    hessian_ *= std::clamp(y.squaredNorm() / y.dot(s), 1.0 / kFirstCurvature,
                           kFirstCurvature);
    first_update_ = false;
  }
  const VectorX Hs = hessian_ * s;
  const double sHs = s.dot(Hs);
  const double sy = s.dot(y);
  if (sy < kDamping * sHs) {
    const double part = (1.0 - kDamping) * sHs / (sHs - sy);
    y = part * y + (1.0 - part) * Hs;
  }
  hessian_ += y * y.transpose() / y.dot(s) - Hs * Hs.transpose() / sHs;
  hessian_ = Eigen::MatrixXd(0.5 * (hessian_ + hessian_.transpose()));
}

void TrustRegion::adjust_radius(Outcome outcome, double length) {
  if (outcome == Outcome::Failed) {
    // The first is kept away from by its cut alone: along it the way is free.
    radius_ = failures_in_a_row_++ == 0 ? length : kShorter * length;
    return;
  }
  failures_in_a_row_ = 0;
  if (outcome == Outcome::Rejected) {
    radius_ = (ratio_ < 0.0 ? kMuchShorter : kShorter) * length;
  } else if (ratio_ < kPoor) {
    radius_ = kShorter * length;
  } else if (ratio_ > kVeryGood && length >= kAtEdge * radius_) {
    radius_ =
        std::min(1.0, (cautious_ > 0 ? kGrowBesideFailures : kGrow) * radius_);
  }
}

// False once little is gained for long, beside points that fail or where
// constraints stay missed.
bool TrustRegion::worth_going_on() {
  const double scale =
      std::max(evaluator_.objective_scale(), evaluator_.objective_unit());
  const bool gained =
      gained_at_ == 0 ||
      evaluator_.best_violation() < (1.0 - kWorthIt) * gained_violation_ ||
      evaluator_.best_objective() < gained_objective_ - kWorthIt * scale;
  if (gained) {
    gained_objective_ = evaluator_.best_objective();
    gained_violation_ = evaluator_.best_violation();
    gained_at_ = evaluator_.evaluations();
    failed_at_gain_ = evaluator_.failed_evaluations();
    return true;
  }
  const int since = evaluator_.evaluations() - gained_at_;
  const bool held_up =
      evaluator_.best_violation() > kMissedByMuch ||
      2 * (evaluator_.failed_evaluations() - failed_at_gain_) >= since;
  return !held_up || since <= kPatience + static_cast<int>(ranges_.size());
}

SearchResult TrustRegion::run(const VectorX& start) {
  SearchResult result;
  if (!linearise(start, centre_)) {
    return result;
  }
  bends_ = VectorX::Zero(centre_.sides.size());
  penalties_ = VectorX::Zero(centre_.sides.size());
  const double least = evaluator_.same_design();
  result.message = "the steps are too small to matter";
  result.finished = true;
  while (true) {
    if (!worth_going_on()) {
      result.finished = false;
      result.message = evaluator_.best_violation() > kMissedByMuch
                           ? "what is missed comes no nearer to its bounds"
                           : "only designs that cannot be evaluated lie ahead";
      break;
    }
    const std::optional<Proposal> proposal = propose(centre_.sides);
    const double length = proposal ? proposal->step.cwiseAbs().maxCoeff() : 0.0;
    if (length <= least) {
      break;
    }
    const Outcome outcome = attempt(*proposal);
    ++result.iterations;
    if (outcome == Outcome::Halted) {
      break;
    }
    adjust_radius(outcome, length);
    if (outcome == Outcome::Accepted) {
      cautious_ = std::max(0, cautious_ - 1);
      failed_.passed(centre_.x, ranges_, accepted_);
      const Linearised before = centre_;
      if (!linearise(accepted_, centre_)) {
        break;
      }
      // Where sides cannot be kept their multipliers have no limit.
      update_hessian(
          before,
          proposal->multipliers.cwiseMin(penalties_).cwiseMax(-penalties_));
    }
  }
  constexpr double kBeside = 0.1;  // x the ranges
  result.walled = failed_.near(centre_.x, ranges_, kBeside);
  return result;
}

}  // namespace

SearchResult trust_region_run(MinimizeEvaluator& evaluator,
                              const VectorX& start, double radius) {
  return TrustRegion(evaluator, radius).run(start);
}

}  // namespace meniscus::optimize
