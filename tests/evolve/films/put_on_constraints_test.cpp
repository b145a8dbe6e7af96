#include "evolve/films/put_on_constraints.h"

#include <random>

#include <gtest/gtest.h>

#include "core/error.h"
#include "evolve/energy/fields.h"

namespace meniscus::put_on_constraints_test {
namespace {

constexpr double kOn = 1e-10;  // as the header promises

films::LevelSet level(const std::string& formula,
                      films::LevelSet::Side side = films::LevelSet::Side::On) {
  return {.name = formula,
          .formula = energy::place_expression(formula),
          .side = side};
}

/// A unit sphere, a plane through its middle, the half space above it, and
/// what no point satisfies.
films::FilmComplex walls() {
  films::FilmComplex complex;
  complex.level_sets = {level("x^2 + y^2 + z^2 - 1"), level("x + 2*y - z"),
                        level("z", films::LevelSet::Side::AtLeast),
                        level("x^2 + y^2 + z^2 + 1")};
  complex.constraint_sets = {{0}, {0, 1}, {2}, {3}, {0, 0}};
  return complex;
}

std::vector<Vec3> random_places() {
  std::mt19937 random(7);
  std::uniform_real_distribution<double> within(-2.0, 2.0);
  std::vector<Vec3> places;
  while (places.size() < 100) {
    const Vec3 place(within(random), within(random), within(random));
    if (place.norm() > 0.3) {  // in the middle every direction is as good
      places.push_back(place);
    }
  }
  return places;
}

TEST(PutOnConstraints, GoesStraightToTheSphere) {
  const films::FilmComplex complex = walls();
  for (const Vec3& from : random_places()) {
    const Vec3 on = films::put_on_constraints(complex, 0, from);
    EXPECT_LT((on - from.normalized()).norm(), kOn);
    // The same wall twice has no second normal.
    EXPECT_LT((films::put_on_constraints(complex, 4, from) - on).norm(), kOn);
  }
}

TEST(PutOnConstraints, HoldsSphereAndPlaneAtOnce) {
  const films::FilmComplex complex = walls();
  for (const Vec3& from : random_places()) {
    const Vec3 on = films::put_on_constraints(complex, 1, from);
    EXPECT_NEAR(on.norm(), 1.0, kOn);
    EXPECT_NEAR(on.x() + 2.0 * on.y() - on.z(), 0.0, kOn);
  }
}

TEST(PutOnConstraints, LeavesWhatIsOnItsSideOfAWall) {
  const films::FilmComplex complex = walls();
  for (const Vec3& from : random_places()) {
    const Vec3 on = films::put_on_constraints(complex, 2, from);
    EXPECT_EQ(on, Vec3(from.x(), from.y(), std::max(from.z(), 0.0)));
    EXPECT_EQ(films::put_on_constraints(complex, -1, from), from);
  }
}

TEST(PutOnConstraints, RefusesWhatCannotBeMet) {
  EXPECT_THROW(films::put_on_constraints(walls(), 3, Vec3(1, 2, 3)),
               InvalidInput);
}

}  // namespace
}  // namespace meniscus::put_on_constraints_test
