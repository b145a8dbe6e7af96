/// Natural frequencies and buckling factors against closed forms, with the
/// rates at which they are reached.
#include <cmath>
#include <numbers>

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "fea/modes/buckling.h"
#include "fea/modes/modes.h"
#include "tests/support/parts.h"

namespace meniscus::eigenvalues_test {
namespace {

using std::numbers::pi;

// Without Poisson's ratio beams know no clamp's constraint, and Timoshenko's
// factor of a rectangle is 5/6 for all loads.
constexpr double kShear = 5.0 / 6.0;

element::Material cork() { return {"cork", 1000.0, 0.0, 2e-3, {}}; }

double shear_modulus(const element::Material& m) {
  return 0.5 * m.youngs_modulus / (1.0 + m.poisson_ratio);
}

/// Half of a pinned beam of section 1 x 1 along x, cut at mid-length (x0) and
/// along its plane of bending (z0); x1 carries the load.
TetMesh half_beam(double length, int along, int across) {
  return shapes::straight_quadratic(
      shapes::brick({length, 1.0, 0.5}, along, across, 1));
}

loads::LoadCase pinned_half(double push) {
  loads::LoadCase load_case;
  load_case.name = "pinned";
  load_case.supports = {{"x0", true, false, false},
                        {"x1", false, true, false},
                        {"z0", false, false, true}};
  load_case.forces = {{"x1", {-push, 0.0, 0.0}}};
  return load_case;
}

double pinned_factor(double length, int along, int across) {
  const TetMesh mesh = half_beam(length, along, across);
  const std::vector<loads::LoadCase> cases = {pinned_half(1.0)};
  const elastic::ElasticModel model(mesh, {cork()}, cases);
  const modes::BucklingModes modes = modes::buckling_modes(
      model, mesh, cases, 0, model.base_solution().displacements[0],
      {.largest = 1e5});
  EXPECT_FALSE(modes.failure);
  return modes.factors.at(0);
}

/// Euler's load of half the section, with the shear of Timoshenko and Engesser
/// and the work of the axial gradient, sigma u_x,x^2, which a solid has and a
/// beam leaves out: EI becomes EI (1 - P / EA).
double pinned_load(double length) {
  const element::Material m = cork();
  const double area = 0.5;
  const double bending = m.youngs_modulus * area / 12.0;
  const double shear = kShear * shear_modulus(m) * area;
  const double wave = std::pow(0.5 * pi / length, 2);
  double P = bending * wave;
  for (int k = 0; k < 50; ++k) {
    const double euler = bending * wave * (1.0 - P / (m.youngs_modulus * area));
    P = euler / (1.0 + euler / shear);
  }
  return P;
}

TEST(EulerColumn, PinnedLoadIsTimoshenkosWithOrderFour) {
  const double coarse = pinned_factor(5.0, 10, 4) / pinned_load(5.0) - 1.0;
  const double fine = pinned_factor(5.0, 20, 8) / pinned_load(5.0) - 1.0;
  const double slender = pinned_factor(10.0, 40, 4) / pinned_load(10.0) - 1.0;
  EXPECT_GT(coarse / fine, 11.0);  // 16, until the theory's own error shows
  EXPECT_LT(std::abs(fine), 2e-5);
  EXPECT_LT(std::abs(slender), 1e-5);
  RecordProperty("slenderness_10", fmt::format("{:.2e}", fine));
  RecordProperty("slenderness_20", fmt::format("{:.2e}", slender));
}

/// (a - b) / (b - c) of three meshes, each with half the elements' size.
double ratio_of_changes(const std::array<double, 3>& value) {
  return (value[0] - value[1]) / (value[1] - value[2]);
}

TEST(EulerColumn, FactorsConvergeWithOrderFour) {
  const std::array<double, 3> factor = {pinned_factor(5.0, 4, 1),
                                        pinned_factor(5.0, 8, 2),
                                        pinned_factor(5.0, 16, 4)};
  EXPECT_GT(factor[0], factor[1]);
  EXPECT_GT(factor[1], factor[2]);
  EXPECT_GT(ratio_of_changes(factor), 11.0);  // 16, from afar
  RecordProperty("ratio", fmt::format("{:.1f}", ratio_of_changes(factor)));
}

// Clamped at one end, a whole section, steel: within beam theory's error.
TEST(EulerColumn, ClampedSteelIsEulersLoad) {
  const double length = 20.0;
  const TetMesh mesh =
      shapes::straight_quadratic(shapes::brick({length, 1.0, 1.2}, 20, 2, 2));
  const element::Material steel = parts::steel();
  const std::vector<loads::LoadCase> cases = {parts::pulled({-1.0, 0.0, 0.0})};
  const elastic::ElasticModel model(mesh, {steel}, cases);
  const modes::BucklingModes modes = modes::buckling_modes(
      model, mesh, cases, 0, model.base_solution().displacements[0],
      {.count = 2, .largest = 1e5});
  ASSERT_EQ(modes.factors.size(), 2U);
  const double euler = pi * pi * steel.youngs_modulus / (4.0 * length * length);
  EXPECT_NEAR(modes.factors[0] / (euler * 1.2 / 12.0), 1.0, 5e-3);
  EXPECT_NEAR(modes.factors[1] / (euler * 1.2 * 1.2 * 1.2 / 12.0), 1.0, 5e-3);
  RecordProperty("relative",
                 fmt::format("{:.5f}", modes.factors[0] / (euler * 0.1)));
}

/// A quarter of a square plate of side 20 and thickness 1, hinged all around,
/// heated between pressed sides: nothing moves before it buckles, the stress is
/// -1 in both directions of the plane.
double hot_plate_factor(int along, int across) {
  const TetMesh mesh = shapes::straight_quadratic(
      shapes::brick({10.0, 10.0, 1.0}, along, along, across));
  element::Material m = cork();
  const double E = m.youngs_modulus;
  m.orthotropic = element::Orthotropic{.youngs_moduli = Vec3::Constant(E),
                                       .poisson_ratios = Vec3::Zero(),
                                       .shear_moduli = Vec3::Constant(0.5 * E)};
  m.thermal_expansion = {1.0 / E, 1.0 / E, 0.0};  // not in thickness
  loads::LoadCase hot;
  hot.name = "hot";
  hot.supports = {{"x0", true, false, false},
                  {"y0", false, true, false},
                  {"x1", false, true, true},
                  {"y1", true, false, true}};
  hot.pressures = {{"x1", 1.0}, {"y1", 1.0}};
  hot.temperature = loads::Temperature{.value = 1.0};
  const std::vector<loads::LoadCase> cases = {hot};
  const elastic::ElasticModel model(mesh, {m}, cases);
  const modes::BucklingModes modes = modes::buckling_modes(
      model, mesh, cases, 0, model.base_solution().displacements[0],
      {.largest = 1e5});
  EXPECT_FALSE(modes.failure);
  return modes.factors.at(0);
}

/// N = D k^2 with k^2 = 2 (pi / a)^2, Mindlin's shear and D (1 - N / (E t)),
/// as of the column.
double hot_plate_load() {
  const element::Material m = cork();
  const double k2 = 2.0 * std::pow(pi / 20.0, 2);
  const double shear = kShear * shear_modulus(m);
  double N = 0.0;
  for (int k = 0; k < 50; ++k) {
    const double thin =
        m.youngs_modulus / 12.0 * k2 * (1.0 - N / m.youngs_modulus);
    N = thin / (1.0 + thin / shear);
  }
  return N;
}

TEST(HotPlate, BucklesAtMindlinsLoadWithOrderFour) {
  const double coarse = hot_plate_factor(10, 2) / hot_plate_load() - 1.0;
  const double fine = hot_plate_factor(20, 4) / hot_plate_load() - 1.0;
  EXPECT_GT(coarse / fine, 9.0);
  EXPECT_LT(std::abs(fine), 3e-4);
  RecordProperty("coarse", fmt::format("{:.2e}", coarse));
  RecordProperty("fine", fmt::format("{:.2e}", fine));
}

/// omega of a pinned Timoshenko beam's first bending, half length given:
/// r w^4 - (1 + I k^2 / A (1 + E / kG)) w^2 + E I k^4 / (rho A) = 0.
double pinned_omega(double length) {
  const element::Material m = cork();
  const double k2 = std::pow(0.5 * pi / length, 2);
  const double inertia = 1.0 / 12.0;  // I / A
  const double shear = kShear * shear_modulus(m);
  const double a = inertia * m.density / shear;
  const double b = 1.0 + inertia * k2 * (1.0 + m.youngs_modulus / shear);
  const double c = m.youngs_modulus * inertia * k2 * k2 / m.density;
  return std::sqrt(2.0 * c / (b + std::sqrt(b * b - 4.0 * a * c)));
}

TEST(PinnedBeam, FrequencyIsTimoshenkosWithOrderFour) {
  const auto error = [](double length, int along, int across) {
    const modes::NaturalModes modes =
        modes::natural_modes(half_beam(length, along, across), {cork()},
                             pinned_half(1.0), {.count = 1});
    return std::pow(2.0 * pi * modes.frequencies.at(0) / pinned_omega(length),
                    2) -
           1.0;
  };
  const double coarse = error(5.0, 10, 4);
  const double fine = error(5.0, 20, 8);
  EXPECT_GT(coarse / fine, 11.0);  // 16, until the theory's own error shows
  EXPECT_LT(std::abs(fine), 2e-5);
  EXPECT_LT(std::abs(error(10.0, 40, 4)), 1e-5);
  RecordProperty("slenderness_10", fmt::format("{:.2e}", fine));
}

/// Huang's frequency equation of a clamped Timoshenko beam (J. Appl. Mech. 28,
/// 1961): its root next to `omega`.
double clamped_omega(const element::Material& m, double length, double inertia,
                     double shear_factor, double omega) {
  const double r2 = inertia / (length * length);
  const double s2 = r2 * m.youngs_modulus / (shear_factor * shear_modulus(m));
  const auto f = [&](double w) {
    const double b = w * length * length *
                     std::sqrt(m.density / (m.youngs_modulus * inertia));
    const double root = std::sqrt((r2 - s2) * (r2 - s2) + 4.0 / (b * b));
    const double alpha = std::sqrt(0.5 * (root - r2 - s2));
    const double beta = std::sqrt(0.5 * (root + r2 + s2));
    return 2.0 +
           (b * b * (r2 - s2) * (r2 - s2) + 2.0) * std::cosh(b * alpha) *
               std::cos(b * beta) -
           b * (r2 + s2) / std::sqrt(1.0 - b * b * r2 * s2) *
               std::sinh(b * alpha) * std::sin(b * beta);
  };
  double low = 0.9 * omega;
  double high = 1.1 * omega;
  for (int k = 0; k < 60; ++k) {
    const double middle = 0.5 * (low + high);
    (f(low) * f(middle) <= 0.0 ? high : low) = middle;
  }
  return 0.5 * (low + high);
}

TEST(Cantilever, BendingFrequenciesAreTimoshenkos) {
  const double length = 12.0;
  const element::Material m = cork();
  const TetMesh mesh =
      shapes::straight_quadratic(shapes::brick({length, 1.0, 1.3}, 18, 3, 3));
  const modes::NaturalModes modes = modes::natural_modes(
      mesh, {m}, parts::pulled(Vec3::Zero()), {.count = 4});
  ASSERT_EQ(modes.frequencies.size(), 4U);
  // Bending across the thin and the thick side in turn, first and second.
  const std::array<double, 4> inertia = {1.0 / 12.0, 1.69 / 12.0, 1.0 / 12.0,
                                         1.69 / 12.0};
  for (std::size_t k = 0; k < 4; ++k) {
    const double ours = 2.0 * pi * modes.frequencies[k];
    const double theirs = clamped_omega(m, length, inertia[k], kShear, ours);
    EXPECT_NEAR(ours / theirs, 1.0, 1e-3) << k;
    RecordProperty("mode_" + std::to_string(k),
                   fmt::format("{:.6f}", ours / theirs));
  }
}

/// Lowest elastic frequency of a bar that slides in a square tube: axial waves,
/// omega = pi / L sqrt(E / rho), and one rigid motion.
double axial_error(int order, int n) {
  const double length = 3.0;
  TetMesh mesh = shapes::brick({length, 1.0, 1.0}, 3 * n, n, n);
  if (order == 2) {
    mesh = shapes::straight_quadratic(mesh);
  }
  loads::LoadCase tube;
  for (const char* side : {"y0", "y1"}) {
    tube.supports.push_back({side, false, true, true});
  }
  for (const char* side : {"z0", "z1"}) {
    tube.supports.push_back({side, false, true, true});
  }
  const modes::NaturalModes modes =
      modes::natural_modes(mesh, {cork()}, tube, {.count = 1});
  EXPECT_EQ(modes.rigid_motions, 1);
  const double exact =
      pi / length * std::sqrt(cork().youngs_modulus / cork().density);
  return std::pow(2.0 * pi * modes.frequencies.at(0) / exact, 2) - 1.0;
}

TEST(FreeBar, AxialFrequencyConvergesWithTwiceTheElementsOrder) {
  const double four = axial_error(1, 4) / axial_error(1, 8);
  const double ten = axial_error(2, 2) / axial_error(2, 4);
  EXPECT_NEAR(four, 4.0, 0.3);
  EXPECT_NEAR(ten, 16.0, 3.0);
  EXPECT_LT(axial_error(2, 4), 1e-5);
  RecordProperty("tet4_ratio", fmt::format("{:.2f}", four));
  RecordProperty("tet10_ratio", fmt::format("{:.2f}", ten));
}

/// Lame's modes of a free cube, u = (cos px sin py, -sin px cos py, 0): no
/// change of volume, no traction on any side for any Poisson's ratio, omega =
/// p sqrt(2 G / rho) with p = pi / a. Three of them, one per pair of sides.
double lame_error(int n) {
  const element::Material steel = parts::steel();
  const TetMesh mesh =
      shapes::straight_quadratic(shapes::brick({1.0, 1.0, 1.0}, n, n, n));
  const modes::NaturalModes modes = modes::natural_modes(
      mesh, {steel}, loads::LoadCase{.name = "free"}, {.count = 14});
  EXPECT_EQ(modes.rigid_motions, 6);
  const double exact =
      pi * std::sqrt(2.0 * shear_modulus(steel) / steel.density);
  std::vector<double> error;
  for (const double f : modes.frequencies) {
    error.push_back(std::abs(std::pow(2.0 * pi * f / exact, 2) - 1.0));
  }
  std::sort(error.begin(), error.end());
  return error.at(2);
}

TEST(FreeCube, LameModesConvergeWithOrderFour) {
  const double coarse = lame_error(2);
  const double middle = lame_error(4);
  const double fine = lame_error(8);
  EXPECT_GT(middle / fine, 1.5 * coarse / middle);  // on its way to 16
  EXPECT_GT(middle / fine, 11.0);
  EXPECT_LT(fine, 2e-3);
  RecordProperty("ratios",
                 fmt::format("{:.1f} {:.1f}", coarse / middle, middle / fine));
  RecordProperty("error", fmt::format("{:.1e}", fine));
}

// A free bar of round section, curved elements: torsion, omega = pi / L
// sqrt(G / rho).
TEST(FreeBar, TorsionOfARoundBarIsExact) {
  const double length = 4.0;
  const element::Material steel = parts::steel();
  TetMesh mesh =
      shapes::straight_quadratic(shapes::brick({2.0, 2.0, length}, 4, 4, 8));
  for (Vec3& x : mesh.nodes) {  // the square onto the disk, ring by ring
    const double a = x.x() - 1.0;
    const double b = x.y() - 1.0;
    const double ring = std::max(std::abs(a), std::abs(b));
    const double length_ab = std::hypot(a, b);
    const double scale = length_ab > 0.0 ? ring / length_ab : 0.0;
    const double mix = ring * ring;  // rings are round outside
    x = Vec3(a * (1.0 - mix + mix * scale), b * (1.0 - mix + mix * scale),
             x.z());
  }
  const modes::NaturalModes modes = modes::natural_modes(
      mesh, {steel}, loads::LoadCase{.name = "free"}, {.count = 8});
  EXPECT_EQ(modes.rigid_motions, 6);
  const double exact =
      0.5 / length * std::sqrt(shear_modulus(steel) / steel.density);
  double nearest = 1.0;
  for (const double f : modes.frequencies) {
    nearest = std::min(nearest, std::abs(f / exact - 1.0));
  }
  EXPECT_LT(nearest, 1e-3);
  RecordProperty("error", fmt::format("{:.1e}", nearest));
}

}  // namespace
}  // namespace meniscus::eigenvalues_test
