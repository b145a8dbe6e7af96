#include "evolve/frozen/carry.h"

#include <cmath>

#include <gtest/gtest.h>

#include "tests/support/film_shapes.h"

namespace meniscus::carry_test {
namespace {

constexpr double kRounding = 1e-12;  // of coordinates of order 1, after a solve

struct Tube {
  films::FilmComplex complex;
  frozen::Carry carry;

  Tube()
      : complex(make()),
        carry(complex, {}, energy::FilmEnergy(complex).vertex_order()) {}

  static films::FilmComplex make() {
    films::FilmComplex complex =
        shapes::tube(1.0, 2.0, 16, 8, [](double) { return 1.0; });
    shapes::close_tube(complex, 16);
    for (std::size_t v = 0; v < complex.vertices.size(); ++v) {
      if (complex.vertices[v].kind == films::VertexKind::OnCurve) {
        complex.mesh.points[v] =
            curves::point_at(complex.curves[complex.vertices[v].curve].shape,
                             complex.vertices[v].t);
      }
    }
    return complex;
  }

  Points at(const Vec3& top_center, const Vec3& top_normal,
            double top_radius) const {
    std::vector<curves::Curve> curves = complex.curves;
    curves[1].shape = curves::Circle{top_center, top_normal, top_radius};
    return carry.at(carry.rim_moves(curves), 1.0);
  }
};

TEST(Carry, NoMoveGivesTheReferenceBitForBit) {
  const Tube tube;
  EXPECT_TRUE(tube.at(Vec3(0, 0, 1), Vec3::UnitZ(), 1.0) ==
              tube.complex.mesh.points);
}

TEST(Carry, MovingEveryCurveAlikeMovesEveryVertexSo) {
  const Tube tube;
  std::vector<curves::Curve> curves = tube.complex.curves;
  const Vec3 shift(0.3, -0.2, 0.7);
  for (curves::Curve& curve : curves) {
    std::get<curves::Circle>(curve.shape).center += shift;
  }
  const Points moved = tube.carry.at(tube.carry.rim_moves(curves), 1.0);
  for (std::size_t v = 0; v < moved.size(); ++v) {
    EXPECT_LT((moved[v] - tube.complex.mesh.points[v] - shift).norm(),
              kRounding);
  }
}

// Positive weights that sum to one: no vertex moves further than the rims.
TEST(Carry, FilmMovesBetweenTheRims) {
  const Tube tube;
  const Points moved = tube.at(Vec3(0.5, 0, 1), Vec3::UnitZ(), 1.0);
  for (std::size_t v = 0; v < moved.size(); ++v) {
    const Vec3 move = moved[v] - tube.complex.mesh.points[v];
    EXPECT_GE(move.x(), -kRounding);
    EXPECT_LE(move.x(), 0.5 + kRounding);
    EXPECT_LT(std::abs(move.y()) + std::abs(move.z()), kRounding);
  }
}

TEST(Carry, CapsStayFlatWhenTheirRimTurnsAndGrows) {
  const Tube tube;
  const Vec3 center(0.4, 0.1, 1.3);
  const Vec3 normal = Vec3(0.3, -0.2, 1.0).normalized();
  const Points moved = tube.at(center, normal, 1.4);
  for (std::size_t f = 0; f < tube.complex.mesh.facets.size(); ++f) {
    if (tube.complex.mesh.facet_label[f] == 2) {
      for (const int v : tube.complex.mesh.facets[f]) {
        EXPECT_LT(std::abs((moved[v] - center).dot(normal)), kRounding);
      }
    }
  }
}

}  // namespace
}  // namespace meniscus::carry_test
