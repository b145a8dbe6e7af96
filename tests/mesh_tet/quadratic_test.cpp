#include "mesh_tet/quadratic.h"

#include <cmath>
#include <random>

#include <Eigen/LU>
#include <gtest/gtest.h>

#include "core/error.h"
#include "mesh_tet/jacobian.h"
#include "mesh_tet/tetrahedralize.h"
#include "tests/support/shapes.h"

namespace meniscus::quadratic_test {

namespace {

constexpr double kQuadraticRounding = 1e-13;

QuadraticSurface on_sphere(const SurfaceMesh& base, double radius) {
  QuadraticSurface surface;
  surface.base = base;
  list_edges(base.facets, surface.edges, surface.facet_edges);
  for (const Edge& e : surface.edges) {
    surface.mid.push_back(radius *
                          (base.points[e[0]] + base.points[e[1]]).normalized());
  }
  return surface;
}

double quadratic_volume(const TetMesh& mesh) {
  double volume = 0.0;
  for (int e = 0; e < mesh.element_count(); ++e) {
    std::array<Vec3, 10> x;
    for (int n = 0; n < 10; ++n) {
      x[n] = mesh.nodes[mesh.element(e)[n]];
    }
    volume += mesh_tet::mean_determinant(mesh_tet::corner_jacobians(x)) / 6.0;
  }
  return volume;
}

struct Ball {
  QuadraticSurface surface;
  TetMesh linear;
};

Ball make_ball(int levels) {
  const SurfaceMesh base = shapes::sphere(1.0, levels);
  auto result = mesh_tet::tetrahedralize(base);
  EXPECT_FALSE(result.failure);
  return {on_sphere(base, 1.0), std::move(result.mesh)};
}

TEST(Quadratic, StraightSidesHaveConstantJacobian) {
  const TetMesh linear =
      shapes::sheared(shapes::brick(Vec3(1, 2, 3), 2, 2, 2), 0.3);
  const TetMesh mesh = shapes::straight_quadratic(linear);
  double volume = 0.0;
  for (int e = 0; e < mesh.element_count(); ++e) {
    EXPECT_EQ(mesh_tet::jacobian_ratio(mesh, e), 1.0);
    volume += corner_volume(linear, e);
  }
  EXPECT_NEAR(quadratic_volume(mesh), volume,
              kQuadraticRounding * volume * 100);
  EXPECT_EQ(mesh_tet::find_inverted(mesh), -1);
  EXPECT_EQ(mesh_tet::find_inverted(linear), -1);
}

TEST(Quadratic, CurvedBallHasItsVolumeAtFourthOrder) {
  const double exact = 4.0 / 3.0 * M_PI;
  std::array<double, 3> error{};
  for (int level = 0; level < 3; ++level) {
    const Ball ball = make_ball(level + 1);
    int straightened = -1;
    const TetMesh mesh = mesh_tet::make_quadratic(ball.linear, ball.surface,
                                                  nullptr, &straightened);
    EXPECT_EQ(mesh_tet::find_inverted(mesh), -1);
    EXPECT_EQ(straightened, 0);
    error[level] = std::abs(quadratic_volume(mesh) - exact);
  }
  for (int level = 1; level < 3; ++level) {
    EXPECT_GT(std::log2(error[level - 1] / error[level]), 3.5);
  }
}

TEST(Quadratic, FacesAndNodesFollowTheSurface) {
  const Ball ball = make_ball(2);
  std::vector<char> curve;
  const TetMesh mesh =
      mesh_tet::make_quadratic(ball.linear, ball.surface, &curve);
  ASSERT_EQ(curve.size(), ball.surface.edges.size());
  for (std::size_t i = 0; i < curve.size(); ++i) {
    EXPECT_EQ(curve[i], 1);
    EXPECT_EQ(mesh.nodes[mesh.corner_count + i], ball.surface.mid[i]);
  }
  for (int f = 0; f < mesh.face_count(); ++f) {
    const auto ids = mesh.face(f);
    for (int k = 0; k < 3; ++k) {
      EXPECT_EQ(ids[k], ball.surface.base.facets[f][k]);
      EXPECT_EQ(ids[3 + k], mesh.corner_count + ball.surface.facet_edges[f][k]);
    }
  }
  TetMesh moved = mesh;
  mesh_tet::move_quadratic(moved, ball.linear.nodes, ball.surface, curve);
  EXPECT_EQ(moved.nodes, mesh.nodes);
}

TEST(Quadratic, PoorElementsAreStraightenedAndStayChosen) {
  Ball ball = make_ball(2);
  Vec3& mid = ball.surface.mid[17];
  mid *= 0.2;
  std::vector<char> curve;
  int straightened = 0;
  const TetMesh mesh = mesh_tet::make_quadratic(ball.linear, ball.surface,
                                                &curve, &straightened);
  EXPECT_GT(straightened, 0);
  EXPECT_EQ(curve[17], 0);
  EXPECT_EQ(std::count(curve.begin(), curve.end(), 0), straightened);
  for (int e = 0; e < mesh.element_count(); ++e) {
    EXPECT_GT(mesh_tet::jacobian_ratio(mesh, e),
              mesh_tet::kLeastCurvedJacobian - 0.01);
  }
  const std::vector<char> chosen = curve;
  const TetMesh again =
      mesh_tet::make_quadratic(ball.linear, ball.surface, &curve);
  EXPECT_EQ(curve, chosen);
  EXPECT_EQ(again.nodes, mesh.nodes);
  std::vector<char> all(curve.size(), 1);
  const TetMesh bad = mesh_tet::make_quadratic(ball.linear, ball.surface, &all);
  const int inverted = mesh_tet::find_inverted(bad);
  ASSERT_GE(inverted, 0);
  EXPECT_LT(mesh_tet::jacobian_ratio(bad, inverted), 0.01);
}

TEST(Quadratic, TransposeMatchesTheMap) {
  const Ball ball = make_ball(1);
  std::vector<char> curve(ball.surface.edges.size(), 1);
  curve[3] = curve[8] = 0;
  TetMesh mesh = mesh_tet::make_quadratic(ball.linear, ball.surface, &curve);
  std::mt19937 random(3);
  std::uniform_real_distribution<double> uniform(-1.0, 1.0);
  const auto draw = [&](std::size_t count) {
    Points points(count);
    for (Vec3& p : points) {
      p = Vec3(uniform(random), uniform(random), uniform(random));
    }
    return points;
  };
  const Points corners = draw(ball.linear.nodes.size());
  const Points weights = draw(mesh.nodes.size());
  QuadraticSurface moved = ball.surface;
  moved.mid = draw(moved.mid.size());
  mesh_tet::move_quadratic(mesh, corners, moved, curve);
  const auto back = mesh_tet::transpose_quadratic(mesh, weights, curve);
  const double forward = flat(weights).dot(flat(mesh.nodes));
  const double backward = flat(back.corners).dot(flat(corners)) +
                          flat(back.mid).dot(flat(moved.mid));
  EXPECT_NEAR(
      forward, backward,
      kQuadraticRounding * flat(weights).norm() * flat(mesh.nodes).norm());
}

TEST(Jacobian, BoundAgreesWithDenseSampling) {
  std::mt19937 random(5);
  std::uniform_real_distribution<double> uniform(-0.35, 0.35);
  const TetMesh unit =
      shapes::straight_quadratic(shapes::brick(Vec3::Ones(), 1, 1, 1));
  int positive = 0;
  for (int trial = 0; trial < 300; ++trial) {
    std::array<Vec3, 10> x;
    for (int n = 0; n < 10; ++n) {
      x[n] = unit.nodes[unit.element(0)[n]];
      if (n > 3) {
        x[n] += Vec3(uniform(random), uniform(random), uniform(random)) *
                (trial % 10) / 10.0;
      }
    }
    const mesh_tet::CornerJacobians jacobians = mesh_tet::corner_jacobians(x);
    double least = 1e300;
    constexpr int kSteps = 10;
    for (int i = 0; i <= kSteps; ++i) {
      for (int j = 0; i + j <= kSteps; ++j) {
        for (int k = 0; i + j + k <= kSteps; ++k) {
          const Mat3 at =
              (i * jacobians[0] + j * jacobians[1] + k * jacobians[2] +
               (kSteps - i - j - k) * jacobians[3]) /
              kSteps;
          least = std::min(least, at.determinant());
        }
      }
    }
    const bool above = mesh_tet::determinant_above(jacobians, 0.0);
    positive += above ? 1 : 0;
    if (above) {
      EXPECT_GT(least, 0.0);
    } else {
      // Halving thrice leaves a doubt of a few percent of the mean.
      EXPECT_LT(least, 0.1 * mesh_tet::mean_determinant(jacobians));
    }
  }
  EXPECT_GT(positive, 30);
  EXPECT_LT(positive, 300);
}

TEST(Quadratic, RefusesWhatDoesNotFit) {
  const Ball ball = make_ball(1);
  const QuadraticSurface other = on_sphere(shapes::sphere(1.0, 0), 1.0);
  EXPECT_THROW(mesh_tet::make_quadratic(ball.linear, other), MeshError);
  std::vector<char> few(3, 1);
  EXPECT_THROW(mesh_tet::make_quadratic(ball.linear, ball.surface, &few),
               MeshError);
  const TetMesh mesh = mesh_tet::make_quadratic(ball.linear, ball.surface);
  EXPECT_THROW(mesh_tet::make_quadratic(mesh, ball.surface), MeshError);
}

}  // namespace

}  // namespace meniscus::quadratic_test
