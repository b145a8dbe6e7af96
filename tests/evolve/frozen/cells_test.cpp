// Films in cells of planes, on each of which a side of their rim slides.
#include <cmath>
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/error.h"
#include "core/geometry/mesh_checks.h"
#include "evolve/films/body_sides.h"
#include "evolve/frozen/film_model.h"
#include "evolve/start/start_complex.h"

namespace meniscus::cells_test {
namespace {

using testing::HasSubstr;

struct CellWall {
  Vec3 at;
  Vec3 normal;  // out of the cell
};

/// A film on a polygon of which each side lies in a wall, and a body of this
/// volume behind it.
films::FilmSystem cell(const Points& rim, const std::vector<CellWall>& walls,
                       double volume) {
  films::FilmSystem system;
  system.curves = {{"rim", curves::Polygon{rim}}};
  system.curves[0].free = true;
  system.films = {{"skin", films::FilmKind::Disk, {"rim"}, 1.0, {}}};
  system.bodies = {{"part", {"skin"}, volume, {}}};
  for (const CellWall& wall : walls) {
    films::CapSpec cap;
    cap.name = "wall_" + std::to_string(system.caps.size());
    cap.wall =
        films::FilmWall{.at = wall.at, .normal = wall.normal, .cuts = true};
    system.bodies[0].enclosed_by.push_back(cap.name);
    system.caps.push_back(cap);
  }
  return system;
}

/// An eighth of the cubic cell of edge 2.
films::FilmSystem schwarz_p(double volume = 0.5) {
  std::vector<CellWall> walls;
  for (int k = 0; k < 3; ++k) {
    walls.push_back({Vec3::Zero(), -Vec3::Unit(k)});
    walls.push_back({Vec3::Ones(), Vec3::Unit(k)});
  }
  return cell({{0, 1, 0.5},
               {0, 0.5, 1},
               {0.5, 0, 1},
               {1, 0, 0.5},
               {1, 0.5, 0},
               {0.5, 1, 0}},
              walls, volume);
}

/// A 96th of the face-centred cubic cell of edge 4.
films::FilmSystem schwarz_d(double volume = 1.0 / 3.0) {
  return cell({{0, 0, 0}, {0.5, -0.5, 0.5}, {0, 0, 1}, {-0.5, 0.5, 0.5}},
              {{{1, 0, 0}, {0, -1, -1}},
               {{1, 0, 0}, {1, 0, 1}},
               {{-1, 0, 0}, {-1, 0, 1}},
               {{-1, 0, 0}, {0, 1, -1}}},
              volume);
}

double area_of(const films::FilmSystem& system, double edge) {
  const auto model =
      frozen::FilmModel::freeze(system, {.edge = edge, .refinements = 1});
  EXPECT_FALSE(model.reference().failure.has_value());
  const settle::FilmReport& report = model.reference().report;
  EXPECT_EQ(report.index, 0);
  EXPECT_NEAR(report.bodies[0].pressure, 0.0, 1e-3);
  return model.areas(model.reference().points)[0];
}

// Areas by Schoen, of the cell and of the conventional cell.
TEST(Cells, HaveSchwarzSurfaces) {
  const double p = 2.345107 * 4.0 / 8.0;
  const double d = 3.837785 * 16.0 / 96.0;
  double last_p = 0.0;
  double last_d = 0.0;
  for (const double edge : {0.2, 0.1}) {
    const double off_p = std::abs(area_of(schwarz_p(), edge) / p - 1.0);
    const double off_d = std::abs(area_of(schwarz_d(), edge) / d - 1.0);
    if (last_p > 0.0) {
      EXPECT_LT(off_p, 0.4 * last_p);
      EXPECT_LT(off_d, 0.4 * last_d);
      EXPECT_LT(off_p, 1e-3);
      EXPECT_LT(off_d, 1e-3);
    }
    last_p = off_p;
    last_d = off_d;
  }
}

// Faces around corners of the cell, and what lines leave out of volumes.
TEST(Cells, CloseBodiesOnBothSidesOfTheirFilms) {
  for (films::FilmSystem system : {schwarz_p(0.45), schwarz_d(0.3)}) {
    const double all = system.caps.size() == 6 ? 1.0 : 2.0 / 3.0;
    const double own = *system.bodies[0].volume;
    for (const double volume : {own, all - own}) {
      *system.bodies[0].volume = volume;
      const auto model =
          frozen::FilmModel::freeze(system, {.edge = 0.1, .refinements = 1});
      ASSERT_FALSE(model.reference().failure.has_value())
          << model.reference().failure->message;
      const SurfaceMesh closed = model.boundary(model.reference().points);
      EXPECT_TRUE(check_surface(closed).empty())
          << volume << " " << summary(check_surface(closed));
      EXPECT_NEAR(enclosed_volume(closed), volume, 1e-9);
    }
  }
}

TEST(Cells, FollowTheirVolume) {
  const auto model =
      frozen::FilmModel::freeze(schwarz_p(), {.edge = 0.2, .refinements = 0});
  for (const double volume : {0.45, 0.55}) {
    const settle::FilmState state = model.settle(schwarz_p(volume));
    ASSERT_FALSE(state.failure.has_value()) << state.failure->message;
    EXPECT_NEAR(enclosed_volume(model.boundary(state.points)), volume, 1e-9);
    // Less than half is pressed out of its own mouths, more into the others.
    EXPECT_GT((0.5 - volume) * state.report.bodies[0].pressure, 0.0);
  }
}

TEST(Cells, OfWhichAWallIsMissingAreRefused) {
  films::FilmSystem system = schwarz_p();
  system.bodies[0].enclosed_by.pop_back();
  system.caps.pop_back();
  try {
    start::build_start(system, 0.2);
    FAIL() << "a cell without one of its walls was built";
  } catch (const InvalidInput& error) {
    EXPECT_THAT(error.what(), HasSubstr("is not closed"));
  }
}

}  // namespace
}  // namespace meniscus::cells_test
