#include "fea/stress/singular_edges.h"

#include <cmath>
#include <numbers>

#include <gtest/gtest.h>

#include "tests/support/parts.h"

namespace meniscus::singular_edges_test {
namespace {

constexpr double kDegree = std::numbers::pi / 180.0;

// Tables of Williams' roots: M. L. Williams (1952); Z. Suo's and others' 0.5445
// of a right-angled notch; 0.711 of a clamped right angle at nu = 0.3.
TEST(SingularEdges, OrdersAreThoseOfTables) {
  constexpr double kTable = 6e-4;
  EXPECT_EQ(stress::groove_order(90.0 * kDegree), 0.0);
  EXPECT_EQ(stress::groove_order(180.0 * kDegree), 0.0);
  EXPECT_NEAR(stress::groove_order(240.0 * kDegree), 1.0 - 0.6157, kTable);
  EXPECT_NEAR(stress::groove_order(270.0 * kDegree), 1.0 - 0.5445, kTable);
  EXPECT_NEAR(stress::groove_order(360.0 * kDegree), 0.5, kTable);  // a crack
  EXPECT_NEAR(stress::clamp_order(90.0 * kDegree, 0.3), 1.0 - 0.7112, kTable);
  EXPECT_EQ(stress::clamp_order(45.0 * kDegree, 0.3), 0.0);
  EXPECT_NEAR(stress::clamp_order(180.0 * kDegree, 0.3), 0.5, kTable);
}

/// A root of the equation that the order says.
TEST(SingularEdges, OrdersSolveTheirEquations) {
  for (int degrees = 185; degrees < 360; degrees += 5) {
    const double angle = degrees * kDegree;
    const double root = 1.0 - stress::groove_order(angle);
    EXPECT_NEAR(std::sin(root * angle), -root * std::sin(angle), 1e-12);
    EXPECT_GT(stress::groove_order(angle),
              stress::groove_order(angle - kDegree));
  }
}

std::vector<char> held(const TetMesh& mesh, const std::string& surface) {
  std::vector<char> faces;
  for (const int label : mesh.face_label) {
    faces.push_back(label == mesh.label_of(surface) ? 1 : 0);
  }
  return faces;
}

class OfBrick : public testing::TestWithParam<int> {
 protected:
  const TetMesh mesh_ =
      GetParam() == 1
          ? shapes::brick({2.0, 1.0, 1.0}, 6, 3, 3)
          : shapes::straight_quadratic(shapes::brick({2.0, 1.0, 1.0}, 6, 3, 3));
};

TEST_P(OfBrick, RidgesAreNone) {
  EXPECT_TRUE(
      stress::singular_edges(mesh_, held(mesh_, "no such surface"), {0.3})
          .empty());
}

TEST_P(OfBrick, AClampsRimIs) {
  const auto edges = stress::singular_edges(mesh_, held(mesh_, "x0"), {0.3});
  ASSERT_EQ(edges.size(), 12U);  // three along each of four sides
  for (const stress::SingularEdge& edge : edges) {
    EXPECT_TRUE(edge.clamped);
    EXPECT_EQ(mesh_.labels[static_cast<std::size_t>(edge.labels[0])], "x0");
    EXPECT_NEAR(edge.angle, 90.0 * kDegree, 1e-12);
    EXPECT_NEAR(edge.order, 0.2888, 1e-3);
    for (const int corner : edge.corners) {
      EXPECT_EQ(mesh_.nodes[static_cast<std::size_t>(corner)].x(), 0.0);
    }
  }
}

/// The upper half in front leans forward: a groove across the top face's rim
/// with the end, none before.
TEST_P(OfBrick, ATurnIntoTheMaterialIs) {
  TetMesh mesh = mesh_;
  for (Vec3& p : mesh.nodes) {  // the end leans out, the top rises to it
    p.z() += p.x() > 1.0 ? 2.0 * (p.x() - 1.0) : 0.0;
  }
  // One surface bent by less than what facets of a round one might be.
  EXPECT_EQ(
      stress::singular_edges(mesh, held(mesh, "no such surface"), {0.3}).size(),
      3U);  // atan 2 = 63 degrees, three edges across the top
  for (const stress::SingularEdge& edge :
       stress::singular_edges(mesh, held(mesh, "no such surface"), {0.3})) {
    EXPECT_NEAR(edge.angle, std::numbers::pi + std::atan(2.0), 1e-9);
    EXPECT_FALSE(edge.clamped);
  }
}

/// In a plane of symmetry edges are those of the whole.
TEST_P(OfBrick, PlanesOfSymmetryHaveTheWholesEdges) {
  const auto edges = stress::singular_edges(mesh_, held(mesh_, "x0"), {0.3},
                                            held(mesh_, "y0"));
  EXPECT_EQ(edges.size(), 9U);  // the clamp goes on beyond y0
  TetMesh mesh = mesh_;
  for (Vec3& p : mesh.nodes) {
    p.z() += 0.6 * p.x();
  }
  const std::vector<char> none = held(mesh, "no such surface");
  const auto grooves =
      stress::singular_edges(mesh, none, {0.3}, held(mesh, "x0"));
  ASSERT_EQ(grooves.size(), 3U);  // across the top, 121 degrees each side
  for (const stress::SingularEdge& edge : grooves) {
    EXPECT_NEAR(edge.angle, std::numbers::pi + 2.0 * std::atan(0.6), 1e-9);
    EXPECT_EQ(edge.order, stress::groove_order(edge.angle));
  }
}

TEST_P(OfBrick, TheirLargestPeakGrowsByItsOrder) {
  const auto edges = stress::singular_edges(mesh_, held(mesh_, "x0"), {0.3});
  const elastic::ElasticModel model(mesh_, {parts::steel()},
                                    {parts::pulled({1.0, 0.0, 0.0})});
  const stress::RecoveredStress recovered = stress::recover_by_patches(
      mesh_, element::point_stress(mesh_, {parts::steel()},
                                   model.base_solution().displacements[0]));
  const auto peak =
      stress::largest_singular_peak(mesh_, edges, recovered, {}, 4.0);
  ASSERT_TRUE(peak);
  EXPECT_EQ(peak->position.x(), 0.0);
  EXPECT_NEAR(peak->grown / peak->von_mises, std::pow(4.0, peak->edge.order),
              1e-12);
  EXPECT_FALSE(stress::largest_singular_peak(
      mesh_, edges, recovered,
      stress::excluded_by(mesh_, {{.surface = "x0", .distance = 0.1}}), 4.0));
}

INSTANTIATE_TEST_SUITE_P(Orders, OfBrick, testing::Values(1, 2));

}  // namespace
}  // namespace meniscus::singular_edges_test
