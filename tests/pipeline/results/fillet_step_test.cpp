// Rounded parts as STEP: OpenCASCADE finds closed, valid solids.
#include <cmath>
#include <cstdlib>
#include <numbers>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/monitor.h"
#include "pipeline/step_parts/export_step.h"
#include "tests/support/case_text.h"
#include "tests/support/rod_on_plate.h"
#include "tests/support/temp_folder.h"

namespace meniscus::fillet_step_test {
namespace {

constexpr double kStepPi = std::numbers::pi;
constexpr double kOfSolid = 2e-3;  // splines through points 1.5 apart

struct Said : Monitor {
  std::string text;
  void log(Severity /*severity*/, const std::string& message) override {
    text += message + "\n";
  }
};

/// The volume that OpenCASCADE measures of the closed solid.
double volume_of(const std::string& text) {
  const TempFolder folder;
  const case_data::Case input = case_of(text);
  Said said;
  step_parts::export_step(
      folder / "part.step",
      case_data::evaluate(input, case_data::initial_design(input)).film_system,
      {.title = "part", .edge = 1.5, .monitor = &said});
  const std::string before = "valid closed solid of ";
  const std::size_t at = said.text.find(before);
  EXPECT_NE(at, std::string::npos) << said.text;
  return at == std::string::npos
             ? 0.0
             : std::strtod(said.text.c_str() + at + before.size(), nullptr);
}

double torus_volume(double radius, double r) {
  const double middle =
      radius + r * (10.0 - 3.0 * kStepPi) / (3.0 * (4.0 - kStepPi));
  return 2.0 * kStepPi * middle * (1.0 - kStepPi / 4.0) * r * r;
}

TEST(FilletStep, IsAClosedSolidWithTheTorus) {
  const double exact =
      kStepPi * (64.0 * 20.0 + 576.0 * 5.0) + torus_volume(8.0, 4.0);
  EXPECT_NEAR(volume_of(rod_on_plate()) / exact, 1.0, kOfSolid);
}

/// Films on both sides of a boss's end: its cylinder is trimmed, too.
TEST(FilletStep, TrimsTheRoundSideOfABoss) {
  std::string text = changed(rod_on_plate(), R"(kind = "flange"
at = [0, 0, 0]
axis = [0, 0, 1]
radius = 24
thickness = 5
curves = ["foot"])",
                             R"(kind = "boss"
at = [0, 0, -12]
axis = [0, 0, -1]
radius = 8
height = 12)");
  text = changed(text, R"(curves = ["foot", "head"])",
                 R"(curves = ["plate/base", "head"])");
  text = changed(text, "curves = [\"foot\"]\nradius = \"fillet\"",
                 "curves = [\"plate/base\"]\nradius = 1.5");
  text = changed(text, "8^2 * 20 + 24^2 * 5", "8^2 * 44");
  text = changed(text, "plate/bottom", "plate/seat");
  // Films of more than the cylinder's 8^2 x 32 bulge: a corner at the boss.
  EXPECT_NEAR(volume_of(text) / (kStepPi * 64.0 * 44.0), 1.0, kOfSolid);
}

}  // namespace
}  // namespace meniscus::fillet_step_test
