// The whole of a part that is drawn as its quarter.
#include "pipeline/whole/whole_part.h"

#include <algorithm>
#include <cmath>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/geometry/mesh_checks.h"
#include "pipeline/forward/worst_cases.h"
#include "tests/support/case_text.h"

namespace meniscus::whole_part_test {
namespace {

using testing::IsEmpty;

constexpr double kRounding = 1e-9;

/// A quarter of a wheel without spokes: two films from a block to planes.
std::string quarter() {
  return R"toml(title = "A quarter"
units = "mm-N-MPa"

[symmetry]
planes = [
  { at = [0, 0, 0], normal = [1, 0, 0] },
  { at = [0, 0, 0], normal = [0, 1, 0] },
]

[curves.middle_x]
kind = "circle"
center = [0, -22, 0]
normal = [1, 0, 0]
radius = 8

[curves.middle_y]
kind = "circle"
center = [-22, 0, 0]
normal = [0, 1, 0]
radius = 8

[solids.block]
kind = "block"
at = [-22, -22, 0]
size = [20, 20, 16]
open = ["right", "back"]

[films.along_x]
kind = "loft"
curves = ["block/right", "middle_x"]

[films.along_y]
kind = "loft"
curves = ["block/back", "middle_y"]

[bodies.part]
enclosed_by = ["along_x", "along_y", "block"]
volume = 13250
material = "aluminium"

[resolution]
fea = 8
film = 8

[materials.aluminium]
youngs_modulus = 71700.0
poisson_ratio = 0.33
density = 2.8e-9

[load_cases.pressed]
supports = [{ on = "block/bottom", fix = "xyz" }]
loads = [{ on = "along_x", traction = [1, 0, -2] }]

[responses.volume]
kind = "volume"

[analysis]
buckling = 0
)toml";
}

struct Solved {
  case_data::Case input = case_of(quarter());
  forward::EvaluationFields drawn;
  forward::EvaluationFields whole;
  double volume = 0.0;

