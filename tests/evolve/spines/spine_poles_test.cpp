// Poles of spines: what they press with, and their derivatives.
#include "evolve/spines/spine_poles.h"

#include <cmath>
#include <numbers>
#include <random>

#include <gtest/gtest.h>

#include "core/error.h"
#include "evolve/energy/pole_field.h"

namespace meniscus::spine_poles_test {
namespace {

using energy::JetOrder;

Numbers span_of(const VectorX& v) {
  return {v.data(), static_cast<std::size_t>(v.size())};
}

/// The pressure at a place: the divergence of the poles' flux.
double pressure(const VectorX& numbers, const Vec3& at) {
  return energy::pole_field(span_of(numbers), at, JetOrder::Gradient)
      .slope.trace();
}

films::SpineSpec straight(double length, double radius) {
  films::SpineSpec spine{.name = "arm", .body = "part"};
  spine.points = {Vec3(1, 2, 3), Vec3(1, 2, 3) + length * Vec3(0.6, 0, 0.8)};
  spine.radii = {radius, radius};
  spine.tension = 2.5;
  return spine;
}

TEST(SpinePoles, ATubeRestsAtTheRadiusUpToItsRims) {
  const films::SpineSpec spine = straight(40.0, 2.0);
  const auto sampling = spines::sample_spine(spine, 0, {true, true});
  const VectorX numbers =
      energy::pole_numbers(spines::poles_of(sampling, spine));
  const Vec3 way = Vec3(0.6, 0, 0.8);
  for (const double along : {0.0, 0.7, 10.0, 20.0, 33.3, 40.0}) {
    double mean = 0.0;
    for (int k = 0; k < 8; ++k) {
      const double a = 2.0 * std::numbers::pi * k / 8.0;
      const Vec3 out =
          std::cos(a) * Vec3(0.8, 0, -0.6) + std::sin(a) * Vec3::UnitY();
      mean +=
          pressure(numbers, spine.points[0] + along * way + 2.0 * out) / 8.0;
    }
    EXPECT_NEAR(mean, 2.5 / 2.0,
                (along > 8.0 && along < 32.0 ? 2e-3 : 1e-2) * 1.25)
        << along;
  }
}

TEST(SpinePoles, AreStableForEveryWavelength) {
  // - R^2 phi'(R) / T = 4 R^2 / (R^2 + e^2): above 1.
  const films::SpineSpec spine = straight(80.0, 2.0);
  const VectorX numbers = energy::pole_numbers(
      spines::poles_of(spines::sample_spine(spine, 0, {true, true}), spine));
  const Vec3 middle = 0.5 * (spine.points[0] + spine.points[1]);
  const double h = 1e-4;
  const double slope = (pressure(numbers, middle + (2.0 + h) * Vec3::UnitY()) -
                        pressure(numbers, middle + (2.0 - h) * Vec3::UnitY())) /
                       (2.0 * h);
  EXPECT_NEAR(-slope * 4.0 / 2.5, 4.0 / 1.49, 5e-3);
}

/// Bent spines with radii that change, of random points.
films::SpineSpec random_spine(std::mt19937& engine, int count, bool smooth) {
  std::uniform_real_distribution<double> unit(-1.0, 1.0);
  films::SpineSpec spine{.name = "arm", .body = "part", .smooth = smooth};
  for (int k = 0; k < count; ++k) {
    spine.points.emplace_back(3.0 * k + unit(engine), 2.0 * unit(engine),
                              2.0 * unit(engine));
    spine.radii.push_back(1.0 + 0.4 * unit(engine));
  }
  spine.tension = 1.5 + unit(engine);
  return spine;
}

films::SpineSpec moved(const films::SpineSpec& spine,
                       const films::SpineSpec& rates, double t) {
  films::SpineSpec result = spine;
  for (std::size_t k = 0; k < spine.points.size(); ++k) {
    result.points[k] += t * rates.points[k];
    result.radii[k] += t * rates.radii[k];
  }
  result.tension += t * rates.tension;
  return result;
}

TEST(SpinePoles, RatesAgreeWithDifferences) {
  std::mt19937 engine(20260728);
  for (int trial = 0; trial < 20; ++trial) {
    const bool smooth = trial % 2 == 0;
    const int count = 2 + trial % 4;
    const films::SpineSpec spine = random_spine(engine, count, smooth);
    const films::SpineSpec rates = random_spine(engine, count, smooth);
    const auto sampling =
        spines::sample_spine(spine, 0, {trial % 3 == 0, trial % 3 != 1});
    const double h = 1e-5;
    const VectorX up = energy::pole_numbers(
        spines::poles_of(sampling, moved(spine, rates, h)));
    const VectorX down = energy::pole_numbers(
        spines::poles_of(sampling, moved(spine, rates, -h)));
    const VectorX rate =
        energy::pole_rate_numbers(spines::pole_rates(sampling, spine, rates));
    EXPECT_LT(((up - down) / (2.0 * h) - rate).norm(), 1e-7 * rate.norm())
        << trial;
  }
}

TEST(SpinePoles, FluxAgreesWithItsOwnDifferences) {
  std::mt19937 engine(7);
  std::normal_distribution<double> normal;
  for (int trial = 0; trial < 20; ++trial) {
    const films::SpineSpec spine = random_spine(engine, 4, true);
    const auto poles =
        spines::poles_of(spines::sample_spine(spine, 0, {false, true}), spine);
    const VectorX numbers = energy::pole_numbers(poles);
    const Vec3 at(4.0 + 4.0 * normal(engine), normal(engine), normal(engine));
    const auto field = [&](const Vec3& x) {
      return energy::pole_field(span_of(numbers), x, JetOrder::Hessian);
    };
    const energy::FieldJet jet = field(at);
    // Its divergence is the poles' own sum.
    double phi = 0.0;
    for (const films::Pole& pole : poles) {
      phi += pole.strength *
             std::pow((at - pole.at).squaredNorm() + pole.core2, -2.5);
    }
    EXPECT_NEAR(jet.slope.trace(), phi, 1e-11 * phi);
    const double h = 1e-5;
    for (int k = 0; k < 3; ++k) {
      const auto up = field(at + h * Vec3::Unit(k));
      const auto down = field(at - h * Vec3::Unit(k));
      EXPECT_LT(((up.value - down.value) / (2 * h) - jet.slope.col(k)).norm(),
                1e-7 * jet.slope.norm());
      for (int m = 0; m < 3; ++m) {
        EXPECT_LT(((up.slope.row(m) - down.slope.row(m)) / (2 * h) -
                   jet.bend[m].col(k).transpose())
                      .norm(),
                  1e-6 * (jet.bend[0].norm() + jet.bend[1].norm()));
      }
    }
  }
}

TEST(SpinePoles, TermsKnowTheirNumbers) {
  std::mt19937 engine(11);
  std::normal_distribution<double> normal;
  const auto draw = [&] {
    return Vec3(normal(engine), normal(engine), normal(engine));
  };
  for (int trial = 0; trial < 10; ++trial) {
    const films::SpineSpec spine = random_spine(engine, 3, true);
    const auto sampling = spines::sample_spine(spine, 0, {true, false});
    const std::vector<films::Pole> poles = spines::poles_of(sampling, spine);
    const VectorX numbers = energy::pole_numbers(poles);
    VectorX rates = VectorX::Zero(numbers.size());
    for (Eigen::Index k = 0; k < rates.size(); ++k) {
      rates[k] = normal(engine);
    }
    // Facets of all sizes, so that every rule has poles.
    const double size = std::pow(10.0, -(trial % 3));
    const Vec3 middle = draw();
    const energy::FilmTerm::Corners corner = {
        middle + size * draw(), middle + size * draw(), middle + size * draw()};
    const energy::FilmTerm::Corners motion = {draw(), draw(), draw()};
    Eigen::Matrix<double, 9, 1> d;
    d << motion[0], motion[1], motion[2];
    const energy::FilmTerm::Element element{0, -0.7, 0};
    SurfaceMesh mesh;
    mesh.points = {corner[0], corner[1], corner[2]};
    mesh.facets = {{0, 1, 2}};
    const auto term = energy::pole_term(mesh, poles, {element});
    const auto jet = [&](double t) {
      const VectorX now = numbers + t * rates;
      return term->jet(element, corner, JetOrder::Gradient, span_of(now));
    };
    const double h = 1e-5;
    const Eigen::Matrix<double, 9, 1> difference =
        (jet(h).gradient - jet(-h).gradient) / (2.0 * h);
    const auto forwards =
        term->gradient_rate(element, corner, span_of(numbers), span_of(rates));
    EXPECT_LT((forwards - difference).norm(), 1e-6 * difference.norm());
    VectorX backwards = VectorX::Zero(numbers.size());
    term->add_by_numbers(element, corner, motion, 1.0, span_of(numbers),
                         backwards);
    EXPECT_NEAR(backwards.dot(rates), forwards.dot(d),
                1e-11 * backwards.norm() * rates.norm());
    VectorX by_value = VectorX::Zero(numbers.size());
    term->add_value_by_numbers(element, corner, 1.0, span_of(numbers),
                               by_value);
    EXPECT_NEAR(by_value.dot(rates), (jet(h).value - jet(-h).value) / (2.0 * h),
                1e-6 * by_value.norm() * rates.norm());
  }
}

TEST(SpinePoles, RefuseWhatIsNoSpine) {
  const films::SpineSpec good = straight(10.0, 1.0);
  const auto refused = [&](const auto& spoil, const std::string& why) {
    films::SpineSpec spine = good;
    spoil(spine);
    try {
      spines::sample_spine(spine, 0, {true, true});
      ADD_FAILURE() << why;
    } catch (const InvalidInput& error) {
      EXPECT_NE(std::string(error.what()).find("spine 'arm'"),
                std::string::npos);
      EXPECT_NE(std::string(error.what()).find(why), std::string::npos)
          << error.what();
    }
  };
  refused([](auto& s) { s.points.pop_back(); }, "two points");
  refused([](auto& s) { s.radii.pop_back(); }, "1 radii for 2 points");
  refused([](auto& s) { s.radii[1] = 0.0; }, "radius 2 is 0");
  refused([](auto& s) { s.points[1] = s.points[0]; }, "coincide");
  refused([](auto& s) { s.points[1].x() = std::nan(""); }, "not finite");
  refused([](auto& s) { s.tension = -1.0; }, "tension");
  refused([](auto& s) { s.radii = {1e-4, 1e-4}; }, "as long as wide");
}

}  // namespace
}  // namespace meniscus::spine_poles_test
