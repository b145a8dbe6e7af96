#include "fea/functionals/thickness.h"

#include <cmath>

#include <gtest/gtest.h>

#include "core/error.h"
#include "tests/support/derivatives.h"
#include "tests/support/gradient_parts.h"

namespace meniscus::thickness_test {
namespace {

constexpr double kThicknessRounding = 1e-12;

/// The bounds of a smooth minimum.
void expect_least(const TetMesh& mesh, double exact, double error) {
  const functionals::ThicknessPairs pairs = functionals::thickness_pairs(mesh);
  constexpr double kSharpness = 400.0;
  const double value =
      functionals::thickness_functional(mesh, pairs, kSharpness).value;
  EXPECT_LE(value, exact + error);
  EXPECT_GE(value,
            exact - error - std::log(1.0 * pairs.faces.size()) / kSharpness);
}

class Thickness : public testing::TestWithParam<int> {
 protected:
  static TetMesh of_order(const TetMesh& mesh) {
    return GetParam() == 1 ? mesh : shapes::straight_quadratic(mesh);
  }
};

TEST_P(Thickness, OfAPlateIsExact) {
  expect_least(of_order(shapes::brick({2.0, 1.0, 0.2}, 7, 3, 2)), 0.2,
               kThicknessRounding);
}

// A wedge from 0.1 to 0.3 thick along x from 0 to 2.
TEST_P(Thickness, ThinnestPlaceOfAWedge) {
  TetMesh wedge = shapes::brick({2.0, 1.0, 1.0}, 20, 3, 2);
  for (Vec3& p : wedge.nodes) {
    p.z() *= 0.1 + 0.1 * p.x();
  }
  wedge = of_order(wedge);
  const functionals::ThinPlace thin = functionals::thinnest_place(
      wedge, functionals::thickness_pairs(wedge), 0.2);
  EXPECT_NEAR(thin.value, 0.1, 0.01);
  EXPECT_LT(thin.place.x(), 0.1);
  EXPECT_NEAR(thin.share, 0.5, 0.06);  // x below 1, by facets of 0.1
  EXPECT_EQ(functionals::thinnest_place(
                wedge, functionals::thickness_pairs(wedge), 0.05)
                .share,
            0.0);
}

/// A wall of thickness 1 between radii 1 and 2, as thick as its height is.
TEST_P(Thickness, OfACurvedWallConvergesAtSecondOrder) {
  double before = 0.0;
  for (const int n : {2, 4}) {
    TetMesh mesh = shapes::brick({1.0, 1.5, 4.0}, n, 3 * n, 4);
    for (Vec3& x : mesh.nodes) {
      const double r = 1.0 + x.x();
      x = Vec3(r * std::cos(x.y()), r * std::sin(x.y()), x.z());
    }
    mesh = of_order(mesh);
    const functionals::ThicknessPairs pairs =
        functionals::thickness_pairs(mesh);
    // So sharp that the logarithm counts little.
    const double error = std::abs(
        functionals::thickness_functional(mesh, pairs, 1e5).value - 1.0);
    EXPECT_LE(error, 0.1 / (n * n));
    if (before > 0.0) {
      EXPECT_GE(before / error, 2.5);
    }
    before = error;
  }
}

TEST_P(Thickness, HasDerivatives) {
  const TetMesh mesh = gradient_parts::block(GetParam());
  const functionals::ThicknessPairs pairs = functionals::thickness_pairs(mesh);
  derivatives::expect_partials(
      mesh, VectorX::Zero(static_cast<Eigen::Index>(3 * mesh.nodes.size())),
      [&](const TetMesh& at, const VectorX&) {
        return functionals::thickness_functional(at, pairs, 30.0);
      });
  EXPECT_THROW(functionals::thickness_functional(mesh, pairs, -1.0),
               InvalidInput);
}

/// A plate of thickness 1 whose ends lean: edges of 40 degrees.
TEST_P(Thickness, SharpEdgesAreNoThinWalls) {
  TetMesh plate = shapes::brick({6.0, 2.0, 1.0}, 24, 8, 4);
  for (Vec3& p : plate.nodes) {
    p.x() += 1.2 * p.z();
  }
  plate = of_order(plate);
  const functionals::ThicknessPairs pairs = functionals::thickness_pairs(plate);
  EXPECT_NEAR(pairs.least, 1.0, kThicknessRounding);
  EXPECT_GT(pairs.faces.size(), 200U);
}

/// As long as it does not come to a feather: 6 degrees are a thin wall.
TEST_P(Thickness, FeathersAreThin) {
  TetMesh feather = shapes::brick({2.0, 1.0, 1.0}, 20, 6, 1);
  for (Vec3& p : feather.nodes) {
    p.z() *= 0.01 + 0.1 * p.x();
  }
  feather = of_order(feather);
  EXPECT_LT(functionals::thickness_pairs(feather).least, 0.03);
}

/// Where the planes of two faces cross beside a feather edge the least distance
/// is below 0, and the thickness still has a value near it.
TEST_P(Thickness, FeathersWhosePlanesCrossHaveOne) {
  const TetMesh plate = of_order(shapes::brick({2.0, 1.0, 0.2}, 8, 4, 1));
  functionals::ThicknessPairs pairs = functionals::thickness_pairs(plate);
  EXPECT_NEAR(pairs.median, 0.2, kThicknessRounding);
  for (const double least : {-0.01, 0.0, 1e-9}) {
    pairs.least = least;
    const double sharpness = functionals::usual_sharpness(pairs);
    ASSERT_GT(sharpness, 0.0);
    const double value =
        functionals::thickness_functional(plate, pairs, sharpness).value;
    EXPECT_LE(value, 0.2);
    EXPECT_GE(value, 0.2 - 0.05 * 0.02 * 0.2 - kThicknessRounding);
  }
}

/// However many pairs there are, and however small the wall.
TEST_P(Thickness, UsualSharpnessStaysNearTheLeast) {
  for (const int n : {2, 8, 20}) {
    for (const double thickness : {0.02, 0.2}) {
      const TetMesh plate =
          of_order(shapes::brick({2.0, 1.0, thickness}, 2 * n, n, 1));
      const functionals::ThicknessPairs pairs =
          functionals::thickness_pairs(plate);
      const double value =
          functionals::thickness_functional(plate, pairs,
                                            functionals::usual_sharpness(pairs))
              .value;
      EXPECT_LE(value, thickness);
      EXPECT_GE(value, 0.9499 * thickness);
    }
  }
}

INSTANTIATE_TEST_SUITE_P(Orders, Thickness, testing::Values(1, 2));

}  // namespace
}  // namespace meniscus::thickness_test
