// A hundred random studies as parts are, each against the best that many starts
// and other methods find: sizes, matches, and members of families that start
// from a neighbour's answer.
#include <algorithm>
#include <cmath>
#include <limits>
#include <random>

#include <fmt/format.h>
#include <gmock/gmock.h>

#include "optimize/minimize.h"
#include "tests/support/standard_problems.h"

namespace meniscus::random_studies_test {
namespace {

constexpr double kOpen = std::numeric_limits<double>::infinity();
constexpr int kStudies = 100;
constexpr int kStarts = 12;       // of each, for the best known
constexpr double kWithin = 1e-3;  // of it, relative
constexpr int kMostMissed = 2;

class Draw {
 public:
  explicit Draw(unsigned seed) : engine_(seed) {}
  // The engine's bits are the same everywhere; those of distributions are not.
  double unit() { return engine_() * 0x1p-32; }
  double between(double low, double high) {
    return low + (high - low) * unit();
  }
  int below(int count) { return static_cast<int>(unit() * count); }

 private:
  std::mt19937 engine_;
};

// Bars of thickness t_j and length l_j under loads of several cases: mass sum
// rho l t, deflection of case i sum a_ij / t_j^p, stress of each b_j / t_j^q.
// Below a thickness of its own, which couples the bars, a design has no film.
struct Part {
  VectorX length;
  Eigen::MatrixXd soft;
  double power = 3.0;
  VectorX pinch;  // pinch . (1 / t) above `most`: no film
  double most = 0.0;
  VectorX start;

  optimize::MinimizeProblem problem(const VectorX& from) const {
    optimize::MinimizeProblem result;
    for (Eigen::Index j = 0; j < length.size(); ++j) {
      result.variables.push_back({fmt::format("t{}", j), from[j], 1.0, 10.0});
    }
    result.objective = "mass";
    for (Eigen::Index i = 0; i < soft.rows(); ++i) {
      result.constraints.push_back({fmt::format("case{}", i), -kOpen, 1.0, {}});
    }
    result.function = [this](const VectorX& t) -> optimize::VectorAnswer {
      if (pinch.dot(t.cwiseInverse()) > most) {
        return {.values = {},
                .failure = Failure{FailureKind::FilmPinched, "the neck"}};
      }
      VectorX values(1 + soft.rows());
      values << length.dot(t), soft * t.array().pow(-power).matrix();
      return {.values = values, .failure = {}};
    };
    result.jacobian = [this](const VectorX& t) -> optimize::JacobianAnswer {
      Eigen::MatrixXd jacobian(1 + soft.rows(), t.size());
      jacobian.row(0) = length.transpose();
      jacobian.bottomRows(soft.rows()) =
          soft * (-power * t.array().pow(-power - 1.0)).matrix().asDiagonal();
      return {.jacobian = jacobian, .failure = {}};
    };
    return result;
  }
};

Part random_part(Draw& draw) {
  const int n = 1 + draw.below(8);
  const int cases = 1 + draw.below(3);
  Part part{.length = VectorX(n),
            .soft = Eigen::MatrixXd(cases, n),
            .power = draw.between(1.0, 3.5),
            .pinch = VectorX(n),
            .start = VectorX(n)};
  // The deflections bind near t = reach, where the pinch is not far.
  const double reach = draw.between(2.0, 5.0);
  for (int j = 0; j < n; ++j) {
    part.length[j] = draw.between(0.3, 2.0);
    part.pinch[j] = draw.between(0.3, 1.0);
    part.start[j] = draw.between(5.0, 10.0);  // far
  }
  for (int i = 0; i < cases; ++i) {
    for (int j = 0; j < n; ++j) {
      part.soft(i, j) = draw.between(0.05, 1.0);
    }
    part.soft.row(i) *= std::pow(reach, part.power) / part.soft.row(i).sum();
  }
  part.most = draw.between(1.3, 3.0) * part.pinch.sum() / reach;
  return part;
}

struct Found {
  double objective = kOpen;  // of a design that keeps all
  VectorX best;
  int evaluations = 0;
  int failed = 0;
};

Found solve(const Part& part, const VectorX& from, const char* method) {
  const optimize::MinimizeReport report = optimize::minimize(
      part.problem(from),
      {.method = method,
       .optimality_tolerance = 1e-4,
       .max_evaluations = method == std::string("slsqp") ? 300 : 3000});
  return {report.feasible ? report.objective : kOpen, report.best,
          report.evaluations, report.failed_evaluations};
}

TEST(RandomStudies, EndAtTheBestKnown) {
  Draw draw(2026);
  int missed = 0;
  int worse = 0;
  int evaluations = 0;
  int failed = 0;
  std::string told;
  for (int k = 0; k < kStudies; ++k) {
    Part part = random_part(draw);
    VectorX start = part.start;
    if (k % 3 == 2) {  // a member: from the answer of a neighbour
      const Found neighbour = solve(part, start, "slsqp");
      for (double& number : part.soft.reshaped()) {
        number *= draw.between(0.7, 1.3);
      }
      start = neighbour.best;
    }
    const Found found = solve(part, start, "slsqp");
    evaluations += found.evaluations;
    failed += found.failed;
    double best = found.objective;
    for (int s = 0; s < kStarts; ++s) {
      VectorX from(start.size());
      for (double& number : from) {
        number = draw.between(1.0, 10.0);
      }
      best = std::min(best, solve(part, from,
                                  s % 4 == 3   ? "cobyla"
                                  : s % 4 == 2 ? "mma"
                                               : "slsqp")
                                .objective);
    }
    const optimize::VectorAnswer at_start = part.problem(start).function(start);
    const bool keeps =
        !at_start.failure &&
        at_start.values.tail(part.soft.rows()).maxCoeff() <= 1.0 + 1e-6;
    worse += keeps && found.objective > at_start.values[0] ? 1 : 0;
    if (!(found.objective <= best + kWithin * std::abs(best))) {
      ++missed;
      told += fmt::format(
          "study {} of {} variables: {:.6g}, best known {:.6g} "
          "({} evaluations, {} failed)\n",
          k, start.size(), found.objective, best, found.evaluations,
          found.failed);
    }
  }
  RecordProperty("missed", missed);
  RecordProperty("evaluations", evaluations);
  RecordProperty("failed", failed);
  EXPECT_LE(missed, kMostMissed) << told;
  EXPECT_EQ(worse, 0);
  // 14 evaluations each in the mean were seen, 5 % of them failed; a line
  // search that halves where designs fail took 18 and 11 %.
  EXPECT_LE(evaluations, 16 * kStudies);
  EXPECT_LE(100 * failed, 8 * evaluations);
}

}  // namespace
}  // namespace meniscus::random_studies_test
