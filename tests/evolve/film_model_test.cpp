#include "evolve/film_model.h"

#include <cmath>
#include <thread>

#include <Eigen/Dense>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/evolve/film_systems.h"

namespace meniscus {
namespace {

using systems::two_arm;

/// Frozen once: every test asks the same model.
const FilmModel& bracket() {
  static const FilmModel model = FilmModel::freeze(two_arm(0), {.edge = 8.0});
  return model;
}

double smallest_angle_deg(const SurfaceMesh& mesh) {
  double least = 180.0;
  for (const Triangle& t : mesh.facets) {
    for (int k = 0; k < 3; ++k) {
      const Vec3 u = mesh.points[t[(k + 1) % 3]] - mesh.points[t[k]];
      const Vec3 v = mesh.points[t[(k + 2) % 3]] - mesh.points[t[k]];
      least = std::min(least, std::atan2(u.cross(v).norm(), u.dot(v)));
    }
  }
  return least * 180.0 / std::numbers::pi;
}

TEST(FilmModel, BracketIsStableOverItsBounds) {
  for (const double x : {-40.0, -20.0, 0.0, 20.0, 40.0}) {
    const FilmState state = bracket().settle(two_arm(x));
    ASSERT_FALSE(state.failure) << x << ": " << state.report.verdict;
    EXPECT_EQ(state.report.index, 0);
    EXPECT_GT(state.report.min_eigenvalue, 0.0);
    EXPECT_LE(state.report.residual, state.report.residual_bound);
    EXPECT_NEAR(state.report.bodies[0].volume, 1.7e6, 1e-10 * 1.7e6);
    EXPECT_GT(state.report.smallest_neck, 20.0);
  }
}

TEST(FilmModel, ReferenceIsTheInitialDesign) {
  const FilmState state = bracket().settle(two_arm(0));
  EXPECT_TRUE(state.points == bracket().reference().points);
  EXPECT_LT(state.heights.cwiseAbs().maxCoeff(), 1e-3);
}

TEST(FilmModel, MirroredDesignsHaveEqualAreas) {
  const double left = bracket().settle(two_arm(-25)).report.area;
  const double right = bracket().settle(two_arm(25)).report.area;
  EXPECT_NEAR(left, right, 1e-4 * left);  // the triangulation's own error
}

TEST(FilmModel, NoHistoryAndNoThreadsShow) {
  const FilmState first = bracket().settle(two_arm(10));
  FilmState other;
  FilmState again;
  std::thread a([&] { other = bracket().settle(two_arm(-7)); });
  std::thread b([&] { again = bracket().settle(two_arm(10)); });
  a.join();
  b.join();
  EXPECT_FALSE(other.failure);
  EXPECT_TRUE(first.points == again.points);
  EXPECT_EQ(first.report.energy, again.report.energy);
}

// The area over 5 mm of support_x departs from a quartic by rounding only.
TEST(FilmModel, AreaIsASmoothFunctionOfTheDesign) {
  constexpr int kSamples = 11;
  Eigen::MatrixXd powers(kSamples, 5);
  VectorX area(kSamples);
  for (int i = 0; i < kSamples; ++i) {
    const double s = 2.0 * i / (kSamples - 1) - 1.0;
    area[i] = bracket().settle(two_arm(12.0 + 2.5 * s)).report.area;
    for (int k = 0; k < 5; ++k) {
      powers(i, k) = std::pow(s, k);
    }
  }
  const VectorX fit = powers.colPivHouseholderQr().solve(area);
  const double departure = (powers * fit - area).cwiseAbs().maxCoeff();
  EXPECT_LT(departure, 1e-9 * area[0]);
}

TEST(FilmModel, SurfaceIsClosedWithGoodFacetsAndFlatPads) {
  const FilmState state = bracket().settle(two_arm(30));
  const QuadraticSurface surface = bracket().surface(state.points);
  EXPECT_NEAR(enclosed_volume(surface.base), 1.7e6, 0.03 * 1.7e6);
  EXPECT_GT(smallest_angle_deg(surface.base), 25.0);
  for (const Triangle& edges : surface.facet_edges) {
    for (const int e : edges) {
      const Edge& ends = surface.edges[e];
      const Vec3& a = surface.base.points[ends[0]];
      const Vec3& b = surface.base.points[ends[1]];
      EXPECT_LT((surface.mid[e] - 0.5 * (a + b)).norm(), 0.2 * (b - a).norm());
    }
  }
  const int pad = surface.base.label_of("support_pad");
  for (std::size_t f = 0; f < surface.base.facets.size(); ++f) {
    if (surface.base.facet_label[f] == pad) {
      for (const int v : surface.base.facets[f]) {
        EXPECT_NEAR(surface.base.points[v].z(), 0.0, 1e-10);
      }
    }
  }
  EXPECT_NEAR(enclosed_volume(bracket().fine_mesh(state.points)), 1.7e6, 1e-3);
}

TEST(FilmModel, ThinDesignFailsCleanly) {
  const FilmState state = bracket().settle(two_arm(40, 1.0e6));
  ASSERT_TRUE(state.failure);
  EXPECT_THAT(state.failure->message, testing::HasSubstr("neck"));
  EXPECT_THAT(state.failure->message, testing::HasSubstr("would help"));
}

// Pinched films settle too: only the neck tells.
TEST(FilmModel, SettledButPinchedFilmIsRecognised) {
  const FilmState state = bracket().settle(two_arm(40, 1.55e6));
  ASSERT_TRUE(state.failure) << state.report.verdict;
}

TEST(FilmModel, SlenderArmsFailWithTheNeck) {
  const FilmModel model =
      FilmModel::freeze(two_arm(0, 0.9e6, 220.0, 25.0), {.edge = 10.0});
  ASSERT_TRUE(model.reference().failure);
  EXPECT_THAT(model.reference().failure->message, testing::HasSubstr("neck"));
}

TEST(FilmModel, CatenoidHasItsLimit) {
  const FilmModel inside =
      FilmModel::freeze(systems::catenoid(1.31), {.edge = 0.1});
  EXPECT_FALSE(inside.reference().failure) << inside.reference().report.verdict;
  const FilmModel beyond =
      FilmModel::freeze(systems::catenoid(1.34), {.edge = 0.1});
  EXPECT_TRUE(beyond.reference().failure);
}

TEST(FilmModel, RefusesDesignsOfAnotherSystem) {
  FilmSystem renamed = two_arm(0);
  renamed.curves[0].name = "foot";
  EXPECT_THROW(bracket().settle(renamed), InvalidInput);
  FilmSystem pressed = two_arm(0);
  pressed.bodies[0].volume.reset();
  pressed.bodies[0].pressure = 0.01;
  EXPECT_THROW(bracket().settle(pressed), InvalidInput);
  EXPECT_THROW(FilmModel::freeze(two_arm(0), {.edge = 0.0}), InvalidInput);
}

TEST(FilmModel, RefusesNumbersThatNoFilmCanFollow) {
  const double nan = std::nan("");
  EXPECT_THROW(bracket().settle(two_arm(nan)), InvalidInput);
  EXPECT_THROW(bracket().settle(two_arm(0, nan)), InvalidInput);
  EXPECT_THROW(bracket().settle(two_arm(0, -1.0)), InvalidInput);
  EXPECT_THROW(bracket().settle(two_arm(0, 1.7e6, 120.0, -50.0)), InvalidInput);
  FilmSystem slack = two_arm(0);
  slack.films[0].tension = 0.0;
  EXPECT_THROW(bracket().settle(slack), InvalidInput);
  EXPECT_THROW(FilmModel::freeze(slack, {.edge = 8.0}), InvalidInput);
}

}  // namespace
}  // namespace meniscus
