#include "optimize/multipliers.h"

#include <cmath>
#include <limits>
#include <random>

#include <fmt/format.h>
#include <gmock/gmock.h>

namespace meniscus::multipliers_test {
namespace {

using optimize::BindingBound;
using optimize::BoundSide;
using optimize::MinimizeProblem;
using optimize::MinimizeReport;
using optimize::Multipliers;

constexpr double kOpen = std::numeric_limits<double>::infinity();
constexpr int kPrograms = 60;
constexpr double kOptimality = 1e-7;
// Of a residual as small, over gradients of about 1.
constexpr double kExact = 1e-5;

class Draw {
 public:
  explicit Draw(unsigned seed) : engine_(seed) {}
  double between(double low, double high) {
    return low + (high - low) * engine_() * 0x1p-32;
  }
  VectorX vector(Eigen::Index size) {
    VectorX result(size);
    for (double& entry : result) {
      entry = between(-1.0, 1.0);
    }
    return result;
  }

 private:
  std::mt19937 engine_;
};

// min (x - s) . Q (x - s) / 2 + g . (x - s), rows x within their bounds, x in a
// box. Built around its solution s: g is what the slopes that are drawn for the
// bounds that bind leave of the gradient.
struct ConvexProgram {
  Eigen::MatrixXd Q;
  VectorX g;
  VectorX solution;
  Eigen::MatrixXd rows;
  MinimizeProblem problem;
  VectorX row_slopes;  // d minimum / d bound, 0 of those that do not bind
  VectorX box_slopes;

  void bind_rows(Draw& draw) {
    for (Eigen::Index i = 0; i < rows.rows(); ++i) {
      const double value = rows.row(i).dot(solution);
      optimize::ResponseBounds bounds{fmt::format("row{}", i), -kOpen, kOpen};
      const double slope = draw.between(0.1, 1.0);
      if (i % 4 == 0) {  // an equation
        bounds.lower = bounds.upper = value;
        row_slopes[i] = i % 8 == 0 ? slope : -slope;
      } else if (i % 4 == 1) {
        bounds.upper = value;
        row_slopes[i] = -slope;
      } else if (i % 4 == 2) {
        bounds.lower = value;
        bounds.upper = value + 3.0;
        row_slopes[i] = slope;
      } else {
        bounds.upper = value + draw.between(0.5, 2.0);  // slack
      }
      bounds.scale = 1.0;
      problem.constraints.push_back(bounds);
    }
  }

  void bind_box(Draw& draw) {
    for (Eigen::Index j = 0; j < solution.size(); ++j) {
      const double slope = draw.between(0.1, 1.0);
      double below = draw.between(0.5, 2.0);
      double above = draw.between(0.5, 2.0);
      if (j % 3 == 0) {
        below = 0.0;
        box_slopes[j] = slope;
      } else if (j % 6 == 1) {
        above = 0.0;
        box_slopes[j] = -slope;
      }
      const double start = draw.between(-below, above);
      problem.variables.push_back({fmt::format("x{}", j), solution[j] + start,
                                   solution[j] - below, solution[j] + above});
    }
  }

