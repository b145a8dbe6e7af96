// Films that slide on plane walls at a contact angle.
#include <algorithm>
#include <array>
#include <cmath>
#include <memory>
#include <numbers>
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/error.h"
#include "core/geometry/surface_mesh.h"
#include "evolve/frozen/film_model.h"

namespace meniscus::sliding_films_test {
namespace {

using testing::HasSubstr;

constexpr double kPi = std::numbers::pi;
constexpr double kTension = 2.0;
constexpr double kFlat = 1e-12;
// Errors of flat facets fall with their square, by 4 a refinement.
constexpr double kSecondOrder = 3.4;

/// Begins on a circle of radius 1, whatever its angle asks for.
films::FilmSystem drop(double angle, const Vec3& normal = Vec3::UnitZ()) {
  films::FilmSystem system;
  system.curves = {{"begin", curves::Circle{Vec3(0.3, 0.1, 0.2), normal, 1.0}}};
  system.films = {{"dome", films::FilmKind::Disk, {"begin"}, kTension}};
  system.caps = {{"floor", "begin"}};
  system.caps[0].wall = films::FilmWall{.at = Vec3(0.3, 0.1, 0.2),
                                        .normal = normal,
                                        .tension = -kTension * std::cos(angle)};
  system.bodies = {{"drop", {"floor", "dome"}, 2.0, {}}};
  return system;
}

/// A spherical cap that meets its plane at an angle in it:
/// V = pi R^3 (2 + cos a) (1 - cos a)^2 / 3.
double drop_radius(double angle, double volume) {
  const double c = std::cos(angle);
  return std::cbrt(3.0 * volume / (kPi * (2.0 + c) * (1.0 - c) * (1.0 - c)));
}

TEST(SlidingFilm, ADropOnAPlaneIsASphericalCapAtItsAngle) {
  for (const double degrees : {60.0, 90.0, 130.0}) {
    const double angle = degrees * kPi / 180.0;
    const double radius = drop_radius(angle, 2.0);
    const double wetted = kPi * std::pow(radius * std::sin(angle), 2);
    std::vector<double> pressure_errors;
    std::vector<double> area_errors;
    for (const int refinements : {0, 1, 2}) {
      const frozen::FilmModel model =
          frozen::FilmModel::freeze(drop(angle, Vec3(0.3, -0.2, 1.0)),
                                    {.edge = 0.3, .refinements = refinements});
      ASSERT_FALSE(model.reference().failure)
          << degrees << ": " << model.reference().failure->message;
      const settle::FilmReport& report = model.reference().report;
      EXPECT_EQ(report.index, 0);
      pressure_errors.push_back(std::abs(
          report.bodies[0].pressure * radius / (2.0 * kTension) - 1.0));
      area_errors.push_back(
          std::abs(model.areas(model.reference().points)[1] / wetted - 1.0));
    }
    EXPECT_LT(pressure_errors[2], 2e-3) << degrees;
    EXPECT_LT(area_errors[2], 4e-3) << degrees;
    for (const int k : {0, 1}) {
      EXPECT_GT(pressure_errors[k] / pressure_errors[k + 1], kSecondOrder)
          << degrees;
      EXPECT_GT(area_errors[k] / area_errors[k + 1], kSecondOrder) << degrees;
    }
  }
}

TEST(SlidingFilm, ItsWettedFaceStaysAFlatMeshAsItSlides) {
  const Vec3 normal = Vec3(0.3, -0.2, 1.0);
  const frozen::FilmModel model = frozen::FilmModel::freeze(
      drop(kPi / 2.0, normal), {.edge = 0.3, .refinements = 1});
  ASSERT_FALSE(model.reference().failure);
  films::FilmSystem larger = drop(kPi / 2.0, normal);
  larger.bodies[0].volume = 3.0;
  larger.caps[0].wall->tension = -0.3 * kTension;
  const settle::FilmState state = model.settle(larger);
  ASSERT_FALSE(state.failure) << state.failure->message;
  const SurfaceMesh mesh = model.fine_mesh(state.points);
  double wetted = 0.0;
  for (std::size_t f = 0; f < mesh.facets.size(); ++f) {
    if (mesh.labels[mesh.facet_label[f]] != "floor") {
      continue;
    }
    const Triangle& t = mesh.facets[f];
    const Vec3& a = mesh.points[t[0]];
    const Vec3 area2 = (mesh.points[t[1]] - a).cross(mesh.points[t[2]] - a);
    EXPECT_GT(-area2.dot(normal.normalized()), 0.0);  // out of the drop
    EXPECT_NEAR(normal.normalized().dot(a - larger.caps[0].wall->at), 0.0,
                kFlat);
    wetted += 0.5 * area2.norm();
  }
  EXPECT_NEAR(wetted, model.areas(state.points)[1], kFlat);
  EXPECT_NEAR(state.report.bodies[0].volume, 3.0, 1e-9);
}

/// A tube between two rings, and its half on the plane in the middle.
films::FilmSystem tube(bool half) {
  films::FilmSystem system;
  system.curves = {
      {"high", curves::Circle{Vec3(0, 0, 0.6), Vec3::UnitZ(), 1.0}},
      {"low",
       curves::Circle{Vec3(0, 0, half ? 0.0 : -0.6), -Vec3::UnitZ(), 1.0}}};
  system.films = {{"skin", films::FilmKind::Loft, {"high", "low"}, 1.0}};
  system.caps = {{"lid", "high"}, {"foot", "low"}};
  if (half) {
    system.caps[1].wall = films::FilmWall{};
  }
  system.bodies = {
      {"part", {"skin", "lid", "foot"}, half ? 2.2 : 4.4, std::nullopt}};
  return system;
}

TEST(SlidingFilm, HalfATubeHasTheWholesPressureAndArea) {
  std::vector<double> pressure;
  std::vector<double> area;
  for (const bool half : {false, true}) {
    const frozen::FilmModel model =
        frozen::FilmModel::freeze(tube(half), {.edge = 0.2, .refinements = 2});
    ASSERT_FALSE(model.reference().failure)
        << model.reference().failure->message;
    pressure.push_back(model.reference().report.bodies[0].pressure);
    area.push_back((half ? 2.0 : 1.0) * model.reference().report.area);
  }
  constexpr double kMeshes = 2e-3;  // two meshes of the same edge
  EXPECT_NEAR(pressure[1] / pressure[0], 1.0, kMeshes);
  EXPECT_NEAR(area[1] / area[0], 1.0, kMeshes);
}

/// A ring and its mirror image about z = 0: of ellipses both begin on their
/// axis, however they tilt, and their points are each other's images.
curves::Ellipse ring(double p, double side) {
  curves::Ellipse result;
  result.center = Vec3(0.1 * p, 0.0, side * (0.6 + 0.05 * p));
  result.normal = Vec3(0.2 * p, 0.0, side);
  result.radius_1 = 1.0;
  result.radius_2 = 1.0 - 0.1 * p;
  return result;
}

/// A tube from given facets, a ring of which moves with p; of the whole both,
/// as mirror images.
films::FilmSystem tube_of(std::shared_ptr<const films::StartFacets> start,
                          bool half, double p) {
  films::FilmSystem system = tube(half);
  system.keep_facets = true;
  system.films[0].kind = films::FilmKind::Facets;
  system.films[0].start = std::move(start);
  system.films[0].within = 0.01;
  system.curves[0].shape = ring(p, 1.0);
  if (!half) {
    system.curves[1].shape = ring(p, -1.0);
  }
  *system.bodies[0].volume *= 1.0 + 0.1 * p;
  return system;
}

/// Rows of facets on a cylinder of radius 1 from z = 0.6 down to 0.
std::shared_ptr<films::StartFacets> rows_of_facets() {
  constexpr int kAround = 20;
  constexpr int kRows = 3;
  auto start = std::make_shared<films::StartFacets>();
  for (int row = kRows; row >= 0; --row) {
    for (int k = 0; k < kAround; ++k) {
      const double angle = 2.0 * kPi * k / kAround;
      start->points.emplace_back(std::cos(angle), std::sin(angle),
                                 0.6 * row / kRows);
    }
  }
  for (int a = 0; a < kRows * kAround; ++a) {
    const int b = (a + 1) % kAround == 0 ? a + 1 - kAround : a + 1;
    start->facets.push_back({a, a + kAround, b});
    start->facets.push_back({b, a + kAround, b + kAround});
  }
  return start;
}

/// A film of a part at rest, with its mirror images in planes through 0 of
/// these normals.
std::shared_ptr<films::StartFacets> mirrored(const SurfaceMesh& part,
                                             const std::string& film,
                                             const Points& normals) {
  auto start = std::make_shared<films::StartFacets>();
  std::vector<int> number(part.points.size(), -1);
  for (std::size_t f = 0; f < part.facets.size(); ++f) {
    if (part.labels[part.facet_label[f]] != film) {
      continue;
    }
    Triangle& facet = start->facets.emplace_back(part.facets[f]);
    for (int& v : facet) {
      if (number[v] < 0) {
        number[v] = static_cast<int>(start->points.size());
        start->points.push_back(part.points[v]);
      }
      v = number[v];
    }
  }
  for (const Vec3& n : normals) {
    std::vector<int> image(start->points.size());
    for (std::size_t v = 0; v < image.size(); ++v) {
      const Vec3 at = start->points[v];
      image[v] = static_cast<int>(v);
      if (std::abs(n.dot(at)) > kFlat) {
        image[v] = static_cast<int>(start->points.size());
        start->points.emplace_back(at - 2.0 * n.dot(at) * n);
      }
    }
    for (std::size_t f = 0, count = start->facets.size(); f < count; ++f) {
      const auto [a, b, c] = start->facets[f];
      start->facets.push_back({image[a], image[c], image[b]});
    }
  }
  return start;
}

/// How far the points of a film are from those of another, at most.
double farthest_from(const Points& others, const SurfaceMesh& part,
                     const std::string& film) {
  double farthest = 0.0;
  for (std::size_t f = 0; f < part.facets.size(); ++f) {
    for (const int v : part.facets[f]) {
      if (part.labels[part.facet_label[f]] == film) {
        double nearest = 1.0;
        for (const Vec3& point : others) {
          nearest = std::min(nearest, (point - part.points[v]).norm());
        }
        farthest = std::max(farthest, nearest);
      }
    }
  }
  return farthest;
}

constexpr double kSameFilm = 1e-9;  // but for rounding

// Mirrored meshes, at the frozen design and at others: what slides on the plane
// and what the whole has there are the same film.
TEST(SlidingFilm, HalfAFilmIsTheWholesToRounding) {
  frozen::FilmModelOptions options = {.edge = 0.29, .refinements = 0};
  const auto rows = rows_of_facets();
  const frozen::FilmModel part =
      frozen::FilmModel::freeze(tube_of(rows, true, 0.0), options);
  ASSERT_FALSE(part.reference().failure);
  const auto both = mirrored(part.fine_mesh(part.reference().points), "skin",
                             {Vec3::UnitZ()});
  options.at_rest = true;
  const frozen::FilmModel whole =
      frozen::FilmModel::freeze(tube_of(both, false, 0.0), options);
  for (const double p : {0.0, 0.7}) {
    const settle::FilmState all = whole.settle(tube_of(both, false, p));
    const settle::FilmState half = part.settle(tube_of(rows, true, p));
    ASSERT_FALSE(all.failure) << all.failure->message;
    ASSERT_FALSE(half.failure) << half.failure->message;
    EXPECT_NEAR(half.report.bodies[0].pressure, all.report.bodies[0].pressure,
                kSameFilm);
    EXPECT_NEAR(2.0 * half.report.area, all.report.area, kSameFilm);
    EXPECT_LT(farthest_from(all.points, part.fine_mesh(half.points), "skin"),
              kSameFilm)
        << p;
  }
}

/// The rim that holds a tube along z or along x, or its image on other sides.
curves::Ellipse rim(bool along_z, double p, double side_x, double side_z) {
  const double near = 0.6 + 0.05 * p;
  const double off = 3.0 + 0.1 * p;
  curves::Ellipse result;
  result.center = Vec3(side_x * (along_z ? off : near), 0.0,
                       side_z * (along_z ? near : off));
  result.normal = along_z ? Vec3(side_x * 0.2 * p, 0.0, side_z)
                          : Vec3(side_x, 0.0, side_z * 0.1 * p);
  result.axis = along_z ? Vec3::UnitX() : Vec3::UnitZ();
  result.radius_1 = 1.0;
  result.radius_2 = 1.0 - 0.1 * p;
  return result;
}

/// A quarter of four tubes of one liquid, two along z and two along x, which
/// end on the planes across z and x.
films::FilmSystem quarter_of_tubes(double p) {
  films::FilmSystem system;
  system.curves = {
      {"rim_z", rim(true, p, 1.0, 1.0)},
      {"rim_x", rim(false, p, 1.0, 1.0)},
      {"begin_z", curves::Circle{Vec3(3, 0, 0), -Vec3::UnitZ(), 1.0}},
      {"begin_x", curves::Circle{Vec3(0, 0, 3), -Vec3::UnitX(), 1.0}}};
  system.films = {
      {"along_z", films::FilmKind::Loft, {"rim_z", "begin_z"}, 1.0},
      {"along_x", films::FilmKind::Loft, {"rim_x", "begin_x"}, 1.0}};
  system.caps = {{"lid_z", "rim_z"},
                 {"lid_x", "rim_x"},
                 {"cut_z", "begin_z"},
                 {"cut_x", "begin_x"}};
  system.caps[2].wall = films::FilmWall{.normal = Vec3::UnitZ()};
  system.caps[3].wall = films::FilmWall{.normal = Vec3::UnitX()};
  system.bodies = {{"part",
                    {"along_z", "along_x", "lid_z", "lid_x", "cut_z", "cut_x"},
                    4.4 * (1.0 + 0.1 * p),
                    std::nullopt}};
  return system;
}

using FilmStarts = std::array<std::shared_ptr<const films::StartFacets>, 2>;

films::FilmSystem all_tubes(const FilmStarts& starts, double p) {
  films::FilmSystem system;
  system.keep_facets = true;
  system.bodies = {{"part", {}, 17.6 * (1.0 + 0.1 * p), std::nullopt}};
  for (const bool along_z : {true, false}) {
    const std::string name = along_z ? "along_z" : "along_x";
    films::FilmSpec film{name, films::FilmKind::Facets, {}, 1.0};
    film.start = starts[along_z ? 0 : 1];
    film.within = 0.01;
    system.bodies[0].enclosed_by.push_back(name);
    for (const double x : {-1.0, 1.0}) {
      for (const double z : {-1.0, 1.0}) {
        const std::string number = std::to_string(system.curves.size());
        film.curves.push_back("rim_" + number);
        system.curves.push_back({film.curves.back(), rim(along_z, p, x, z)});
        system.caps.push_back({"lid_" + number, film.curves.back()});
        system.bodies[0].enclosed_by.push_back("lid_" + number);
      }
    }
    system.films.push_back(std::move(film));
  }
  return system;
}

TEST(SlidingFilm, AQuarterOfFilmsIsTheWholesToRounding) {
  frozen::FilmModelOptions options = {.edge = 0.4, .refinements = 0};
  const frozen::FilmModel part =
      frozen::FilmModel::freeze(quarter_of_tubes(0.0), options);
  ASSERT_FALSE(part.reference().failure) << part.reference().failure->message;
  const SurfaceMesh drawn = part.fine_mesh(part.reference().points);
  const Points planes = {Vec3::UnitZ(), Vec3::UnitX()};
  const FilmStarts starts = {mirrored(drawn, "along_z", planes),
                             mirrored(drawn, "along_x", planes)};
  options.at_rest = true;
  options.edge = 10.0;  // the facets as they are
  const frozen::FilmModel whole =
      frozen::FilmModel::freeze(all_tubes(starts, 0.0), options);
  ASSERT_FALSE(whole.reference().failure) << whole.reference().failure->message;
  for (const double p : {0.0, 0.7}) {
    const settle::FilmState all = whole.settle(all_tubes(starts, p));
    const settle::FilmState quarter = part.settle(quarter_of_tubes(p));
    ASSERT_FALSE(all.failure) << all.failure->message;
    ASSERT_FALSE(quarter.failure) << quarter.failure->message;
    EXPECT_NEAR(quarter.report.bodies[0].pressure,
                all.report.bodies[0].pressure, kSameFilm);
    EXPECT_NEAR(4.0 * quarter.report.area, all.report.area, kSameFilm);
    const SurfaceMesh mesh = part.fine_mesh(quarter.points);
    for (const char* film : {"along_z", "along_x"}) {
      EXPECT_LT(farthest_from(all.points, mesh, film), kSameFilm)
          << film << " " << p;
    }
  }
}

std::string message_of(const films::FilmSystem& system) {
  try {
    frozen::FilmModel::freeze(system, {.edge = 0.3});
  } catch (const InvalidInput& error) {
    return error.what();
  }
  return "";
}

TEST(SlidingFilm, RefusesWallsThatNoFilmCanMeet) {
  films::FilmSystem system = drop(1.0);
  system.caps[0].wall->tension = kTension;
  EXPECT_THAT(message_of(system), HasSubstr("energy is less than its own"));
  system = drop(1.0);
  system.caps[0].wall->normal = Vec3::Zero();
  EXPECT_THAT(message_of(system), HasSubstr("a normal that is not 0"));
  system = drop(1.0);
  system.caps[0].wall->at.z() += 0.1;
  EXPECT_THAT(message_of(system), HasSubstr("curve 'begin' is"));
}

TEST(SlidingFilm, ADesignCannotMoveAWall) {
  const frozen::FilmModel model =
      frozen::FilmModel::freeze(tube(true), {.edge = 0.3});
  films::FilmSystem moved = tube(true);
  moved.caps[1].wall->at.z() = 0.1;
  EXPECT_THROW(static_cast<void>(model.settle(moved)), InvalidInput);
}

}  // namespace
}  // namespace meniscus::sliding_films_test
