#include "evolve/energy/fields.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/error.h"
#include "core/math/macaulay.h"
#include "evolve/energy/energy.h"
#include "evolve/settle/find_equilibrium.h"
#include "tests/support/film_shapes.h"

namespace meniscus::fields_test {
namespace {

using std::numbers::pi;

/// A closed film that is nowhere symmetric.
films::FilmComplex skewed_drop(int levels = 2) {
  SurfaceMesh mesh = shapes::sphere(1.0, levels);
  for (Vec3& p : mesh.points) {
    p = Vec3(0.8 * p.x() + 0.1 * p.y() * p.z() + 0.2, 1.1 * p.y(),
             0.9 * p.z() + 0.2 * p.x());
  }
  return shapes::drop(mesh, 3.0);
}

std::vector<films::PoleShape> all_shapes() {
  return {
      films::PointPole{Vec3(0.3, 0.1, -0.2)},
      films::SegmentPole{Vec3(-2, -0.5, 0.1), Vec3(2, 0.4, 0.3)},
      films::PolylinePole{{Vec3(-9, 2, 0), Vec3(4, 1.5, 0.2), Vec3(9, 3, 0.3)}},
      films::PlanePole{Vec3(0, 0, 0.4), Vec3(0.1, 0.2, 1)}};
}

double distance_to(const Vec3& at, const Vec3& from, const Vec3& to) {
  const double t = std::clamp(
      (at - from).dot(to - from) / (to - from).squaredNorm(), 0.0, 1.0);
  return (at - from - t * (to - from)).norm();
}

double distance(const films::PoleShape& shape, const Vec3& at) {
  if (const auto* point = std::get_if<films::PointPole>(&shape)) {
    return (at - point->at).norm();
  }
  if (const auto* s = std::get_if<films::SegmentPole>(&shape)) {
    return distance_to(at, s->from, s->to);
  }
  if (const auto* plane = std::get_if<films::PlanePole>(&shape)) {
    return std::abs((at - plane->at).dot(plane->normal.normalized()));
  }
  const Points& points = std::get<films::PolylinePole>(shape).points;
  double least = 1e300;
  for (std::size_t i = 1; i < points.size(); ++i) {
    least = std::min(least, distance_to(at, points[i - 1], points[i]));
  }
  return least;
}

TEST(Fields, PotentialFollowsTheDistanceToEveryShape) {
  for (const films::PoleShape& shape : all_shapes()) {
    const films::FieldSpec field{"pole", shape, 1.5,
                                 3.0,    0.4,   films::PerArea{}};
    const Expression phi = with_numbers(energy::place_field(field));
    for (int i = 0; i < 50; ++i) {
      const Vec3 at(3 * std::sin(7.0 * i), 3 * std::cos(3.0 * i),
                    2 * std::sin(1.0 + 5.0 * i));
      const double d = distance(shape, at) / 0.4;
      EXPECT_NEAR(value_at(phi, at), -1.5 * std::pow(1 + d * d, -1.5), 1e-13);
    }
  }
}

/// The field's energy alone: tension 0.
struct FieldEnergy {
  films::FilmComplex complex;
  energy::FilmEnergy energy;
  films::FilmTargets targets;

