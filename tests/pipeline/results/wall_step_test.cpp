// Walls as STEP: OpenCASCADE finds closed, valid solids of B-spline faces and
// planes, as large as the walls.
#include "pipeline/step_parts/wall_step.h"

#include <cmath>
#include <numbers>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "cad/solid/spline.h"
#include "cad/step/step_writer.h"
#include "core/atomic_file.h"
#include "tests/support/film_parts.h"
#include "tests/support/sheet_shapes.h"
#include "tests/support/temp_folder.h"
#include "tests/support/wall_films.h"

namespace meniscus::wall_step_test {
namespace {

constexpr double kCircle = std::numbers::pi;
constexpr double kRounding = 1e-9;

struct WallSolid {
  solid::FilmSolid solid;
  step::StepReport step;
};

/// Written and read by OpenCASCADE, which throws for what is no solid.
WallSolid solid_of_wall(const walls::ThickWall& wall, double edge) {
  const TempFolder folder;
  WallSolid result{step_parts::wall_solid(step_parts::with_ends(wall), edge),
                   {}};
  result.step = step::write_step(folder / "wall.step", result.solid.brep,
                                 {.name = "web"});
  expect_closed(result.solid.brep);
  return result;
}

SurfaceMesh plate(int n) {
  return shapes::patch(
      [](double u, double v) { return Vec3(40.0 * u, 30.0 * v, 0.0); },
      {.rows = n, .columns = n, .jitter = 0.25});
}

TEST(WallStep, OfAFlatPlateIsABox) {
  const WallSolid made = solid_of_wall(wall_of(plate(8), 3.0, 0), 5.0);
  EXPECT_EQ(made.solid.report.planes, 6);
  EXPECT_EQ(made.solid.report.patches, 0);
  EXPECT_EQ(made.solid.brep.vertices.size(), 8);
  EXPECT_EQ(made.solid.brep.edges.size(), 12);
  EXPECT_NEAR(made.step.volume / (40.0 * 30.0 * 3.0), 1.0, kRounding);
}

/// Largest distance of the sides' faces from their cylinders.
double off_cylinders(const solid::Brep& brep, double radius, double t) {
  double most = 0.0;
  for (const solid::BrepFace& face : brep.faces) {
    const auto* surface = std::get_if<solid::SplineSurface>(&face.surface);
    if (surface == nullptr || face.name.find("/rim") != std::string::npos) {
      continue;
    }
    const double exact = radius + (face.name == "web" ? 0.5 : -0.5) * t;
    for (int k = 0; k < 400; ++k) {
      const int row = k / 20;
      const Vec3 p =
          solid::jet_of(*surface, {row / 19.0, (k % 20) / 19.0}).point;
      most = std::max(most, std::abs(std::hypot(p[0], p[1]) - exact));
    }
  }
  return most;
}

TEST(WallStep, OfACylinderComesToTheTubeFasterThanFacets) {
  constexpr double kLeastRatio = 5.0;  // facets: 4
  const double radius = 20.0;
  const double t = 3.0;
  const double length = 30.0;
  std::vector<double> off;
  std::vector<double> volume;
  for (const int n : {16, 32}) {
    walls::ThickWall wall =
        wall_of(shapes::cylinder_sheet(
                    radius, length,
                    {.rows = n / 4, .columns = n, .around = true, .jitter = 0}),
                t, 0);
    // Its own offsets are as near as a wall's thickness; here they are exact.
    for (Vec3& p : wall.surface.points) {
      const double r = std::hypot(p[0], p[1]);
      p.head<2>() *= (radius + (r > radius ? 0.5 : -0.5) * t) / r;
    }
    const WallSolid made = solid_of_wall(wall, 2.0 * kCircle * radius / n);
    EXPECT_EQ(made.solid.report.patches, 16);
    off.push_back(off_cylinders(made.solid.brep, radius, t));
    volume.push_back(made.step.volume / (2.0 * kCircle * radius * t * length) -
                     1.0);
  }
  EXPECT_LT(off[1], 0.02);
  EXPECT_GT(off[0] / off[1], kLeastRatio);
  EXPECT_LT(std::abs(volume[1]), 1e-3);
  EXPECT_GT(std::abs(volume[0] / volume[1]), kLeastRatio);
}

void expect_near_wall(const WallSolid& made, const walls::ThickWall& wall,
                      double edge, double from_facets = 0.1) {
  EXPECT_LT(made.solid.report.gap, 1e-4);
  EXPECT_LT(made.solid.report.film_to_solid, 0.1 * edge);
  EXPECT_LT(made.solid.report.solid_to_film, from_facets * edge);
  EXPECT_LT(made.solid.report.tangent_break, 1.0);
  EXPECT_NEAR(made.step.volume / wall.volume, 1.0, 3e-3);
}

struct Fan {
  const char* name;
  std::vector<double> angles;
  double rise;
};

class WallStepOfAFan : public testing::TestWithParam<Fan> {};

/// Two sides of each film, strips along its three others, an end above and
/// one below.
TEST_P(WallStepOfAFan, HasSidesStripsAndEnds) {
  constexpr int kAcross = 12;
  const walls::ThickWall wall =
      wall_of(film_fan(GetParam().angles, GetParam().rise, kAcross), 0.12, 0);
  const WallSolid made = solid_of_wall(wall, 1.0 / kAcross);
  expect_near_wall(made, wall, 1.0 / kAcross);
  EXPECT_EQ(made.solid.brep.faces.size(), 5 * GetParam().angles.size() + 2);
}

INSTANTIATE_TEST_SUITE_P(Fans, WallStepOfAFan,
                         testing::Values(Fan{"T", {0, 90, 180}, 0.0},
                                         Fan{"Y", {0, 120, 240}, 0.0},
                                         Fan{"bent", {0, 120, 240}, 0.2},
                                         Fan{"X", {0, 90, 180, 270}, 0.0},
                                         Fan{"sharp", {0, 70, 200}, 0.1}),
                         [](const auto& fan) {
                           return std::string(fan.param.name);
                         });

/// One sheet with a crease: its sides meet at an edge. Facets beside it are
/// bent by the mitre, 0.17 of their edges off what is smooth.
TEST(WallStep, OfTwoFilmsAtACreaseHasItsEdges) {
  SurfaceMesh films = film_fan({0, 130}, 0.1, 12);
  for (std::size_t f = 0; f < films.facets.size(); ++f) {
    if (films.facet_label[f] == 1) {
      std::swap(films.facets[f][0], films.facets[f][1]);
    }
  }
  const walls::ThickWall wall = wall_of(films, 0.12, 0);
  const WallSolid made = solid_of_wall(wall, 1.0 / 12);
  expect_near_wall(made, wall, 1.0 / 12, 0.2);
  EXPECT_EQ(made.solid.brep.faces.size(), 10);
}

TEST(WallStep, IsTheSameTwice) {
  const walls::ThickWall wall = wall_of(film_fan({0, 120, 240}, 0.2), 0.12, 0);
  const TempFolder folder;
  for (const char* name : {"one.step", "two.step"}) {
    step_parts::export_walls(folder / name,
                             {{"web", step_parts::with_ends(wall)}},
                             {.title = "web", .edge = 0.125});
  }
  EXPECT_EQ(read_file(folder / "one.step"), read_file(folder / "two.step"));
}

}  // namespace
}  // namespace meniscus::wall_step_test
