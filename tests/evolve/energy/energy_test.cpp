#include "evolve/energy/energy.h"

#include <algorithm>
#include <cmath>

#include <gtest/gtest.h>

#include "core/error.h"
#include "tests/support/film_shapes.h"

namespace meniscus::energy_test {
namespace {

constexpr double kRounding = 1e-13;

Expression over(const std::string& text) {
  return Expression::parse(text, {"x", "y", "z"});
}

/// A tube with caps that is nowhere symmetric.
films::FilmComplex skewed_tube() {
  films::FilmComplex complex = shapes::tube(
      1.0, 1.5, 9, 5, [](double z) { return 1.0 + 0.2 * z + 0.1 * z * z; });
  shapes::close_tube(complex, 9);
  for (Vec3& p : complex.mesh.points) {
    p += Vec3(0.1 * p.y() * p.z(), 0.2 * p.x(), 0.05 * p.x() * p.y());
  }
  return complex;
}

/// The tube without its lid, its top rim on a ball and its bottom rim sliding
/// on a curve, with every term that a film can carry.
films::FilmComplex loaded_tube() {
  films::FilmComplex complex = skewed_tube();
  complex.surfaces[0].tension_field = over("1 + 0.3*sin(x) + y*z");
  complex.gravity = Vec3(0.3, -0.2, -1.0);
  complex.bodies[0].density = 0.8;
  complex.volume_rule = films::VolumeRule::Column;
  std::erase_if(complex.bodies[0].sides,
                [](const films::BodySide& side) { return side.surface == 2; });
  complex.level_sets = {{"ball", over("x^2 + y^2 + z^2 - 2"), {}}};
  complex.constraint_sets = {{0}};
  complex.integrals = {{"contact",
                        films::LineIntegral::Role::Energy,
                        {over("0.3*y*z"), over("x^2"), over("sin(x)")}},
                       {"content",
                        films::LineIntegral::Role::Content,
                        {over("0"), over("x*z"), over("0.1*y")}}};
  complex.integral_sets = {{0, 1}};
  complex.curves.push_back(
      {"slide", curves::Ellipse{Vec3(0, 0, -0.8), Vec3(0, 0.1, 1),
                                Vec3(1, 0.2, 0), 1.1, 0.9}});
  std::vector<int> top;
  for (std::size_t v = 0; v < complex.vertices.size(); ++v) {
    films::ComplexVertex& vertex = complex.vertices[v];
    if (vertex.kind == films::VertexKind::OnCurve && vertex.curve == 1) {
      vertex = {films::VertexKind::Free, -1, 0.0, 0};
      top.push_back(static_cast<int>(v));
    } else if (vertex.kind == films::VertexKind::OnCurve) {
      vertex.kind = films::VertexKind::Slides;
      vertex.curve = 2;
      vertex.t += 0.01;
    }
  }
  for (std::size_t i = 0; i < top.size(); ++i) {
    films::ComplexEdge edge;
    edge.a = top[i];
    edge.b = top[(i + 1) % top.size()];
    edge.constraints = 0;
    edge.integrals = 0;
    complex.edges.push_back(edge);
  }
  films::FilmQuantity flux{"flux", films::FilmQuantity::Role::Energy,
                           films::FilmQuantity::Kind::VectorIntegral};
  flux.field = {over("y*z"), over("x*x*z"), over("cos(x)")};
  flux.modulus = 0.4;
  films::FilmQuantity scalar{"scalar", films::FilmQuantity::Role::Held,
                             films::FilmQuantity::Kind::ScalarIntegral};
  scalar.scalar = over("x*y + z^2");
  complex.quantities = {flux, scalar};
  return complex;
}

struct Loaded {
  films::FilmComplex complex;
  energy::FilmEnergy energy;
  Points base;
  Points directions;
  films::FilmTargets targets;
  VectorX pressure;

  explicit Loaded(films::FilmComplex made)
      : complex(std::move(made)),
        energy(complex),
        base(complex.mesh.points),
        targets(energy::targets_of(complex)) {
    energy.space().project(base);
    pressure = VectorX::Constant(energy.functionals(), 0.7);
    directions = energy.space().directions(base);
    for (int i = 0; i < energy.unknowns(); ++i) {
      const int v = energy.vertices()[i];
      if (complex.vertices[v].kind == films::VertexKind::Free &&
          complex.vertices[v].constraints < 0) {
        directions[i] =
            Vec3(std::sin(3.0 * i), std::cos(5.0 * i), std::sin(1.0 + 7.0 * i))
                .normalized();
      }
    }
  }

  double total(const VectorX& h) const {
    const Points moved = energy.space().moved(base, directions, h);
    return energy.value(moved, targets) - pressure.dot(energy.volumes(moved));
  }

