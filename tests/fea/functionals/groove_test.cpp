#include "fea/functionals/groove.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include <gtest/gtest.h>

#include "core/error.h"
#include "tests/support/shapes.h"

namespace meniscus::groove_test {
namespace {

constexpr double kSharpness = 200.0;

class Groove : public testing::TestWithParam<int> {
 protected:
  static TetMesh brick() { return shapes::brick({2.0, 1.0, 1.0}, 4, 2, 2); }
  static TetMesh of_order(const TetMesh& mesh) {
    return GetParam() == 1 ? mesh : shapes::straight_quadratic(mesh);
  }
};

// Its rims are ridges of 90 degrees.
TEST_P(Groove, OfABrickIsMinusARightAngle) {
  const TetMesh mesh = of_order(brick());
  const double value = functionals::groove_functional(mesh, kSharpness).value;
  const double rims = 4.0 * (4.0 + 2.0 + 2.0);  // edges
  EXPECT_NEAR(value, -0.5 * std::numbers::pi + std::log(rims) / kSharpness,
              1e-9);
}

// Two surfaces that meet at x = 1 by a turn of the one in front.
TEST_P(Groove, IsTheTurnWhereTwoSurfacesMeet) {
  constexpr double kEdges = 2.0;
  for (const double slope : {-0.3, 0.1, 0.8}) {
    TetMesh mesh = brick();
    mesh.labels.emplace_back("front");
    const int top = mesh.label_of("z1");
    for (int f = 0; f < mesh.face_count(); ++f) {
      double x = 0.0;
      for (const int n : mesh.face(f).first(3)) {
        x += mesh.nodes[static_cast<std::size_t>(n)].x() / 3.0;
      }
      if (mesh.face_label[static_cast<std::size_t>(f)] == top && x > 1.0) {
        mesh.face_label[static_cast<std::size_t>(f)] =
            static_cast<int>(mesh.labels.size()) - 1;
      }
    }
    for (Vec3& p : mesh.nodes) {
      p.z() += p.x() > 1.0 && p.z() > 0.4 ? slope * (p.x() - 1.0) : 0.0;
    }
    EXPECT_NEAR(
        functionals::groove_functional(of_order(mesh), kSharpness).value,
        std::atan(slope) + std::log(kEdges) / kSharpness, 1e-9)
        << slope;
  }
}

TEST_P(Groove, DerivativesAreThoseOfDifferences) {
  TetMesh mesh = of_order(brick());
  for (Vec3& p : mesh.nodes) {
    p += 0.05 * Vec3(std::sin(3.0 * p.y() + p.z()), std::cos(2.0 * p.x()),
                     std::sin(5.0 * p.x() * p.y()));
  }
  constexpr double kSmooth = 5.0;  // many edges count
  const element::Functional groove =
      functionals::groove_functional(mesh, kSmooth);
  constexpr double kStep = 1e-5;
  for (std::size_t n = 0; n < mesh.nodes.size(); n += 7) {
    for (int k = 0; k < 3; ++k) {
      const auto at = [&](double step) {
        TetMesh moved = mesh;
        moved.nodes[n][k] += step;
        return functionals::groove_functional(moved, kSmooth,
                                              element::Derivatives::None)
            .value;
      };
      EXPECT_NEAR(groove.by_nodes[n][k],
                  (at(kStep) - at(-kStep)) / (2.0 * kStep), 1e-8);
    }
  }
}

TEST_P(Groove, NeedsTwoSurfacesAndASharpness) {
  TetMesh mesh = of_order(brick());
  EXPECT_THROW(functionals::groove_functional(mesh, 0.0), InvalidInput);
  std::fill(mesh.face_label.begin(), mesh.face_label.end(), 0);
  EXPECT_THROW(functionals::groove_functional(mesh, kSharpness), InvalidInput);
}

INSTANTIATE_TEST_SUITE_P(Orders, Groove, testing::Values(1, 2));

}  // namespace
}  // namespace meniscus::groove_test
