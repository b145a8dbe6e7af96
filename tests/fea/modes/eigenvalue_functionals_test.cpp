/// Derivatives of buckling factors and frequencies, and what they are made of.
#include "fea/modes/eigenvalue_functionals.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include <gtest/gtest.h>

#include "core/error.h"
#include "fea/elastic/elastic_gradient.h"
#include "fea/loads/body_loads.h"
#include "fea/modes/buckling.h"
#include "fea/modes/eigenvalue_bound.h"
#include "fea/modes/mode_shapes.h"
#include "fea/modes/modes.h"
#include "tests/support/derivatives.h"
#include "tests/support/eigen_parts.h"
#include "tests/support/gradient_parts.h"

namespace meniscus::eigenvalue_functionals_test {
namespace {

using derivatives::expect_derivative;
using derivatives::expect_partials;
using derivatives::moved;
using derivatives::wave;

class ModeWorks : public testing::TestWithParam<int> {};

TEST_P(ModeWorks, GeometricIsTheMatrixAndHasExactPartials) {
  const TetMesh mesh = gradient_parts::block(GetParam());
  const std::vector<element::Material> materials = gradient_parts::materials();
  const VectorX x = wave(mesh, 1.7);
  const VectorX u = 0.1 * wave(mesh, 0.9);
  for (const loads::LoadCase& load_case :
       {gradient_parts::held("plain"), gradient_parts::warm()}) {
    SCOPED_TRACE(load_case.name);
    const element::Functional work =
        modes::geometric_work(mesh, materials, load_case, u, x);
    const solver::ElementTable table = parts::table_of(mesh);
    const solver::NodalMatrix Kg = solver::geometric_stiffness(
        table, mesh.nodes, parts::own_elements(mesh),
        element::point_stress(mesh, materials, u,
                              loads::temperature_change(mesh, load_case)));
    EXPECT_NEAR(work.value, x.dot(parts::product(table, Kg, x)),
                1e-12 * std::abs(work.value));
    expect_partials(mesh, u, [&](const TetMesh& m, const VectorX& v) {
      return modes::geometric_work(m, materials, load_case, v, x);
    });
  }
}

TEST_P(ModeWorks, InertiaIsTheMatrixAndHasExactPartials) {
  const TetMesh mesh = gradient_parts::block(GetParam());
  const std::vector<element::Material> materials = gradient_parts::materials();
  const VectorX x = wave(mesh, 1.7);
  const modes::ModeFunctional work = modes::inertia_work(mesh, materials, x);
  const solver::ElementTable table = parts::table_of(mesh);
  const solver::NodalMatrix M = solver::mass_matrix(
      table, mesh.nodes, {materials[0].density, materials[1].density});
  EXPECT_NEAR(work.value, x.dot(parts::product(table, M, x)),
              1e-12 * work.value);
  EXPECT_NEAR(work.by_density[0] * materials[0].density +
                  work.by_density[1] * materials[1].density,
              work.value, 1e-12 * work.value);
  expect_partials(mesh, x, [&](const TetMesh& m, const VectorX&) {
    return modes::inertia_work(m, materials, x);
  });
}

TEST_P(ModeWorks, StiffnessHasExactPartials) {
  const TetMesh mesh = gradient_parts::block(GetParam());
  const std::vector<element::Material> materials = gradient_parts::materials();
  loads::LoadCase bed = gradient_parts::held("bed");
  bed.springs = {{.surface = "y1", .components = {3.0, 5.0, 2.0}}};
  const VectorX x = wave(mesh, 1.7);
  const VectorX none = VectorX::Zero(x.size());
  expect_partials(mesh, x, [&](const TetMesh& m, const VectorX&) {
    return modes::stiffness_work(m, materials, bed, x, none);
  });
}

/// The least distance between neighbours that a simple value must keep.
constexpr double kSimple = 0.02;
/// Of eigenvalues to 1e-12 or so, over steps of 1e-3.
constexpr double kTotal = 3e-7;

struct Column {
  TetMesh mesh;
  std::vector<element::Material> materials;
  std::vector<loads::LoadCase> cases;