  double objective(const VectorX& x) const {
    const VectorX d = x - solution;
    return 0.5 * d.dot(Q * d) + g.dot(d) + 1.0;
  }
};

ConvexProgram random_program(unsigned seed) {
  Draw draw(seed);
  const Eigen::Index n = 6 + seed % 5;
  const Eigen::Index m = 1 + seed % 4;  // fewer than what the box leaves free
  ConvexProgram program{.Q = Eigen::MatrixXd::Identity(n, n),
                        .g = VectorX::Zero(n),
                        .solution = draw.vector(n),
                        .rows = Eigen::MatrixXd(m, n),
                        .row_slopes = VectorX::Zero(m),
                        .box_slopes = VectorX::Zero(n)};
  for (Eigen::Index j = 0; j < n; ++j) {
    const VectorX a = draw.vector(n);
    program.Q += a * a.transpose() / static_cast<double>(n);
  }
  for (Eigen::Index i = 0; i < m; ++i) {
    program.rows.row(i) = draw.vector(n).transpose();
  }
  program.bind_rows(draw);
  program.bind_box(draw);
  program.g =
      program.rows.transpose() * program.row_slopes + program.box_slopes;
  program.problem.objective = "quadratic";
  return program;
}

MinimizeReport solve(const ConvexProgram& program, MinimizeProblem problem) {
  problem.function = [&](const VectorX& x) -> optimize::VectorAnswer {
    VectorX values(1 + program.rows.rows());
    values << program.objective(x), program.rows * x;
    return {.values = values, .failure = {}};
  };
  problem.jacobian = [&](const VectorX& x) -> optimize::JacobianAnswer {
    Eigen::MatrixXd jacobian(1 + program.rows.rows(), x.size());
    jacobian.row(0) =
        (program.Q * (x - program.solution) + program.g).transpose();
    jacobian.bottomRows(program.rows.rows()) = program.rows;
    return {.jacobian = jacobian, .failure = {}};
  };
  return optimize::minimize(problem, {.optimality_tolerance = kOptimality,
                                      .feasibility_tolerance = 1e-9});
}

// Slopes where bounds bind, 0 elsewhere: of the constraints, then of the box.
VectorX slopes(const ConvexProgram& program, const Multipliers& found) {
  const Eigen::Index m = program.rows.rows();
  VectorX all = VectorX::Zero(m + program.solution.size());
  for (const BindingBound& bound : found.binding) {
    all[static_cast<Eigen::Index>(bound.index) + (bound.of_variable ? m : 0)] =
        bound.slope;
  }
  return all;
}

TEST(Multipliers, AreThoseThatRandomConvexProgramsAreMadeOf) {
  for (unsigned seed = 1; seed <= kPrograms; ++seed) {
    const ConvexProgram program = random_program(seed);
    const MinimizeReport report = solve(program, program.problem);
    ASSERT_EQ(report.termination, optimize::Termination::Converged)
        << seed << ": " << report.message;
    const auto found = optimize::multipliers(program.problem.variables, report);
    ASSERT_TRUE(found);
    EXPECT_LE(found->residual, kOptimality);
    VectorX expected(program.row_slopes.size() + program.box_slopes.size());
    expected << program.row_slopes, program.box_slopes;
    EXPECT_LT((slopes(program, *found) - expected).cwiseAbs().maxCoeff(),
              kExact)
        << seed;
    for (std::size_t k = 1; k < found->binding.size(); ++k) {
      EXPECT_GE(found->binding[k - 1].weight, found->binding[k].weight);
    }
  }
}

TEST(Multipliers, AreWhatBoundsThatMoveCost) {
  constexpr double kStep = 1e-3;
  const ConvexProgram program = random_program(4);
  const auto least = [&](const BindingBound& bound, double step) {
    MinimizeProblem moved = program.problem;
    if (bound.of_variable) {
      optimize::Variable& variable = moved.variables[bound.index];
      (bound.side == BoundSide::Lower ? variable.lower : variable.upper) +=
          step;
      variable.initial =
          std::clamp(variable.initial, variable.lower, variable.upper);
    } else {
      optimize::ResponseBounds& bounds = moved.constraints[bound.index];
      bounds.lower += bound.side == BoundSide::Upper ? 0.0 : step;
      bounds.upper += bound.side == BoundSide::Lower ? 0.0 : step;
    }
    return solve(program, moved).objective;
  };
  const auto found = optimize::multipliers(program.problem.variables,
                                           solve(program, program.problem));
  ASSERT_TRUE(found);
  EXPECT_GE(found->binding.size(), 4U);
  for (const BindingBound& bound : found->binding) {
    // Exact but for the residuals: the minimum is quadratic in a bound.
    EXPECT_NEAR((least(bound, kStep) - least(bound, -kStep)) / (2.0 * kStep),
                bound.slope, 1e-3);
  }
}

TEST(Multipliers, CountByTheBoundsThatCountInTheEnd) {
  // x^2 from x = 3 down to the case's 1, in a search that was held near 2.
  MinimizeProblem problem;
  problem.objective = "square";
  problem.variables = {
      {.name = "x", .initial = 2.0, .lower = 1.8, .upper = 2.2, .range = 3.0}};
  problem.function = [](const VectorX& x) -> optimize::VectorAnswer {
    return {.values = x.cwiseAbs2(), .failure = {}};
  };
  problem.jacobian = [](const VectorX& x) -> optimize::JacobianAnswer {
    return {.jacobian = 2.0 * x, .failure = {}};
  };
  const MinimizeReport report = optimize::minimize(problem, {});
  const auto near = optimize::multipliers(problem.variables, report);
  ASSERT_TRUE(near);
  ASSERT_EQ(near->binding.size(), 1U);
  EXPECT_EQ(near->binding[0].side, BoundSide::Lower);
  EXPECT_NEAR(near->binding[0].slope, 3.6, 1e-12);
  EXPECT_LT(near->residual, 1e-12);

  std::vector<optimize::Variable> wide = problem.variables;
  wide[0].lower = 1.0;
  wide[0].upper = 4.0;
  const auto far = optimize::multipliers(wide, report);
  ASSERT_TRUE(far);
  EXPECT_TRUE(far->binding.empty());
  EXPECT_GT(far->residual, 0.1);  // it is no minimum within these
}

TEST(Multipliers, AreNotToldOfWhatMissesAConstraint) {
  const ConvexProgram program = random_program(5);
  MinimizeReport report = solve(program, program.problem);
  report.feasible = false;
  EXPECT_FALSE(optimize::multipliers(program.problem.variables, report));
  report.feasible = true;
  report.first_order.reset();
  EXPECT_FALSE(optimize::multipliers(program.problem.variables, report));
}

}  // namespace
}  // namespace meniscus::multipliers_test
