#include "cad/solid/film_solid.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "cad/solid/spline.h"
#include "core/error.h"
#include "tests/support/film_parts.h"

namespace meniscus::film_solid_test {
namespace {

constexpr double kFullTurn = 2.0 * std::numbers::pi;
constexpr double kHeight = 40.0;

/// Radius of a film of revolution with a waist, by height.
double radius_at(double z) {
  return 20.0 * std::cosh((z - 0.4 * kHeight) / 20.0);
}

FilmPart waisted(int around) { return spool(around, kHeight, radius_at); }

/// Farthest that the faces lie from the exact surface of revolution.
double error_of(const solid::Brep& brep) {
  double error = 0.0;
  for (const solid::BrepFace& face : brep.faces) {
    const auto* surface = std::get_if<solid::SplineSurface>(&face.surface);
    for (int k = 0; k < 400 && surface != nullptr; ++k) {
      const int row = k / 20;
      const Vec3 p =
          solid::jet_of(*surface, {row / 19.0, (k % 20) / 19.0}).point;
      error =
          std::max(error, std::abs(std::hypot(p[0], p[1]) - radius_at(p[2])));
    }
  }
  return error;
}

TEST(FilmSolid, TubeBecomesFourPatchesAndTwoDisks) {
  constexpr int kAround = 48;
  const solid::FilmSolid solid = solid_of(waisted(kAround));
  EXPECT_EQ(solid.report.patches, 4);
  EXPECT_EQ(solid.report.planes, 2);
  expect_closed(solid.brep);
  EXPECT_LT(solid.report.gap, 1e-3);
  EXPECT_LT(solid.report.tangent_break, 0.2);
  const double edge = kFullTurn * 20.0 / kAround;
  EXPECT_LT(solid.report.film_to_solid, 0.1 * edge);
  EXPECT_LT(solid.report.solid_to_film, 0.1 * edge);
}

TEST(FilmSolid, FacesComeToTheSmoothSurfaceFasterThanFacets) {
  // Facets are off by a factor of 4 less at half the edge; the third order of
  // the points between them would be 8.
  constexpr double kLeastRatio = 5.0;
  const double coarse = error_of(solid_of(waisted(24)).brep);
  const double fine = error_of(solid_of(waisted(48)).brep);
  EXPECT_LT(fine, 0.02);
  EXPECT_GT(coarse / fine, kLeastRatio);
}

TEST(FilmSolid, IsTheSameTwice) {
  const solid::FilmSolid a = solid_of(waisted(24));
  const solid::FilmSolid b = solid_of(waisted(24));
  ASSERT_EQ(a.brep.faces.size(), b.brep.faces.size());
  for (std::size_t f = 2; f < a.brep.faces.size(); ++f) {
    EXPECT_EQ(std::get<solid::SplineSurface>(a.brep.faces[f].surface).poles,
              std::get<solid::SplineSurface>(b.brep.faces[f].surface).poles);
  }
}

TEST(FilmSolid, NamesAFilmThatItCannotCut) {
  // Both ends are the film's too: a closed film that its middle does not see
  // all of.
  FilmPart s = spool(24, 400.0, [](double z) {
    return 5.0 + 20.0 * std::pow(std::cos(0.5 * kFullTurn * z / 400.0), 6);
  });
  for (int& label : s.mesh.facet_label) {
    label = 0;
  }
  s.caps.clear();
  try {
    solid_of(s);
    FAIL() << "no error";
  } catch (const MeshError& error) {
    EXPECT_THAT(error.what(), testing::HasSubstr("film 'skin'"));
  }
}

/// Farthest that B-spline faces lie from `off` = 0.
double farthest(const solid::Brep& brep,
                const std::function<double(const Vec3&)>& off) {
  double most = 0.0;
  for (const solid::BrepFace& face : brep.faces) {
    const auto* surface = std::get_if<solid::SplineSurface>(&face.surface);
    for (int k = 0; k < 400 && surface != nullptr; ++k) {
      const int row = k / 20;
      const Vec3 p =
          solid::jet_of(*surface, {row / 19.0, (k % 20) / 19.0}).point;
      most = std::max(most, std::abs(off(p)));
    }
  }
  return most;
}

double leaning(double x, double y) {
  return 12.0 * (1.0 - (x * x + y * y) / 400.0) * (1.0 + x / 60.0);
}

TEST(FilmSolid, DomeBecomesFivePatches) {
  const FilmPart part = dome(10, leaning);
  const solid::FilmSolid solid = solid_of(part);
  EXPECT_EQ(solid.report.patches, 5);
  EXPECT_EQ(solid.report.planes, 1);
  EXPECT_EQ(solid.report.spheres, 0);
  expect_closed(solid.brep);
  EXPECT_LT(solid.report.gap, 1e-3);
  EXPECT_LT(solid.report.tangent_break, 1.0);
  EXPECT_LT(solid.report.film_to_solid, 0.02 * part.edge);
  EXPECT_LT(solid.report.solid_to_film, 0.1 * part.edge);
  const auto off = [](const Vec3& p) { return p[2] - leaning(p[0], p[1]); };
  const double coarse = farthest(solid_of(dome(6, leaning)).brep, off);
  const double fine = farthest(solid_of(dome(12, leaning)).brep, off);
  EXPECT_LT(fine, 0.02);
  EXPECT_GT(coarse / fine, 5.0);  // facets: 4; their smooth points: 8
}

TEST(FilmSolid, FilmInARimOfFourCornersIsOneFace) {
  const FilmPart part = square_dome(6, 8.0);
  const solid::FilmSolid solid = solid_of(part);
  EXPECT_EQ(solid.report.patches, 1);
  expect_closed(solid.brep);
  EXPECT_EQ(solid.brep.vertices.size(), 4);
  EXPECT_LT(solid.report.film_to_solid, 0.1 * part.edge);
  EXPECT_LT(solid.report.solid_to_film, 0.1 * part.edge);
}

/// An ellipsoid cut into films like an orange, whose lines meet in its poles.
TEST(FilmSolid, FilmsWhoseLinesMeetInPointsShareThem) {
  const Vec3 half(14.0, 10.0, 18.0);
  const Vec3 middle(3, 2, 1);
  FilmPart part = ellipsoid(12, half);
  part.mesh.labels = {"one", "two", "three"};
  for (std::size_t f = 0; f < part.mesh.facets.size(); ++f) {
    Vec3 at = -middle;
    for (const int v : part.mesh.facets[f]) {
      at += part.mesh.points[v] / 3.0;
    }
    at = at.cwiseQuotient(half);
    const double angle = std::atan2(at[1], at[0]);
    part.mesh.facet_label[f] = static_cast<int>(
        3.0 * (angle < 0.0 ? angle + kFullTurn : angle) / kFullTurn);
  }
  const solid::FilmSolid solid = solid_of(part);
  expect_closed(solid.brep);
  const auto is_pole = [&](const Vec3& p) {
    return (p - middle).head<2>().norm() < 1e-9;
  };
  EXPECT_EQ(std::count_if(solid.brep.vertices.begin(),
                          solid.brep.vertices.end(), is_pole),
            2);
  EXPECT_LT(solid.report.gap, 1e-3);
  EXPECT_LT(solid.report.tangent_break, 1.0);
  EXPECT_LT(farthest(solid.brep,
                     [&](const Vec3& p) {
                       return ((p - middle).cwiseQuotient(half).norm() - 1.0) *
                              half.mean();
                     }),
            0.05 * part.edge);
}

TEST(FilmSolid, ClosedFilmBecomesACubesSides) {
  const Vec3 half(14.0, 10.0, 18.0);
  const FilmPart part = ellipsoid(8, half);
  const solid::FilmSolid solid = solid_of(part);
  EXPECT_EQ(solid.report.patches, 6);
  EXPECT_EQ(solid.brep.vertices.size(), 8);
  EXPECT_EQ(solid.brep.edges.size(), 12);
  expect_closed(solid.brep);
  EXPECT_LT(solid.report.tangent_break, 1.0);
  EXPECT_LT(solid.report.film_to_solid, 0.02 * part.edge);
  EXPECT_LT(
      farthest(solid.brep,
               [&](const Vec3& p) {
                 return ((p - Vec3(3, 2, 1)).cwiseQuotient(half).norm() - 1.0) *
                        half.mean();
               }),
      0.05 * part.edge);
}

TEST(FilmSolid, RefusesABentCap) {
  FilmPart s = waisted(24);
  s.mesh.points.back()[2] += 1.0;  // the middle of the upper end
  EXPECT_THROW(solid_of(s), InvalidInput);
}

TEST(FilmSolid, FacetedHasAFaceForEachFacet) {
  const FilmPart s = waisted(12);
  const solid::Brep brep = solid::faceted_solid(s.mesh);
  EXPECT_EQ(brep.faces.size(), s.mesh.facets.size());
  expect_closed(brep);
}

}  // namespace
}  // namespace meniscus::film_solid_test
