#include <omp.h>

#include <Eigen/Geometry>
#include <gtest/gtest.h>

#include "core/error.h"
#include "fea/element/tet_shape.h"
#include "fea/stress/peak_stress.h"
#include "tests/support/parts.h"
#include "tests/support/shapes.h"

namespace meniscus::stress_test {
namespace {

constexpr double kStressRounding = 1e-12;  // closed forms in double

/// u = H x + shift at all nodes.
VectorX linear_field(const TetMesh& mesh, const Mat3& H) {
  VectorX u(3 * static_cast<Eigen::Index>(mesh.nodes.size()));
  for (std::size_t i = 0; i < mesh.nodes.size(); ++i) {
    u.segment<3>(static_cast<Eigen::Index>(3 * i)) =
        H * mesh.nodes[i] + Vec3(1.0, -2.0, 3.0);
  }
  return u;
}

/// Integral of L0^a L1^b L2^c L3^d over a tetrahedron, as a fraction of its
/// volume: 6 a! b! c! d! / (a + b + c + d + 3)!.
double exact_moment(const std::array<int, 4>& powers) {
  double value = 6.0;
  int sum = 3;
  for (const int p : powers) {
    value *= std::tgamma(p + 1.0);
    sum += p;
  }
  return value / std::tgamma(sum + 1.0);
}

TEST(FineRule, IsExactToDegreeFive) {
  for (int a = 0; a <= 5; ++a) {
    for (int b = 0; a + b <= 5; ++b) {
      for (int c = 0; a + b + c <= 5; ++c) {
        const int d = 5 - a - b - c;
        double sum = 0.0;
        for (const auto& [L, weight] : element::fine_tet_rule()) {
          sum += weight * std::pow(L[0], a) * std::pow(L[1], b) *
                 std::pow(L[2], c) * std::pow(L[3], d);
        }
        const double exact = exact_moment({a, b, c, d});
        EXPECT_NEAR(sum, exact, kStressRounding * exact) << a << b << c << d;
      }
    }
  }
}

TEST(Stress, PrincipalStressesAndFrameRebuildTheTensor) {
  const element::Stress s = {3.0, -1.0, 2.0, 0.7, -0.4, 1.1};
  const element::PrincipalFrame frame = element::principal_frame(s);
  EXPECT_GT(frame.stress[0], frame.stress[1]);
  EXPECT_GT(frame.stress[1], frame.stress[2]);
  EXPECT_NEAR(frame.direction.determinant(), 1.0, kStressRounding);
  const Mat3 t =
      frame.direction * frame.stress.asDiagonal() * frame.direction.transpose();
  const std::array<double, 6> back = {t(0, 0), t(1, 1), t(2, 2),
                                      t(0, 1), t(1, 2), t(2, 0)};
  for (int k = 0; k < 6; ++k) {
    EXPECT_NEAR(back[k], s[k], kStressRounding * 3.0);
  }
  EXPECT_NEAR(element::principal_stresses({1.0, 2.0, 3.0, 0.0, 0.0, 0.0})[0],
              3.0, kStressRounding);
}

TEST(Stress, StrainAndEnergyInvertTheMaterialLaw) {
  const element::Material steel = parts::steel();
  const element::Lame m = element::lame(steel);
  Mat3 H;
  H << 1e-3, 4e-4, -2e-4, 3e-4, -7e-4, 5e-4, 1e-4, 6e-4, 2e-4;
  const Mat3 E = 0.5 * (H + H.transpose());
  const element::Strain strain =
      element::strain_of(element::stress_of_gradient(H, m), m);
  const element::Strain exact = {E(0, 0), E(1, 1), E(2, 2),
                                 E(0, 1), E(1, 2), E(2, 0)};
  for (int k = 0; k < 6; ++k) {
    EXPECT_NEAR(strain[k], exact[k], kStressRounding * 1e-3);
  }
  // A pulled bar: s^2 / 2 E.
  EXPECT_NEAR(element::strain_energy_density({50.0, 0, 0, 0, 0, 0}, m),
              2500.0 / (2.0 * steel.youngs_modulus), kStressRounding);
}

class PointStresses : public testing::TestWithParam<int> {};

TEST_P(PointStresses, AreExactForLinearFieldsAndCoverTheVolume) {
  TetMesh mesh = parts::distorted_brick({1.0, 2.0, 1.5}, 3);
  if (GetParam() == 2) {
    mesh = shapes::straight_quadratic(mesh);
  }
  Mat3 H;
  H << 1e-3, 4e-4, -2e-4, 3e-4, -7e-4, 5e-4, 1e-4, 6e-4, 2e-4;
  const element::Material steel = parts::steel();
  const element::PointStress points =
      element::point_stress(mesh, {steel}, linear_field(mesh, H));
  const element::Stress exact =
      element::stress_of_gradient(H, element::lame(steel));
  double volume = 0.0;
  Vec3 moment = Vec3::Zero();
  for (std::size_t q = 0; q < points.stress.size(); ++q) {
    for (int k = 0; k < 6; ++k) {
      EXPECT_NEAR(points.stress[q][k], exact[k], 1e-10 * 210.0);
    }
    volume += points.volume[q];
    moment += points.volume[q] * points.position[q];
  }
  EXPECT_NEAR(volume, 3.0, kStressRounding * 3.0);
  EXPECT_LE((moment / volume - Vec3(0.5, 1.0, 0.75)).norm(), 1e-11);
}

TEST_P(PointStresses, GradientsElsewhereAreThoseOfTheField) {
  Mat3 H;
  H << 0.1, 0.4, -0.2, 0.3, -0.7, 0.5, 0.1, 0.6, 0.2;
  const element::Barycentric L = {0.1, 0.2, 0.3, 0.4};
  std::array<Vec3, 10> x = {Vec3(0, 0, 0), Vec3(1.2, 0.1, 0),
                            Vec3(0.2, 0.9, 0.1), Vec3(0.1, 0.3, 1.1)};
  for (int m = 0; m < 6; ++m) {
    x[4 + m] = 0.5 * (x[kTetEdges[m][0]] + x[kTetEdges[m][1]]);
  }
  x[5] += Vec3(0.05, 0.03, -0.02);  // curved
  std::array<Vec3, 10> u;
  for (int a = 0; a < 10; ++a) {
    u[a] = H * x[a];
  }
  if (GetParam() == 2) {
    EXPECT_LE((element::gradient_at<10>(x, u, L).gradient - H).norm(),
              kStressRounding);
  } else {
    const std::array<Vec3, 4> x4 = {x[0], x[1], x[2], x[3]};
    const std::array<Vec3, 4> u4 = {u[0], u[1], u[2], u[3]};
    EXPECT_LE((element::gradient_at<4>(x4, u4, L).gradient - H).norm(),
              kStressRounding);
  }
}

INSTANTIATE_TEST_SUITE_P(Orders, PointStresses, testing::Values(1, 2));

/// Runs `work` with one and with two threads.
template <class Work>
auto on_one_and_two_threads(const Work& work) {
  const int before = omp_get_max_threads();
  omp_set_num_threads(1);
  auto one = work();
  omp_set_num_threads(2);
  auto two = work();
  omp_set_num_threads(before);
  return std::pair{std::move(one), std::move(two)};
}

TEST(Stress, HasTheSameBitsOnOneAndTwoThreads) {
  const TetMesh mesh =
      shapes::straight_quadratic(parts::distorted_brick({1.0, 2.0, 1.5}, 4));
  VectorX u(3 * static_cast<Eigen::Index>(mesh.nodes.size()));
  for (Eigen::Index k = 0; k < u.size(); ++k) {
    u[k] = std::sin(static_cast<double>(k));
  }
  const auto [one, two] = on_one_and_two_threads(
      [&] { return stress::recover_stress(mesh, {parts::steel()}, u); });
  EXPECT_EQ(one.nodal, two.nodal);
  EXPECT_EQ(one.von_mises, two.von_mises);
}

TEST(Stress, VonMisesOfPullAndShear) {
  EXPECT_DOUBLE_EQ(element::von_mises({3.0, 0.0, 0.0, 0.0, 0.0, 0.0}), 3.0);
  EXPECT_DOUBLE_EQ(element::von_mises({0.0, 0.0, 0.0, 2.0, 0.0, 0.0}),
                   2.0 * std::sqrt(3.0));
  EXPECT_DOUBLE_EQ(element::von_mises({5.0, 5.0, 5.0, 0.0, 0.0, 0.0}), 0.0);
}

TEST(Stress, PeakIsTheLargestNodalValue) {
  const TetMesh mesh =
      shapes::straight_quadratic(shapes::brick({3.0, 1.0, 1.0}, 6, 2, 2));
  const elastic::ElasticModel model(mesh, {parts::steel()},
                                    {parts::pulled({0.0, 0.0, -10.0})});
  const stress::StressField field = stress::recover_stress(
      mesh, {parts::steel()}, model.base_solution().displacements[0]);
  double top = 0.0;
  for (const double s : field.von_mises) {
    top = std::max(top, s);
  }
  EXPECT_EQ(field.max_von_mises, top);
  EXPECT_EQ(field.von_mises[field.max_node], top);
}

TEST(Stress, WrongSizesAreRefused) {
  const TetMesh mesh = shapes::brick({1.0, 1.0, 1.0}, 1, 1, 1);
  EXPECT_THROW(stress::recover_stress(mesh, {parts::steel()}, VectorX::Zero(3)),
               InvalidInput);
  EXPECT_THROW(stress::recover_stress(mesh, {}, VectorX::Zero(24)),
               InvalidInput);
}

}  // namespace
// Plates of so many cells through their thickness, of either order.
TEST(Peak, KnowsWhereOneElementIsAllThereIs) {
  const Vec3 corner(0.0, 0.0, 0.0);
  const Vec3 middle(4.0, 4.0, 0.0);
  for (const int layers : {1, 2, 3}) {
    const TetMesh plate = shapes::brick({8.0, 8.0, 1.0}, 8, 8, layers);
    EXPECT_EQ(stress::one_element_through(plate, middle, 0), layers == 1)
        << layers;
    EXPECT_EQ(stress::one_element_through(plate, corner, 0), layers == 1)
        << layers;
    EXPECT_FALSE(stress::one_element_through(plate, middle, 1))
        << "no such region";
    EXPECT_EQ(stress::one_element_through(shapes::straight_quadratic(plate),
                                          middle, 0),
              layers == 1);
  }
}

}  // namespace meniscus::stress_test
