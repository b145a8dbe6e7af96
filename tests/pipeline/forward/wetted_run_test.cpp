// Parts whose films slide on walls are meshed, analysed and differentiated.
#include <cmath>
#include <numbers>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "pipeline/forward/forward_model.h"
#include "pipeline/forward/gradient_check.h"
#include "tests/support/case_text.h"

namespace meniscus::wetted_run_test {
namespace {

using testing::IsEmpty;

constexpr double kPi = std::numbers::pi;

/// A drop that begins on a circle of radius 30 and is held where it wets.
std::string drop() {
  return R"toml(title = "A drop"
units = "mm-N-MPa"

[design.size]
initial = 9e4
bounds = [7e4, 1.2e5]

[design.angle]
initial = 1.2
bounds = [1.0, 1.6]

[curves.begin]
kind = "circle"
center = [0, 0, 0]
normal = [0, 0, 1]
radius = 30

[films.dome]
kind = "disk"
curves = ["begin"]
tension = 3.0

[solids.sole]
kind = "wetted"
curve = "begin"
at = [0, 0, 0]
normal = [0, 0, 1]
contact_angle = "angle"

[bodies.part]
enclosed_by = ["dome", "sole"]
volume = "size"
material = "aluminium"

[resolution]
fea = 10.0
film = 5.0

[materials.aluminium]
youngs_modulus = 71700.0
poisson_ratio = 0.33
density = 2.8e-9

[load_cases.service]
supports = [{ on = "sole", fix = "xyz" }]
loads = [{ on = "dome", pressure = 10.0 }]

[responses.area]
kind = "film_area"

[responses.energy]
kind = "film_energy"

[responses.pressure]
kind = "pressure"
body = "part"

[responses.work]
kind = "compliance"
)toml";
}

// A spherical cap of radius R that meets its plane at the angle a in it:
// V = pi R^3 (2 + cos a) (1 - cos a)^2 / 3.
TEST(WettedRuns, OfADropAreASphericalCaps) {
  constexpr double kFacets = 0.01;  // of edges of an eighth of R
  const case_data::Case input = case_of(drop());
  const forward::ForwardModel model(input);
  ASSERT_FALSE(model.failure()) << model.failure()->message;
  for (const Eigen::Vector2d& design :
       {Eigen::Vector2d(9e4, 1.2), Eigen::Vector2d(1.1e5, 1.5)}) {
    const double c = std::cos(design[1]);
    const double radius =
        std::cbrt(3.0 * design[0] / (kPi * (2.0 + c) * (1.0 - c) * (1.0 - c)));
    const double area = 2.0 * kPi * radius * radius * (1.0 - c);
    const double wetted = kPi * radius * radius * (1.0 - c * c);
    forward::EvaluationFields fields;
    const forward::Evaluation at = model.evaluate(design, &fields);
    ASSERT_FALSE(at.failure) << at.failure->message;
    EXPECT_NEAR(at.responses[0] / area, 1.0, kFacets);
    EXPECT_NEAR(at.responses[1] / (3.0 * (area - c * wetted)), 1.0, kFacets);
    EXPECT_NEAR(at.responses[2] * radius / 6.0, 1.0, kFacets);
    EXPECT_NEAR(enclosed_volume(fields.boundary) / design[0], 1.0, 1e-3);
  }
}

void expect_exact(const std::string& text, const VectorX& move) {
  const case_data::Case input = case_of(text);
  const forward::CaseGradientCheck check = forward::check_case_gradient(
      input, case_data::initial_design(input) + move);
  EXPECT_TRUE(check.report.passed)
      << forward::gradient_check_text(input, check);
  EXPECT_THAT(check.left_out, IsEmpty());
}

TEST(WettedRuns, HaveExactGradients) {
  expect_exact(drop(), Eigen::Vector2d(5e3, 0.1));
}

/// A ring of liquid between two films that end on one face.
std::string ring() {
  std::string text = changed(drop(), "[films.dome]", R"toml([curves.top]
kind = "circle"
center = [0, 0, 12]
normal = [0, 0, 1]
radius = 25

[curves.hole]
kind = "circle"
center = [0, 0, 0]
normal = [0, 0, 1]
radius = 16

[curves.vent]
kind = "circle"
center = [0, 0, 12]
normal = [0, 0, 1]
radius = 17

[solids.pad]
kind = "cap"
curve = "top"
holes = ["vent"]

[films.core]
kind = "loft"
curves = ["hole", "vent"]
tension = 3.0

[films.dome])toml");
  text = changed(text, "\"disk\"\ncurves = [\"begin\"]",
                 "\"loft\"\ncurves = [\"begin\", \"top\"]");
  text = changed(text, "curve = \"begin\"\nat",
                 "curve = \"begin\"\nholes = [\"hole\"]\nat");
  text = changed(text, "[\"dome\", ", "[\"dome\", \"core\", \"pad\", ");
  text = changed(text, "fea = 10.0\nfilm = 5.0", "fea = 5.0\nfilm = 2.5");
  return changed(text, "9e4\nbounds = [7e4, 1.2e5]",
                 "1.2e4\nbounds = [1e4, 1.3e4]");
}

TEST(WettedRuns, OfTwoFilmsOnOneFaceHaveExactGradients) {
  expect_exact(ring(), Eigen::Vector2d(1e2, 0.05));
}

/// The drop's wall and where the drop begins on it.
std::string drop_on(const std::string& wall, const std::string& begin) {
  return changed(changed(drop(), "at = [0, 0, 0]\nnormal = [0, 0, 1]\n", wall),
                 "center = [0, 0, 0]\nnormal = [0, 0, 1]\nradius = 30", begin);
}

std::string drop_in_funnel() {
  return drop_on(
      "wall = \"cone\"\nat = [0, 0, -40]\naxis = [0, 0, 2]\n"
      "half_angle = \"40 deg\"\n",
      "center = [0, 0, -2]\nnormal = [0, 0, 1]\nradius = 32");
}

/// A film about a cone's axis: of the polar angle 40 deg + angle - 90 deg at
/// the wall, a sphere of radius R there and R sin(polar) around.
TEST(WettedRuns, OfADropInAFunnelAreASphericalCapOnIt) {
  constexpr double kFacets = 0.01;
  const case_data::Case input = case_of(drop_in_funnel());
  const forward::ForwardModel model(input);
  ASSERT_FALSE(model.failure()) << model.failure()->message;
  for (const Eigen::Vector2d& design :
       {Eigen::Vector2d(9e4, 1.2), Eigen::Vector2d(1.1e5, 1.5)}) {
    const double half = 40.0 * kPi / 180.0;
    const double polar = half + design[1] - 0.5 * kPi;
    // Of a rim of radius 1: the cone less what is hollow, or and what bulges.
    const double bend = 1.0 / std::sin(polar);
    const double rise = std::tan(0.5 * polar);
    const double unit =
        kPi / 3.0 / std::tan(half) + kPi * rise * (3.0 + rise * rise) / 6.0;
    const double rim = std::cbrt(design[0] / unit);
    forward::EvaluationFields fields;
    const forward::Evaluation at = model.evaluate(design, &fields);
    ASSERT_FALSE(at.failure) << at.failure->message;
    const double area = kPi * rim * rim * (1.0 + rise * rise);
    const double wetted = kPi * rim * rim / std::sin(half);
    EXPECT_NEAR(at.responses[0] / area, 1.0, kFacets);
    EXPECT_NEAR(at.responses[1] / (3.0 * (area - std::cos(design[1]) * wetted)),
                1.0, kFacets);
    EXPECT_NEAR(at.responses[2] * rim * bend / 6.0, 1.0, kFacets);
    // The boundary has flat facets on the cone.
    EXPECT_NEAR(enclosed_volume(fields.boundary) / design[0], 1.0, 0.03);
  }
}

TEST(WettedRuns, OnBentWallsHaveExactGradients) {
  expect_exact(drop_in_funnel(), Eigen::Vector2d(5e3, 0.1));
  // Upon a ball, and across a rod, from a circle that is near it.
  expect_exact(drop_on("wall = \"sphere\"\nat = [0, 0, -60]\nradius = 60\n",
                       "center = [0, 0, -9]\nnormal = [0, 0, 1]\n"
                       "radius = 31.6"),
               Eigen::Vector2d(5e3, 0.1));
  expect_exact(drop_on("wall = \"cylinder\"\nat = [0, 0, -150]\n"
                       "axis = [0, 1, 0]\nradius = 150\n",
                       "center = [0, 0, -1.5]\nnormal = [0, 0, 1]\n"
                       "radius = 30"),
               Eigen::Vector2d(5e3, 0.1));
}

}  // namespace
}  // namespace meniscus::wetted_run_test
