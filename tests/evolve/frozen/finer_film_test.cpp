// A model's film on its own facets halved, and what refinement makes of facets.
#include <cmath>
#include <numbers>
#include <random>

#include <gtest/gtest.h>

#include "evolve/frozen/film_model.h"
#include "tests/support/film_systems.h"
#include "tests/support/more.h"
#include "tests/support/systems.h"

namespace meniscus::finer_film_test {
namespace {

using systems::two_arm;

/// Three feet on a circle of that radius, a head above its middle.
films::FilmSystem tripod(double ring, double height, double foot, double head,
                         double fill) {
  films::FilmSystem system;
  system.films = {{"skin", films::FilmKind::Branch, {}, 1.0}};
  system.bodies = {{"part",
                    {"skin"},
                    1.3 * fill * 3.0 * std::numbers::pi * foot * foot *
                        std::hypot(ring, height),
                    std::nullopt}};
  const auto add = [&](const std::string& name, const curves::Circle& circle) {
    system.curves.push_back({name, circle});
    system.films[0].curves.push_back(name);
    system.caps.push_back({"cap_" + name, name});
    system.bodies[0].enclosed_by.push_back("cap_" + name);
  };
  for (const int k : {0, 1, 2}) {
    const double angle = 2.0 * std::numbers::pi * (k + 1) / 3.0;
    add("foot_" + std::to_string(k),
        {ring * Vec3(std::cos(angle), std::sin(angle), 0.0), Vec3(0, 0, -1),
         foot});
  }
  add("head", {Vec3(0, 0, height), Vec3(0, 0, 1), head});
  return system;
}

// Area 2 pi a^2 (s + sinh s cosh s) with a = 1 / cosh s, half the spacing a s.
TEST(FinerFilm, KnowsTheErrorOfCatenoids) {
  std::mt19937 random(20261126);
  std::uniform_real_distribution<double> slopes(0.2, 0.9);
  std::uniform_real_distribution<double> edges(0.1, 0.25);
  for (int k = 0; k < 12; ++k) {
    const double s = slopes(random);
    const double a = 1.0 / std::cosh(s);
    const double exact =
        2.0 * std::numbers::pi * a * a * (s + std::sinh(s) * std::cosh(s));
    const films::FilmSystem system = systems::catenoid(2.0 * a * s);
    const frozen::FilmModel model =
        frozen::FilmModel::freeze(system, {.edge = edges(random)});
    const settle::FilmState& own = model.reference();
    ASSERT_FALSE(own.failure) << own.report.verdict;
    const frozen::FilmModel finer = model.refined(own, system, nullptr);
    ASSERT_FALSE(finer.reference().failure);
    const double error = own.report.area - exact;
    const double told =
        4.0 / 3.0 * (own.report.area - finer.reference().report.area);
    EXPECT_NEAR(told, error, 0.05 * std::abs(error)) << "slope " << s;
  }
}

/// A square foot of side 38, a round end of radius 14 that stands off it and
/// leans, 70 above; the end 10 long, a body of its own.
films::FilmSystem leaning_strut() {
  const double tilt = std::numbers::pi / 18.0;
  const Vec3 axis(std::sin(tilt), 0.0, std::cos(tilt));
  const Vec3 eye(8.0, 0.0, 70.0);
  const double area = std::numbers::pi * 14.0 * 14.0;
  films::FilmSystem system;
  system.curves = {{"foot", curves::Rectangle{.normal = Vec3(0, 0, -1),
                                              .axis = Vec3(1, 0, 0),
                                              .width = 38.0,
                                              .height = 38.0,
                                              .corner_radius = 5.0}},
                   {"eye", curves::Circle{eye, axis, 14.0}},
                   {"end", curves::Circle{eye + 10.0 * axis, axis, 14.0}}};
  system.films = {{"skin", films::FilmKind::Branch, {"foot", "eye"}, 1.0},
                  {"side", films::FilmKind::Loft, {"eye", "end"}, 1.0}};
  system.caps = {{"low", "foot"}, {"joint", "eye"}, {"high", "end"}};
  system.bodies = {{"part",
                    {"skin", "low", "joint"},
                    1.1 * 70.0 * (38.0 * 38.0 + area) / 2.0,
                    std::nullopt},
                   {"boss", {"side", "joint", "high"}, 10.0 * area, {}}};
  return system;
}

// Folds at the foot's corners, where edges are as long as these, stay folds
// when they are refined: their film was an unstable one.
TEST(FinerFilm, FoldsAreEvenedOut) {
  for (const double edge : {15.0, 16.0, 17.0}) {
    const frozen::FilmModel model = frozen::FilmModel::freeze(
        leaning_strut(), {.edge = edge, .refinements = 1});
    EXPECT_FALSE(model.reference().failure)
        << edge << ": " << model.reference().report.verdict;
  }
}

TEST(FinerFilm, IsThatOfOneMoreRefinement) {
  const films::FilmSystem system = two_arm(0);
  const frozen::FilmModel once =
      frozen::FilmModel::freeze(system, {.edge = 16.0, .refinements = 1});
  const frozen::FilmModel twice =
      frozen::FilmModel::freeze(system, {.edge = 16.0, .refinements = 2});
  const frozen::FilmModel finer =
      once.refined(once.reference(), system, nullptr);
  EXPECT_EQ(finer.reference().points.size(), twice.reference().points.size());
  const double change =
      once.reference().report.area - twice.reference().report.area;
  EXPECT_NEAR(finer.reference().report.area, twice.reference().report.area,
              1e-3 * std::abs(change));
}

// At a design that the model was not frozen at, by the margin of that model.
TEST(FinerFilm, FollowsTheDesign) {
  const frozen::FilmModel model =
      frozen::FilmModel::freeze(two_arm(0), {.edge = 12.0});
  const films::FilmSystem system = two_arm(30.0);
  const settle::FilmState state = model.settle(system);
  const frozen::FilmModel finer = model.refined(state, system, nullptr);
  EXPECT_NEAR(finer.reference().report.area, state.report.area,
              0.01 * state.report.area);
  const double own = model.margin(state, system).value;
  EXPECT_NEAR(finer.margin(finer.reference(), system).value, own, 0.05 * own);
  // Not of the model's own film.
  EXPECT_GT(std::abs(state.report.area - model.reference().report.area),
            std::abs(state.report.area - finer.reference().report.area));
}

TEST(FinerFilm, RefusesAFilmThatFailed) {
  const frozen::FilmModel model =
      frozen::FilmModel::freeze(two_arm(0), {.edge = 12.0});
  const films::FilmSystem system = two_arm(0, 1.1e6);
  EXPECT_THROW(
      static_cast<void>(model.refined(model.settle(system), system, nullptr)),
      InvalidInput);
}

// Where feet flare, refinement left facets of 2 degrees.
TEST(FinerFilm, RefinementLeavesNoSlivers) {
  std::mt19937 random(7);
  const auto draw = [&](double from, double to) {
    return std::uniform_real_distribution<double>(from, to)(random);
  };
  const int count = more_or(12, 4);
  int seen = 0;
  for (int k = 0; k < 40 && seen < count; ++k) {
    const double ring = draw(30, 70);
    const double height = ring * draw(0.8, 1.6);
    const double foot = ring * draw(0.22, 0.42);
    const double head = ring * draw(0.22, 0.5);
    const films::FilmSystem system =
        tripod(ring, height, foot, head, draw(0.8, 1.4));
    const frozen::FilmModel model = frozen::FilmModel::freeze(
        system, {.edge = ring / 6.0, .refinements = 2});
    if (model.reference().failure) {
      continue;
    }
    ++seen;
    const films::FilmComplex film = model.complex_at(model.reference(), system);
    EXPECT_GT(systems::quality(film, systems::Part::Films).smallest_angle, 7.0)
        << "tripod " << k;
  }
  EXPECT_EQ(seen, count);
}

}  // namespace
}  // namespace meniscus::finer_film_test
