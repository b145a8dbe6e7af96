#include "evolve/frozen/film_model.h"

#include <cmath>
#include <thread>

#include <Eigen/Dense>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/support/film_systems.h"
#include "tests/support/systems.h"

namespace meniscus::film_model_test {
namespace {

using systems::two_arm;

/// Frozen once: every test asks the same model.
const frozen::FilmModel& bracket() {
  static const frozen::FilmModel model =
      frozen::FilmModel::freeze(two_arm(0), {.edge = 8.0});
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
    const settle::FilmState state = bracket().settle(two_arm(x));
    ASSERT_FALSE(state.failure) << x << ": " << state.report.verdict;
    EXPECT_EQ(state.report.index, 0);
    EXPECT_GT(state.report.min_eigenvalue, 0.0);
    EXPECT_LE(state.report.residual, state.report.residual_bound);
    EXPECT_NEAR(state.report.bodies[0].volume, 1.7e6, 1e-10 * 1.7e6);
    EXPECT_GT(state.report.smallest_neck, 20.0);
  }
}

TEST(FilmModel, ReferenceIsTheInitialDesign) {
  const settle::FilmState state = bracket().settle(two_arm(0));
  EXPECT_TRUE(state.points == bracket().reference().points);
  EXPECT_LT(state.heights.cwiseAbs().maxCoeff(), 1e-3);
  // It is kept, not settled again: a design as near as nothing is settled, and
  // comes to rest there.
  const settle::FilmState near = bracket().settle(two_arm(1e-8));
  ASSERT_FALSE(near.failure) << near.report.verdict;
  double apart = 0.0;
  for (std::size_t v = 0; v < near.points.size(); ++v) {
    apart = std::max(apart, (near.points[v] - state.points[v]).norm());
  }
  EXPECT_LT(apart, 1e-6);
  EXPECT_GT(apart, 0.0);
}

TEST(FilmModel, MirroredDesignsHaveEqualAreas) {
  const double left = bracket().settle(two_arm(-25)).report.area;
  const double right = bracket().settle(two_arm(25)).report.area;
  EXPECT_NEAR(left, right, 1e-4 * left);  // the triangulation's own error
}

TEST(FilmModel, NoHistoryAndNoThreadsShow) {
  const settle::FilmState first = bracket().settle(two_arm(10));
  settle::FilmState other;
  settle::FilmState again;
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
  const settle::FilmState state = bracket().settle(two_arm(30));
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
  const settle::FilmState state = bracket().settle(two_arm(40, 1.0e6));
  ASSERT_TRUE(state.failure);
  EXPECT_THAT(state.failure->message, testing::HasSubstr("neck"));
  // Advice is tried before it is given, by whoever asked for the film.
  EXPECT_THAT(state.failure->message,
              testing::Not(testing::HasSubstr("would help")));
}

// Pinched films settle too: only the neck tells.
TEST(FilmModel, SettledButPinchedFilmIsRecognised) {
  const settle::FilmState state = bracket().settle(two_arm(40, 1.55e6));
  ASSERT_TRUE(state.failure) << state.report.verdict;
  EXPECT_EQ(state.failure->kind, FailureKind::FilmPinched);
}

TEST(FilmModel, SlenderArmsFailWithTheNeck) {
  const frozen::FilmModel model =
      frozen::FilmModel::freeze(two_arm(0, 0.9e6, 220.0, 25.0), {.edge = 10.0});
  ASSERT_TRUE(model.reference().failure);
  EXPECT_THAT(model.reference().failure->message, testing::HasSubstr("neck"));
  EXPECT_THROW(model.settle(two_arm(0, 0.9e6, 220.0, 25.0)), InvalidInput);
}

TEST(FilmModel, CatenoidHasItsLimit) {
  const frozen::FilmModel inside =
      frozen::FilmModel::freeze(systems::catenoid(1.31), {.edge = 0.1});
  EXPECT_FALSE(inside.reference().failure) << inside.reference().report.verdict;
  const frozen::FilmModel beyond =
      frozen::FilmModel::freeze(systems::catenoid(1.34), {.edge = 0.1});
  EXPECT_TRUE(beyond.reference().failure);
}

/// Asks to stop from the first look on.
class Impatient : public Monitor {
 public:
  bool stop_requested() const override { return true; }
};

TEST(FilmModel, StopsWhenAsked) {
  Impatient monitor;
  EXPECT_THROW(
      frozen::FilmModel::freeze(two_arm(0), {.edge = 8.0, .monitor = &monitor}),
      Interrupted);
  EXPECT_THROW(bracket().settle(two_arm(5), {.monitor = &monitor}),
               Interrupted);
}

TEST(FilmModel, RefusesAnEdgeThatLeavesNoFreeVertex) {
  EXPECT_THROW(
      frozen::FilmModel::freeze(systems::catenoid(0.05), {.edge = 1.0}),
      InvalidInput);
}

// The skin's hull holds about 1.9e6: half and twice of it.
TEST(FilmModel, StartsFarFromTheTargetVolume) {
  for (const double volume : {1.25e6, 3.8e6}) {
    const frozen::FilmModel model =
        frozen::FilmModel::freeze(two_arm(0, volume), {.edge = 8.0});
    ASSERT_FALSE(model.reference().failure) << model.reference().report.verdict;
    EXPECT_NEAR(model.reference().report.bodies[0].volume, volume,
                1e-10 * volume);
  }
}

films::FilmSystem strut(double volume) {
  films::FilmSystem system = systems::strut();
  system.bodies[0].pressure.reset();
  system.bodies[0].volume = volume;
  return system;
}

// Square of side 2 to a circle of radius 0.6, 4 higher and 0.8 aside
// (reference.md): area 26.89002, pressure 1.0771 at V = 14; none at 12.5.
TEST(FilmModel, StrutAtSecondOrder) {
  std::vector<double> error;
  for (const double edge : {0.3, 0.15}) {
    const frozen::FilmModel model =
        frozen::FilmModel::freeze(strut(14.0), {.edge = edge});
    ASSERT_FALSE(model.reference().failure) << model.reference().report.verdict;
    error.push_back(model.reference().report.area - 26.89002);
    EXPECT_NEAR(model.reference().report.bodies[0].pressure, 1.0771, 0.005);
  }
  EXPECT_GT(std::log2(std::abs(error[0] / error[1])), 1.6);
  EXPECT_FALSE(frozen::FilmModel::freeze(strut(13.0), {.edge = 0.2})
                   .reference()
                   .failure);
  EXPECT_TRUE(frozen::FilmModel::freeze(strut(12.5), {.edge = 0.2})
                  .reference()
                  .failure);
}

// Coarse facets beside the foot's corners: normals that turn at every step kept
// Newton from its bound at some edges (13 mm among them).
TEST(FilmModel, StrutAtEveryCoarseEdge) {
  for (double edge = 11.0; edge < 14.1; edge += 0.5) {
    const frozen::FilmModel model = frozen::FilmModel::freeze(
        systems::leaning_strut(), {.edge = edge, .refinements = 0});
    EXPECT_FALSE(model.reference().failure)
        << edge << ": " << model.reference().report.verdict;
  }
}

// A mirror-symmetric saddle that settles to rounding: only the index tells.
TEST(FilmModel, SymmetricSaddleIsUnstable) {
  const settle::FilmState state = bracket().settle(two_arm(0, 1.1e6));
  ASSERT_TRUE(state.failure);
  EXPECT_EQ(state.failure->kind, FailureKind::FilmUnstable);
  EXPECT_EQ(state.report.index, 1);
  EXPECT_LE(state.report.residual, state.report.residual_bound);
  EXPECT_THAT(state.failure->message, testing::HasSubstr("mode is largest at"));
}

TEST(FilmModel, RefusesDesignsOfAnotherSystem) {
  films::FilmSystem renamed = two_arm(0);
  renamed.curves[0].name = "foot";
  EXPECT_THROW(bracket().settle(renamed), InvalidInput);
  films::FilmSystem pressed = two_arm(0);
  pressed.bodies[0].volume.reset();
  pressed.bodies[0].pressure = 0.01;
  EXPECT_THROW(bracket().settle(pressed), InvalidInput);
  EXPECT_THROW(frozen::FilmModel::freeze(two_arm(0), {.edge = 0.0}),
               InvalidInput);
}

TEST(FilmModel, RefusesNumbersThatNoFilmCanFollow) {
  const double nan = std::nan("");
  EXPECT_THROW(bracket().settle(two_arm(nan)), InvalidInput);
  EXPECT_THROW(bracket().settle(two_arm(0, nan)), InvalidInput);
  EXPECT_THROW(bracket().settle(two_arm(0, -1.0)), InvalidInput);
  EXPECT_THROW(bracket().settle(two_arm(0, 1.7e6, 120.0, -50.0)), InvalidInput);
  films::FilmSystem slack = two_arm(0);
  slack.films[0].tension = 0.0;
  EXPECT_THROW(bracket().settle(slack), InvalidInput);
  EXPECT_THROW(frozen::FilmModel::freeze(slack, {.edge = 8.0}), InvalidInput);
}

}  // namespace
}  // namespace meniscus::film_model_test
