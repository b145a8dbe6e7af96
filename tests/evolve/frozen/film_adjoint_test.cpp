// The pieces of the film's adjoint, each against differences or as a
// transposed product.
#include "evolve/frozen/film_adjoint.h"

#include <cmath>

#include <Eigen/Dense>
#include <gtest/gtest.h>

#include "core/error.h"
#include "evolve/frozen/carry.h"
#include "evolve/settle/equilibrium.h"
#include "tests/support/film_shapes.h"

namespace meniscus::film_adjoint_test {
namespace {

constexpr double kRounding = 1e-12;   // relative, of sums of products
constexpr double kStep = 1e-5;        // of lengths of order 1
constexpr double kDifference = 1e-9;  // what central differences then leave

double wave(std::size_t i) { return std::sin(1.3 * static_cast<double>(i)); }

Points waves(std::size_t count, std::size_t seed) {
  Points result;
  for (std::size_t i = 0; i < count; ++i) {
    const std::size_t at = 3 * i + seed;
    result.emplace_back(wave(at), wave(at + 1), wave(at + 2));
  }
  return result;
}

Points shifted(const Points& x, const Points& d, double step) {
  Points result = x;
  flat(result) += step * flat(d);
  return result;
}

/// A capped tube, nowhere symmetric, whose waist carries a disk: three films
/// along a line of free vertices.
films::FilmComplex tube_with_disk() {
  constexpr int kAround = 8;
  constexpr int kRows = 4;
  films::FilmComplex complex = shapes::tube(
      1.0, 1.0, kAround, kRows, [](double z) { return 0.9 + 0.3 * z * z; });
  shapes::close_tube(complex, kAround);
  complex.mesh.labels.emplace_back("disk");
  complex.surfaces.push_back({"disk", true, 1.2});
  const auto center = static_cast<int>(complex.mesh.points.size());
  complex.mesh.points.emplace_back(0, 0, 0);
  complex.vertices.emplace_back();
  const int first = kAround * kRows / 2;
  for (int i = 0; i < kAround; ++i) {
    complex.mesh.facets.push_back(
        {center, first + i, first + (i + 1) % kAround});
    complex.mesh.facet_label.push_back(3);
  }
  for (Vec3& p : complex.mesh.points) {
    p += Vec3(0.04 * p.y() * p.z(), 0.06 * p.x(), 0.05 * p.x() * p.y());
  }
  return complex;
}

struct Film {
  films::FilmComplex complex = tube_with_disk();
  energy::FilmEnergy energy{complex};
  films::FilmTargets targets = energy::targets_of(complex);
  const Points& x = complex.mesh.points;
};

TEST(FilmAdjoint, DirectionsAreTransposedThroughNormalsAndLines) {
  const Film film;
  const energy::FilmSpace& space = film.energy.space();
  bool lines = false;
  for (int v = 0; v < space.vertex_count(); ++v) {
    lines = lines || space.rank(v) == 2;
  }
  EXPECT_TRUE(lines);
  const Points by = waves(static_cast<std::size_t>(film.energy.unknowns()), 5);
  const Points d = waves(film.x.size(), 1);
  Points sum(film.x.size(), Vec3::Zero());
  space.transpose_directions(film.x, by, sum);
  const Points up = space.directions(shifted(film.x, d, kStep));
  const Points down = space.directions(shifted(film.x, d, -kStep));
  const double difference =
      (flat(up) - flat(down)).dot(flat(by)) / (2.0 * kStep);
  EXPECT_NEAR(flat(sum).dot(flat(d)), difference,
              kDifference * flat(sum).norm() * flat(d).norm());
}

TEST(FilmAdjoint, ProductsAreDifferencesOfGradients) {
  Film film;
  film.complex.surfaces[0].tension_field =
      Expression::parse("1+0.3*sin(x)+0.2*y*z", {"x", "y", "z"});
  films::FilmQuantity flux{"flux", films::FilmQuantity::Role::Energy,
                           films::FilmQuantity::Kind::VectorIntegral};
  for (int k = 0; k < 3; ++k) {
    flux.field[k] = Expression::parse("x*y+z^2", {"x", "y", "z"});
  }
  film.complex.quantities = {flux};
  const energy::FilmEnergy energy(film.complex);
  const films::FilmTargets targets = energy::targets_of(film.complex);
  const VectorX pressure = VectorX::Constant(energy.functionals(), 0.7);
  const energy::FilmProducts products(energy, targets, pressure);
  const Points d = waves(film.x.size(), 2);
  const auto slope = [&](double step) {
    const Points x = shifted(film.x, d, step);
    const Points of_volume = energy.functional_gradient(x, 0);
    return VectorX(flat(energy.gradient(x, targets)) -
                   pressure[0] * flat(of_volume));
  };
  const VectorX difference = (slope(kStep) - slope(-kStep)) / (2.0 * kStep);
  const Points product = products.hessian_times(film.x, d);
  EXPECT_LT((flat(product) - difference).norm(),
            kDifference * difference.norm());
  const VectorX rates = products.area_rates(film.x, d);
  const VectorX grown = (energy.areas(shifted(film.x, d, kStep)) -
                         energy.areas(shifted(film.x, d, -kStep))) /
                        (2.0 * kStep);
  EXPECT_LT((rates - grown).norm(), kDifference * energy.areas(film.x).norm());
}

TEST(FilmAdjoint, CarryIsTransposed) {
  const Film film;
  const frozen::Carry carry(film.complex, {}, film.energy.vertex_order());
  Points moves = waves(film.x.size(), 3);
  for (std::size_t v = 0; v < moves.size(); ++v) {
    if (film.complex.vertices[v].kind != films::VertexKind::OnCurve) {
      moves[v].setZero();
    }
  }
  const Points by = waves(film.x.size(), 4);
  const double there =
      (flat(carry.at(moves, 1.0)) - flat(film.x)).dot(flat(by));
  EXPECT_NEAR(flat(carry.transpose(by)).dot(flat(moves)), there,
              kRounding * flat(by).norm() * flat(moves).norm());
}

/// With a field, whose third derivatives are differences themselves.
TEST(FilmAdjoint, ThirdDerivativesAreDifferencesOfProducts) {
  Film film;
  films::FilmQuantity flux{"flux", films::FilmQuantity::Role::Energy,
                           films::FilmQuantity::Kind::VectorIntegral};
  for (int k = 0; k < 3; ++k) {
    flux.field[k] = Expression::parse("sin(x*y)+z^3", {"x", "y", "z"});
  }
  for (const bool with_field : {false, true}) {
    if (with_field) {
      film.complex.quantities = {flux};
    }
    const energy::FilmEnergy energy(film.complex);
    const VectorX pressure = VectorX::Constant(energy.functionals(), 0.7);
    const energy::FilmProducts products(energy, film.targets, pressure);
    const Points d = waves(film.x.size(), 2);
    const Points to = waves(film.x.size(), 8);
    const auto bend = [&](double step) {
      const Points x = shifted(film.x, to, step);
      return flat(products.hessian_times(x, d)).dot(flat(d));
    };
    const double difference = (bend(kStep) - bend(-kStep)) / (2.0 * kStep);
    const Points third = products.third_times(film.x, d);
    EXPECT_NEAR(flat(third).dot(flat(to)), difference,
                kDifference * flat(third).norm() * flat(to).norm());
    const auto rate = [&](double step) {
      return products.area_rates(shifted(film.x, d, step), d);
    };
    const VectorX curve = (rate(kStep) - rate(-kStep)) / (2.0 * kStep);
    EXPECT_LT((products.area_curvatures(film.x, d) - curve).norm(),
              kDifference * curve.norm());
    const VectorX weight = VectorX::LinSpaced(energy.unknowns(), 0.0, 1.0);
    const double grown =
        weight.dot(energy.lumped_area(shifted(film.x, d, kStep)) -
                   energy.lumped_area(shifted(film.x, d, -kStep))) /
        (2.0 * kStep);
    EXPECT_NEAR(flat(products.metric_gradient(film.x, weight)).dot(flat(d)),
                grown, kDifference * weight.norm());
  }
}

/// At rest from `base`, along its own normals.
settle::FilmState rest(const Film& film, const Points& base) {
  settle::FilmState state =
      settle::settle_along(film.energy, film.complex, film.targets, base,
                           film.energy.space().directions(base), {}, 0.0, {});
  EXPECT_FALSE(state.failure) << state.report.verdict;
  return state;
}

// Three films at 120 degrees, their line free, with a volume held.
TEST(FilmAdjoint, OfFilmsThatMeetAlongAFreeLine) {
  Film film;
  film.targets.bodies[0].volume = film.energy.volumes(film.x)[0];
  const settle::FilmState at_rest = rest(film, film.x);
  const energy::FilmPaths paths = film.energy.space().paths(
      film.x, film.energy.space().directions(film.x), at_rest.heights);
  const VectorX pressure =
      VectorX::Constant(1, at_rest.report.bodies[0].pressure);
  const frozen::FilmAdjoint adjoint(film.energy, film.targets, film.x, paths,
                                    at_rest.points, at_rest.heights, pressure);
  frozen::FilmCovector by;
  by.points = waves(film.x.size(), 6);
  by.pressures = VectorX::Constant(1, 0.8);
  const frozen::FilmAdjoint::Result gradient = adjoint.transpose(by);
  const auto j = [&](const settle::FilmState& state) {
    return flat(by.points).dot(flat(state.points)) +
           by.pressures[0] * state.report.bodies[0].pressure;
  };
  const Points d = waves(film.x.size(), 7);
  const double slope = (j(rest(film, shifted(film.x, d, kStep))) -
                        j(rest(film, shifted(film.x, d, -kStep)))) /
                       (2.0 * kStep);
  // Settled films lose a few figures more than formulas.
  constexpr double kSettled = 1e-7;
  EXPECT_NEAR(flat(gradient.base).dot(flat(d)), slope,
              kSettled * flat(gradient.base).norm() * flat(d).norm());
  for (const int s : {0, 3}) {
    double& tension = film.targets.tension[static_cast<std::size_t>(s)];
    const double usual = tension;
    tension = usual + kStep;
    const double up = j(rest(film, film.x));
    tension = usual - kStep;
    const double down = j(rest(film, film.x));
    tension = usual;
    EXPECT_NEAR(gradient.tensions[s], (up - down) / (2.0 * kStep),
                kSettled * gradient.tensions.norm());
  }
}

// A round tube's modes come in pairs; the volume takes one more away.
TEST(LowestModes, AreThoseOfTheDenseProblem) {
  constexpr int kModes = 6;
  films::FilmComplex complex =
      shapes::tube(1.0, 1.0, 8, 6, [](double) { return 1.0; });
  shapes::close_tube(complex, 8);
  complex.bodies[0].volume = 3.0;
  const energy::FilmEnergy energy(complex);
  const films::FilmTargets targets = energy::targets_of(complex);
  const Points& x = complex.mesh.points;
  const energy::SaddleSystem saddle(energy, targets, x,
                                    {energy.space().directions(x), {}, {}},
                                    VectorX::Constant(1, 0.5));
  ASSERT_TRUE(saddle.factored());
  ASSERT_EQ(saddle.system().index(), 0);
  const energy::LowestModes found =
      saddle.system().lowest_modes(saddle.metric(), kModes);
  const Eigen::HouseholderQR<Eigen::MatrixXd> qr(saddle.constraints());
  const Eigen::Index n = energy.unknowns();
  const Eigen::MatrixXd q = qr.householderQ();
  const Eigen::MatrixXd kernel = q.rightCols(n - 1);
  const Eigen::MatrixXd lower = saddle.hessian();
  const Eigen::MatrixXd hessian = lower.selfadjointView<Eigen::Lower>();
  const Eigen::GeneralizedSelfAdjointEigenSolver<Eigen::MatrixXd> dense(
      kernel.transpose() * hessian * kernel,
      kernel.transpose() * saddle.metric().asDiagonal() * kernel);
  const VectorX expected = dense.eigenvalues().head(kModes);
  ASSERT_EQ(found.eigenvalues.size(), kModes);
  EXPECT_LT((found.eigenvalues - expected).norm(), kRounding * expected.norm());
  const Eigen::MatrixXd mass =
      found.modes.transpose() * saddle.metric().asDiagonal() * found.modes;
  EXPECT_LT((mass - Eigen::MatrixXd::Identity(kModes, kModes)).norm(),
            kRounding);
  EXPECT_LT((saddle.constraints().transpose() * found.modes).norm(), kRounding);
  // All there are, when more are asked for.
  EXPECT_EQ(saddle.system().lowest_modes(saddle.metric(), 1000).modes.cols(),
            n - 1);
}

// Next to collapse one eigenvalue is nothing beside the others: solves know
// these to no more digits than that one leaves, and that is enough.
TEST(LowestModes, AreFoundBesideOneThatIsNearlyNothing) {
  constexpr int kSize = 3000;
  constexpr double kNothing = 1e-9;
  SparseMatrix hessian(kSize, kSize);
  std::vector<int> order;
  for (int i = 0; i < kSize; ++i) {
    hessian.insert(i, i) = i == 0 ? kNothing : static_cast<double>(i);
    order.push_back(i);
  }
  hessian.makeCompressed();
  energy::ConstrainedHessian system(hessian, order);
  const VectorX metric = VectorX::Ones(kSize);
  ASSERT_TRUE(
      system.factorize(hessian, metric, 0.0, Eigen::MatrixXd(kSize, 0)));
  const energy::LowestModes found = system.lowest_modes(metric, 4);
  ASSERT_EQ(found.eigenvalues.size(), 4);
  EXPECT_NEAR(found.eigenvalues[0] / kNothing, 1.0, 1e-6);
  for (int k = 1; k < 4; ++k) {
    EXPECT_NEAR(found.eigenvalues[k], k, 1e-6);
  }
}

}  // namespace
}  // namespace meniscus::film_adjoint_test
