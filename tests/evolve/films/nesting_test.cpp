#include "evolve/films/nesting.h"

#include <cmath>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/error.h"
#include "evolve/groom/refine.h"
#include "evolve/settle/equilibrium.h"
#include "tests/support/film_shapes.h"

namespace meniscus::nesting_test {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;

void append(SurfaceMesh& mesh, const SurfaceMesh& more, const std::string& name,
            const Vec3& shift) {
  const auto first = static_cast<int>(mesh.points.size());
  const auto label = static_cast<int>(mesh.labels.size());
  mesh.labels.push_back(name);
  for (const Vec3& p : more.points) {
    mesh.points.push_back(p + shift);
  }
  for (const Triangle& t : more.facets) {
    mesh.facets.push_back({t[0] + first, t[1] + first, t[2] + first});
    mesh.facet_label.push_back(label);
  }
}

void append(films::FilmComplex& complex, const films::FilmComplex& more,
            const std::string& name) {
  const auto curves = static_cast<int>(complex.curves.size());
  append(complex.mesh, more.mesh, name, Vec3::Zero());
  complex.surfaces.push_back({name, true, 1.0});
  for (films::ComplexVertex vertex : more.vertices) {
    vertex.curve += vertex.curve >= 0 ? curves : 0;
    complex.vertices.push_back(vertex);
  }
  complex.curves.insert(complex.curves.end(), more.curves.begin(),
                        more.curves.end());
}

/// Tubes between rings of radius R, 0.8 apart, for every R.
films::FilmComplex tubes(const std::vector<double>& radii, double growth) {
  films::FilmComplex complex;
  double length = 0.8;
  for (const double radius : radii) {
    append(complex,
           shapes::tube(radius, length, 24, 8, [&](double) { return radius; }),
           "film_" + std::to_string(static_cast<int>(100 * radius)));
    length *= growth;
  }
  return complex;
}

/// At rest. Films near each other are none of a solver's business.
films::FilmComplex settled(films::FilmComplex complex) {
  const energy::FilmEnergy energy(complex);
  const settle::FilmState state = settle::settle_in_normals(
      energy, complex, energy::targets_of(complex), complex.mesh.points, {});
  EXPECT_LE(state.report.residual, state.report.residual_bound);
  EXPECT_EQ(state.report.index, 0);
  complex.mesh.points = state.points;
  return complex;
}

// Scaled curve pairs: each film is the next one scaled, c cosh(z / c) with
// cosh(0.4 / c) = 1 / c for the first.
TEST(Nesting, ScaledCatenoidsSettledTogetherDoNotCross) {
  films::FilmComplex complex = tubes({1.0, 1.2, 1.44}, 1.2);
  complex = groom::refine(settled(std::move(complex))).complex;
  complex = settled(std::move(complex));
  const films::NestingReport report = films::check_nesting(complex.mesh);
  EXPECT_TRUE(report.apart) << films::nesting_text(report);
  EXPECT_THAT(report.order, ElementsAre("film_100", "film_120", "film_144"));
  EXPECT_EQ(report.inside.size(), 3U);
  ASSERT_EQ(report.gaps.size(), 3U);
  // Nearest at the rims, where the inner film leans outward: 0.15, below the
  // 0.2 x 0.911 between the waists. The pairs are scaled copies.
  EXPECT_NEAR(report.gaps[0].gap, 0.152, 0.01);
  EXPECT_NEAR(report.gaps[2].gap, 1.2 * report.gaps[0].gap, 1e-6);
  EXPECT_NEAR((report.gaps[0].on_group - report.gaps[0].on_other).norm(),
              report.gaps[0].gap, 1e-15);
}

// 0.911 cosh(z / 0.911) and 0.929 cosh((z - 0.5) / 0.929) meet at z = 0.28,
// where both have the radius 0.956.
TEST(Nesting, FilmsThatCrossAreNamedWithTheirPlace) {
  const auto straight = [](double) { return 1.0; };
  films::FilmComplex complex;
  append(complex, shapes::tube(1.0, 0.8, 24, 6, straight), "lower");
  films::FilmComplex upper = shapes::tube(1.02, 0.816, 24, 6, straight);
  for (Vec3& p : upper.mesh.points) {
    p.z() += 0.5;
  }
  for (curves::Curve& curve : upper.curves) {
    std::get<curves::Circle>(curve.shape).center.z() += 0.5;
  }
  append(complex, upper, "upper");
  complex = settled(std::move(complex));
  const films::NestingReport report = films::check_nesting(complex.mesh);
  EXPECT_FALSE(report.apart);
  ASSERT_FALSE(report.crossings.empty());
  EXPECT_GT(report.crossing_pairs, 20);
  EXPECT_EQ(report.crossings.size(), 20U);
  EXPECT_EQ(report.crossings[0].film, "lower");
  EXPECT_EQ(report.crossings[0].other, "upper");
  EXPECT_NEAR(report.crossings[0].position.head<2>().norm(), 0.956, 0.03);
  EXPECT_NEAR(report.crossings[0].position.z(), 0.28, 0.05);
  EXPECT_THAT(films::nesting_text(report), HasSubstr("'lower'"));
  EXPECT_THAT(films::nesting_text(report), HasSubstr("'upper'"));
  EXPECT_EQ(report.gaps[0].gap, 0.0);
}

TEST(Nesting, ConcentricSpheresAreOrderedInsideOut) {
  SurfaceMesh mesh;
  append(mesh, shapes::sphere(2.0, 3), "outer", Vec3::Zero());
  append(mesh, shapes::sphere(0.5, 3), "inner", Vec3(0.1, 0, 0));
  append(mesh, shapes::sphere(1.0, 3), "middle", Vec3(0.2, 0, 0));
  append(mesh, shapes::sphere(1.0, 2), "beside", Vec3(5, 0, 0));
  const films::NestingReport report = films::check_nesting(mesh);
  EXPECT_TRUE(report.apart) << films::nesting_text(report);
  EXPECT_THAT(report.order, ElementsAre("inner", "middle", "outer", "beside"));
  EXPECT_EQ(report.inside.size(), 3U);
  // Spheres of radius 0.5 and 1, centres 0.1 apart: 0.4 less the sagitta.
  EXPECT_NEAR(report.gaps[3].gap, 0.4, 0.01);
  EXPECT_THAT(films::nesting_text(report), HasSubstr("apart"));
}

TEST(Nesting, GapIsThatOfEveryPairOfFacets) {
  SurfaceMesh mesh;
  append(mesh, shapes::box(Vec3(1, 1, 1), 3), "low", Vec3::Zero());
  append(mesh, shapes::sphere(0.5, 2), "high", Vec3(1.1, 1.3, 1.9));
  const films::NestingReport report = films::check_nesting(mesh);
  const Vec3 corner(1, 1, 1);
  EXPECT_NEAR(report.gaps[0].gap, (Vec3(1.1, 1.3, 1.9) - corner).norm() - 0.5,
              0.02);
  EXPECT_NEAR((report.gaps[0].on_group - corner).norm(), 0.0, 1e-12);
}

TEST(Nesting, FilmsThatShareARimAreOneGroup) {
  films::FilmComplex complex =
      shapes::tube(1, 1, 12, 4, [](double) { return 1.0; });
  complex.mesh.labels.push_back("upper");
  for (std::size_t f = 48; f < 96; ++f) {
    complex.mesh.facet_label[f] = 1;
  }
  films::NestingReport report = films::check_nesting(complex.mesh);
  EXPECT_TRUE(report.apart);
  EXPECT_TRUE(report.gaps.empty());
  EXPECT_EQ(films::nesting_text(report), "");
  // A ball within the tube lies in the group, in neither film alone.
  append(complex.mesh, shapes::sphere(0.6, 2), "ball", Vec3(0, 0, 0));
  report = films::check_nesting(complex.mesh);
  ASSERT_EQ(report.inside.size(), 1U);
  EXPECT_EQ(report.inside[0].inner, "ball");
  EXPECT_THAT(report.inside[0].outer, HasSubstr("and 1 more"));
}

TEST(Nesting, RefusesBrokenMeshes) {
  SurfaceMesh mesh = shapes::sphere(1.0, 0);
  EXPECT_THROW(films::check_nesting(mesh, {3}), MeshError);
  mesh.points[0].x() = std::nan("");
  EXPECT_THROW(films::check_nesting(mesh), MeshError);
  mesh = shapes::sphere(1.0, 0);
  mesh.facets[2][1] = 999;
  EXPECT_THROW(films::check_nesting(mesh), MeshError);
}

}  // namespace
}  // namespace meniscus::nesting_test
