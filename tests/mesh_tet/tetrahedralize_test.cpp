#include "mesh_tet/tetrahedralize.h"

#include <gtest/gtest.h>

#include "tests/support/shapes.h"

namespace meniscus {

namespace {

TEST(Tetrahedralize, BoxSphere) {
  for (const auto& s : {shapes::box(Vec3(1, 2, 3), 4), shapes::sphere(1.0, 3),
                        shapes::sphere(1.0, 5)}) {
    const auto r = tetrahedralize(s);
    ASSERT_FALSE(r.failure) << r.failure->message;
    const double edge = mean_edge_length(s);
    printf(
        "%d tets, mean volume / regular %g, dihedral %g %g, re %g aspect %g, "
        "%g s (tetgen %g)\n",
        r.mesh.element_count(),
        enclosed_volume(s) / r.mesh.element_count() /
            (edge * edge * edge / 8.4853),
        r.quality.min_dihedral_deg, r.quality.max_dihedral_deg,
        r.quality.max_radius_edge, r.quality.max_aspect, r.seconds,
        r.tetgen_seconds);
  }
}

}  // namespace

}  // namespace meniscus
