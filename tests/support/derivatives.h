/// Derivatives against central differences over a sweep of steps.
#pragma once

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "core/geometry/tet_mesh.h"
#include "fea/element/functional.h"

namespace meniscus::derivatives {

/// Central differences at steps 1, 1/2 and 1/4 of `step` must near `exact` with
/// order 2, and their extrapolation to step 0 meet it to `tolerance` of
/// `scale`, a size of the derivative's terms.
struct Check {
  double exact = 0.0;
  double scale = 0.0;
  double step = 1e-3;
  double tolerance = 1e-8;
};

/// Differences that are nearer than this show rounding, no order.
inline constexpr double kRounding = 2e-10;

template <class Value>
void expect_derivative(const Check& check, const Value& value) {
  const auto slope = [&](double h) {
    return (value(h) - value(-h)) / (2.0 * h);
  };
  const double a = slope(check.step);
  const double b = slope(0.5 * check.step);
  const double c = slope(0.25 * check.step);
  const double once = (4.0 * b - a) / 3.0;
  const double twice = (16.0 * (4.0 * c - b) / 3.0 - once) / 15.0;
  EXPECT_NEAR(twice, check.exact, check.tolerance * check.scale);
  const double first = std::abs(a - check.exact);
  const double second = std::abs(b - check.exact);
  const double rounding =
      std::max(kRounding * 1e-3 * check.scale,
               64.0 * std::numeric_limits<double>::epsilon() *
                   std::abs(value(0.0))) /
      check.step;
  if (second > rounding) {
    EXPECT_NEAR(std::log2(first / second), 2.0, 0.2)
        << "errors " << first << " and " << second << " of " << check.exact;
  }
}

/// A smooth displacement of places, each coordinate by its own mix.
inline Vec3 wave(const Vec3& x, double phase) {
  return {std::sin(1.3 * x.x() + 0.7 * x.y() + phase) + 0.3 * x.z(),
          std::cos(0.9 * x.y() - 1.1 * x.z() + 2.0 * phase),
          std::sin(0.8 * x.z() + 0.5 * x.x() - phase) - 0.2 * x.y()};
}

inline VectorX wave(const TetMesh& mesh, double phase) {
  VectorX v(static_cast<Eigen::Index>(3 * mesh.nodes.size()));
  for (std::size_t i = 0; i < mesh.nodes.size(); ++i) {
    v.segment<3>(static_cast<Eigen::Index>(3 * i)) = wave(mesh.nodes[i], phase);
  }
  return v;
}

inline TetMesh moved(TetMesh mesh, const VectorX& direction, double t) {
  flat(mesh.nodes) += t * direction;
  return mesh;
}

/// Both partial derivatives of functional(mesh, u), along waves.
template <class OfMesh>
void expect_partials(const TetMesh& mesh, const VectorX& u,
                     const OfMesh& functional, Check check = {}) {
  const element::Functional here = functional(mesh, u);
  const VectorX dx = wave(mesh, 0.4);
  ASSERT_EQ(here.by_nodes.size(), mesh.nodes.size());
  check.exact = flat(here.by_nodes).dot(dx);
  check.scale = flat(here.by_nodes).cwiseProduct(dx).lpNorm<1>() +
                1e-3 * std::abs(here.value);
  {
    SCOPED_TRACE("by nodes");
    expect_derivative(check, [&](double t) {
      return functional(moved(mesh, dx, t), u).value;
    });
  }
  if (here.by_displacement.size() == 0) {
    return;
  }
  SCOPED_TRACE("by displacement");
  const VectorX du = u.norm() * wave(mesh, 2.2).normalized();
  check.exact = here.by_displacement.dot(du);
  check.scale = here.by_displacement.cwiseProduct(du).lpNorm<1>();
  expect_derivative(
      check, [&](double t) { return functional(mesh, u + t * du).value; });
}

}  // namespace meniscus::derivatives