  explicit FieldEnergy(films::FilmComplex made)
      : complex(std::move(made)),
        energy(complex),
        targets(energy::targets_of(complex)) {
    targets.tension.assign(targets.tension.size(), 0.0);
  }
  double at(const Points& points) const {
    return energy.value(points, targets);
  }
};

FieldEnergy energy_of(const films::FieldSpec& field, int levels = 2) {
  films::FilmComplex complex = skewed_drop(levels);
  complex.quantities = {energy::field_quantity(complex, field)};
  return FieldEnergy(std::move(complex));
}

Points shaken(const Points& points, double step) {
  Points result = points;
  for (std::size_t v = 0; v < points.size(); ++v) {
    const auto i = static_cast<double>(v);
    result[v] +=
        step * Vec3(std::sin(3 * i), std::cos(5 * i), std::sin(1 + 7 * i));
  }
  return result;
}

struct Errors {
  std::vector<double> gradient;
  std::vector<double> hessian;
};

/// Relative errors of central differences against gradient and Hessian, over
/// steps of 1e-2 to 1e-5.
Errors sweep(const FieldEnergy& field) {
  const Points& base = field.complex.mesh.points;
  const Points way = shaken(Points(base.size(), Vec3::Zero()), 1.0);
  const Points gradient = field.energy.gradient(base, field.targets);
  double slope = 0.0;
  double size = 0.0;
  for (std::size_t v = 0; v < base.size(); ++v) {
    slope += gradient[v].dot(way[v]);
    size += gradient[v].squaredNorm();
  }
  const int n = field.energy.unknowns();
  Points directions(n);
  for (int i = 0; i < n; ++i) {
    directions[i] = way[field.energy.vertices()[i]];
  }
  SparseMatrix hessian = field.energy.pattern();
  field.energy.hessian(base, directions, field.targets,
                       VectorX::Zero(field.energy.functionals()), hessian);
  const VectorX ones = VectorX::Ones(n);
  const double curvature =
      ones.dot(hessian.selfadjointView<Eigen::Lower>() * ones);
  Errors errors;
  for (const double step : {1e-2, 1e-3, 1e-4, 1e-5}) {
    const double up = field.at(shaken(base, step));
    const double down = field.at(shaken(base, -step));
    errors.gradient.push_back(std::abs((up - down) / (2 * step) - slope) /
                              std::sqrt(size));
    errors.hessian.push_back(
        std::abs((up + down - 2 * field.at(base)) / (step * step) - curvature) /
        std::abs(curvature));
  }
  return errors;
}

// Second order until rounding rules. The planes where segments are not smooth
// lie outside this film.
TEST(Fields, DerivativesMatchDifferencesOverASweepOfSteps) {
  const std::vector<std::variant<films::PerArea, films::PerVolume>> kinds = {
      films::PerArea{}, films::PerVolume{"drop"}};
  for (const films::PoleShape& shape : all_shapes()) {
    for (const auto& per : kinds) {
      SCOPED_TRACE(shape.index());
      SCOPED_TRACE(per.index());
      const Errors e = sweep(energy_of({"pole", shape, 1.3, 2.5, 0.6, per}, 1));
      EXPECT_NEAR(std::log10(e.gradient[0] / e.gradient[1]), 2.0, 0.3);
      EXPECT_NEAR(std::log10(e.hessian[0] / e.hessian[1]), 2.0, 0.3);
      EXPECT_LT(*std::min_element(e.gradient.begin(), e.gradient.end()), 1e-8);
      EXPECT_LT(*std::min_element(e.hessian.begin(), e.hessian.end()), 1e-5);
    }
  }
}

TEST(Fields, ForcesPullAttractedFilmsTowardsThePole) {
  for (const double strength : {1.0, -1.0}) {
    const FieldEnergy field =
        energy_of({"pole", films::PlanePole{Vec3(0, 0, 5), Vec3::UnitZ()},
                   strength, 2.0, 1.0, films::PerVolume{}});
    Vec3 force = Vec3::Zero();
    for (const Vec3& g :
         field.energy.gradient(field.complex.mesh.points, field.targets)) {
      force -= g;
    }
    EXPECT_GT(strength * force.z(), 0.01);
  }
}

TEST(Fields, ConstantFieldMeasuresTheVolumeWhereverRaysStart) {
  films::FilmComplex complex = skewed_drop();
  const double volume = enclosed_volume(complex.mesh);
  for (const Vec3& origin : {Vec3(0, 0, 0), Vec3(3, -2, 1)}) {
    films::FilmQuantity quantity =
        energy::pressure_quantity(complex, "push", "drop", Expression(2.0));
    quantity.origin.at = origin;
    complex.quantities = {quantity};
    const FieldEnergy field(complex);
    EXPECT_NEAR(field.at(complex.mesh.points), -2.0 * volume, 1e-12 * volume);
  }
}

// Polynomials of degree 4 are within every rule, and curved facets are none:
// the flux is exact, so it cannot depend on the origin.
TEST(Fields, BodyIntegralsDoNotDependOnTheOrigin) {
  films::FilmComplex complex = skewed_drop();
  std::vector<double> found;
  for (const Vec3& origin : {Vec3(0, 0, 0), Vec3(0.5, 0.1, 1), Vec3(2, 1, 0)}) {
    films::FilmQuantity quantity = energy::pressure_quantity(
        complex, "push", "drop",
        energy::place_expression("1 + x*y*z + x^2 + z^4"));
    quantity.origin.at = origin;
    complex.quantities = {quantity};
    found.push_back(FieldEnergy(complex).at(complex.mesh.points));
  }
  EXPECT_NEAR(found[1], found[0], 1e-12 * std::abs(found[0]));
  EXPECT_NEAR(found[2], found[0], 1e-12 * std::abs(found[0]));
}

// Power 2 over a ball of radius R about its pole:
// 4 pi c^2 (R - c atan(R / c)) per volume, 4 pi R^2 c^2 / (R^2 + c^2) per area.
TEST(Fields, PolesInASphereAtSecondOrder) {
  const double core = 0.3;
  const double volume =
      -4 * pi * core * core * (1 - core * std::atan(1 / core));
  const double area = -4 * pi * core * core / (1 + core * core);
  double before_volume = 0.0;
  double before_area = 0.0;
  for (const int levels : {2, 3, 4}) {
    films::FilmComplex complex = shapes::drop(shapes::sphere(1.0, levels), 1.0);
    const auto error =
        [&](const std::variant<films::PerArea, films::PerVolume>& per,
            double exact) {
          complex.quantities = {energy::field_quantity(
              complex, {"pole", films::PointPole{}, 1.0, 2.0, core, per})};
          return FieldEnergy(complex).at(complex.mesh.points) - exact;
        };
    const double by_volume = error(films::PerVolume{}, volume);
    const double by_area = error(films::PerArea{}, area);
    if (levels > 2) {
      EXPECT_NEAR(std::log2(before_volume / by_volume), 2.0, 0.2);
      EXPECT_NEAR(std::log2(before_area / by_area), 2.0, 0.2);
    }
    before_volume = by_volume;
    before_area = by_area;
  }
  EXPECT_LT(std::abs(before_volume / volume), 0.01);
}

/// A flat film across a square of side 2, n x n cells, rim fixed.
films::FilmComplex square_film(int n) {
  films::FilmComplex complex;
  complex.mesh.labels = {"film"};
  complex.surfaces = {{"film", true, 1.0}};
  for (int j = 0; j <= n; ++j) {
    for (int i = 0; i <= n; ++i) {
      complex.mesh.points.emplace_back(2.0 * i / n - 1, 2.0 * j / n - 1, 0.0);
      const bool rim = i == 0 || j == 0 || i == n || j == n;
      complex.vertices.push_back(
          {rim ? films::VertexKind::Fixed : films::VertexKind::Free, -1, 0.0});
    }
  }
  for (int j = 0; j < n; ++j) {
    for (int i = 0; i < n; ++i) {
      const int a = j * (n + 1) + i;
      const int b = a + n + 1;
      complex.mesh.facets.push_back({a, a + 1, b + 1});
      complex.mesh.facets.push_back({a, b + 1, b});
      complex.mesh.facet_label.insert(complex.mesh.facet_label.end(), 2, 0);
    }
  }
  return complex;
}

double middle_height(double strength, int n) {
  films::FilmComplex complex = square_film(n);
  complex.quantities = {energy::field_quantity(
      complex, {"pole", films::PointPole{Vec3(0, 0, 0.5)}, strength, 2.0, 0.5,
                films::PerArea{}})};
  const energy::FilmEnergy energy(complex);
  const settle::FilmState state = settle::settle_in_normals(
      energy, complex, energy::targets_of(complex), complex.mesh.points, {});
  EXPECT_FALSE(state.failure) << state.report.verdict;
  EXPECT_LE(state.report.residual, state.report.residual_bound);
  EXPECT_EQ(state.report.index, 0);
  return state.points[(n + 1) * n / 2 + n / 2].z();
}

TEST(Fields, PolesPullOrPushAFilmThatThenRests) {
  EXPECT_GT(middle_height(0.3, 8), 0.01);
  EXPECT_LT(middle_height(-0.3, 8), -0.01);
}

TEST(Fields, AttractedFilmConvergesAtSecondOrder) {
  std::array<double, 3> z{};
  for (int k = 0; k < 3; ++k) {
    z[k] = middle_height(0.3, 8 << k);
  }
  EXPECT_NEAR(std::log2((z[1] - z[0]) / (z[2] - z[1])), 2.0, 0.4);
}

/// Profile r(z) of a film of revolution between rings of radius 1 whose
/// tension T(z) = 1 + a <z>^1, rounded over a width: the axial balance
/// d/ds (T r dr/ds) = T, from E = 2 pi int T r sqrt(1 + r'^2) dz,
/// r'' = (1 + r'^2) (1/r - r' T'/T).
/// Returns r at z by shooting from the lower ring with Runge-Kutta steps.
double ramp_profile(double ramp, double width, double half, double at) {
  constexpr int kSteps = 4000;
  const auto shoot = [&](double slope, double end) {
    double r = 1.0;
    double u = slope;
    const double h = (end + half) / kSteps;
    const auto bend = [&](double z, double radius, double up) {
      const double push =
          ramp * macaulay(z, 0.0, width) / (1 + ramp * macaulay(z, 1.0, width));
      return (1 + up * up) * (1 / radius - up * push);
    };
    for (int i = 0; i < kSteps; ++i) {
      const double z = -half + i * h;
      const double a1 = bend(z + 1e-12, r, u);
      const double u2 = u + 0.5 * h * a1;
      const double a2 = bend(z + 0.5 * h, r + 0.5 * h * u, u2);
      const double u3 = u + 0.5 * h * a2;
      const double a3 = bend(z + 0.5 * h, r + 0.5 * h * u2, u3);
      const double u4 = u + h * a3;
      const double a4 = bend(z + h - 1e-12, r + h * u3, u4);
      r += h / 6 * (u + 2 * u2 + 2 * u3 + u4);
      u += h / 6 * (a1 + 2 * a2 + 2 * a3 + a4);
    }
    return r;
  };
  double low = -0.9;
  double high = 0.2;
  for (int i = 0; i < 50; ++i) {
    const double slope = 0.5 * (low + high);
    (shoot(slope, half) < 1.0 ? low : high) = slope;
  }
  return shoot(0.5 * (low + high), at);
}

// Rows of vertices lie on z = 0, where the tension has its corner.
double ramp_error(int n, double width) {
  const double ramp = 0.5;
  films::FilmComplex complex =
      shapes::tube(1.0, 0.8, n, n / 4, [](double) { return 0.95; });
  complex.surfaces[0].tension_field = energy::place_expression(
      fmt::format("1 + {}*macaulay(z, 1, {})", ramp, width));
  const settle::FilmState state = settle::find_equilibrium(complex, {});
  EXPECT_FALSE(state.failure) << state.report.verdict;
  const Vec3& p = state.points[(n / 8) * n];
  return std::hypot(p.x(), p.y()) - ramp_profile(ramp, width, 0.4, p.z());
}

TEST(Fields, FilmOfRampedTensionFollowsItsBalanceAtSecondOrder) {
  for (const double width : {0.0, 0.2}) {
    const double coarse = ramp_error(32, width);
    const double fine = ramp_error(64, width);
    EXPECT_LT(std::abs(fine), 2e-3) << width;
    EXPECT_NEAR(std::log2(std::abs(coarse / fine)), 2.0, 0.3) << width;
  }
}

TEST(Fields, RefusesWhatMakesNoField) {
  const films::FilmComplex complex = skewed_drop(0);
  films::FieldSpec field{"pole", films::PointPole{}, 1.0, 2.0,
                         0.0,    films::PerArea{}};
  EXPECT_THROW(energy::field_quantity(complex, field), InvalidInput);
  field.core = 1.0;
  field.power = -1.0;
  EXPECT_THROW(energy::field_quantity(complex, field), InvalidInput);
  field.power = 2.0;
  field.strength = std::nan("");
  EXPECT_THROW(energy::field_quantity(complex, field), InvalidInput);
  field.strength = 1.0;
  field.shape = films::SegmentPole{Vec3::Zero(), Vec3::Zero()};
  EXPECT_THROW(energy::field_quantity(complex, field), InvalidInput);
  field.shape = films::PolylinePole{Points(1, Vec3::Zero())};
  EXPECT_THROW(energy::field_quantity(complex, field), InvalidInput);
  Points spiral;
  for (int i = 0; i < 500; ++i) {
    spiral.emplace_back(std::cos(0.1 * i), std::sin(0.1 * i), 0.01 * i);
  }
  field.shape = films::PolylinePole{spiral};
  EXPECT_THROW(energy::field_quantity(complex, field), InvalidInput);
  spiral.resize(30);
  field.shape = films::PolylinePole{spiral};
  EXPECT_NO_THROW(energy::field_quantity(complex, field));
  field.shape = films::PlanePole{Vec3::Zero(), Vec3::Zero()};
  EXPECT_THROW(energy::field_quantity(complex, field), InvalidInput);
  field.shape = films::PointPole{};
  field.per = films::PerArea{{"filn"}};
  try {
    energy::field_quantity(complex, field);
    ADD_FAILURE() << "accepted a surface that is not there";
  } catch (const InvalidInput& error) {
    EXPECT_THAT(error.what(), testing::HasSubstr("film"));
  }
  EXPECT_THROW(energy::place_expression("x + w"), InvalidInput);
}

}  // namespace
}  // namespace meniscus::fields_test
