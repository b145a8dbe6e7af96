#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/error.h"
#include "fea/functionals/displacement_functionals.h"
#include "fea/functionals/energy_functionals.h"
#include "fea/functionals/volume_functionals.h"
#include "fea/loads/body_loads.h"
#include "fea/loads/loads.h"
#include "fea/stress/stress.h"
#include "tests/support/derivatives.h"
#include "tests/support/gradient_parts.h"

namespace meniscus::functionals_test {
namespace {

using derivatives::expect_derivative;
using derivatives::expect_partials;
using testing::HasSubstr;

constexpr double kRounding = 1e-12;

class Functionals : public testing::TestWithParam<int> {
 protected:
  TetMesh mesh_ = gradient_parts::block(GetParam());
  VectorX u_ = 1e-3 * derivatives::wave(mesh_, 1.0);
  std::vector<element::Material> materials_ = gradient_parts::materials();
};

/// By the direction, too.
template <class OfDirection>
void expect_by_direction(const Vec3& direction, const OfDirection& functional) {
  const element::DirectedFunctional here = functional(direction);
  const Vec3 change(0.3, -0.5, 0.2);
  SCOPED_TRACE("by direction");
  expect_derivative(
      {.exact = here.by_direction.dot(change),
       .scale = here.by_direction.norm() * change.norm()},
      [&](double t) { return functional(direction + t * change).value; });
}

TEST_P(Functionals, MeanDisplacement) {
  const Vec3 d(1.0, -2.0, 0.5);
  const auto of = [&](const TetMesh& mesh, const VectorX& u) {
    return functionals::mean_displacement_functional(mesh, "x1", d, u);
  };
  EXPECT_NEAR(of(mesh_, u_).value, loads::mean_displacement(mesh_, "x1", d, u_),
              kRounding * std::abs(of(mesh_, u_).value));
  expect_partials(mesh_, u_, of);
  expect_by_direction(d, [&](const Vec3& direction) {
    return functionals::mean_displacement_functional(mesh_, "x1", direction,
                                                     u_);
  });
}

TEST_P(Functionals, WeightedDisplacement) {
  const Vec3 d(1.0, 2.0, 0.5);
  const loads::SlopedField weight{
      [](const Vec3& x) { return x.y() * x.y() - 0.4 * x.z(); },
      [](const Vec3& x) { return Vec3(0.0, 2.0 * x.y(), -0.4); }};
  expect_partials(mesh_, u_, [&](const TetMesh& mesh, const VectorX& u) {
    return functionals::weighted_displacement_functional(mesh, "x1", d, weight,
                                                         u);
  });
  expect_by_direction(d, [&](const Vec3& direction) {
    return functionals::weighted_displacement_functional(mesh_, "x1", direction,
                                                         weight, u_);
  });
  EXPECT_THROW(functionals::weighted_displacement_functional(
                   mesh_, "x1", d, {weight.value, {}}, u_),
               InvalidInput);
}

TEST_P(Functionals, NormOfDisplacement) {
  const Vec3 d(0.2, -1.0, 0.5);
  for (const double power : {2.0, 8.0}) {
    const auto of = [&](const TetMesh& mesh, const VectorX& u) {
      return functionals::displacement_norm_functional(mesh, "x1", d, power, u);
    };
    expect_partials(mesh_, u_, of);
    expect_by_direction(d, [&](const Vec3& direction) {
      return functionals::displacement_norm_functional(mesh_, "x1", direction,
                                                       power, u_);
    });
  }
}

TEST_P(Functionals, RotationIsThatOfARigidTurn) {
  const Vec3 turn(2e-4, -3e-4, 5e-4);
  VectorX u(u_.size());
  for (std::size_t i = 0; i < mesh_.nodes.size(); ++i) {
    u.segment<3>(static_cast<Eigen::Index>(3 * i)) =
        Vec3(0.1, 0.2, 0.3) + turn.cross(mesh_.nodes[i]);
  }
  const Vec3 axis(1.0, 0.5, 2.0);
  EXPECT_NEAR(functionals::rotation_functional(mesh_, "x1", axis, u).value,
              turn.dot(axis.normalized()), 1e-14);
  expect_partials(mesh_, u_, [&](const TetMesh& mesh, const VectorX& v) {
    return functionals::rotation_functional(mesh, "x1", axis, v);
  });
  expect_by_direction(axis, [&](const Vec3& direction) {
    return functionals::rotation_functional(mesh_, "x1", direction, u_);
  });
}

TEST_P(Functionals, ComplianceOfEveryLoad) {
  for (const loads::LoadCase& load_case : gradient_parts::load_cases()) {
    SCOPED_TRACE(load_case.name);
    expect_partials(mesh_, u_, [&](const TetMesh& mesh, const VectorX& u) {
      return functionals::compliance_functional(mesh, materials_, load_case, u);
    });
  }
}

TEST_P(Functionals, StrainEnergy) {
  for (const loads::LoadCase& load_case :
       {parts::pulled({1.0, 0.0, 0.0}), gradient_parts::warm()}) {
    SCOPED_TRACE(load_case.name);
    expect_partials(mesh_, u_, [&](const TetMesh& mesh, const VectorX& u) {
      return functionals::strain_energy_functional(mesh, materials_, load_case,
                                                   u);
    });
  }
}

TEST_P(Functionals, VolumeMassAndItsCentre) {
  EXPECT_NEAR(functionals::volume_functional(mesh_).value,
              stress::mesh_volume(mesh_),
              kRounding * stress::mesh_volume(mesh_));
  EXPECT_NEAR(functionals::mass_functional(mesh_, materials_).value,
              stress::mesh_mass(mesh_, materials_),
              kRounding * stress::mesh_mass(mesh_, materials_));
  const Vec3 d(0.5, 1.0, -2.0);
  expect_partials(mesh_, u_, [](const TetMesh& mesh, const VectorX&) {
    return functionals::volume_functional(mesh);
  });
  expect_partials(mesh_, u_, [&](const TetMesh& mesh, const VectorX&) {
    return functionals::mass_functional(mesh, materials_);
  });
  expect_partials(mesh_, u_, [&](const TetMesh& mesh, const VectorX&) {
    return functionals::centre_of_mass_functional(mesh, materials_, d);
  });
  const std::vector<double> by =
      functionals::centre_of_mass_functional(mesh_, materials_, d).by_density;
  const double size = materials_[1].density;
  expect_derivative(
      {.exact = by[1] * size, .scale = std::abs(by[1] * size)}, [&](double t) {
        std::vector<element::Material> changed = materials_;
        changed[1].density += t * size;
        return functionals::centre_of_mass_functional(mesh_, changed, d).value;
      });
}

TEST_P(Functionals, CentreOfMassOfABoxIsItsMiddle) {
  TetMesh box = shapes::brick({2.0, 1.0, 3.0}, 2, 2, 2);
  if (GetParam() == 2) {
    box = shapes::straight_quadratic(box);
  }
  EXPECT_NEAR(functionals::centre_of_mass_functional(box, {parts::steel()},
                                                     Vec3::UnitX())
                  .value,
              1.0, kRounding);
  EXPECT_NEAR(functionals::centre_of_mass_functional(box, {parts::steel()},
                                                     {0.0, 2.0, 1.0})
                  .value,
              1.0 + 1.5, kRounding);
}

INSTANTIATE_TEST_SUITE_P(Orders, Functionals, testing::Values(1, 2));

}  // namespace
}  // namespace meniscus::functionals_test
