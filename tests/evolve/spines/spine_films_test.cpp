// Films that spines hold: arms of any length, their blends and gradients.
#include <cmath>
#include <numbers>

#include <gtest/gtest.h>

#include "core/error.h"
#include "evolve/frozen/film_model.h"

namespace meniscus::spine_films_test {
namespace {

constexpr double kPi = std::numbers::pi;

films::SpineSpec arm(const std::string& name, Points points,
                     std::vector<double> radii, bool smooth = false) {
  if (radii.size() == 1) {
    radii.resize(points.size(), radii[0]);
  }
  return {.name = name,
          .body = "part",
          .points = std::move(points),
          .smooth = smooth,
          .radii = std::move(radii)};
}

/// Arms from a common film to circles around spines' ends.
films::FilmSystem spined(std::vector<films::SpineSpec> spines,
                         const std::vector<curves::Circle>& rims) {
  films::FilmSystem system;
  films::FilmSpec skin{.name = "skin", .kind = films::FilmKind::Spines};
  films::BodySpec part{.name = "part", .enclosed_by = {"skin"}};
  for (std::size_t k = 0; k < rims.size(); ++k) {
    const std::string name = "rim_" + std::to_string(k);
    system.curves.push_back({name, rims[k]});
    skin.curves.push_back(name);
    system.caps.push_back({"cap_" + std::to_string(k), name});
    part.enclosed_by.push_back(system.caps.back().name);
  }
  system.films = {std::move(skin)};
  system.bodies = {std::move(part)};
  system.spines = std::move(spines);
  return system;
}

films::FilmSystem tube(double length, double radius) {
  return spined({arm("arm", {Vec3::Zero(), Vec3(0, 0, length)}, {radius})},
                {curves::Circle{Vec3::Zero(), -Vec3::UnitZ(), radius},
                 curves::Circle{Vec3(0, 0, length), Vec3::UnitZ(), radius}});
}

const settle::FilmState& settled(const frozen::FilmModel& model) {
  const settle::FilmState& film = model.reference();
  EXPECT_FALSE(film.failure) << film.report.verdict;
  return film;
}

// T/R^2 (4 R^2/(R^2 + e^2) - 1) + T (pi/L)^2.
TEST(SpineFilms, TubesOfAnyLengthStandWithTheEigenvalueOfTheFormula) {
  for (const double length : {200.0, 400.0}) {
    const frozen::FilmModel model =
        frozen::FilmModel::freeze(tube(length, 10.0), {.edge = 5.0});
    const settle::FilmState& film = settled(model);
    EXPECT_EQ(film.report.index, 0);
    const double formula =
        0.01 * (4.0 / 1.49 - 1.0) + std::pow(kPi / length, 2);
    EXPECT_NEAR(film.report.min_eigenvalue, formula, 0.05 * formula) << length;
    EXPECT_NEAR(film.report.bodies[0].volume, kPi * 100.0 * length,
                0.03 * kPi * 100.0 * length);
  }
}

TEST(SpineFilms, ComeNearTheTubeAsTheSquareOfTheEdge) {
  double before = 0.0;
  for (const double edge : {5.0, 2.5}) {
    const frozen::FilmModel model = frozen::FilmModel::freeze(
        tube(100.0, 10.0), {.edge = edge, .refinements = 0});
    const settle::FilmState& film = settled(model);
    double most = 0.0;
    for (const Vec3& p : film.points) {
      const double r = std::hypot(p.x(), p.y());
      if (p.z() > 1.0 && p.z() < 99.0) {
        most = std::max(most, std::abs(r - 10.0));
      }
    }
    EXPECT_LT(most, 0.3);
    if (before > 0.0) {
      EXPECT_GT(before / most, 3.0);
    }
    before = most;
  }
}

/// Three arms of that length that meet in the middle, 120 degrees apart.
films::FilmSystem spider(int arms, double length, double radius, double p = 0) {
  std::vector<films::SpineSpec> spines;
  std::vector<curves::Circle> rims;
  for (int k = 0; k < arms; ++k) {
    const double a = 2.0 * kPi * k / arms + 0.05 * p;
    const Vec3 way(std::cos(a), std::sin(a), 0.1 * p * k);
    spines.push_back(arm("arm_" + std::to_string(k),
                         {Vec3(0, 0, 0.5 * p), length * way},
                         {radius * (1.0 + 0.1 * p), radius}));
    rims.push_back({length * way, way.normalized(), radius});
  }
  return spined(spines, rims);
}

TEST(SpineFilms, ThreeLongArmsThatMeetStand) {
  const frozen::FilmModel model =
      frozen::FilmModel::freeze(spider(3, 130.0, 10.0), {.edge = 5.0});
  const settle::FilmState& film = settled(model);
  EXPECT_EQ(film.report.index, 0);
  EXPECT_LT(film.report.seconds, 20.0);
}

TEST(SpineFilms, ATipEndsRound) {
  const frozen::FilmModel model = frozen::FilmModel::freeze(
      spined({arm("horn", {Vec3::Zero(), Vec3(20, 0, 60), Vec3(60, 0, 80)},
                  {10, 9, 8}, true)},
             {curves::Circle{Vec3::Zero(), -Vec3::UnitZ(), 10.0}}),
      {.edge = 4.0});
  const settle::FilmState& film = settled(model);
  double most = 0.0;
  for (const Vec3& p : film.points) {
    most = std::max(most, p.x());
  }
  EXPECT_GT(most, 60.0);
  EXPECT_LT(most, 60.0 + 2.0 * 8.0);
}

TEST(SpineFilms, AFilmThatFloatsNeedsNoRim) {
  const frozen::FilmModel model = frozen::FilmModel::freeze(
      spined({arm("ring", {Vec3(30, 0, 0), Vec3(0, 30, 0), Vec3(-30, 0, 0)},
                  {8}, true)},
             {}),
      {.edge = 4.0});
  settled(model);
}

/// An eye of spines about a bore along y, 10 wide, and an arm along x from it
/// to a rim; `beside` is how far the eye's middle stands off the bore's axis.
films::FilmSystem eye(double half, double ring_radius, double radius,
                      const films::SpineSpec& arm_spine, double beside = 0.0) {
  films::FilmSystem system =
      spined({}, {curves::Circle{Vec3(0, -half, 0), -Vec3::UnitY(), 10.0},
                  curves::Circle{Vec3(0, half, 0), Vec3::UnitY(), 10.0},
                  curves::Circle{arm_spine.points.back(), Vec3::UnitX(),
                                 arm_spine.radii.back()}});
  system.caps = {{"bore", "rim_0", "rim_1"}, {"head", "rim_2"}};
  system.bodies[0].enclosed_by = {"skin", "bore", "head"};
  Points ring;
  for (int k = 0; k <= 12; ++k) {
    const double a = 2.0 * kPi * k / 12.0;
    ring.emplace_back(ring_radius * std::cos(a) - beside, 0.0,
                      ring_radius * std::sin(a));
  }
  system.spines = {arm("eye", ring, {radius}, true), arm_spine};
  return system;
}

TEST(SpineFilms, AnEyeAroundABore) {
  const films::FilmSystem system =
      eye(9.0, 15.0, 9.0, arm("arm", {Vec3(20, 0, 0), Vec3(90, 0, 0)}, {8.0}));
  const frozen::FilmModel model =
      frozen::FilmModel::freeze(system, {.edge = 4.0});
  const settle::FilmState& film = settled(model);
  EXPECT_EQ(film.report.index, 0);
  double most = 0.0;
  for (const Vec3& p : film.points) {
    most = std::max(most, -p.x());
  }
  EXPECT_NEAR(most, 24.0, 3.0);
}

/// What a start is refused with.
std::string refusal(const films::FilmSystem& system) {
  try {
    frozen::FilmModel::freeze(system, {.edge = 4.0});
  } catch (const InvalidInput& error) {
    return error.what();
  }
  return "";
}

TEST(SpineFilms, BoresInThinEyesAreNoEndsOfSpines) {
  // The spine of the arm begins in the bore's middle, nearer to its rims than
  // half its radius.
  const films::FilmSystem system =
      eye(4.0, 14.0, 6.0, arm("arm", {Vec3::Zero(), Vec3(90, 0, 0)}, {9.0}));
  settled(frozen::FilmModel::freeze(system, {.edge = 3.0}));
}

// The liquid leaves the bore halfway between its rims, on one side: a cut as
// wide as the bore would leave its rims joined there.
TEST(SpineFilms, AnEyeMayBeWiderThanItsBore) {
  for (const double wider : {0.0, 0.3, 0.6}) {
    const films::FilmSystem system =
        eye(3.0, 14.0, 4.2, arm("arm", {Vec3(17, 0, 0), Vec3(60, 0, 0)}, {4.0}),
            wider);
    const frozen::FilmModel model =
        frozen::FilmModel::freeze(system, {.edge = 2.5});
    EXPECT_EQ(settled(model).report.index, 0) << wider;
  }
}

TEST(SpineFilms, WallsAndPlanesOfSymmetryAreRefused) {
  films::FilmSystem system = tube(60.0, 10.0);
  system.caps.push_back({"cut", ""});
  system.caps.back().wall =
      films::FilmWall{.normal = Vec3::UnitY(), .cuts = true};
  system.bodies[0].enclosed_by.push_back("cut");
  EXPECT_NE(refusal(system).find("spine 'arm' holds body 'part', which ends at "
                                 "the plane of symmetry 'cut'"),
            std::string::npos)
      << refusal(system);
}

TEST(SpineFilms, LiquidThatMeetsNoRimIsTold) {
  films::FilmSystem system = tube(60.0, 10.0);
  system.spines.push_back(
      arm("stray", {Vec3(60, 0, 30), Vec3(90, 0, 30)}, {8.0}));
  EXPECT_NE(refusal(system).find("hangs together with no rim"),
            std::string::npos)
      << refusal(system);
}

TEST(SpineFilms, TwoFilmsOfOneBodysSpinesAreRefused) {
  films::FilmSystem system = tube(60.0, 10.0);
  system.films.push_back(
      {.name = "other", .kind = films::FilmKind::Spines, .curves = {"rim_1"}});
  system.films[0].curves = {"rim_0"};
  system.bodies[0].enclosed_by.push_back("other");
  EXPECT_NE(refusal(system).find("both start from the spines of body 'part'"),
            std::string::npos)
      << refusal(system);
}

TEST(SpineFilms, AModelThatBeginsFromAnothersFilmSamplesItsSpinesAnew) {
  const frozen::FilmModel wide =
      frozen::FilmModel::freeze(tube(120.0, 10.0), {.edge = 4.0});
  const films::FilmSystem slim = tube(120.0, 8.0);
  const settle::FilmState there = wide.settle(slim);
  ASSERT_FALSE(there.failure) << there.report.verdict;
  const films::FilmComplex start = wide.meshed_at(there, slim);
  const frozen::FilmModel after =
      frozen::FilmModel::freeze(slim, {.edge = 4.0, .start = &start});
  const frozen::FilmModel fresh =
      frozen::FilmModel::freeze(slim, {.edge = 4.0});
  const auto samples = [&](const frozen::FilmModel& model,
                           const films::FilmSystem& system) {
    return model.complex_at(settled(model), system).spines[0].samples.size();
  };
  EXPECT_EQ(samples(after, slim), samples(fresh, slim));
  EXPECT_NE(samples(after, slim), samples(wide, tube(120.0, 10.0)));
}

TEST(SpineFilms, ASpineThatADesignOpensIsRefused) {
  films::FilmSystem ring =
      spined({arm("ring",
                  {Vec3(30, 0, 0), Vec3(0, 30, 0), Vec3(-30, 0, 0),
                   Vec3(0, -30, 0), Vec3(30, 0, 0)},
                  {8}, true)},
             {});
  const frozen::FilmModel model =
      frozen::FilmModel::freeze(ring, {.edge = 4.0});
  settled(model);
  ring.spines[0].points.back().x() = 28.0;
  EXPECT_THROW(model.settle(ring), InvalidInput);
}

TEST(SpineFilms, RimsWithoutASpineAreNamed) {
  films::FilmSystem system = tube(60.0, 10.0);
  system.spines[0].points[1] = Vec3(0, 0, 40);
  try {
    frozen::FilmModel::freeze(system, {.edge = 5.0});
    ADD_FAILURE();
  } catch (const InvalidInput& error) {
    EXPECT_NE(std::string(error.what())
                  .find("no spine ends at its curve "
                        "'rim_1'"),
              std::string::npos)
        << error.what();
  }
  system = tube(60.0, 10.0);
  system.spines.clear();
  EXPECT_THROW(frozen::FilmModel::freeze(system, {.edge = 5.0}), InvalidInput);
}

}  // namespace
}  // namespace meniscus::spine_films_test
