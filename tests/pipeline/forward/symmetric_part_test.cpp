// A frame of four blocks and four films, drawn whole, as its half and as its
// quarter.
#include <array>
#include <string>
#include <vector>

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "pipeline/forward/forward_model.h"
#include "pipeline/forward/gradient_check.h"
#include "tests/support/case_text.h"

namespace meniscus::symmetric_part_test {
namespace {

using testing::HasSubstr;
using testing::IsEmpty;

/// A film between the open faces of two blocks, or from one to the plane that
/// lies between them.
struct Arm {
  std::string name, from, to;
  bool along_x = true;
  double side = 0.0;  // where it lies along the other axis: -22 or 22
};

std::string start_in_plane(const Arm& arm) {
  return fmt::format(
      "[curves.{0}_mid]\nkind = \"rectangle\"\ncenter = [{1}, {2}, 0]\n"
      "normal = [{3}, {4}, 0]\naxis = [{4}, {3}, 0]\nwidth = 20\n"
      "height = 16\n\n",
      arm.name, arm.along_x ? 0.0 : arm.side, arm.along_x ? arm.side : 0.0,
      arm.along_x ? 1 : 0, arm.along_x ? 0 : 1);
}

/// Drawn on the sides x < 0 and y < 0 of so many planes.
std::string frame(int planes, double fea) {
  std::vector<std::string> blocks;
  std::string text =
      "title = \"A frame\"\nunits = \"mm-N-MPa\"\n\n"
      "[design.size]\ninitial = 53.0 # 1000 mm3, of the whole\n"
      "bounds = [48, 60]\n\n";
  if (planes > 0) {
    text += fmt::format(
        "[symmetry]\nplanes = [{{ at = [0, 0, 0], normal = [1, 0, 0] }}{}]\n\n",
        planes > 1 ? ", { at = [0, 0, 0], normal = [0, 2, 0] }" : "");
  }
  const auto is_drawn = [&](double x, double y) {
    return (planes < 1 || x < 0.0) && (planes < 2 || y < 0.0);
  };
  const auto block_at = [](double x, double y) {
    return fmt::format("block_{}{}", x < 0.0 ? "w" : "e", y < 0.0 ? "s" : "n");
  };
  for (const double x : {-22.0, 22.0}) {
    for (const double y : {-22.0, 22.0}) {
      if (is_drawn(x, y)) {
        blocks.push_back(block_at(x, y));
        text += fmt::format(
            "[solids.{}]\nkind = \"block\"\nat = [{}, {}, 0]\n"
            "size = [20, 20, 16]\nopen = [\"{}\", \"{}\"]\n\n",
            blocks.back(), x, y, x < 0.0 ? "right" : "left",
            y < 0.0 ? "back" : "front");
      }
    }
  }
  std::vector<Arm> arms;
  for (const double side : {-22.0, 22.0}) {
    const char* of_side = side < 0.0 ? "1" : "2";
    if (planes < 2 || side < 0.0) {
      arms.push_back(
          {std::string("along_x_") + of_side, block_at(-22.0, side) + "/right",
           planes < 1 ? block_at(22.0, side) + "/left" : "", true, side});
    }
    if (planes < 1 || side < 0.0) {
      arms.push_back(
          {std::string("along_y_") + of_side, block_at(side, -22.0) + "/back",
           planes < 2 ? block_at(side, 22.0) + "/front" : "", false, side});
    }
  }
  std::vector<std::string> films;
  for (const Arm& arm : arms) {
    films.push_back(arm.name);
    text += arm.to.empty() ? start_in_plane(arm) : "";
    text += fmt::format(
        "[films.{}]\nkind = \"loft\"\ncurves = [\"{}\", \"{}\"]\n\n", arm.name,
        arm.from, arm.to.empty() ? arm.name + "_mid" : arm.to);
  }
  std::vector<std::string> all = films;
  all.insert(all.end(), blocks.begin(), blocks.end());
  std::vector<std::string> held;
  for (const std::string& block : blocks) {
    held.push_back(
        fmt::format("{{ on = \"{}/bottom\", fix = \"xyz\" }}", block));
  }
  return text +
         fmt::format(
             "[bodies.part]\nenclosed_by = [\"{}\"]\n"
             "volume = \"size * 1000 / {}\"\nmaterial = \"aluminium\"\n\n"
             "[resolution]\nfea = {}\nfilm = {}\n\n"
             "[materials.aluminium]\nyoungs_modulus = 71700.0\n"
             "poisson_ratio = 0.33\ndensity = 2.8e-9\n\n"
             "[load_cases.pressed]\nsupports = [{}]\n"
             "loads = [{{ on = [\"{}\"], traction = [0, 0, -2] }}]\n\n",
             fmt::join(all, "\", \""), 1 << planes, fea, fea / 2.0,
             fmt::join(held, ", "), fmt::join(films, "\", \"")) +
         R"toml([responses.mass]
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

[responses.sag]
kind = "mean_displacement"
on = "along_x_1"
direction = [0, 0, 1]

[responses.stress]
kind = "von_mises_norm"
power = 4

[analysis]
buckling = 0
)toml";
}

VectorX responses_of(int planes) {
  const case_data::Case input = case_of(frame(planes, 5.0));
  const forward::ForwardModel model(input);
  EXPECT_FALSE(model.failure()) << model.failure()->message;
  return model.evaluate(case_data::initial_design(input)).responses;
}

// On meshes of one edge that are no more alike.
TEST(SymmetricPart, HalfAndQuarterAnswerAsTheWhole) {
  // Mass, area, pressure, inertia, work, sag, stress.
  // The whole's own change by 1e-3 in mass, 2e-2 in stress on other meshes.
  constexpr std::array<double, 7> kMesh = {1e-3, 1e-3, 2e-3,  1e-3,
                                           1e-2, 1e-2, 2.5e-2};
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

TEST(SymmetricPart, AQuarterHasExactGradients) {
  const case_data::Case input = case_of(frame(2, 6.0));
  const forward::CaseGradientCheck check =
      forward::check_case_gradient(input, VectorX::Constant(1, 54.0));
  EXPECT_TRUE(check.report.passed)
      << forward::gradient_check_text(input, check);
  EXPECT_THAT(check.left_out, IsEmpty());
}

/// A drop that ends in the plane, and a tube beside it.
std::string drop_and_tube(int normal, int volume) {
  return fmt::format(R"toml(title = "Beside a plane"
units = "mm-N-MPa"

[symmetry]
planes = [{{ at = [0, 0, 0], normal = [1, 0, 0] }}]

[curves.rim]
kind = "circle"
center = [0, 0, -40]
normal = [{0}, 0, 0]
radius = 10

[curves.low]
kind = "circle"
center = [-14, 0, 0]
normal = [0, 0, 1]
radius = 10

[curves.high]
kind = "circle"
center = [-14, 0, 30]
normal = [0, 0, 1]
radius = 10

[films.drop]
kind = "disk"
curves = ["rim"]

[films.skin]
kind = "loft"
curves = ["low", "high"]

[solids.foot]
kind = "cap"
curve = "low"

[solids.head]
kind = "cap"
curve = "high"

[bodies.half]
enclosed_by = ["drop"]
volume = 2094
material = "aluminium"

[bodies.tube]
enclosed_by = ["skin", "foot", "head"]
volume = {1}
material = "aluminium"

[resolution]
fea = 6

[materials.aluminium]
youngs_modulus = 71700.0
poisson_ratio = 0.33
density = 2.8e-9

[load_cases.pressed]
supports = [{{ on = "drop", fix = "xyz" }}, {{ on = "foot", fix = "xyz" }}]
loads = [{{ on = "skin", pressure = 1 }}]

[responses.volume]
kind = "volume"

[analysis]
buckling = 0
)toml",
                     normal, volume);
}

// Their images would overlap them, and mass be counted twice.
TEST(SymmetricPart, FilmsThatPassAPlaneAreTold) {
  const auto failure = [](int normal, int volume) {
    const case_data::Case input = case_of(drop_and_tube(normal, volume));
    const forward::ForwardModel model(input);
    return model.failure() ? model.failure()->message : "";
  };
  EXPECT_EQ(failure(-1, 9400), "");
  EXPECT_THAT(failure(1, 9400),
              HasSubstr("'drop' passes plane 1 of symmetry (case.toml:5) by"));
  EXPECT_THAT(failure(-1, 21000),
              HasSubstr("'skin' passes plane 1 of symmetry (case.toml:5) by"));
}

}  // namespace
}  // namespace meniscus::symmetric_part_test
