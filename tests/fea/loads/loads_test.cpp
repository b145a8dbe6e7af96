#include <algorithm>
#include <cmath>

#include <Eigen/Geometry>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/error.h"
#include "core/math/expression.h"
#include "fea/loads/face_pressures.h"
#include "tests/support/parts.h"

namespace meniscus::loads_test {
namespace {

constexpr double kLoadRounding = 1e-12;
constexpr double kEndEffect = 1e-4;
constexpr double kPi = 3.14159265358979323846;

Vec3 total_force(const VectorX& f) {
  Vec3 sum = Vec3::Zero();
  for (Eigen::Index d = 0; d < f.size(); d += 3) {
    sum += f.segment<3>(d);
  }
  return sum;
}

TEST(Loads, WeightsSumToTheAreaAndVanishAtCornersOfFlatQuadraticFaces) {
  const TetMesh mesh =
      shapes::straight_quadratic(shapes::brick({2.0, 3.0, 4.0}, 2, 3, 2));
  const loads::SurfaceWeights w = loads::surface_weights(mesh, "x1");
  EXPECT_NEAR(w.weights.sum(), 12.0, kLoadRounding * 12.0);
  for (std::size_t k = 0; k < w.nodes.size(); ++k) {
    if (w.nodes[k] < mesh.corner_count) {
      EXPECT_NEAR(w.weights[static_cast<Eigen::Index>(k)], 0.0, kLoadRounding);
    }
  }
}

TEST(Loads, ForceIsSpreadToItsTotal) {
  const TetMesh mesh =
      shapes::straight_quadratic(shapes::brick({2.0, 3.0, 4.0}, 2, 2, 2));
  const Vec3 force(3.0, -5.0, 7.0);
  const VectorX f = loads::nodal_forces(mesh, parts::pulled(force));
  EXPECT_LE((total_force(f) - force).norm(), kLoadRounding * force.norm());
}

TEST(Loads, PressurePushesIntoTheSolidAndBalancesAllRound) {
  const TetMesh mesh =
      shapes::straight_quadratic(shapes::brick({2.0, 3.0, 4.0}, 2, 2, 2));
  loads::LoadCase one;
  one.pressures = {{"x1", 2.0}};
  EXPECT_LE(
      (total_force(loads::nodal_forces(mesh, one)) - Vec3(-24.0, 0.0, 0.0))
          .norm(),
      kLoadRounding * 24.0);
  loads::LoadCase all;
  for (const std::string& name : mesh.labels) {
    all.pressures.push_back({name, 2.0});
  }
  EXPECT_LE(total_force(loads::nodal_forces(mesh, all)).norm(),
            kLoadRounding * 24.0);
}

TEST(Loads, CurvedAreaAndVolumeConverge) {
  double area_error[2];
  double volume_error[2];
  for (int k = 0; k < 2; ++k) {
    const TetMesh mesh = parts::quarter_tube(k == 0 ? 2 : 4, 1.0);
    area_error[k] =
        std::abs(loads::surface_weights(mesh, "x0").weights.sum() - 0.5 * kPi);
    volume_error[k] = std::abs(stress::mesh_volume(mesh) - 0.75 * kPi);
  }
  EXPECT_GT(area_error[0] / area_error[1], 12.0);      // order 4
  EXPECT_GT(volume_error[0] / volume_error[1], 12.0);  // order 4
  EXPECT_LT(volume_error[1], 1e-4);
}

TEST(Loads, MeanDisplacementOfALinearFieldIsItsValueAtTheCentre) {
  const TetMesh mesh =
      shapes::straight_quadratic(shapes::brick({2.0, 3.0, 4.0}, 2, 2, 2));
  VectorX u(3 * static_cast<Eigen::Index>(mesh.nodes.size()));
  for (std::size_t i = 0; i < mesh.nodes.size(); ++i) {
    const Vec3& x = mesh.nodes[i];
    u.segment<3>(static_cast<Eigen::Index>(3 * i)) =
        Vec3(x.x(), 2.0 * x.y() + x.z(), 0.0);
  }
  EXPECT_NEAR(loads::mean_displacement(mesh, "x1", {0.0, 7.0, 0.0}, u), 5.0,
              5.0 * kLoadRounding);
}

TEST(Loads, MassUsesTheDensityOfEachRegion) {
  TetMesh mesh = shapes::brick({2.0, 1.0, 1.0}, 2, 1, 1);
  for (int e = 0; e < mesh.element_count(); ++e) {
    mesh.element_region[e] = e < mesh.element_count() / 2 ? 0 : 1;
  }
  element::Material light = parts::steel();
  light.density = 2.0;
  element::Material heavy = light;
  heavy.density = 3.0;
  EXPECT_NEAR(stress::mesh_mass(mesh, {light, heavy}), 5.0,
              kLoadRounding * 5.0);
}

/// Sum of x times f over the nodes, about `point`.
Vec3 moment_about(const TetMesh& mesh, const VectorX& f, const Vec3& point) {
  Vec3 sum = Vec3::Zero();
  for (std::size_t i = 0; i < mesh.nodes.size(); ++i) {
    sum += (mesh.nodes[i] - point)
               .cross(f.segment<3>(static_cast<Eigen::Index>(3 * i)));
  }
  return sum;
}

TEST(Loads, TractionFieldHasItsForceAndMoment) {
  const TetMesh mesh =
      shapes::straight_quadratic(shapes::brick({2.0, 3.0, 4.0}, 2, 2, 2));
  loads::LoadCase load_case;
  load_case.tractions = {{.surface = "x1", .field = [](const Vec3& x) {
                            return Vec3(x.y(), x.z() * x.z(), x.y() * x.z());
                          }}};
  const VectorX f = loads::nodal_forces(mesh, load_case);
  // Over y in [0, 3], z in [0, 4] at x = 2, by hand.
  const Vec3 force(18.0, 64.0, 36.0);
  EXPECT_LE((total_force(f) - force).norm(), kLoadRounding * force.norm());
  const Vec3 moment(72.0 - 192.0, 36.0 - 72.0, 128.0 - 36.0);
  EXPECT_LE((moment_about(mesh, f, Vec3::Zero()) - moment).norm(),
            kLoadRounding * moment.norm());
}

TEST(Loads, FieldsOfOneValueActAsNumbers) {
  const TetMesh mesh =
      shapes::straight_quadratic(shapes::brick({2.0, 3.0, 4.0}, 2, 2, 2));
  loads::LoadCase numbers;
  numbers.pressures = {{"y1", 2.0}};
  numbers.tractions = {{"z1", {1.0, 2.0, 3.0}}};
  loads::LoadCase fields;
  fields.pressures = {{"y1", 0.0, [](const Vec3&) { return 2.0; }}};
  fields.tractions = {
      {"z1", Vec3::Zero(), [](const Vec3&) { return Vec3(1.0, 2.0, 3.0); }}};
  const VectorX f = loads::nodal_forces(mesh, numbers);
  EXPECT_LE((loads::nodal_forces(mesh, fields) - f).norm(),
            kLoadRounding * f.norm());
}

TEST(Loads, LiquidLiftsACurvedPartByTheWeightItDisplaces) {
  const TetMesh mesh = parts::quarter_tube(2, 1.5);
  loads::LoadCase load_case;
  for (const std::string& name : mesh.labels) {
    load_case.pressures.push_back(
        {name, 0.0, [](const Vec3& x) { return 7.0 - 3.0 * x.z(); }});
  }
  const Vec3 lift(0.0, 0.0, 3.0 * stress::mesh_volume(mesh));
  EXPECT_LE((total_force(loads::nodal_forces(mesh, load_case)) - lift).norm(),
            kLoadRounding * 100.0);
}

TEST(RemoteLoads, HaveTheForceAndTheMomentAndAreARigidPattern) {
  const TetMesh mesh = parts::quarter_tube(2, 1.5);
  loads::LoadCase load_case;
  const Vec3 point(5.0, -2.0, 3.0);
  const Vec3 force(1.0, 2.0, -3.0);
  const Vec3 moment(4.0, -1.0, 2.0);
  load_case.remote_loads = {{"z1", point, force, moment}};
  const VectorX f = loads::nodal_forces(mesh, load_case);
  EXPECT_LE((total_force(f) - force).norm(), kLoadRounding * force.norm());
  EXPECT_LE((moment_about(mesh, f, point) - moment).norm(),
            kLoadRounding * 20.0 * force.norm());
  // Least in the weighted norm: force over weight is a rigid motion, which
  // takes six numbers.
  const loads::SurfaceWeights w = loads::surface_weights(mesh, "z1");
  const auto count = static_cast<Eigen::Index>(w.nodes.size());
  Eigen::MatrixXd rows(3 * count, 6);
  VectorX pattern(3 * count);
  for (Eigen::Index k = 0; k < count; ++k) {
    const double weight = w.weights[k];
    const Vec3& x = mesh.nodes[w.nodes[k]];
    rows.block<3, 3>(3 * k, 0) = weight * Mat3::Identity();
    for (int c = 0; c < 3; ++c) {
      rows.block<3, 1>(3 * k, 3 + c) = weight * Vec3::Unit(c).cross(x);
    }
    pattern.segment<3>(3 * k) = f.segment<3>(3L * w.nodes[k]);
  }
  const VectorX fit = rows.colPivHouseholderQr().solve(pattern);
  EXPECT_LE((rows * fit - pattern).norm(), 1e-10 * pattern.norm());
}

// Euler-Bernoulli is exact for a bar under a linear end traction; nodal forces
// of the same moment differ from it within a width of the end.
TEST(RemoteLoads, EndMomentBendsABarToACircle) {
  const TetMesh mesh =
      shapes::straight_quadratic(shapes::brick({10.0, 1.0, 1.0}, 20, 2, 2));
  loads::LoadCase load_case;
  load_case.name = "bend";
  load_case.supports = {parts::hold("x0")};
  load_case.remote_loads = {
      {"x1", {10.0, 0.5, 0.5}, Vec3::Zero(), {0.0, 700.0, 0.0}}};
  element::Material material = parts::steel();
  material.poisson_ratio = 0.0;
  const elastic::ElasticModel model(mesh, {material}, {load_case});
  ASSERT_FALSE(model.base_solution().failure);
  const double tip = loads::mean_displacement(
      mesh, "x1", -Vec3::UnitZ(), model.base_solution().displacements[0]);
  const double exact =
      700.0 * 100.0 / (2.0 * material.youngs_modulus * (1.0 / 12.0));
  EXPECT_NEAR(tip, exact, kEndEffect * exact);
}

TEST(Loads, FieldsWithoutAValueAreRefusedWithTheirPlace) {
  const TetMesh mesh = shapes::brick({1.0, 1.0, 1.0}, 1, 1, 1);
  loads::LoadCase load_case;
  load_case.name = "main";
  load_case.pressures = {
      {"x1", 0.0, [](const Vec3& x) { return std::sqrt(x.y() - 0.5); }}};
  EXPECT_THAT([&] { loads::nodal_forces(mesh, load_case); },
              testing::ThrowsMessage<InvalidInput>(testing::AllOf(
                  testing::HasSubstr("'main'"), testing::HasSubstr("'x1'"),
                  testing::HasSubstr("at (1, "))));
  const Expression bad = Expression::parse("1 / (x - 1)", {"x", "y", "z"});
  load_case.pressures = {{"x1", 0.0, [bad](const Vec3& x) {
                            return bad.evaluate(
                                std::span<const double>(x.data(), 3));
                          }}};
  EXPECT_THAT(
      [&] { loads::nodal_forces(mesh, load_case); },
      testing::ThrowsMessage<InvalidInput>(testing::HasSubstr("no value")));
  load_case.pressures.clear();
  load_case.tractions = {{"lid", Vec3::UnitX()}};
  EXPECT_THROW(loads::nodal_forces(mesh, load_case), InvalidInput);
  load_case.tractions = {{"x1", {0.0, INFINITY, 0.0}}};
  EXPECT_THROW(loads::nodal_forces(mesh, load_case), InvalidInput);
  load_case.tractions.clear();
  load_case.remote_loads = {{"x1", {0.0, 0.0, NAN}}};
  EXPECT_THROW(loads::nodal_forces(mesh, load_case), InvalidInput);
}

TEST(Loads, WrongNamesAndNumbersAreRefused) {
  const TetMesh mesh = shapes::brick({1.0, 1.0, 1.0}, 1, 1, 1);
  EXPECT_THAT([&] { loads::surface_weights(mesh, "lid"); },
              testing::ThrowsMessage<InvalidInput>(testing::AllOf(
                  testing::HasSubstr("lid"), testing::HasSubstr("x0, x1"))));
  loads::LoadCase bad = parts::pulled({NAN, 0.0, 0.0});
  EXPECT_THROW(loads::nodal_forces(mesh, bad), InvalidInput);
  const VectorX u = VectorX::Zero(24);
  EXPECT_THROW(loads::mean_displacement(mesh, "x0", Vec3::Zero(), u),
               InvalidInput);
  EXPECT_THROW(loads::mean_displacement(mesh, "x0", Vec3::UnitX(), u.head(3)),
               InvalidInput);
}

TEST(Loads, SurfaceWithoutAreaIsRefusedByName) {
  TetMesh mesh = shapes::brick({1.0, 1.0, 1.0}, 1, 1, 1);
  for (Vec3& x : mesh.nodes) {
    x.y() = 0.0;
  }
  EXPECT_THAT([&] { loads::surface_weights(mesh, "x1"); },
              testing::ThrowsMessage<InvalidInput>(testing::HasSubstr("x1")));
}

/// The boundary's faces of a label as faces of elements.
std::vector<loads::FacePressure> faces_of(const TetMesh& mesh,
                                          const std::string& surface,
                                          double pressure) {
  std::vector<loads::FacePressure> faces;
  for (int f = 0; f < mesh.face_count(); ++f) {
    if (mesh.face_label[f] != mesh.label_of(surface)) {
      continue;
    }
    const auto ids = mesh.face(f);
    const auto element = mesh.element(mesh.face_element[f]);
    for (int c = 0; c < 4; ++c) {
      if (std::find(ids.begin(), ids.begin() + 3, element[c]) ==
          ids.begin() + 3) {
        faces.push_back({mesh.face_element[f], c, pressure});
      }
    }
  }
  return faces;
}

TEST(FacePressures, OfASurfaceAreItsPressure) {
  const TetMesh curved = parts::quarter_tube(3, 0.5);
  const TetMesh plane = shapes::brick({2.0, 3.0, 4.0}, 2, 2, 2);
  for (const TetMesh& mesh : {curved, plane}) {
    for (const std::string& surface : mesh.labels) {
      loads::LoadCase load_case;
      load_case.pressures = {{surface, 2.5}};
      const VectorX expected = loads::nodal_forces(mesh, load_case);
      const VectorX found =
          loads::face_pressure_forces(mesh, faces_of(mesh, surface, 2.5));
      EXPECT_LE((found - expected).norm(), kLoadRounding * expected.norm())
          << surface;
    }
  }
}

// All faces of one element, two or three of them inside: no resultant.
TEST(FacePressures, AroundAnElementBalance) {
  const TetMesh mesh = parts::quarter_tube(3, 0.5);
  std::vector<loads::FacePressure> around;
  for (int c = 0; c < 4; ++c) {
    around.push_back({mesh.element_count() / 2, c, 7.0});
  }
  const VectorX f = loads::face_pressure_forces(mesh, around);
  EXPECT_LE(total_force(f).norm(), kLoadRounding * f.norm());
  EXPECT_GT(f.norm(), 0.0);
  EXPECT_THROW(loads::face_pressure_forces(mesh, {{0, 4, 1.0}}), InvalidInput);
  EXPECT_THROW(
      loads::face_pressure_forces(mesh, {{mesh.element_count(), 0, 1.0}}),
      InvalidInput);
  EXPECT_THROW(loads::face_pressure_forces(mesh, {{0, 0, NAN}}), InvalidInput);
}

}  // namespace
}  // namespace meniscus::loads_test
