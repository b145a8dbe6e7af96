// Frozen films under tension that varies in space, and field energies.
#include <array>
#include <cmath>
#include <numbers>

#include <gtest/gtest.h>

#include "core/error.h"
#include "evolve/frozen/film_model.h"
#include "tests/support/film_systems.h"

namespace meniscus::film_model_energies_test {
namespace {

// Tension 1 / r makes the energy of a surface of revolution 2 pi x the length
// of its profile: the film between two rings is a cone.
films::FilmSystem cone(double low, double high = 0.6, double height = 1.0) {
  films::FilmSystem system;
  system.curves = {
      {"low", curves::Circle{Vec3::Zero(), -Vec3::UnitZ(), low}},
      {"high", curves::Circle{Vec3(0, 0, height), Vec3::UnitZ(), high}}};
  system.films = {{"film", films::FilmKind::Loft, {"low", "high"}, 1.0}};
  system.films[0].tension_field =
      Expression::parse("1/sqrt(x^2+y^2)", {"x", "y", "z"});
  return system;
}

double cone_energy(double low, double high = 0.6, double height = 1.0) {
  return 2.0 * std::numbers::pi * std::hypot(low - high, height);
}

TEST(TensionField, MakesAConeAtSecondOrder) {
  std::array<double, 2> error{};
  for (const int k : {0, 1}) {
    const frozen::FilmModel model =
        frozen::FilmModel::freeze(cone(1.0), {.edge = 0.1, .refinements = k});
    ASSERT_FALSE(model.reference().failure)
        << model.reference().failure->message;
    EXPECT_EQ(model.reference().report.index, 0);
    error[k] = std::abs(model.reference().report.energy - cone_energy(1.0));
  }
  EXPECT_LT(error[1], 2e-3 * cone_energy(1.0));
  EXPECT_GT(std::log2(error[0] / error[1]), 1.9);
}

// Another design than the frozen one: the same cone, and its energy's slope
// over the design is the closed form's to the order of the mesh.
TEST(TensionField, FollowsTheDesign) {
  const frozen::FilmModel model =
      frozen::FilmModel::freeze(cone(1.0), {.edge = 0.1, .refinements = 1});
  const auto energy = [&](double low) {
    const settle::FilmState state = model.settle(cone(low));
    EXPECT_FALSE(state.failure) << state.failure->message;
    return state.report.energy;
  };
  EXPECT_NEAR(energy(1.2), cone_energy(1.2), 1e-3 * cone_energy(1.2));
  const double step = 1e-3;
  const double slope = (energy(1.2 + step) - energy(1.2 - step)) / (2 * step);
  const double exact =
      (cone_energy(1.2 + step) - cone_energy(1.2 - step)) / (2 * step);
  EXPECT_NEAR(slope, exact, 5e-3 * exact);
}

TEST(TensionField, BelongsToTheModel) {
  const frozen::FilmModel model =
      frozen::FilmModel::freeze(cone(1.0), {.edge = 0.2});
  films::FilmSystem other = cone(1.0);
  other.films[0].tension_field =
      Expression::parse("2/sqrt(x^2+y^2)", {"x", "y", "z"});
  EXPECT_THROW(model.settle(other), InvalidInput);
  other.films[0].tension_field.reset();
  EXPECT_THROW(model.settle(other), InvalidInput);
}

TEST(TensionField, MustStayAboveZero) {
  for (const char* text : {"z-0.5", "log(z-0.5)", "1/(z-z)"}) {
    films::FilmSystem system = cone(1.0);
    system.films[0].tension_field = Expression::parse(text, {"x", "y", "z"});
    EXPECT_THROW(frozen::FilmModel::freeze(system, {.edge = 0.2}), InvalidInput)
        << text;
  }
  // A film that grows to where there is none left.
  films::FilmSystem system = cone(1.0);
  system.films[0].tension_field =
      Expression::parse("1.1-sqrt(x^2+y^2)", {"x", "y", "z"});
  EXPECT_THROW(frozen::FilmModel::freeze(system, {.edge = 0.2}), InvalidInput);
  // Good at the frozen design, not where another one takes the film.
  const auto ring = [](double height) {
    films::FilmSystem result = cone(1.0, 1.0, height);
    result.films[0].tension_field =
        Expression::parse("if(z<0.6,1,-1)", {"x", "y", "z"});
    return result;
  };
  const frozen::FilmModel model =
      frozen::FilmModel::freeze(ring(0.5), {.edge = 0.2});
  ASSERT_FALSE(model.reference().failure) << model.reference().failure->message;
  const settle::FilmState state = model.settle(ring(0.7));
  ASSERT_TRUE(state.failure);
  EXPECT_EQ(state.failure->kind, FailureKind::NotANumber);
}

films::FilmSystem tube(double radius) {
  films::FilmSystem system = cone(radius, 1.0);
  system.films[0].tension_field.reset();
  system.caps = {{"bottom", "low"}, {"top", "high"}};
  system.bodies = {{"tube", {"film", "bottom", "top"}, std::nullopt, 0.8}};
  return system;
}

films::FilmSystem inflated(double radius) {
  films::FilmSystem system = tube(radius);
  system.bodies[0].pressure = 0.0;
  system.pressures = {
      {"gas", "tube", Expression::parse("0.8+0*x", {"x", "y", "z"})}};
  return system;
}

// A pressure field that is a number is the body's own pressure.
TEST(FieldEnergy, OfConstantPressureIsThePressure) {
  const frozen::FilmModelOptions options{.edge = 0.2};
  const frozen::FilmModel plain = frozen::FilmModel::freeze(tube(1.0), options);
  const frozen::FilmModel field =
      frozen::FilmModel::freeze(inflated(1.0), options);
  for (const double radius : {1.0, 0.9}) {
    const settle::FilmState a = plain.settle(tube(radius));
    const settle::FilmState b = field.settle(inflated(radius));
    ASSERT_FALSE(a.failure || b.failure);
    EXPECT_NEAR(b.report.area, a.report.area, 1e-8 * a.report.area);
    EXPECT_NEAR(b.report.energy,
                a.report.area - 0.8 * b.report.bodies[0].volume,
                1e-8 * a.report.area);
  }
}

// A film is cheaper on a plane that attracts it, so there is more of it there.
TEST(FieldEnergy, PolesMoveTheFilmAndBelongToTheModel) {
  films::FilmSystem system = tube(1.0);
  system.fields = {{"middle", films::PlanePole{Vec3(0, 0, 0.5), Vec3::UnitZ()},
                    0.3, 2.0, 0.3, films::PerArea{{"film"}}}};
  const frozen::FilmModel model =
      frozen::FilmModel::freeze(system, {.edge = 0.2});
  ASSERT_FALSE(model.reference().failure) << model.reference().failure->message;
  const frozen::FilmModel without =
      frozen::FilmModel::freeze(tube(1.0), {.edge = 0.2});
  EXPECT_GT(model.reference().report.bodies[0].volume,
            1.01 * without.reference().report.bodies[0].volume);
  EXPECT_FALSE(model.settle(system).failure);
  EXPECT_THROW(model.settle(tube(1.0)), InvalidInput);
  system.fields[0].strength = 0.2;
  EXPECT_THROW(model.settle(system), InvalidInput);
}

}  // namespace
}  // namespace meniscus::film_model_energies_test