  VectorX solution() const {
    return elastic::ElasticModel(mesh, materials, cases, {.tolerance = 1e-13})
        .base_solution()
        .displacements[0];
  }
  modes::BucklingModes buckling(int count) const {
    const elastic::ElasticModel model(mesh, materials, cases,
                                      {.tolerance = 1e-13});
    return modes::buckling_modes(model, mesh, cases, 0,
                                 model.base_solution().displacements[0],
                                 {.count = count, .tolerance = 1e-9});
  }
  modes::NaturalModes vibration(int count) const {
    return modes::natural_modes(mesh, materials, cases[0],
                                {.count = count, .tolerance = 1e-9});
  }
};

/// Of unequal sides, pushed askew; it stands on a bed of springs and slides
/// along a foot's normal where `sliding`.
Column column(int order, bool sliding) {
  Column result;
  result.mesh = shapes::brick({5.0, 1.0, 0.7}, 6, 2, 2);
  for (int e = 0; e < result.mesh.element_count(); e += 3) {
    result.mesh.element_region[e] = 1;
  }
  if (order == 2) {
    result.mesh = shapes::straight_quadratic(result.mesh);
  }
  for (Vec3& x : result.mesh.nodes) {  // no side is plane
    x += 0.02 * Vec3(std::sin(2.0 * x.y()), std::sin(1.5 * x.z() + x.x()),
                     std::cos(2.0 * x.x()));
  }
  result.materials = {{"soft", 70.0, 0.33, 2.7, {}},
                      {"hard", 90.0, 0.3, 3.1, {}}};
  loads::LoadCase pushed;
  pushed.name = "push";
  pushed.supports = {parts::hold("x0")};
  if (sliding) {
    pushed.supports = {{.surface = "x0", .kind = loads::SupportKind::Normal}};
    pushed.springs = {{.surface = "x0", .components = {0.0, 40.0, 40.0}},
                      {.surface = "y0", .components = {0.1, 0.3, 0.2}}};
  }
  pushed.forces = {{"x1", {-0.2, 0.001, 0.002}}};
  pushed.temperature = loads::Temperature{
      .field = [](const Vec3& x) { return 1.0 + 0.1 * x.x() * x.y(); },
      .slope =
          [](const Vec3& x) { return Vec3(0.1 * x.y(), 0.1 * x.x(), 0.0); }};
  result.materials[0].thermal_expansion.setConstant(1e-5);
  result.materials[1].thermal_expansion.setConstant(2e-5);
  result.cases = {pushed};
  return result;
}

struct Kind {
  int order;
  bool sliding;
};
class Eigenvalue : public testing::TestWithParam<Kind> {
 protected:
  Column part_ = column(GetParam().order, GetParam().sliding);
};

/// By nodes, with the adjoint of the stresses.
VectorX total_by_nodes(const Column& part, const VectorX& weights,
                       const modes::BucklingModes& modes) {
  const elastic::ElasticModel model(part.mesh, part.materials, part.cases,
                                    {.tolerance = 1e-13});
  equations::ElasticState state;
  const equations::ElasticSolution solution =
      model.solve(part.mesh, part.cases, &state);
  const VectorX& u = solution.displacements[0];
  const element::Functional by =
      modes::factor_functional(part.mesh, part.materials, part.cases[0], u,
                               {modes.factors, modes.shapes, weights});
  const equations::AdjointSolution adjoint =
      model.solve_adjoint(state, 0, {by.by_displacement});
  Points gradient = elastic::residual_gradient(
      part.mesh, part.materials, part.cases[0],
      {u, solution.reactions[0], adjoint.lambda[0], adjoint.reactions[0]});
  flat(gradient) += flat(by.by_nodes);
  return flat(gradient);
}

TEST_P(Eigenvalue, BucklingFactorsHaveExactDerivatives) {
  const modes::BucklingModes modes = part_.buckling(3);
  ASSERT_FALSE(modes.failure) << modes.failure->message;
  for (int k = 0; k < 2; ++k) {
    ASSERT_GT(modes.factors[k + 1], (1.0 + kSimple) * modes.factors[k]);
    const VectorX dx = wave(part_.mesh, 0.4);
    const VectorX gradient = total_by_nodes(part_, VectorX::Unit(3, k), modes);
    expect_derivative({.exact = gradient.dot(dx),
                       .scale = gradient.cwiseProduct(dx).lpNorm<1>(),
                       .tolerance = kTotal},
                      [&](double t) {
                        Column there = part_;
                        there.mesh = moved(part_.mesh, dx, t);
                        return there.buckling(3).factors[k];
                      });
  }
}

TEST_P(Eigenvalue, FrequenciesHaveExactDerivatives) {
  const modes::NaturalModes modes = part_.vibration(3);
  ASSERT_FALSE(modes.failure) << modes.failure->message;
  for (int k = 0; k < 2; ++k) {
    ASSERT_GT(modes.frequencies[k + 1], (1.0 + kSimple) * modes.frequencies[k]);
    const VectorX weights = VectorX::Unit(3, k);
    const modes::ModeFunctional by =
        modes::frequency_functional(part_.mesh, part_.materials, part_.cases[0],
                                    {modes.frequencies, modes.shapes, weights});
    EXPECT_NEAR(by.value, modes.frequencies[k], 1e-12 * by.value);
    const VectorX dx = wave(part_.mesh, 0.4);
    expect_derivative({.exact = flat(by.by_nodes).dot(dx),
                       .scale = flat(by.by_nodes).cwiseProduct(dx).lpNorm<1>(),
                       .tolerance = kTotal},
                      [&](double t) {
                        Column there = part_;
                        there.mesh = moved(part_.mesh, dx, t);
                        return there.vibration(3).frequencies[k];
                      });
    for (int region = 0; region < 2; ++region) {
      const auto with = [&](double modulus, double density) {
        Column there = part_;
        there.materials[region].youngs_modulus += modulus;
        there.materials[region].density += density;
        return there.vibration(3).frequencies[k];
      };
      expect_derivative({.exact = by.by_modulus[region],
                         .scale = std::abs(by.by_modulus[region]),
                         .step = 1.0,
                         .tolerance = 1e-5},
                        [&](double t) { return with(t, 0.0); });
      expect_derivative({.exact = by.by_density[region],
                         .scale = std::abs(by.by_density[region]),
                         .step = 5e-2,
                         .tolerance = 1e-5},
                        [&](double t) { return with(0.0, t); });
    }
  }
}

// With u in inverse proportion to a common factor of all moduli the stresses
// stay, so that factors are in proportion to it.
TEST_P(ModeWorks, FactorsAreByModuliWhatTheirUnitsSay) {
  Column part = column(GetParam(), false);
  part.cases[0].temperature.reset();
  const modes::BucklingModes modes = part.buckling(2);
  const VectorX u = part.solution();
  const element::Functional by = modes::factor_functional(
      part.mesh, part.materials, part.cases[0], u,
      {modes.factors, modes.shapes, VectorX::Unit(2, 0)});
  const double factor = modes.factors[0];
  const double by_all = by.by_modulus[0] * part.materials[0].youngs_modulus +
                        by.by_modulus[1] * part.materials[1].youngs_modulus;
  EXPECT_NEAR(by_all - by.by_displacement.dot(u), factor, 1e-8 * factor);
  // At held displacements twice the moduli make twice the stress: nothing.
  EXPECT_NEAR(by_all, 0.0, 1e-8 * factor);
}

INSTANTIATE_TEST_SUITE_P(Orders, ModeWorks, testing::Values(1, 2));

INSTANTIATE_TEST_SUITE_P(Kinds, Eigenvalue,
                         testing::Values(Kind{1, false}, Kind{2, false},
                                         Kind{1, true}, Kind{2, true}),
                         [](const testing::TestParamInfo<Kind>& kind) {
                           return std::string(kind.param.order == 1 ? "Four"
                                                                    : "Ten") +
                                  (kind.param.sliding ? "Sliding" : "Held");
                         });

TEST(FreeBody, FrequenciesHaveExactDerivatives) {
  Column part = column(2, false);
  part.cases = {loads::LoadCase{.name = "free"}};
  const modes::NaturalModes modes = part.vibration(2);
  ASSERT_EQ(modes.rigid_motions, 6);
  const modes::ModeFunctional by = modes::frequency_functional(
      part.mesh, part.materials, part.cases[0],
      {modes.frequencies, modes.shapes, VectorX::Unit(2, 0)});
  const VectorX dx = wave(part.mesh, 0.4);
  expect_derivative({.exact = flat(by.by_nodes).dot(dx),
                     .scale = flat(by.by_nodes).cwiseProduct(dx).lpNorm<1>(),
                     .tolerance = kTotal},
                    [&](double t) {
                      Column there = part;
                      there.mesh = moved(part.mesh, dx, t);
                      return there.vibration(2).frequencies[0];
                    });
}

/// A square column whose two bending modes are one value: y and z changed into
/// each other give the same mesh.
Column square_column() {
  Column result;
  const TetMesh quarter = shapes::brick({6.0, 1.0, 1.0}, 6, 2, 2);
  result.mesh = shapes::straight_quadratic(quarter);
  result.materials = {{"soft", 70.0, 0.3, 2.7, {}}};
  result.cases = {parts::pulled({-0.2, 0.0, 0.0})};
  return result;
}

/// Wider by t in y, or as much thicker in z.
TetMesh stretched(TetMesh mesh, double y, double z) {
  for (Vec3& x : mesh.nodes) {
    x.y() *= 1.0 + y;
    x.z() *= 1.0 + z;
  }
  return mesh;
}

class RepeatedModes : public testing::Test {
 protected:
  double bound_at(const TetMesh& mesh) const {
    Column there = part_;
    there.mesh = mesh;
    return modes::eigenvalue_bound(there.buckling(4).factors, kWidth).value;
  }
  static constexpr double kWidth = 0.1;
  Column part_ = square_column();
};

TEST_F(RepeatedModes, TheBoundHasExactDerivatives) {
  const modes::BucklingModes modes = part_.buckling(4);
  // The diagonals of the bricks make them differ by little.
  ASSERT_LT(modes.factors[1], (1.0 + 1e-2) * modes.factors[0]);
  ASSERT_GT(modes.factors[2], 1.5 * modes.factors[0]);
  const modes::EigenvalueBound bound =
      modes::eigenvalue_bound(modes.factors, kWidth);
  const VectorX gradient = total_by_nodes(part_, bound.by_value, modes);
  VectorX wider(gradient.size());
  VectorX larger(gradient.size());
  for (std::size_t i = 0; i < part_.mesh.nodes.size(); ++i) {
    const Vec3& x = part_.mesh.nodes[i];
    const auto at = static_cast<Eigen::Index>(3 * i);
    wider.segment<3>(at) = Vec3(0.0, x.y(), -0.4 * x.z());
    larger.segment<3>(at) = Vec3(0.0, x.y(), x.z());
  }
  for (const VectorX& dx : {wider, larger, wave(part_.mesh, 0.4)}) {
    expect_derivative(
        {.exact = gradient.dot(dx),
         .scale = gradient.cwiseProduct(dx).lpNorm<1>(),
         .tolerance = 3e-6},  // bent within the width: differences of order 4
        [&](double t) { return bound_at(moved(part_.mesh, dx, t)); });
  }
}

TEST_F(RepeatedModes, AnyBasisGivesTheSameDerivatives) {
  modes::BucklingModes modes = part_.buckling(4);
  modes.factors[1] = modes.factors[0];  // as of the section
  const modes::EigenvalueBound bound =
      modes::eigenvalue_bound(modes.factors, kWidth);
  const VectorX u = part_.solution();
  const auto unit = [&](VectorX x) {
    return x /= std::sqrt(-modes::geometric_work(part_.mesh, part_.materials,
                                                 part_.cases[0], u, x,
                                                 element::Derivatives::None)
                               .value);
  };
  const VectorX a = unit(modes.shapes[0]);
  const VectorX b = unit(modes.shapes[1]);
  const auto gradient = [&](double angle) -> VectorX {
    modes.shapes[0] = std::cos(angle) * a + std::sin(angle) * b;
    modes.shapes[1] = -std::sin(angle) * a + std::cos(angle) * b;
    return flat(
        modes::factor_functional(part_.mesh, part_.materials, part_.cases[0], u,
                                 {modes.factors, modes.shapes, bound.by_value})
            .by_nodes);
  };
  const VectorX here = gradient(0.0);
  EXPECT_LE((gradient(0.7) - here).norm(), 1e-9 * here.norm());
  // The single mode's depends on it.
  modes.shapes = {a, (a + b) / std::sqrt(2.0)};
  const auto single = [&](int k) {
    return modes::factor_functional(part_.mesh, part_.materials, part_.cases[0],
                                    u,
                                    {{modes.factors[0], modes.factors[1]},
                                     modes.shapes,
                                     VectorX::Unit(2, k)})
        .by_nodes;
  };
  const Points first = single(0);
  const Points second = single(1);
  EXPECT_GT((flat(first) - flat(second)).norm(), 0.1 * flat(first).norm());
}

TEST(EigenvalueBoundOf, OneValueIsItself) {
  const modes::EigenvalueBound bound =
      modes::eigenvalue_bound({3.0, 3.31, 7.0}, 0.1);
  EXPECT_NEAR(bound.value, 3.0, 1e-14);
  EXPECT_NEAR(bound.by_value[0], 1.0, 1e-13);
  EXPECT_EQ(bound.by_value[1], 0.0);
  EXPECT_NEAR(bound.reach, 3.3, 1e-13);
}

TEST(EigenvalueBoundOf, EqualValuesIsTheFormula) {
  for (int r = 1; r <= 4; ++r) {
    const modes::EigenvalueBound bound =
        modes::eigenvalue_bound(std::vector<double>(r, 5.0), 0.1);
    EXPECT_NEAR(bound.value, 5.0 / (1.1 - 0.1 * std::pow(r, -1.0 / 3.0)),
                1e-13);
    EXPECT_NEAR(bound.by_value.sum() * 5.0, bound.value, 1e-13);
    EXPECT_GE(bound.value, 5.0 / 1.1);
  }
}

TEST(EigenvalueBoundOf, DerivativesAreExactAndValuesMayPass) {
  const auto value = [](double t) {
    std::vector<double> v = {2.0 + 0.3 * t, 2.05 - 0.2 * t, 2.1 + t, 2.35 - t};
    std::sort(v.begin(), v.end());
    return modes::eigenvalue_bound(v, 0.1).value;
  };
  for (const double at : {-0.1, 0.0, 0.02, 0.1, 0.125, 0.3}) {
    std::vector<std::pair<double, double>> v = {{2.0 + 0.3 * at, 0.3},
                                                {2.05 - 0.2 * at, -0.2},
                                                {2.1 + at, 1.0},
                                                {2.35 - at, -1.0}};
    std::sort(v.begin(), v.end());
    std::vector<double> values;
    for (const auto& [x, slope] : v) {
      values.push_back(x);
    }
    const modes::EigenvalueBound bound = modes::eigenvalue_bound(values, 0.1);
    double slope = 0.0;
    for (std::size_t k = 0; k < v.size(); ++k) {
      slope += bound.by_value[static_cast<Eigen::Index>(k)] * v[k].second;
    }
    const double h = 1e-5;
    EXPECT_NEAR((value(at + h) - value(at - h)) / (2.0 * h), slope, 1e-6);
    EXPECT_LE(bound.value, values.front());
  }
}

TEST(EigenvalueBoundOf, WrongInputIsRefused) {
  EXPECT_THROW(modes::eigenvalue_bound({}, 0.1), InvalidInput);
  EXPECT_THROW(modes::eigenvalue_bound({0.0}, 0.1), InvalidInput);
  EXPECT_THROW(modes::eigenvalue_bound({1.0}, 0.0), InvalidInput);
}

TEST(SameMode, IsFoundInAnotherOrder) {
  Column part = column(2, false);
  const modes::BucklingModes modes = part.buckling(3);
  // Wider and thinner: the first two change places.
  Column turned = part;
  turned.mesh = stretched(part.mesh, -0.35, 0.35);
  const modes::BucklingModes others = turned.buckling(3);
  const auto of = [&](std::size_t k) {
    return modes::same_mode(turned.mesh, {1.0, 1.0}, others.shapes,
                            modes.shapes[k]);
  };
  EXPECT_EQ(of(0), 1U);
  EXPECT_EQ(of(1), 0U);
  EXPECT_FALSE(modes::same_mode(turned.mesh, {1.0, 1.0}, {others.shapes[0]},
                                modes.shapes[0]));
}

TEST(ModeStressOf, AColumnIsThatOfItsSection) {
  Column part = square_column();
  part.materials[0].yield_strength = 0.5;
  const modes::BucklingModes modes = part.buckling(1);
  const modes::ModeStress stress =
      modes::mode_stress(part.mesh, part.materials, part.cases[0],
                         part.solution(), modes.shapes[0]);
  // The clamp's edges count a little.
  EXPECT_NEAR(stress.von_mises, 0.2, 0.02 * 0.2);
  EXPECT_NEAR(stress.of_yield, stress.von_mises / 0.5, 1e-12);
  EXPECT_NEAR(stress.strain, 0.2 / 70.0 * std::sqrt(1.0 + 2.0 * 0.09),
              0.02 * 0.2 / 70.0);
  EXPECT_NEAR(stress.position.y(), 0.5, 0.02);
}

TEST(StartOfASearch, ChangesNoAnswer) {
  const Column part = column(2, false);
  const elastic::ElasticModel model(part.mesh, part.materials, part.cases);
  const VectorX& u = model.base_solution().displacements[0];
  const modes::BucklingModes found =
      modes::buckling_modes(model, part.mesh, part.cases, 0, u, {.count = 3});
  // Of shapes that lack the first mode.
  const std::vector<VectorX> others = {found.shapes[1], found.shapes[2]};
  const modes::BucklingModes again = modes::buckling_modes(
      model, part.mesh, part.cases, 0, u, {.count = 2, .start = &others});
  EXPECT_NEAR(again.factors.at(0), found.factors[0], 1e-8 * found.factors[0]);
  EXPECT_NEAR(again.factors.at(1), found.factors[1], 1e-8 * found.factors[1]);
}

}  // namespace
}  // namespace meniscus::eigenvalue_functionals_test