  VectorX slope() const {
    Points g = energy.gradient(base, targets);
    for (int b = 0; b < energy.functionals(); ++b) {
      const Points more = energy.functional_gradient(base, b);
      for (std::size_t v = 0; v < g.size(); ++v) {
        g[v] -= pressure[b] * more[v];
      }
    }
    VectorX result(energy.unknowns());
    for (int i = 0; i < energy.unknowns(); ++i) {
      result[i] = g[energy.vertices()[i]].dot(directions[i]);
    }
    return result;
  }
};

TEST(FilmEnergy, AreaAndVolumeAreThoseOfTheSurface) {
  const SurfaceMesh box = shapes::box(Vec3(1, 2, 3), 3);
  films::FilmComplex complex = shapes::drop(box, 6.0);
  complex.surfaces[0].tension = 2.0;
  const energy::FilmEnergy energy(complex);
  EXPECT_NEAR(energy.value(box.points, energy::targets_of(complex)), 44.0,
              44 * kRounding);
  EXPECT_NEAR(energy.volumes(box.points)[0], 6.0, 6 * kRounding);
}

// Central differences fall at second order until rounding takes over: a 10x
// smaller step gains about 100x where the formula's error rules, and the least
// error over a sweep of steps is small. Along walls h moves vertices on the
// wall, so the second differences see the walls' bending too.
void check_derivatives(const Loaded& film) {
  const int n = film.energy.unknowns();
  VectorX along(n);
  for (int i = 0; i < n; ++i) {
    along[i] = std::cos(2.0 * i);
  }
  const VectorX zero = VectorX::Zero(n);
  SparseMatrix hessian = film.energy.pattern();
  film.energy.hessian(film.base, film.directions, film.targets, film.pressure,
                      hessian);
  const double curvature =
      along.dot(hessian.selfadjointView<Eigen::Lower>() * along);
  const double slope = film.slope().dot(along);
  const double size = film.slope().norm();
  std::vector<double> gradient_error;
  std::vector<double> hessian_error;
  for (const double step : {1e-1, 1e-2, 1e-3, 1e-4, 1e-5}) {
    const double up = film.total(step * along);
    const double down = film.total(-step * along);
    gradient_error.push_back(std::abs((up - down) / (2 * step) - slope) / size);
    hessian_error.push_back(
        std::abs((up + down - 2 * film.total(zero)) / (step * step) -
                 curvature) /
        std::abs(curvature));
  }
  EXPECT_NEAR(std::log10(gradient_error[1] / gradient_error[2]), 2.0, 0.3);
  EXPECT_NEAR(std::log10(hessian_error[1] / hessian_error[2]), 2.0, 0.3);
  EXPECT_LT(*std::min_element(gradient_error.begin(), gradient_error.end()),
            1e-9);
  EXPECT_LT(*std::min_element(hessian_error.begin(), hessian_error.end()),
            1e-7);
}

// Line integrals that close such a body count on cones to the origin itself.
TEST(FilmEnergy, ConesOfOpenBodiesStandOnTheOrigin) {
  films::FilmComplex complex;
  complex.mesh.points = {{1, 0, 0}, {0, 2, 0}, {0, 0, 3}};
  complex.mesh.facets = {{0, 1, 2}};
  complex.mesh.facet_label = {0};
  complex.mesh.labels = {"film"};
  complex.vertices.resize(3);
  complex.surfaces.resize(1);
  complex.bodies.resize(1);
  complex.bodies[0].sides = {{0, 1}};
  complex.volume_rule = films::VolumeRule::Cone;
  const energy::FilmEnergy energy(complex);
  const Points& x = complex.mesh.points;
  EXPECT_NEAR(energy.volumes(x)[0], 1.0, kRounding);
  EXPECT_NEAR(energy.functional_gradient(x, 0)[0].x(), 1.0, kRounding);
}

TEST(FilmEnergy, DerivativesMatchDifferencesOverASweepOfSteps) {
  check_derivatives(Loaded(skewed_tube()));
}

TEST(FilmEnergy, DerivativesOfEveryTermAndWallMatchDifferences) {
  check_derivatives(Loaded(loaded_tube()));
}

TEST(FilmEnergy, NormalsOfASphereAreRadial) {
  const SurfaceMesh sphere = shapes::sphere(2.0, 3);
  const energy::FilmEnergy energy(shapes::drop(sphere, 1.0));
  const Points normals = energy.space().directions(sphere.points);
  for (int i = 0; i < energy.unknowns(); ++i) {
    EXPECT_GT(normals[i].dot(sphere.points[energy.vertices()[i]]), 1.999);
  }
  EXPECT_NEAR(energy.lumped_area(sphere.points).sum(),
              energy.area(sphere.points), 50 * kRounding);
}

TEST(FilmEnergy, RefusesCornersOutOfRange) {
  films::FilmComplex complex = shapes::drop(shapes::sphere(1.0, 0), 1.0);
  complex.mesh.facets[3][1] = 99;
  EXPECT_THROW(energy::FilmEnergy{complex}, MeshError);
}

}  // namespace
}  // namespace meniscus::energy_test
