// Bodies between disk films and caps, films joined on shared curves, and rims
// of many short sides.
#include <numbers>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/geometry/surface_mesh.h"
#include "evolve/curves/curve_contact.h"
#include "evolve/frozen/film_model.h"

namespace meniscus::disk_films_test {
namespace {

constexpr double kPi = std::numbers::pi;
constexpr double kEdge = 0.2;
// Of flat facets of this size on a sphere; it falls with their square.
constexpr double kFacets = 0.01;

films::FilmSystem cap_under_film(std::optional<double> volume,
                                 std::optional<double> pressure) {
  films::FilmSystem system;
  system.curves = {{"rim", curves::Circle{}}};
  system.films = {{"dome", films::FilmKind::Disk, {"rim"}, 2.0, {}}};
  system.caps = {{"floor", "rim"}};
  system.bodies = {{"drop", {"floor", "dome"}, volume, pressure}};
  return system;
}

double highest(const frozen::FilmModel& model) {
  double z = 0.0;
  for (const Vec3& p : model.reference().points) {
    z = std::max(z, p.z());
  }
  return z;
}

// A spherical cap of height h on a circle of radius 1: R = (1 + h^2) / (2 h),
// V = pi h (3 + h^2) / 6, dp = 2 T / R.
TEST(DiskFilm, UnderPressureIsASphericalCap) {
  constexpr double kHeight = 0.5;
  const double radius = (1.0 + kHeight * kHeight) / (2.0 * kHeight);
  const frozen::FilmModel model = frozen::FilmModel::freeze(
      cap_under_film({}, 4.0 / radius), {.edge = kEdge, .refinements = 1});
  ASSERT_FALSE(model.reference().failure) << model.reference().failure->message;
  EXPECT_NEAR(highest(model), kHeight, kFacets * kHeight);
  EXPECT_NEAR(model.reference().report.bodies[0].volume,
              kPi * kHeight * (3.0 + kHeight * kHeight) / 6.0, kFacets);
}

TEST(DiskFilm, OfAVolumeHasThePressureOfItsSphere) {
  for (const double height : {0.3, 1.2}) {  // flat, and more than a half
    const double radius = (1.0 + height * height) / (2.0 * height);
    const double volume = kPi * height * (3.0 + height * height) / 6.0;
    const frozen::FilmModel model =
        frozen::FilmModel::freeze(cap_under_film(volume, {}), {.edge = kEdge});
    ASSERT_FALSE(model.reference().failure)
        << model.reference().failure->message;
    EXPECT_NEAR(highest(model), height, 2.0 * kFacets * height);
    EXPECT_NEAR(model.reference().report.bodies[0].pressure * radius / 4.0, 1.0,
                0.03);
  }
}

TEST(DiskFilm, TwoOnOneCurveMakeALens) {
  films::FilmSystem system = cap_under_film(2.0, {});
  system.caps.clear();
  system.films.push_back({"belly", films::FilmKind::Disk, {"rim"}, 2.0, {}});
  system.bodies = {{"lens", {"dome", "belly"}, 2.0, {}}};
  const frozen::FilmModel model =
      frozen::FilmModel::freeze(system, {.edge = kEdge});
  ASSERT_FALSE(model.reference().failure) << model.reference().failure->message;
  double lowest = 0.0;
  for (const Vec3& p : model.reference().points) {
    lowest = std::min(lowest, p.z());
  }
  EXPECT_NEAR(highest(model), -lowest, 1e-3);
  EXPECT_GT(highest(model), 0.5);
}

// Between a circle and a smaller one above it the film is a catenoid, r =
// c cosh(z / c) of area pi c^2 (u + sinh u cosh u) up to z = c u.
TEST(DiskFilm, AroundAnotherCurveIsACatenoid) {
  constexpr double kNeck = 0.45;
  const double low = std::acosh(1.0 / kNeck);
  const double high = std::acosh(0.5 / kNeck);
  const auto area_to = [](double u) {
    return kPi * kNeck * kNeck * (u + std::sinh(u) * std::cosh(u));
  };
  films::FilmSystem system = cap_under_film({}, 0.0);
  system.curves.push_back(
      {"hole",
       curves::Circle{Vec3(0, 0, kNeck * (low - high)), Vec3::UnitZ(), 0.5}});
  system.films[0].curves = {"rim", "hole"};
  system.caps.push_back({"lid", "hole"});
  system.bodies[0].enclosed_by.emplace_back("lid");
  std::vector<double> errors;
  for (const int refinements : {0, 1, 2}) {
    const frozen::FilmModel model = frozen::FilmModel::freeze(
        system, {.edge = kEdge, .refinements = refinements});
    ASSERT_FALSE(model.reference().failure)
        << model.reference().failure->message;
    errors.push_back(std::abs(
        model.reference().report.area / (area_to(low) - area_to(high)) - 1.0));
  }
  EXPECT_LT(errors[2], 0.1 * kFacets);
  constexpr double kSecondOrder = 3.5;  // of facets: 4
  EXPECT_GT(errors[0] / errors[1], kSecondOrder);
  EXPECT_GT(errors[1] / errors[2], kSecondOrder);
}

// Two lofts meet on a curve that both name: one body, closed, and a kink where
// the curve holds them.
TEST(JoinedFilms, TwoLoftsShareTheirMiddleCurve) {
  films::FilmSystem system;
  const auto ring = [](double z, double radius) {
    return curves::Circle{Vec3(0, 0, z), Vec3::UnitZ(), radius};
  };
  system.curves = {
      {"low", ring(0, 1.0)}, {"waist", ring(1, 0.6)}, {"high", ring(2, 1.0)}};
  system.films = {{"lower", films::FilmKind::Loft, {"low", "waist"}, 1.0, {}},
                  {"upper", films::FilmKind::Loft, {"high", "waist"}, 1.0, {}}};
  system.caps = {{"floor", "low"}, {"lid", "high"}};
  system.bodies = {{"part", {"lower", "upper", "floor", "lid"}, 4.5, {}}};
  const frozen::FilmModel model =
      frozen::FilmModel::freeze(system, {.edge = kEdge});
  ASSERT_FALSE(model.reference().failure) << model.reference().failure->message;
  EXPECT_NEAR(model.reference().report.bodies[0].volume, 4.5, 1e-9);
  EXPECT_GE(model.rim("waist").size(), 18U);
  const SurfaceMesh mesh = model.boundary(model.reference().points);
  EXPECT_NEAR(enclosed_volume(mesh), 4.5, 1e-9);
}

curves::Polygon sides(int count) {
  curves::Polygon polygon;
  for (int k = 0; k < count; ++k) {
    const double a = 2.0 * kPi * k / count;
    polygon.points.emplace_back(std::cos(a), std::sin(a), 0.0);
  }
  return polygon;
}

std::size_t facets_of(const curves::CurveShape& rim) {
  films::FilmSystem system = cap_under_film(1.0, {});
  system.curves[0].shape = rim;
  const frozen::FilmModel model =
      frozen::FilmModel::freeze(system, {.edge = kEdge, .refinements = 0});
  EXPECT_FALSE(model.reference().failure);
  return model.boundary(model.reference().points).facets.size();
}

// Corners stay, but sides shorter than an edge are not split, and facets grow
// away from them.
TEST(ManySides, MakeNoMeshThatIsMuchFinerThanAsked) {
  const std::size_t round = facets_of(curves::Circle{});
  EXPECT_LT(facets_of(sides(40)), 2 * round);   // sides of 0.8 edges
  EXPECT_LT(facets_of(sides(120)), 5 * round);  // of a quarter
}

TEST(CurveContact, FindsCrossingsAndTouches) {
  const curves::Polygon bow{{{0, 0, 0}, {3, 2, 0}, {3, 0, 0}, {0, 1, 0}}};
  const auto at = curves::meets_itself(bow);
  ASSERT_TRUE(at);
  EXPECT_LT((*at - Vec3(1.0, 2.0 / 3.0, 0)).norm(), 1e-9);
  EXPECT_FALSE(curves::meets_itself(sides(5)));
  EXPECT_FALSE(curves::meets_itself(curves::Spline{sides(40).points}));
  const curves::CurveShape one = curves::Circle{};
  const auto other = [](double x, double z) {
    return curves::CurveShape(
        curves::Circle{Vec3(x, 0, z), Vec3::UnitZ(), 1.0});
  };
  const curves::CurveShape tangent = other(2.0, 0.0);
  const curves::CurveShape near = other(2.001, 0.0);
  const curves::CurveShape across = other(1.0, 0.0);
  const curves::CurveShape above = other(0.0, 0.001);
  const curves::CurveShape same = other(0.0, 0.0);
  EXPECT_EQ(curves::meetings_of({&one, &tangent}).size(), 1U);
  EXPECT_EQ(curves::meetings_of({&one, &near}).size(), 0U);
  EXPECT_EQ(curves::meetings_of({&one, &across}).size(), 1U);
  EXPECT_EQ(curves::meetings_of({&one, &above}).size(), 0U);
  EXPECT_EQ(curves::meetings_of({&one, &same}).size(), 1U);
}

}  // namespace
}  // namespace meniscus::disk_films_test
