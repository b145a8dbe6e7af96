#include "cad/film_solid.h"

#include <cmath>
#include <numbers>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "cad/spline.h"
#include "core/error.h"

namespace meniscus {
namespace {

constexpr double kTurn = 2.0 * std::numbers::pi;
constexpr double kHeight = 40.0;

/// Radius of a film of revolution with a waist, by height.
double radius_at(double z) {
  return 20.0 * std::cosh((z - 0.4 * kHeight) / 20.0);
}

struct Spool {
  SurfaceMesh mesh;
  std::vector<NamedRim> rims;
};

/// The film of revolution with flat ends, `around` edges on each rim.
Spool spool(int around) {
  Spool result;
  SurfaceMesh& mesh = result.mesh;
  mesh.labels = {"skin", "bottom", "top"};
  const int rings = around / 3;
  const auto id = [&](int i, int j) {
    return i * around + (j % around + around) % around;
  };
  const auto add = [&](int a, int b, int c, int label) {
    mesh.facets.push_back({a, b, c});
    mesh.facet_label.push_back(label);
  };
  for (int i = 0; i <= rings; ++i) {
    const double z = kHeight * i / rings;
    for (int j = 0; j < around; ++j) {
      const double angle = kTurn * (j + 0.5 * i) / around;
      mesh.points.emplace_back(radius_at(z) * std::cos(angle),
                               radius_at(z) * std::sin(angle), z);
    }
  }
  for (int i = 0; i < rings; ++i) {
    for (int j = 0; j < around; ++j) {
      add(id(i, j), id(i, j + 1), id(i + 1, j), 0);
      add(id(i, j + 1), id(i + 1, j + 1), id(i + 1, j), 0);
    }
  }
  for (const int i : {0, rings}) {
    const double z = kHeight * i / rings;
    const int center = static_cast<int>(mesh.points.size());
    mesh.points.emplace_back(0.0, 0.0, z);
    NamedRim rim{
        i == 0 ? "low" : "high",
        RimCurve({{EllipseCurve{Vec3(0, 0, z), radius_at(z) * Vec3::UnitX(),
                                radius_at(z) * Vec3::UnitY()},
                   0.0, kTurn}}),
        {}};
    for (int j = 0; j < around; ++j) {
      rim.vertices.push_back(id(i, j));
      if (i == 0) {
        add(center, id(i, j + 1), id(i, j), 1);
      } else {
        add(center, id(i, j), id(i, j + 1), 2);
      }
    }
    result.rims.push_back(std::move(rim));
  }
  return result;
}

FilmSolid solid_of(const Spool& s, int around) {
  return film_solid({.mesh = s.mesh,
                     .rims = s.rims,
                     .caps = {"bottom", "top"},
                     .edge = kTurn * 20.0 / around});
}

/// Farthest that the faces lie from the exact surface of revolution.
double error_of(const Brep& brep) {
  double error = 0.0;
  for (const BrepFace& face : brep.faces) {
    const auto* surface = std::get_if<SplineSurface>(&face.surface);
    for (int k = 0; k < 400 && surface != nullptr; ++k) {
      const Vec3 p = jet_of(*surface, {(k / 20) / 19.0, (k % 20) / 19.0}).point;
      error =
          std::max(error, std::abs(std::hypot(p[0], p[1]) - radius_at(p[2])));
    }
  }
  return error;
}

/// Every edge once each way, loops closed.
void expect_closed(const Brep& brep) {
  std::vector<int> uses(brep.edges.size(), 0);
  for (const BrepFace& face : brep.faces) {
    for (const auto& loop : face.loops) {
      for (std::size_t k = 0; k < loop.size(); ++k) {
        const BrepUse& use = loop[k];
        const BrepUse& next = loop[(k + 1) % loop.size()];
        uses[use.edge] += use.forward ? 1 : 100;
        const BrepEdge& e = brep.edges[use.edge];
        const BrepEdge& f = brep.edges[next.edge];
        EXPECT_EQ(use.forward ? e.to : e.from, next.forward ? f.from : f.to);
      }
    }
  }
  EXPECT_THAT(uses, testing::Each(101));
}

TEST(FilmSolid, TubeBecomesFourPatchesAndTwoDisks) {
  constexpr int kAround = 48;
  const FilmSolid solid = solid_of(spool(kAround), kAround);
  EXPECT_EQ(solid.report.patches, 4);
  EXPECT_EQ(solid.report.planes, 2);
  expect_closed(solid.brep);
  EXPECT_LT(solid.report.gap, 1e-3);
  EXPECT_LT(solid.report.tangent_break, 0.2);
  const double edge = kTurn * 20.0 / kAround;
  EXPECT_LT(solid.report.film_to_solid, 0.1 * edge);
  EXPECT_LT(solid.report.solid_to_film, 0.1 * edge);
}

TEST(FilmSolid, FacesComeToTheSmoothSurfaceFasterThanFacets) {
  // Facets are off by a factor of 4 less at half the edge; the third order of
  // the points between them would be 8.
  constexpr double kLeastRatio = 5.0;
  const double coarse = error_of(solid_of(spool(24), 24).brep);
  const double fine = error_of(solid_of(spool(48), 48).brep);
  EXPECT_LT(fine, 0.02);
  EXPECT_GT(coarse / fine, kLeastRatio);
}

TEST(FilmSolid, IsTheSameTwice) {
  const FilmSolid a = solid_of(spool(24), 24);
  const FilmSolid b = solid_of(spool(24), 24);
  ASSERT_EQ(a.brep.faces.size(), b.brep.faces.size());
  for (std::size_t f = 2; f < a.brep.faces.size(); ++f) {
    EXPECT_EQ(std::get<SplineSurface>(a.brep.faces[f].surface).poles,
              std::get<SplineSurface>(b.brep.faces[f].surface).poles);
  }
}

TEST(FilmSolid, NamesAFilmThatItCannotCut) {
  // A hemisphere has one rim.
  Spool s = spool(24);
  for (int& label : s.mesh.facet_label) {
    label = label == 2 ? 0 : label;
  }
  try {
    solid_of(s, 24);
    FAIL() << "no error";
  } catch (const MeshError& error) {
    EXPECT_THAT(error.what(), testing::HasSubstr("film 'skin'"));
  }
}

TEST(FilmSolid, RefusesABentCap) {
  Spool s = spool(24);
  s.mesh.points.back()[2] += 1.0;  // the middle of the upper end
  EXPECT_THROW(solid_of(s, 24), InvalidInput);
}

TEST(FilmSolid, FacetedHasAFaceForEachFacet) {
  const Spool s = spool(12);
  const Brep brep = faceted_solid(s.mesh);
  EXPECT_EQ(brep.faces.size(), s.mesh.facets.size());
  expect_closed(brep);
}

}  // namespace
}  // namespace meniscus
