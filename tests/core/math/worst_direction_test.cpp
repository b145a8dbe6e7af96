#include "core/math/worst_direction.h"

#include <cmath>
#include <random>
#include <vector>

#include <Eigen/Geometry>
#include <gtest/gtest.h>

namespace meniscus::worst_direction_test {
namespace {

constexpr double kPi = 3.14159265358979323846;
constexpr double kRounding = 1e-12;  // of the largest value
constexpr int kSamples = 10000;

Vec3 random_unit(std::mt19937& random) {
  std::normal_distribution<double> normal;
  const Vec3 v(normal(random), normal(random), normal(random));
  return v.normalized();
}

/// Even over the cone by area, its rim and axis among them.
Vec3 random_in(const Cone& cone, std::mt19937& random, int sample) {
  std::uniform_real_distribution<double> uniform;
  const double least = std::cos(cone.half_angle);
  const double c =
      sample % 3 == 0 ? least : least + (1.0 - least) * uniform(random);
  const double turn = 2.0 * kPi * uniform(random);
  const Vec3 u = cone.axis.unitOrthogonal();
  return c * cone.axis +
         std::sqrt(std::max(0.0, 1.0 - c * c)) *
             (std::cos(turn) * u + std::sin(turn) * cone.axis.cross(u));
}

Mat3 random_symmetric(std::mt19937& random) {
  const Vec3 axis = random_unit(random);
  const Mat3 R = Eigen::AngleAxisd(2.0, axis).toRotationMatrix();
  std::uniform_real_distribution<double> uniform(-1.0, 1.0);
  const Vec3 values(uniform(random), uniform(random), uniform(random));
  return R * values.asDiagonal() * R.transpose();
}

const std::vector<double> kAngles = {0.0, 0.02,      0.3, 0.9,
                                     1.4, 0.5 * kPi, 2.3, kPi};

double angle_between(const Vec3& a, const Vec3& b) {
  return std::atan2(a.cross(b).norm(), a.dot(b));
}

TEST(WorstDirection, NoSampleOfTheConeIsWorse) {
  std::mt19937 random(7);
  for (const double half_angle : kAngles) {
    const Cone cone{random_unit(random), half_angle};
    const Vec3 m = 3.0 * random_unit(random);
    const Mat3 Q = random_symmetric(random);
    const WorstDirection linear = worst_of_linear(m, cone);
    const WorstDirection quadratic = worst_of_quadratic(Q, cone);
    for (const WorstDirection& worst : {linear, quadratic}) {
      EXPECT_NEAR(worst.direction.norm(), 1.0, kRounding);
      EXPECT_LE(angle_between(worst.direction, cone.axis), half_angle + 1e-8);
    }
    EXPECT_NEAR(linear.value, m.dot(linear.direction), 3.0 * kRounding);
    EXPECT_NEAR(quadratic.value,
                quadratic.direction.dot(Q * quadratic.direction), kRounding);
    double most_linear = -10.0;
    double most_quadratic = -10.0;
    for (int s = 0; s < kSamples; ++s) {
      const Vec3 d = random_in(cone, random, s);
      most_linear = std::max(most_linear, m.dot(d));
      most_quadratic = std::max(most_quadratic, d.dot(Q * d));
    }
    EXPECT_LE(most_linear, linear.value + 3.0 * kRounding) << half_angle;
    EXPECT_LE(most_quadratic, quadratic.value + kRounding) << half_angle;
    // So many samples come close.
    EXPECT_GE(most_linear, linear.value - 0.02) << half_angle;
    EXPECT_GE(most_quadratic, quadratic.value - 0.02) << half_angle;
  }
}

TEST(WorstDirection, OfAllDirectionsIsNormOrEigenvalue) {
  const Cone all{Vec3::UnitZ(), kPi};
  EXPECT_NEAR(worst_of_linear(Vec3(1, -2, -2), all).value, 3.0, kRounding);
  EXPECT_NEAR(worst_of_quadratic(Vec3(1, 4, -9).asDiagonal(), all).value, 4.0,
              kRounding);
  // From a right angle on, too: a direction and its opposite are as bad.
  EXPECT_NEAR(worst_of_quadratic(Vec3(1, 4, -9).asDiagonal(),
                                 {Vec3::UnitX(), 0.5 * kPi})
                  .value,
              4.0, kRounding);
}

TEST(WorstDirection, OfAConeWithoutWidthIsItsAxis) {
  std::mt19937 random(3);
  for (int k = 0; k < 20; ++k) {
    const Cone cone{random_unit(random), 0.0};
    const Vec3 m = random_unit(random);
    const Mat3 Q = random_symmetric(random);
    EXPECT_NEAR(worst_of_linear(m, cone).value, m.dot(cone.axis), kRounding);
    EXPECT_NEAR(worst_of_quadratic(Q, cone).value, cone.axis.dot(Q * cone.axis),
                kRounding);
  }
}

/// What has several best directions, and the hard case of the rim's problem,
/// where the axis is across the larger of two values.
TEST(WorstDirection, EqualEigenvaluesAndTheHardCase) {
  const Cone cone{Vec3::UnitZ(), 0.5};
  const double s = std::sin(0.5);
  const double c = std::cos(0.5);
  EXPECT_NEAR(worst_of_quadratic(Mat3::Identity(), cone).value, 1.0, kRounding);
  EXPECT_NEAR(worst_of_quadratic(Vec3(3, 3, 1).asDiagonal(), cone).value,
              3.0 * s * s + c * c, kRounding);
  EXPECT_NEAR(worst_of_quadratic(Vec3(3, 2, 1).asDiagonal(), cone).value,
              3.0 * s * s + c * c, kRounding);
  EXPECT_NEAR(worst_of_quadratic(Mat3::Zero(), cone).value, 0.0, kRounding);
  // Pulled along the lesser value, strongly and weakly.
  for (const double pull : {0.01, 0.2, 5.0}) {
    Mat3 Q = Vec3(3, 2, 1).asDiagonal();
    Q(1, 2) = Q(2, 1) = pull;
    double most = -10.0;
    for (int k = 0; k < 100000; ++k) {
      const double turn = 2.0 * kPi * k / 100000;
      const Vec3 d(s * std::cos(turn), s * std::sin(turn), c);
      most = std::max(most, d.dot(Q * d));
    }
    const WorstDirection worst = worst_of_quadratic(Q, cone);
    EXPECT_GE(worst.value, most - kRounding) << pull;
    if (angle_between(worst.direction, cone.axis) > 0.4999) {
      EXPECT_LE(worst.value, most + 1e-8) << pull;
    }
  }
  EXPECT_EQ(worst_of_linear(Vec3::Zero(), cone).direction, cone.axis);
  EXPECT_NEAR(worst_of_linear(-Vec3::UnitZ(), cone).value, -c, kRounding);
}

TEST(WorstDirection, DerivativesAreThoseAtTheDirectionHeld) {
  constexpr double kStep = 1e-5;
  constexpr double kDifferences = 1e-8;
  std::mt19937 random(11);
  for (const double half_angle : kAngles) {
    const Cone cone{random_unit(random), half_angle};
    const Vec3 m = random_unit(random);
    const Vec3 dm = random_unit(random);
    const Mat3 Q = random_symmetric(random);
    const Mat3 dQ = random_symmetric(random);
    const Vec3 d = worst_of_linear(m, cone).direction;
    const Vec3 e = worst_of_quadratic(Q, cone).direction;
    EXPECT_NEAR((worst_of_linear(m + kStep * dm, cone).value -
                 worst_of_linear(m - kStep * dm, cone).value) /
                    (2.0 * kStep),
                dm.dot(d), kDifferences)
        << half_angle;
    EXPECT_NEAR((worst_of_quadratic(Q + kStep * dQ, cone).value -
                 worst_of_quadratic(Q - kStep * dQ, cone).value) /
                    (2.0 * kStep),
                e.dot(dQ * e), kDifferences)
        << half_angle;
  }
}

}  // namespace
}  // namespace meniscus::worst_direction_test
