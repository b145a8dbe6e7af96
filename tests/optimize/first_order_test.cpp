#include "optimize/first_order.h"

#include <limits>

#include <gmock/gmock.h>

#include "core/error.h"
#include "optimize/quadratic/nonnegative_least_squares.h"
#include "optimize/samples/sampling.h"
#include "tests/support/standard_problems.h"

namespace meniscus::first_order_test {
namespace {

using tests::vector_of;

constexpr double kInf = std::numeric_limits<double>::infinity();

TEST(NonnegativeLeastSquares, MeetsItsOwnConditions) {
  // x >= 0, the gain A'(b - A x) <= 0, and both not at once.
  for (std::uint64_t seed = 1; seed <= 40; ++seed) {
    const samples::Samples rows = samples::latin_hypercube_samples(9, 14, seed);
    Eigen::MatrixXd A(14, 8);
    VectorX b(14);
    for (Eigen::Index i = 0; i < 14; ++i) {
      const VectorX row = rows[static_cast<std::size_t>(i)].array() - 0.5;
      A.row(i) = row.head(8).transpose();
      b[i] = row[8];
    }
    A.col(5) = A.col(2);  // a dependent column does no harm
    const VectorX x = quadratic::nonnegative_least_squares(A, b);
    const VectorX gain = A.transpose() * (b - A * x);
    EXPECT_GE(x.minCoeff(), 0.0);
    EXPECT_LE(gain.maxCoeff(), 1e-12);
    EXPECT_LE(x.cwiseProduct(gain).cwiseAbs().maxCoeff(), 1e-12);
  }
  EXPECT_EQ(quadratic::nonnegative_least_squares(Eigen::MatrixXd(3, 0),
                                                 VectorX::Ones(3))
                .size(),
            0);
}

// f = x + 2 y over x + y >= 1, in the box [0, 4]^2: the minimum is (1, 0).
optimize::FirstOrderInput corner(double x, double y) {
  optimize::FirstOrderInput input;
  input.x = vector_of({x, y});
  input.lower = vector_of({0.0, 0.0});
  input.upper = vector_of({4.0, 4.0});
  input.values = vector_of({x + 2.0 * y, x + y});
  input.jacobian.resize(2, 2);
  input.jacobian << 1.0, 2.0, 1.0, 1.0;
  input.constraint_lower = vector_of({1.0});
  input.constraint_upper = vector_of({kInf});
  input.constraint_scale = vector_of({1.0});
  input.objective_scale = 1.0;
  return input;
}

TEST(FirstOrder, VanishesAtTheMinimumWithItsMultipliers) {
  const optimize::FirstOrderReport report =
      optimize::first_order(corner(1.0, 0.0));
  EXPECT_LT(report.residual, 1e-14);
  EXPECT_NEAR(report.multipliers[0], -1.0, 1e-13);        // a lower bound
  EXPECT_NEAR(report.bound_multipliers[1], -1.0, 1e-13);  // y's lower bound
  EXPECT_NEAR(report.bound_multipliers[0], 0.0, 1e-13);
  EXPECT_EQ(report.violation, 0.0);
}

TEST(FirstOrder, IsAboutTheGainThatIsLeft) {
  // Off the corner by d, the objective can still fall by 2 d or so.
  for (const double d : {1e-2, 1e-4, 1e-6}) {
    const optimize::FirstOrderReport report =
        optimize::first_order(corner(1.0 + d, d));
    EXPECT_GT(report.residual, 0.2 * d);
    EXPECT_LT(report.residual, 5.0 * d);
  }
  EXPECT_GT(optimize::first_order(corner(2.0, 2.0)).residual, 0.5);
  const optimize::FirstOrderReport outside =
      optimize::first_order(corner(0.4, 0.0));
  EXPECT_NEAR(outside.violation, 0.6, 1e-15);
}

TEST(FirstOrder, DoesNotDependOnUnits) {
  const optimize::FirstOrderInput input = corner(1.2, 0.3);
  optimize::FirstOrderInput other = input;
  const double length = 1000.0;
  const double mass = 1e-3;
  const double stress = 50.0;
  other.x *= length;
  other.lower *= length;
  other.upper *= length;
  other.values[0] *= mass;
  other.values[1] *= stress;
  other.jacobian.row(0) *= mass / length;
  other.jacobian.row(1) *= stress / length;
  other.constraint_lower *= stress;
  other.constraint_scale *= stress;
  other.objective_scale *= mass;
  const optimize::FirstOrderReport a = optimize::first_order(input);
  const optimize::FirstOrderReport b = optimize::first_order(other);
  EXPECT_NEAR(a.residual, b.residual, 1e-12);
  EXPECT_NEAR(a.multipliers[0] * mass / stress, b.multipliers[0], 1e-15);
}

TEST(FirstOrder, RefusesSizesThatDoNotFit) {
  optimize::FirstOrderInput input = corner(1.0, 0.0);
  input.constraint_scale = vector_of({1.0, 1.0});
  EXPECT_THROW(optimize::first_order(input), InvalidInput);
}

}  // namespace
}  // namespace meniscus::first_order_test
