// Tensions that turn with their films: derivatives by differences, and free
// drops, whose shape is known (Wulff).
#include "evolve/films/drop_shape.h"

#include <cmath>
#include <limits>
#include <numbers>
#include <random>

#include <Eigen/Geometry>
#include <gtest/gtest.h>

#include "core/math/dense.h"
#include "evolve/energy/energy.h"
#include "evolve/energy/facet_size.h"
#include "evolve/settle/find_equilibrium.h"
#include "tests/support/film_shapes.h"

namespace meniscus::drop_shape_test {
namespace {

using Random = std::mt19937;

double draw(Random& random, double least, double most) {
  return std::uniform_real_distribution<double>(least, most)(random);
}

Vec3 draw_vector(Random& random) {
  std::normal_distribution<double> normal;
  const double x = normal(random);
  const double y = normal(random);
  return {x, y, normal(random)};
}

films::DropShape draw_shape(Random& random, int parts) {
  films::DropShape shape;
  for (int k = 0; k < parts; ++k) {
    shape.push_back(
        {draw_vector(random), draw(random, 0.1, 2.0), draw(random, 0.1, 2.0)});
  }
  return shape;
}

VectorX numbers_of(const films::DropShape& shape) {
  films::ComplexSurface surface;
  surface.tension_field = PlaceField(Expression(1.0));
  surface.drop_shape = shape;
  return films::tension_numbers(surface);
}

Numbers span(const VectorX& v) {
  return {v.data(), static_cast<std::size_t>(v.size())};
}

// g itself, from its definition.
double support(const films::DropShape& shape, const Vec3& n) {
  double sum = 0.0;
  for (const films::Spheroid& part : shape) {
    const Vec3 a = part.axis.normalized();
    sum += std::hypot(part.along * a.dot(n),
                      part.across * (n - a.dot(n) * a).norm());
  }
  return sum;
}

TEST(FacetSizes, AreSupportFunctionsConvexAndOfDegreeOne) {
  Random random(3);
  for (int k = 0; k < 100; ++k) {
    films::DropShape shape = draw_shape(random, 1 + k % 4);
    Vec3 n = draw_vector(random);
    double room = 1e-13;
    if (k % 5 == 0) {  // thin plates, seen from above
      room = 1e-6;
      shape.resize(1);
      shape[0].along = 1e-4;
      n = shape[0].axis;
    }
    const VectorX numbers = numbers_of(shape);
    const energy::FacetSize size = energy::facet_size(n, span(numbers));
    EXPECT_NEAR(size.value, support(shape, n), room * size.value);
    EXPECT_NEAR(size.slope.dot(n), size.value, room * size.value);
    EXPECT_LT((size.curve * n).norm(), 1e-12 * size.curve.norm());
    const auto eigen = symmetric_eigen(size.curve);
    EXPECT_GT(eigen.values[0], -1e-12 * eigen.values[2]);
    EXPECT_GT(eigen.values[1], 0.0);
    EXPECT_TRUE(size.curve.allFinite());
  }
}

TEST(FacetSizes, DerivativesMatchDifferences) {
  Random random(5);
  const double step = 1e-6;
  for (int k = 0; k < 50; ++k) {
    const VectorX numbers = numbers_of(draw_shape(random, 1 + k % 3));
    const Vec3 n = draw_vector(random);
    const Vec3 way = draw_vector(random);
    const energy::FacetSize size = energy::facet_size(n, span(numbers));
    const energy::FacetSize up =
        energy::facet_size(n + step * way, span(numbers));
    const energy::FacetSize down =
        energy::facet_size(n - step * way, span(numbers));
    EXPECT_NEAR((up.value - down.value) / (2 * step), size.slope.dot(way),
                1e-8);
    EXPECT_LT(((up.slope - down.slope) / (2 * step) - size.curve * way).norm(),
              1e-6 * (1.0 + (size.curve * way).norm()));

    const VectorX rates = VectorX::NullaryExpr(
        numbers.size(), [&] { return draw(random, -1, 1); });
    const VectorX more = numbers + step * rates;
    const VectorX less = numbers - step * rates;
    const energy::FacetSize ahead = energy::facet_size(n, span(more));
    const energy::FacetSize behind = energy::facet_size(n, span(less));
    const energy::FacetSize rate =
        energy::facet_size_rate(n, span(numbers), span(rates));
    EXPECT_NEAR((ahead.value - behind.value) / (2 * step), rate.value, 1e-7);
    EXPECT_LT(((ahead.slope - behind.slope) / (2 * step) - rate.slope).norm(),
              1e-6);

    VectorX sum = VectorX::Zero(2 + numbers.size());
    energy::add_by_spheroids(n, span(numbers), 0.7, way, sum, 2);
    EXPECT_NEAR(sum.tail(numbers.size()).dot(rates),
                0.7 * rate.value + way.dot(rate.slope),
                1e-12 * (1.0 + sum.norm()));
    EXPECT_EQ(sum[0], 0.0);
  }
}

films::FilmComplex drop_of(const films::DropShape& shape, int levels,
                           double volume) {
  films::FilmComplex complex =
      shapes::drop(shapes::sphere(1.0, levels), volume);
  complex.surfaces[0].drop_shape = shape;
  return complex;
}

TEST(DropShape, EnergiesOfFilmsMatchDifferences) {
  Random random(11);
  for (int k = 0; k < 6; ++k) {
    films::FilmComplex complex = drop_of(draw_shape(random, 1 + k % 3), 2, 3.0);
    if (k % 2 == 1) {
      complex.surfaces[0].tension_field = Expression::parse(
          "1.5 + 0.4*sin(x + 2*y) + 0.1*z^2", {"x", "y", "z"});
    }
    const energy::FilmEnergy energy(complex);
    const films::FilmTargets targets = energy::targets_of(complex);
    const Points& base = complex.mesh.points;
    Points way(base.size());
    for (Vec3& w : way) {
      w = 0.3 * draw_vector(random);
    }
    const auto moved = [&](double t) {
      Points points = base;
      for (std::size_t v = 0; v < points.size(); ++v) {
        points[v] += t * way[v];
      }
      return points;
    };
    const double step = 1e-4;
    const Points gradient = energy.gradient(base, targets);
    double slope = 0.0;
    for (std::size_t v = 0; v < base.size(); ++v) {
      slope += gradient[v].dot(way[v]);
    }
    const double here = energy.value(base, targets);
    const double up = energy.value(moved(step), targets);
    const double down = energy.value(moved(-step), targets);
    EXPECT_NEAR((up - down) / (2 * step), slope, 1e-6 * here);

    Points directions(energy.unknowns());
    for (int i = 0; i < energy.unknowns(); ++i) {
      directions[i] = way[energy.vertices()[i]];
    }
    SparseMatrix hessian = energy.pattern();
    energy.hessian(base, directions, targets,
                   VectorX::Zero(energy.functionals()), hessian);
    const VectorX ones = VectorX::Ones(energy.unknowns());
    const double curvature =
        ones.dot(hessian.selfadjointView<Eigen::Lower>() * ones);
    EXPECT_NEAR((up + down - 2 * here) / (step * step), curvature,
                1e-5 * std::abs(curvature));
  }
}

// A drop of volume V is the sum of the spheroids times (V/W)^(1/3), W the
// volume of that sum, and has 3 W^(1/3) V^(2/3) of energy: its flat facets
// have more, at second order.
TEST(DropShape, AFreeDropIsItsSpheroidWhereverThatPoints) {
  Random random(17);
  for (int k = 0; k < 4; ++k) {
    films::DropShape shape = draw_shape(random, 1);
    shape[0].across = shape[0].along * draw(random, 0.6, 1.6);
    const double whole = 4.0 / 3.0 * std::numbers::pi * shape[0].along *
                         shape[0].across * shape[0].across;
    const double volume = draw(random, 2.0, 20.0);
    const double tension = draw(random, 0.5, 2.0);
    const double exact = 3.0 * tension * std::cbrt(whole * volume * volume);
    std::vector<double> errors;
    std::vector<double> off;  // of the farthest points along directions
    for (const int levels : {2, 3, 4}) {
      films::FilmComplex complex = drop_of(shape, levels, volume);
      complex.surfaces[0].tension = tension;
      const settle::FilmState state = settle::find_equilibrium(complex, {});
      ASSERT_FALSE(state.failure) << state.report.verdict;
      EXPECT_EQ(state.report.index, 0);
      errors.push_back(state.report.energy / exact - 1.0);
      Vec3 middle = Vec3::Zero();
      for (const Vec3& p : state.points) {
        middle += p / static_cast<double>(state.points.size());
      }
      double worst = 0.0;
      for (int m = 0; m < 40; ++m) {
        const Vec3 d = draw_vector(random).normalized();
        double reach = 0.0;
        for (const Vec3& p : state.points) {
          reach = std::max(reach, (p - middle).dot(d));
        }
        worst = std::max(worst, std::abs(reach / std::cbrt(volume / whole) /
                                             support(shape, d) -
                                         1.0));
      }
      off.push_back(worst);
    }
    EXPECT_NEAR(std::log2(errors[0] / errors[1]), 2.0, 0.25);
    EXPECT_NEAR(std::log2(errors[1] / errors[2]), 2.0, 0.25);
    EXPECT_GT(errors[2], 0.0);
    EXPECT_LT(off[2], 0.01);
    EXPECT_LT(off[2], 0.5 * off[1]);
  }
}

/// The volume of a sum of spheroids, from the places where its surface has a
/// sphere's normals.
double volume_of(const films::DropShape& shape) {
  const VectorX numbers = numbers_of(shape);
  SurfaceMesh mesh = shapes::sphere(1.0, 6);
  for (Vec3& p : mesh.points) {
    p = energy::facet_size(p.normalized(), span(numbers)).slope;
  }
  return enclosed_volume(mesh);
}

TEST(DropShape, ABoxWithRoundEdgesIsTheSumOfThreeNeedles) {
  const films::DropShape shape = {{Vec3::UnitX(), 1.0, 0.3},
                                  {Vec3::UnitY(), 0.7, 0.3},
                                  {Vec3(0.2, 0.1, 1.0), 1.2, 0.2}};
  const double whole = volume_of(shape);
  films::FilmComplex complex = drop_of(shape, 4, whole);
  const settle::FilmState state = settle::find_equilibrium(complex, {});
  ASSERT_FALSE(state.failure) << state.report.verdict;
  EXPECT_NEAR(state.report.energy / (3.0 * whole), 1.0, 5e-3);
}

TEST(DropShape, RefusesWhatIsNoSpheroid) {
  EXPECT_EQ(films::what_is_wrong({}), "");
  EXPECT_EQ(films::what_is_wrong({{Vec3(0, 0, 9), 0.1, 2.0}}), "");
  const double inf = std::numeric_limits<double>::infinity();
  for (const films::Spheroid& part :
       {films::Spheroid{Vec3::Zero(), 1.0, 1.0},
        films::Spheroid{Vec3::UnitX(), 0.0, 1.0},
        films::Spheroid{Vec3::UnitX(), 1.0, -1.0},
        films::Spheroid{Vec3::UnitX(), inf, 1.0},
        films::Spheroid{Vec3(inf, 0, 1), 1.0, 1.0}}) {
    EXPECT_NE(films::what_is_wrong({{Vec3::UnitZ(), 1.0, 1.0}, part}), "");
  }
}

// Moving a drop changes nothing, turning it does unless all of its spheroids
// have one axis or are spheres.
TEST(DropShape, OnlyMotionsThatChangeNothingAreRigid) {
  const auto rigid = [](const films::DropShape& shape) {
    films::FilmComplex complex = drop_of(shape, 2, 4.0);
    for (Vec3& p : complex.mesh.points) {
      p = Vec3(p.x(), 1.3 * p.y(), 0.6 * p.z());  // turns of it are seen
    }
    const energy::FilmEnergy energy(complex);
    const Points& points = complex.mesh.points;
    return energy
        .rigid_motions(points, energy.space().directions(points),
                       energy.lumped_area(points))
        .cols();
  };
  EXPECT_EQ(rigid({}), 6);
  EXPECT_EQ(rigid({{Vec3(1, 1, 0), 1.0, 0.5}}), 4);
  EXPECT_EQ(rigid({{Vec3(1, 1, 0), 1.0, 0.5}, {Vec3(-2, -2, 0), 0.3, 2.0}}), 4);
  EXPECT_EQ(rigid({{Vec3::UnitX(), 1.0, 0.5}, {Vec3::UnitY(), 0.8, 0.4}}), 3);
  EXPECT_EQ(rigid({{Vec3::UnitX(), 0.8, 0.8}, {Vec3::UnitY(), 0.5, 0.5}}), 6);
}

}  // namespace
}  // namespace meniscus::drop_shape_test
