#include "evolve/groom/refine.h"

#include <gtest/gtest.h>

#include "core/error.h"
#include "evolve/films/body_sides.h"
#include "evolve/groom/remesh.h"
#include "evolve/start/start_complex.h"
#include "tests/support/check_complex.h"
#include "tests/support/systems.h"

namespace meniscus::refine_test {
namespace {

TEST(Refine, KeepsOldVerticesAndPutsNewOnesInTheMiddle) {
  for (const films::FilmSystem& system :
       {systems::bulkhead(), systems::strut(), systems::catenoid()}) {
    films::FilmComplex coarse = start::build_start(system, 0.4);
    groom::remesh_films(coarse, {.edge = 0.4});
    const groom::Refinement fine = groom::refine(coarse);
    test_films::check_complex(fine.complex);
    const std::size_t old = coarse.mesh.points.size();
    ASSERT_EQ(fine.complex.mesh.points.size(), old + fine.parents.size());
    EXPECT_EQ(fine.complex.mesh.facets.size(), 4 * coarse.mesh.facets.size());
    EXPECT_EQ(systems::euler_characteristic(fine.complex.mesh),
              systems::euler_characteristic(coarse.mesh));
    for (std::size_t v = 0; v < old; ++v) {
      EXPECT_EQ(fine.complex.mesh.points[v], coarse.mesh.points[v]);
      EXPECT_EQ(fine.complex.vertices[v].kind, coarse.vertices[v].kind);
    }
    for (std::size_t e = 0; e < fine.parents.size(); ++e) {
      const auto [a, b] = fine.parents[e];
      const Vec3 middle = 0.5 * (coarse.mesh.points[a] + coarse.mesh.points[b]);
      const films::ComplexVertex& made = fine.complex.vertices[old + e];
      const Vec3& p = fine.complex.mesh.points[old + e];
      if (made.kind == films::VertexKind::OnCurve) {
        // The middle of an arc, near the chord's.
        const double chord =
            (coarse.mesh.points[a] - coarse.mesh.points[b]).norm();
        EXPECT_LT((p - middle).norm(), 0.2 * chord);
        EXPECT_NEAR((p - coarse.mesh.points[a]).norm(),
                    (p - coarse.mesh.points[b]).norm(), 1e-12);
      } else {
        EXPECT_EQ(p, middle);
      }
    }
  }
}

TEST(Refine, DoublesEveryRim) {
  const films::FilmComplex coarse = start::build_start(systems::bracket(), 8.0);
  const films::FilmComplex fine = groom::refine(coarse).complex;
  const auto on_curve = [](const films::FilmComplex& c, int curve) {
    return std::count_if(c.vertices.begin(), c.vertices.end(),
                         [&](const films::ComplexVertex& v) {
                           return v.kind == films::VertexKind::OnCurve &&
                                  v.curve == curve;
                         });
  };
  for (int curve = 0; curve < 3; ++curve) {
    EXPECT_EQ(on_curve(fine, curve), 2 * on_curve(coarse, curve));
  }
}

TEST(Refine, ApproachesTheCircleAtSecondOrder) {
  films::FilmComplex complex = start::build_start(systems::cylinder(2.0), 0.4);
  double last = 0.0;
  for (int level = 0; level < 3; ++level) {
    const int top = complex.mesh.label_of("top");
    const double error =
        std::abs(surface_area(complex.mesh, top) - 3.14159265358979);
    if (level > 0) {
      EXPECT_NEAR(last / error, 4.0, 0.1);
    }
    last = error;
    complex = groom::refine(complex).complex;
  }
}

TEST(CheckComplex, NamesWhatIsBroken) {
  const films::FilmComplex sound =
      start::build_start(systems::cylinder(2.0), 0.4);
  test_films::check_complex(sound);
  films::FilmComplex broken = sound;
  broken.vertices.pop_back();
  EXPECT_THROW(test_films::check_complex(broken), MeshError);
  broken = sound;
  broken.mesh.points[0] += Vec3(0.1, 0, 0);
  EXPECT_THROW(test_films::check_complex(broken), MeshError);
  broken = sound;
  broken.mesh.facets.pop_back();
  broken.mesh.facet_label.pop_back();
  EXPECT_THROW(test_films::check_complex(broken), MeshError);
  broken = sound;
  std::swap(broken.mesh.facets[5][0], broken.mesh.facets[5][1]);
  EXPECT_THROW(test_films::check_complex(broken), MeshError);
  broken = sound;
  broken.bodies[0].sides[0].sign = -1;
  EXPECT_THROW(test_films::check_complex(broken), MeshError);
  broken = sound;
  broken.surfaces[1].name = "else";
  EXPECT_THROW(test_films::check_complex(broken), MeshError);
  broken = sound;
  broken.mesh.facets[0][0] = 100000;
  EXPECT_THROW(test_films::check_complex(broken), MeshError);
  broken = sound;
  broken.vertices.back().kind = films::VertexKind::Free;
  EXPECT_THROW(test_films::check_complex(broken), MeshError);
}

}  // namespace
}  // namespace meniscus::refine_test
