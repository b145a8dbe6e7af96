/// Films that are planes, cylinders and spheres: recognised, and valid solids
/// of the exact volume in OpenCASCADE's eyes.
#include <cmath>
#include <fstream>
#include <iterator>
#include <numbers>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "cad/step/step_reader.h"
#include "cad/step/step_writer.h"
#include "tests/support/film_parts.h"
#include "tests/support/temp_folder.h"

namespace meniscus::simple_faces_test {
namespace {

constexpr double kPi = std::numbers::pi;
constexpr double kExact = 1e-9;  // relative, of OpenCASCADE's own integrals
// Of the volume of a sphere that is fitted: what the points between the film's
// vertices miss it by, fourth order in its edge.
constexpr double kFitted = 5e-4;

class SimpleFaces : public testing::Test {
 protected:
  step::StepReport written(const solid::FilmSolid& solid) {
    expect_closed(solid.brep);
    return step::write_step(file_, solid.brep, {.name = "part", .unit = "mm"});
  }
  std::string text() const {
    std::ifstream in(file_);
    return {std::istreambuf_iterator<char>(in), {}};
  }
  TempFolder folder_;
  std::filesystem::path file_ = folder_.path() / "part.step";
};

TEST_F(SimpleFaces, TubeBetweenEqualCirclesIsACylinder) {
  const solid::FilmSolid solid =
      solid_of(spool(36, 40.0, [](double) { return 15.0; }));
  EXPECT_EQ(solid.report.cylinders, 1);
  EXPECT_EQ(solid.report.planes, 2);
  EXPECT_EQ(solid.report.patches, 0);
  EXPECT_LT(solid.report.film_to_solid, kExact);
  const double exact = kPi * 15.0 * 15.0 * 40.0;
  const step::StepReport report = written(solid);
  EXPECT_NEAR(report.volume, exact, kExact * exact);
  EXPECT_NEAR(report.mass_center[2], 20.0, kExact * 40.0);
  EXPECT_THAT(text(), testing::HasSubstr("CYLINDRICAL_SURFACE"));
  EXPECT_THAT(text(), testing::Not(testing::HasSubstr("B_SPLINE_SURFACE")));
}

TEST_F(SimpleFaces, BoreIsACylinderThatLooksInward) {
  const solid::FilmSolid solid = solid_of(spool(
      36, 40.0, [](double) { return 16.0; }, true));
  EXPECT_EQ(solid.report.cylinders, 2);
  const double exact = kPi * (16.0 * 16.0 - 4.0 * 4.0) * 40.0;
  EXPECT_NEAR(written(solid).volume, exact, kExact * exact);
}

TEST_F(SimpleFaces, ZoneOfASphereBetweenTwoCircles) {
  const auto radius = [](double z) {
    return std::sqrt(25.0 * 25.0 - (z - 10.0) * (z - 10.0));
  };
  const solid::FilmSolid solid = solid_of(spool(48, 30.0, radius));
  EXPECT_EQ(solid.report.spheres, 1);
  const auto cap = [](double z) { return kPi * (625.0 * z - z * z * z / 3.0); };
  const double exact = cap(20.0) - cap(-10.0);
  EXPECT_NEAR(written(solid).volume, exact, kExact * exact);
}

TEST_F(SimpleFaces, DomesAreSpheresAlsoBeyondTheHalf) {
  for (const double rise : {6.0, 20.0, 45.0}) {
    const solid::FilmSolid solid = solid_of(ball_cap(12, rise));
    EXPECT_EQ(solid.report.spheres, 1) << rise;
    EXPECT_EQ(solid.report.planes, 1);
    EXPECT_EQ(solid.report.patches, 0);
    const double exact = kPi * rise * (3.0 * 400.0 + rise * rise) / 6.0;
    EXPECT_NEAR(written(solid).volume, exact, kFitted * exact);
    EXPECT_THAT(text(), testing::HasSubstr("SPHERICAL_SURFACE"));
  }
}

TEST_F(SimpleFaces, ClosedFilmIsAWholeSphere) {
  const solid::FilmSolid solid = solid_of(ellipsoid(8, Vec3::Constant(12.0)));
  EXPECT_EQ(solid.report.spheres, 1);
  EXPECT_EQ(solid.brep.faces.size(), 1);
  const double exact = 4.0 / 3.0 * kPi * std::pow(12.0, 3);
  const step::StepReport report = written(solid);
  EXPECT_NEAR(report.volume, exact, kFitted * exact);
  EXPECT_NEAR((report.mass_center - Vec3(3, 2, 1)).norm(), 0.0, 1e-7);
  // Read again it is the same ball.
  const SurfaceMesh read =
      step::read_step_part(file_, {.unit = "mm", .edge = 1.0});
  EXPECT_NEAR(enclosed_volume(read) / exact, 1.0, 0.01);
}

TEST_F(SimpleFaces, LinesBetweenTwoCirclesAreACone) {
  for (const double slope : {0.1, -0.3, 1.2}) {
    const auto radius = [slope](double z) { return 55.0 + slope * z; };
    const solid::FilmSolid solid = solid_of(spool(36, 40.0, radius));
    EXPECT_EQ(solid.report.cones, 1) << slope;
    EXPECT_EQ(solid.report.patches, 0);
    const double a = radius(-20.0);
    const double b = radius(20.0);
    const double exact = kPi * 40.0 / 3.0 * (a * a + a * b + b * b);
    const double other =
        kPi * 40.0 / 3.0 *
        (std::pow(radius(0.0), 2) + radius(0.0) * radius(40.0) +
         std::pow(radius(40.0), 2));
    const double volume = written(solid).volume;
    EXPECT_NEAR(std::min(std::abs(volume / exact - 1.0),
                         std::abs(volume / other - 1.0)),
                0.0, kExact);
    EXPECT_THAT(text(), testing::HasSubstr("CONICAL_SURFACE"));
  }
  // A film that bulges between them is none.
  const solid::FilmSolid bulged = solid_of(
      spool(36, 40.0, [](double z) { return 15.0 + 0.1 * z + 2e-3 * z * z; }));
  EXPECT_EQ(bulged.report.cones, 0);
  EXPECT_EQ(bulged.report.patches, 4);
}

TEST_F(SimpleFaces, FlatFilmIsAPlane) {
  FilmPart tube = spool(36, 40.0, [](double) { return 15.0; });
  tube.caps = {"bottom"};  // the top is a film across its rim
  const solid::FilmSolid closed = solid_of(tube);
  EXPECT_EQ(closed.report.planes, 2);
  EXPECT_EQ(closed.report.simple.size(), 2);
  const double exact = kPi * 15.0 * 15.0 * 40.0;
  EXPECT_NEAR(written(closed).volume, exact, kExact * exact);
}

TEST_F(SimpleFaces, NearlyIsNotEnough) {
  // Off by a twentieth of an edge: more than the film's own error.
  const solid::FilmSolid solid = solid_of(spool(36, 40.0, [](double z) {
    return 15.0 + 0.15 * std::sin(kPi * z / 40.0);
  }));
  EXPECT_EQ(solid.report.cylinders, 0);
  EXPECT_EQ(solid.report.patches, 4);
  written(solid);
}

TEST_F(SimpleFaces, OtherUnitsOnlyScale) {
  const solid::FilmSolid solid = solid_of(spool(
      36, 40.0, [](double) { return 16.0; }, true));
  const step::StepReport report =
      step::write_step(file_, solid.brep, {.name = "part", .unit = "in"});
  const double exact = kPi * (16.0 * 16.0 - 4.0 * 4.0) * 40.0;
  EXPECT_NEAR(report.volume, exact, kExact * exact);
}

TEST_F(SimpleFaces, DomesAndBubblesOfPatchesAreValidSolids) {
  EXPECT_EQ(written(solid_of(dome(10,
                                  [](double x, double y) {
                                    return 12.0 *
                                           (1.0 - (x * x + y * y) / 400.0) *
                                           (1.0 + x / 60.0);
                                  })))
                .shells,
            1);
  EXPECT_EQ(written(solid_of(square_dome(6, 8.0))).shells, 1);
  const double exact = 4.0 / 3.0 * kPi * 14.0 * 10.0 * 18.0;
  EXPECT_NEAR(written(solid_of(ellipsoid(10, {14.0, 10.0, 18.0}))).volume,
              exact, 2e-3 * exact);
}

}  // namespace
}  // namespace meniscus::simple_faces_test