  Solved() {
    const forward::ForwardModel model(input);
    const VectorX design(0);
    const forward::Evaluation at = model.evaluate(design, &drawn);
    EXPECT_FALSE(at.failure) << at.failure->message;
    volume = at.responses[0];
    forward::find_stresses(input, drawn);
    whole = whole::whole_part(input, drawn).value();
  }
};

const Solved& solved() {
  static const Solved result;
  return result;
}

TEST(WholePart, IsClosedAndFourTimesAsLarge) {
  const forward::EvaluationFields& whole = solved().whole;
  EXPECT_THAT(check_surface(whole.boundary), IsEmpty());
  EXPECT_NEAR(enclosed_volume(whole.boundary),
              4.0 * enclosed_volume(solved().drawn.boundary), 1e-6);
  const SurfaceMesh same =
      whole::whole_surface(solved().input, solved().drawn.boundary);
  EXPECT_EQ(same.facets, whole.boundary.facets);
  const TetMesh& mesh = whole.mesh;
  EXPECT_EQ(mesh.element_count(), 4 * solved().drawn.mesh.element_count());
  double volume = 0.0;
  for (int e = 0; e < mesh.element_count(); ++e) {
    const double one = corner_volume(mesh, e);
    EXPECT_GT(one, 0.0);
    volume += one;
  }
  EXPECT_NEAR(volume / solved().volume, 1.0, 0.01);  // the sides are curved
  EXPECT_EQ(mesh.label_of("along_x/image") >= 0, true);
  for (const int label : mesh.face_label) {
    EXPECT_EQ(mesh.labels[label].find("symmetry"), std::string::npos);
  }
}

/// The node at a place; -1: none.
int node_at(const TetMesh& mesh, const Vec3& place) {
  const auto at = std::find_if(
      mesh.nodes.begin(), mesh.nodes.end(),
      [&](const Vec3& p) { return (p - place).norm() < kRounding; });
  return at == mesh.nodes.end() ? -1
                                : static_cast<int>(at - mesh.nodes.begin());
}

TEST(WholePart, MovesAndIsStressedAsItsImages) {
  const forward::EvaluationFields& whole = solved().whole;
  const TetMesh& mesh = whole.mesh;
  const VectorX& u = whole.solution.displacements[0];
  const stress::StressField stress =
      stress::nodal_stress(mesh, whole.stresses[0].recovered);
  const stress::StressField drawn = stress::nodal_stress(
      solved().drawn.mesh, solved().drawn.stresses[0].recovered);
  EXPECT_NEAR(
      *std::max_element(stress.von_mises.begin(), stress.von_mises.end()),
      *std::max_element(drawn.von_mises.begin(), drawn.von_mises.end()), 1e-9);
  EXPECT_GT(u.lpNorm<Eigen::Infinity>(), 0.0);
  for (std::size_t n = 0; n < mesh.nodes.size(); n += 37) {
    const Vec3 p = mesh.nodes[n];
    const int other = node_at(mesh, Vec3(-p.x(), p.y(), p.z()));
    ASSERT_GE(other, 0) << p.transpose();
    const Vec3 here = u.segment<3>(3 * static_cast<Eigen::Index>(n));
    const Vec3 there = u.segment<3>(3 * other);
    EXPECT_NEAR(here.x(), -there.x(), 1e-12);
    EXPECT_NEAR(here.y(), there.y(), 1e-12);
    EXPECT_NEAR(here.z(), there.z(), 1e-12);
    EXPECT_NEAR(stress.nodal[n][0], stress.nodal[other][0], kRounding);
    EXPECT_NEAR(stress.nodal[n][3], -stress.nodal[other][3], kRounding);
    EXPECT_NEAR(stress.nodal[n][4], stress.nodal[other][4], kRounding);
    EXPECT_NEAR(stress.nodal[n][5], -stress.nodal[other][5], kRounding);
  }
}

// Recovered from one side, it is not 0 there.
TEST(WholePart, HasNoShearAcrossItsPlanes) {
  const TetMesh& mesh = solved().whole.mesh;
  const stress::StressField stress =
      stress::nodal_stress(mesh, solved().whole.stresses[0].recovered);
  const double most =
      *std::max_element(stress.von_mises.begin(), stress.von_mises.end());
  int in_planes = 0;
  for (std::size_t n = 0; n < mesh.nodes.size(); ++n) {
    const element::Stress& s = stress.nodal[n];  // xx yy zz xy yz zx
    const Vec3& p = mesh.nodes[n];
    if (std::abs(p.x()) < kRounding) {
      ++in_planes;
      EXPECT_NEAR(s[3] / most, 0.0, kRounding) << p.transpose();
      EXPECT_NEAR(s[5] / most, 0.0, kRounding) << p.transpose();
    }
    if (std::abs(p.y()) < kRounding) {
      ++in_planes;
      EXPECT_NEAR(s[3] / most, 0.0, kRounding) << p.transpose();
      EXPECT_NEAR(s[4] / most, 0.0, kRounding) << p.transpose();
    }
  }
  EXPECT_GT(in_planes, 100);
}

Vec3 sum_of(const VectorX& forces) {
  Vec3 sum = Vec3::Zero();
  for (Eigen::Index n = 0; n < forces.size(); n += 3) {
    sum += forces.segment<3>(n);
  }
  return sum;
}

TEST(WholePart, IsHeldByTheForcesOfAllParts) {
  const Vec3 drawn = sum_of(solved().drawn.solution.reactions[0]);
  const Vec3 whole = sum_of(solved().whole.solution.reactions[0]);
  EXPECT_GT(drawn.z(), 0.0);
  EXPECT_NEAR(whole.z(), 4.0 * drawn.z(), kRounding * drawn.z());
  EXPECT_NEAR(whole.x(), 0.0, kRounding * drawn.z());
  EXPECT_NEAR(whole.y(), 0.0, kRounding * drawn.z());
}

}  // namespace
}  // namespace meniscus::whole_part_test
