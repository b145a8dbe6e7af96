// Films as meshes: folds beside corners of rims flipped away.
#include "cad/solid/film_mesh.h"

#include <random>

#include <Eigen/Geometry>
#include <gtest/gtest.h>

#include "tests/support/sheet_shapes.h"

namespace meniscus::film_mesh_test {
namespace {

solid::FilmMesh film_of(const SurfaceMesh& mesh) {
  return {mesh.points, {}, mesh.facets, {}};
}

double least_height(const solid::FilmMesh& mesh) {
  double least = 1.0;
  for (const Triangle& t : mesh.facets) {
    const Vec3 area = (mesh.points[t[1]] - mesh.points[t[0]])
                          .cross(mesh.points[t[2]] - mesh.points[t[0]]);
    least = std::min(least, area.normalized().z());
  }
  return least;
}

// A vertex of a flat film pushed over an edge that faces it turns one facet
// over, and only other edges can mend that.
TEST(FilmMesh, FoldsAreFlippedAway) {
  std::mt19937 random(5);
  std::uniform_real_distribution<double> part(0.0, 1.0);
  int folded = 0;
  for (int k = 0; k < 30; ++k) {
    const SurfaceMesh flat = shapes::patch(
        [](double u, double v) { return Vec3(u, v, 0.02 * u * v); },
        {.rows = 6, .columns = 6, .jitter = 0.0});
    solid::FilmMesh mesh = film_of(flat);
    const int i = 2 + static_cast<int>(3.0 * part(random));
    const int j = 2 + static_cast<int>(3.0 * part(random));
    const double way = 0.55 + 0.2 * part(random);  // of a cell's diagonal
    mesh.points[j * 7 + i] += way / 6.0 * Vec3(1, k % 2 == 0 ? 1 : -1, 0);
    const bool is_folded = least_height(mesh) < 0.0;
    folded += is_folded ? 1 : 0;
    const std::vector<Triangle> before = mesh.facets;
    solid::flip_folds(mesh);
    EXPECT_GT(least_height(mesh), 0.0) << k;
    EXPECT_EQ(mesh.facets != before, is_folded) << k;
    // The outline stays, and so does the number of facets.
    EXPECT_EQ(solid::boundary_loops(mesh.facets, mesh.points),
              solid::boundary_loops(before, mesh.points));
  }
  EXPECT_GT(folded, 5);
}

TEST(FilmMesh, CornersOfAFilmStay) {
  const SurfaceMesh bent = shapes::patch(
      [](double u, double v) {
        return u < 0.5 ? Vec3(u, v, 0.0) : Vec3(0.5, v, 0.5 - u);
      },
      {.rows = 6, .columns = 6, .jitter = 0.0});
  solid::FilmMesh mesh = film_of(bent);
  solid::flip_folds(mesh);
  EXPECT_EQ(mesh.facets, bent.facets);
}

}  // namespace
}  // namespace meniscus::film_mesh_test
