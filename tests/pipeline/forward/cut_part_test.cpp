// A tube between two circles, drawn whole, and cut by one and two planes of
// symmetry along its axis.
#include <array>
#include <cmath>
#include <numbers>
#include <string>

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "pipeline/forward/forward_model.h"
#include "pipeline/forward/gradient_check.h"
#include "tests/support/case_text.h"

namespace meniscus::cut_part_test {
namespace {

using testing::IsEmpty;

/// Volume and force are those of the part that so many planes leave.
std::string tube(int planes, double fea) {
  const int parts = 1 << planes;
  std::string text =
      "title = \"A tube\"\nunits = \"mm-N-MPa\"\n\n"
      "[design.size]\ninitial = 44.0 # 1000 mm3, of the whole\n"
      "bounds = [40, 60]\n\n"
      "[design.long]\ninitial = 40.0\nbounds = [35, 45]\n\n";
  if (planes > 0) {
    text += fmt::format(
        "[symmetry]\nplanes = [{{ at = [0, 0, 0], normal = [1, 0, 0] }}{}]\n\n",
        planes > 1 ? ", { at = [0, 0, 0], normal = [0, 1, 0] }" : "");
  }
  return text + fmt::format(R"toml([curves.low]
kind = "circle"
center = [0, 0, 0]
normal = [0, 0, 1]
radius = 20

[curves.high]
kind = "rectangle"
center = [0, 0, "long"]
normal = [0, 0, 1]
axis = [1, 0, 0]
width = "long * 0.8"
height = 28
corner_radius = 10

[films.skin]
kind = "loft"
curves = ["low", "high"]

[solids.foot]
kind = "cap"
curve = "low"

[solids.head]
kind = "cap"
curve = "high"

[bodies.part]
enclosed_by = ["skin", "foot", "head"]
volume = "size * 1000 / {0}"
material = "aluminium"

[resolution]
fea = {1}
film = {2}

[materials.aluminium]
youngs_modulus = 71700.0
poisson_ratio = 0.33
density = 2.8e-9

[load_cases.pulled]
supports = [{{ on = "foot", fix = "xyz" }}]
loads = [
  {{ on = "head", force = [0, 0, "4000 / {0}"] }},
  {{ on = "skin", pressure = 2 }},
]

[responses.mass]
kind = "mass"

[responses.area]
kind = "film_area"

[responses.pressure]
kind = "pressure"
body = "part"

[responses.inertia]
kind = "inertia"
axis = [0, 0, 1]
through = [0, 0, 0]

[responses.work]
kind = "compliance"

[responses.lift]
kind = "mean_displacement"
on = "head"
direction = [0, 0, 1]

[responses.stress]
kind = "von_mises_norm"
power = 4

[analysis]
buckling = 0
)toml",
                            parts, fea, fea / 2.0);
}

VectorX responses_of(int planes) {
  const case_data::Case input = case_of(tube(planes, 5.0));
  const forward::ForwardModel model(input);
  EXPECT_FALSE(model.failure()) << model.failure()->message;
  return model.evaluate(case_data::initial_design(input)).responses;
}

// On meshes of one edge that are no more alike.
TEST(CutPart, HalfAndQuarterAnswerAsTheWhole) {
  // Mass, area, pressure, inertia, work, lift, stress.
  constexpr std::array<double, 7> kMesh = {6e-4, 3e-4, 1e-3, 1e-3,
                                           3e-3, 3e-3, 3e-3};
  const VectorX whole = responses_of(0);
  ASSERT_EQ(whole.size(), std::ssize(kMesh));
  for (const int planes : {1, 2}) {
    const VectorX part = responses_of(planes);
    ASSERT_EQ(part.size(), whole.size());
    for (std::size_t k = 0; k < kMesh.size(); ++k) {
      const auto i = static_cast<Eigen::Index>(k);
      EXPECT_NEAR(part[i] / whole[i], 1.0, kMesh[k])
          << planes << " planes, response " << k;
    }
  }
}

/// On a boss whose seat is held.
std::string on_boss(int planes) {
  std::string text = changed(tube(planes, 8.0), R"toml([curves.low]
kind = "circle"
center = [0, 0, 0]
normal = [0, 0, 1]
radius = 20

)toml",
                             "");
  text = changed(text, R"toml(kind = "cap"
curve = "low")toml",
                 R"toml(kind = "boss"
at = [0, 0, -8]
axis = [0, 0, -1]
radius = 18
height = 8
bore = 5
depth = 5
chamfer = 0.8)toml");
  text = changed(text, "curves = [\"low\"", "curves = [\"foot/base\"");
  text = changed(text, "initial = 44.0", "initial = 52.0");
  return changed(text, "{ on = \"foot\"", "{ on = \"foot/seat\"");
}

// Faces around a bore, a cone and a cylinder are cut along their lines.
TEST(CutPart, ABossIsCutWithItsBore) {
  constexpr double kMesh = 4e-3;
  const auto responses = [](int planes) {
    const case_data::Case input = case_of(on_boss(planes));
    const forward::ForwardModel model(input);
    EXPECT_FALSE(model.failure()) << model.failure()->message;
    return model.evaluate(case_data::initial_design(input)).responses;
  };
  const VectorX whole = responses(0);
  const VectorX part = responses(2);
  ASSERT_EQ(part.size(), whole.size());
  for (Eigen::Index k = 0; k < whole.size(); ++k) {
    EXPECT_NEAR(part[k] / whole[k], 1.0, kMesh) << "response " << k;
  }
}

TEST(CutPart, HalfAndQuarterHaveExactGradients) {
  for (const int planes : {1, 2}) {
    const case_data::Case input = case_of(tube(planes, 8.0));
    const forward::CaseGradientCheck check =
        forward::check_case_gradient(input, VectorX{{47.0, 41.0}});
    EXPECT_TRUE(check.report.passed)
        << forward::gradient_check_text(input, check);
    EXPECT_THAT(check.left_out, IsEmpty());
  }
}

}  // namespace
}  // namespace meniscus::cut_part_test
