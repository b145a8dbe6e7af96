#include "mesh_tet/mesh_motion.h"

#include <cmath>
#include <random>

#include <gtest/gtest.h>

#include "core/error.h"
#include "mesh_tet/tetrahedralize.h"
#include "tests/support/shapes.h"

namespace meniscus::mesh_motion_test {

namespace {

// A direct solve of a well conditioned system, relative to the motion.
constexpr double kSolve = 1e-12;

struct Part {
  SurfaceMesh surface;
  TetMesh mesh;
  int points = 0;
};

/// Two arms, 300 long, on a foot: the proportions of the bracket.
Part make_part() {
  Part part;
  part.surface = shapes::sphere(1.0, 3);
  for (Vec3& p : part.surface.points) {
    const double arm = 0.8 + 0.4 * p.x() * p.x();
    p = Vec3(150 * p.x(), 80 * arm * p.y(),
             70 * arm * p.z() + 50 * p.x() * p.x());
  }
  auto result = mesh_tet::tetrahedralize(part.surface);
  EXPECT_FALSE(result.failure) << result.failure->message;
  part.mesh = std::move(result.mesh);
  part.points = static_cast<int>(part.surface.points.size());
  return part;
}

Points random_points(std::size_t count, unsigned seed) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> uniform(-1.0, 1.0);
  Points points(count);
  for (Vec3& p : points) {
    p = Vec3(uniform(random), uniform(random), uniform(random));
  }
  return points;
}

TEST(MeshMotion, ReferenceStaysBitForBit) {
  const Part part = make_part();
  const mesh_tet::MeshMotion motion(part.mesh, part.points);
  EXPECT_EQ(motion.move(part.surface.points), part.mesh.nodes);
}

TEST(MeshMotion, TranslationIsExact) {
  const Part part = make_part();
  const mesh_tet::MeshMotion motion(part.mesh, part.points);
  const Vec3 shift(10, -20, 30);
  Points surface = part.surface.points;
  for (Vec3& p : surface) {
    p += shift;
  }
  const Points nodes = motion.move(surface);
  for (std::size_t n = 0; n < nodes.size(); ++n) {
    EXPECT_LT((nodes[n] - part.mesh.nodes[n] - shift).norm(),
              kSolve * part.mesh.nodes.size());
  }
}

TEST(MeshMotion, IsLinearAndTransposed) {
  const Part part = make_part();
  const mesh_tet::MeshMotion motion(part.mesh, part.points);
  const Points u = random_points(part.surface.points.size(), 1);
  const Points g = random_points(part.mesh.nodes.size(), 2);
  const auto moved = [&](double factor) {
    Points surface = part.surface.points;
    for (std::size_t n = 0; n < surface.size(); ++n) {
      surface[n] += factor * u[n];
    }
    Points nodes = motion.move(surface);
    flat(nodes) -= flat(part.mesh.nodes);
    return nodes;
  };
  const Points once = moved(1.0);
  const Points thrice = moved(3.0);
  EXPECT_LT((3.0 * flat(once) - flat(thrice)).norm(),
            kSolve * flat(thrice).norm() * 10.0);
  const double forward = flat(g).dot(flat(once));
  const double backward = flat(motion.transpose(g)).dot(flat(u));
  EXPECT_NEAR(forward, backward, kSolve * flat(g).norm() * flat(once).norm());
}

TEST(MeshMotion, FootMovesFarWithoutInversion) {
  const Part part = make_part();
  const mesh_tet::MeshMotion motion(part.mesh, part.points);
  const double before = mesh_tet::tet_quality(part.mesh).min_dihedral_deg;
  for (const Vec3& shift :
       {Vec3(40, 0, 0), Vec3(-40, 0, 0), Vec3(0, 40, 0), Vec3(0, 0, -40)}) {
    Points surface = part.surface.points;
    for (Vec3& p : surface) {
      p += std::exp(-std::pow(p.x() / 80.0, 2)) * shift;
    }
    TetMesh moved = part.mesh;
    moved.nodes = motion.move(surface);
    for (int e = 0; e < moved.element_count(); ++e) {
      ASSERT_GT(corner_volume(moved, e), 0.0) << shift.transpose();
    }
    EXPECT_GT(mesh_tet::tet_quality(moved).min_dihedral_deg, 0.3 * before);
  }
}

TEST(MeshMotion, MeshWithoutInnerNodes) {
  const TetMesh brick = shapes::brick(Vec3::Ones(), 1, 1, 1);
  const mesh_tet::MeshMotion motion(brick, 8);
  Points surface = brick.nodes;
  surface[3] *= 2.0;
  EXPECT_EQ(motion.move(surface), surface);
  EXPECT_EQ(motion.transpose(surface), surface);
}

TEST(MeshMotion, RefusesWhatDoesNotFit) {
  const TetMesh brick = shapes::brick(Vec3::Ones(), 1, 1, 1);
  const mesh_tet::MeshMotion motion(brick, 8);
  EXPECT_THROW(motion.move(Points(7)), MeshError);
  EXPECT_THROW(motion.transpose(Points(9)), MeshError);
  EXPECT_THROW(mesh_tet::MeshMotion(brick, 9), MeshError);
  TetMesh flat_brick = brick;
  for (Vec3& p : flat_brick.nodes) {
    p.z() = 0.0;
  }
  EXPECT_THROW(mesh_tet::MeshMotion(flat_brick, 4), MeshError);
}

}  // namespace

}  // namespace meniscus::mesh_motion_test
