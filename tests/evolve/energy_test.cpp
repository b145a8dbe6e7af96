#include "evolve/energy.h"

#include <cmath>

#include <gtest/gtest.h>

#include "core/error.h"
#include "tests/evolve/film_shapes.h"

namespace meniscus {
namespace {

constexpr double kRounding = 1e-13;

/// A tube with caps that is nowhere symmetric, and directions that are not
/// its normals.
struct Skewed {
  FilmComplex complex;
  FilmEnergy energy;
  Points directions;
  FilmTargets targets;
  VectorX pressure;

  Skewed() : complex(make()), energy(complex), targets(targets_of(complex)) {
    for (int i = 0; i < energy.unknowns(); ++i) {
      directions.push_back(
          Vec3(std::sin(3.0 * i), std::cos(5.0 * i), std::sin(1.0 + 7.0 * i))
              .normalized());
    }
    pressure = VectorX::Constant(1, 0.7);
  }

  static FilmComplex make() {
    FilmComplex complex = shapes::tube(
        1.0, 1.5, 9, 5, [](double z) { return 1.0 + 0.2 * z + 0.1 * z * z; });
    shapes::close_tube(complex, 9);
    for (Vec3& p : complex.mesh.points) {
      p += Vec3(0.1 * p.y() * p.z(), 0.2 * p.x(), 0.05 * p.x() * p.y());
    }
    return complex;
  }

  double total(const VectorX& h) const {
    const Points moved = energy.moved(complex.mesh.points, directions, h);
    return energy.value(moved, targets.tension) -
           pressure.dot(energy.volumes(moved));
  }

  VectorX slope(const VectorX& h) const {
    const Points moved = energy.moved(complex.mesh.points, directions, h);
    const Eigen::MatrixX3d rows =
        energy.gradient(moved, targets.tension) -
        pressure[0] * energy.volume_gradient(moved, 0);
    VectorX result(rows.rows());
    for (Eigen::Index i = 0; i < rows.rows(); ++i) {
      result[i] = rows.row(i).dot(directions[i]);
    }
    return result;
  }
};

TEST(FilmEnergy, AreaAndVolumeAreThoseOfTheSurface) {
  const SurfaceMesh box = shapes::box(Vec3(1, 2, 3), 3);
  const FilmComplex complex = shapes::drop(box, 6.0);
  const FilmEnergy energy(complex);
  EXPECT_NEAR(energy.value(box.points, {2.0}), 44.0, 44 * kRounding);
  EXPECT_NEAR(energy.volumes(box.points)[0], 6.0, 6 * kRounding);
  EXPECT_EQ(energy.floating_count(), 1);
}

// Central differences fall at second order until rounding takes over: the
// least error over a sweep of steps must be small, and a 10x smaller step
// must gain about 100x where the formula's error rules.
TEST(FilmEnergy, DerivativesMatchDifferencesOverASweepOfSteps) {
  const Skewed film;
  const int n = film.energy.unknowns();
  VectorX along(n);
  for (int i = 0; i < n; ++i) {
    along[i] = std::cos(2.0 * i);
  }
  const VectorX zero = VectorX::Zero(n);
  SparseMatrix hessian = film.energy.pattern();
  film.energy.hessian(film.complex.mesh.points, film.directions,
                      film.targets.tension, film.pressure, hessian);
  const VectorX curvature = hessian.selfadjointView<Eigen::Lower>() * along;
  const double slope = film.slope(zero).dot(along);
  const double size = film.slope(zero).norm();
  std::vector<double> gradient_error;
  std::vector<double> hessian_error;
  for (const double step : {1e-2, 1e-3, 1e-4, 1e-5, 1e-6}) {
    const double d =
        (film.total(step * along) - film.total(-step * along)) / (2 * step);
    gradient_error.push_back(std::abs(d - slope) / size);
    const VectorX dd =
        (film.slope(step * along) - film.slope(-step * along)) / (2 * step);
    hessian_error.push_back((dd - curvature).norm() / curvature.norm());
  }
  EXPECT_NEAR(std::log10(gradient_error[0] / gradient_error[1]), 2.0, 0.3);
  EXPECT_NEAR(std::log10(hessian_error[0] / hessian_error[1]), 2.0, 0.3);
  EXPECT_LT(*std::min_element(gradient_error.begin(), gradient_error.end()),
            1e-9);
  EXPECT_LT(*std::min_element(hessian_error.begin(), hessian_error.end()),
            1e-9);
}

TEST(FilmEnergy, NormalsOfASphereAreRadial) {
  const SurfaceMesh sphere = shapes::sphere(2.0, 3);
  const FilmEnergy energy(shapes::drop(sphere, 1.0));
  const Points normals = energy.normals(sphere.points);
  for (int i = 0; i < energy.unknowns(); ++i) {
    EXPECT_GT(normals[i].dot(sphere.points[energy.vertices()[i]]), 1.999);
  }
  EXPECT_NEAR(energy.lumped_area(sphere.points).sum(),
              energy.area(sphere.points), 50 * kRounding);
}

TEST(FilmEnergy, RefusesCornersOutOfRange) {
  FilmComplex complex = shapes::drop(shapes::sphere(1.0, 0), 1.0);
  complex.mesh.facets[3][1] = 99;
  EXPECT_THROW(FilmEnergy{complex}, MeshError);
}

}  // namespace
}  // namespace meniscus
