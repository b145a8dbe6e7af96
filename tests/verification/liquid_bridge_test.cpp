// The least volume at which a liquid bridge between two equal rings is stable,
// its volume held (Gillette, Dyson 1971). Up to a slenderness of about 2.13 a
// symmetric mode is the first to grow, beyond it an antisymmetric one.
#include <cmath>
#include <numbers>

#include <gtest/gtest.h>

#include "core/geometry/surface_mesh.h"
#include "evolve/groom/flip_average.h"
#include "evolve/settle/equilibrium.h"
#include "tests/support/film_shapes.h"

namespace meniscus::liquid_bridge_test {
namespace {

constexpr double kFirstStep = 0.04;
constexpr double kLastStep = 5e-4;   // of the volume of the cylinder
constexpr double kMostMotion = 0.3;  // x distance to the axis, a step
constexpr double kError = 0.01;      // relative, of the least volume

/// Settles in `bridge` at the volume; false, and nothing moves, where that is
/// no minimum.
bool settles_at(films::FilmComplex& bridge, double volume) {
  bridge.bodies[0].volume = volume;
  const energy::FilmEnergy energy(bridge);
  const settle::FilmState state = settle::settle_in_normals(
      energy, bridge, energy::targets_of(bridge), bridge.mesh.points, {});
  if (state.report.index > 0 ||
      !(state.report.residual <= state.report.residual_bound)) {
    return false;
  }
  // beyond the fold Newton may end at a neck that is turned inside out
  for (std::size_t v = 0; v < state.points.size(); ++v) {
    const Vec3& old = bridge.mesh.points[v];
    if ((state.points[v] - old).norm() > kMostMotion * old.head<2>().norm()) {
      return false;
    }
  }
  bridge.mesh.points = state.points;
  return true;
}

/// Over the volume of the cylinder, by `around` facets along each ring of
/// radius 1, 2 x slenderness apart.
double least_volume(double slenderness, int around) {
  const double length = 2.0 * slenderness;
  const auto rows = static_cast<int>(
      std::lround(1.2 * around * length / (2.0 * std::numbers::pi)));
  films::FilmComplex bridge =
      shapes::tube(1.0, length, around, std::max(around / 2, rows),
                   [](double) { return 1.0; });
  shapes::close_tube(bridge, around);
  // of a prism, so that the corners that chords cut off count on both sides
  const double whole = enclosed_volume(bridge.mesh);
  double least = 1.0;
  for (double step = kFirstStep; step > kLastStep;) {
    films::FilmComplex next = bridge;
    if (settles_at(next, (least - step) * whole)) {
      least -= step;
      bridge = std::move(next);
      groom::average_vertices(bridge);
    } else {
      step *= 0.5;
    }
  }
  return least;
}

struct Bridge {
  double slenderness = 0.0;  // length over diameter
  double least = 0.0;        // volume / (pi R^2 L)
};

class LiquidBridge : public ::testing::TestWithParam<Bridge> {};

TEST_P(LiquidBridge, IsStableDownToItsLeastVolume) {
  const auto [slenderness, least] = GetParam();
  const double coarse = least_volume(slenderness, 24);
  const double fine = least_volume(slenderness, 48);
  // second order in the length of the edges
  const double limit = fine + (fine - coarse) / 3.0;
  EXPECT_NEAR(limit, least, kError * least) << coarse << ", " << fine;
}

INSTANTIATE_TEST_SUITE_P(
    Slenderness, LiquidBridge,
    ::testing::Values(Bridge{0.5, 0.254}, Bridge{0.663, 0.313},
                      Bridge{0.8, 0.347}, Bridge{1.0, 0.387},
                      Bridge{1.5, 0.475}, Bridge{2.0, 0.566},
                      Bridge{2.5, 0.690}, Bridge{3.0, 0.915}));

}  // namespace
}  // namespace meniscus::liquid_bridge_test
