// Plane faces between polygons: shared sides, holes, parts without liquid.
#include "evolve/films/shared_sides.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/error.h"
#include "core/geometry/mesh_checks.h"
#include "evolve/frozen/film_model.h"
#include "evolve/start/disk_fill.h"

namespace meniscus::shared_sides_test {
namespace {

using ::testing::HasSubstr;

constexpr double kExact = 1e-12;  // relative: sums of a few hundred terms

double area_of(const SurfaceMesh& mesh) {
  double sum = 0.0;
  for (int f = 0; f < static_cast<int>(mesh.facets.size()); ++f) {
    sum += 0.5 * area_vector2(mesh, f).norm();
  }
  return sum;
}

Points ring(double radius, int n, double x = 0.0) {
  Points points;
  for (int k = 0; k < n; ++k) {
    const double a = 2.0 * EIGEN_PI * k / n;
    points.emplace_back(x + radius * std::cos(a), radius * std::sin(a), 0.0);
  }
  return points;
}

double polygon_area(const Points& rim) {
  return polygon_area_vector(rim).norm();
}

TEST(FillDisk, LeavesHolesOpen) {
  const Points outer = ring(10.0, 60);
  std::vector<Points> holes = {ring(2.0, 24, -4.0), ring(1.5, 16, 4.0)};
  std::reverse(holes[1].begin(), holes[1].end());  // either direction will do
  const SurfaceMesh disk = start::fill_disk(outer, holes, 1.0);
  EXPECT_NEAR(area_of(disk) / (polygon_area(outer) - polygon_area(holes[0]) -
                               polygon_area(holes[1])),
              1.0, kExact);
  // Facets all face one way, and each rim edge is used once.
  std::size_t points = outer.size();
  for (const Points& hole : holes) {
    points += hole.size();
  }
  std::vector<Edge> edges;
  std::vector<Triangle> facet_edges;
  list_edges(disk.facets, edges, facet_edges);
  std::vector<int> uses(edges.size(), 0);
  for (const Triangle& t : facet_edges) {
    for (const int e : t) {
      ++uses[static_cast<std::size_t>(e)];
    }
  }
  EXPECT_EQ(static_cast<std::size_t>(std::count(uses.begin(), uses.end(), 1)),
            points);
  for (int f = 0; f < static_cast<int>(disk.facets.size()); ++f) {
    EXPECT_GT(area_vector2(disk, f).z(), 0.0);
  }
}

TEST(FillDisk, FillsAroundAnH) {
  const Points plate = {{-6, -5, 0}, {6, -5, 0}, {6, 5, 0}, {-6, 5, 0}};
  const Points h = {{-5, -4, 0}, {-4, -4, 0},  {-4, -0.5, 0}, {4, -0.5, 0},
                    {4, -4, 0},  {5, -4, 0},   {5, 4, 0},     {4, 4, 0},
                    {4, 0.5, 0}, {-4, 0.5, 0}, {-4, 4, 0},    {-5, 4, 0}};
  const SurfaceMesh disk = start::fill_disk(plate, {h}, 0.7);
  EXPECT_NEAR(area_of(disk), 120.0 - 24.0, 1e-10);
}

TEST(FillDisk, RefusesAHoleOutside) {
  EXPECT_THROW(start::fill_disk(ring(2.0, 24), {ring(1.0, 12, 8.0)}, 0.5),
               MeshError);
}

/// A block of plane faces; `top`: how far its upper face is moved along x.
films::FilmSystem block(double top = 0.0, double height = 3.0) {
  const auto at = [&](double z) {
    const double x = z > 0.0 ? top : 0.0;
    return Points{{x, 0, z}, {x + 2, 0, z}, {x + 2, 1, z}, {x, 1, z}};
  };
  const Points low = at(0.0);
  const Points high = at(height);
  films::FilmSystem system;
  system.curves = {{"low", curves::Polygon{low}},
                   {"high", curves::Polygon{high}}};
  films::CapSpec sides{.name = "sides", .curve = "side0"};
  for (std::size_t k = 0; k < 4; ++k) {
    const std::size_t next = (k + 1) % 4;
    system.curves.push_back(
        {"side" + std::to_string(k),
         curves::Polygon{{low[k], low[next], high[next], high[k]}}});
    if (k > 0) {
      sides.more.push_back(system.curves.back().name);
    }
  }
  system.caps = {{"floor", "low"}, {"lid", "high"}, sides};
  system.bodies = {{"part", {"floor", "lid", "sides"}, {}, {}}};
  return system;
}

TEST(SharedSides, AreFoundOnce) {
  const std::vector<films::SharedSide> sides =
      films::shared_sides(block().curves);
  EXPECT_EQ(sides.size(), 12U);  // the edges of a block
}

TEST(SharedSides, FacesOfABlockCloseIt) {
  const frozen::FilmModel model =
      frozen::FilmModel::freeze(block(), {.edge = 0.4, .refinements = 1});
  const settle::FilmState& state = model.reference();
  ASSERT_FALSE(state.failure) << state.failure->message;
  EXPECT_NEAR(state.report.bodies[0].volume, 6.0, 6.0 * kExact);
  const SurfaceMesh surface = model.surface(state.points).base;
  EXPECT_TRUE(check_surface(surface).empty());
  EXPECT_NEAR(area_of(surface), 22.0, 22.0 * kExact);
  for (const Vec3& mid : model.surface(state.points).mid) {
    EXPECT_GE(mid.minCoeff(), -kExact);
  }
}

TEST(SharedSides, FacesFollowTheDesignExactly) {
  const frozen::FilmModel model =
      frozen::FilmModel::freeze(block(), {.edge = 0.4, .refinements = 1});
  const settle::FilmState moved = model.settle(block(0.7, 3.6));
  ASSERT_FALSE(moved.failure);
  EXPECT_NEAR(moved.report.bodies[0].volume, 7.2, 7.2 * kExact);
  // Each point on a plane of the sheared block: x from 0 to 2 at z = 0.
  for (const Vec3& p : moved.points) {
    const double x = p.x() - 0.7 * p.z() / 3.6;
    const double off = std::min({std::abs(x), std::abs(x - 2.0),
                                 std::abs(p.y()), std::abs(p.y() - 1.0),
                                 std::abs(p.z()), std::abs(p.z() - 3.6)});
    EXPECT_LT(off, 1e-12);
  }
}

TEST(SharedSides, GradientsOfABlockAreExact) {
  const films::FilmSystem system = block();
  const frozen::FilmModel model =
      frozen::FilmModel::freeze(system, {.edge = 0.5, .refinements = 0});
  const settle::FilmState& state = model.reference();
  // J: sum of z over all vertices; only the upper rim's height moves them.
  frozen::FilmCovector by;
  by.points.assign(state.points.size(), Vec3::UnitZ());
  const std::vector<frozen::FilmGradient> found =
      model.transpose(state, system, {by});
  const films::FilmSystem higher = block(0.0, 4.0);
  films::FilmSystem rates = system;  // by the height
  for (std::size_t c = 0; c < rates.curves.size(); ++c) {
    auto& points = std::get<curves::Polygon>(rates.curves[c].shape).points;
    const auto& there =
        std::get<curves::Polygon>(higher.curves[c].shape).points;
    for (std::size_t k = 0; k < points.size(); ++k) {
      points[k] = there[k] - points[k];
    }
  }
  double sum = 0.0;
  for (const Vec3& p : state.points) {
    sum += p.z() / 3.0;
  }
  EXPECT_NEAR(model.rate(found[0], system, rates) / sum, 1.0, 1e-11);
}

TEST(SharedSides, AFaceThatIsMissingIsTold) {
  films::FilmSystem open = block();
  open.caps[2].more.pop_back();
  try {
    frozen::FilmModel::freeze(open, {.edge = 0.5, .refinements = 0});
    FAIL() << "an open block was taken";
  } catch (const InvalidInput& error) {
    EXPECT_THAT(error.what(), HasSubstr("part"));
  }
}

}  // namespace
}  // namespace meniscus::shared_sides_test
