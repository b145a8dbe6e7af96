// Halves and quarters between curves that planes cut, as STEP and STL: the
// whole.
#include <cmath>
#include <cstdlib>
#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/error.h"
#include "core/monitor.h"
#include "pipeline/step_parts/export_step.h"
#include "pipeline/whole/whole_system.h"
#include "tests/support/case_text.h"
#include "tests/support/temp_folder.h"

namespace meniscus::cut_step_test {
namespace {

using testing::HasSubstr;
using testing::IsEmpty;

constexpr const char* kAcross = "{ at = [0, 0, 0], normal = [1, 0, 0] }";
constexpr double kOfSolid = 5e-5;  // 1.7e-5 of the whole's film too

struct CutSaid : Monitor {
  std::string text;
  void log(Severity /*severity*/, const std::string& message) override {
    text += message + "\n";
  }
};

/// The strut along its axis; forces are in the planes.
std::string cut_strut(const std::string& planes, double volume) {
  std::string text =
      changed(strut(), "[curves.base]",
              "[symmetry]\nplanes = [" + planes + "]\n\n[curves.base]");
  text = changed(text, "[\"load\", 0, 0]", "[0, 0, \"load\"]");
  text = changed(text, "direction = [1, 0, 0]", "direction = [0, 0, 1]");
  return changed(text, "volume = 9e4", "volume = " + std::to_string(volume)) +
         "[analysis]\nbuckling = 0\n";
}

TEST(CutStep, IsOneValidSolidOfTheWhole) {
  for (const int planes : {1, 2}) {
    const std::string two =
        std::string(kAcross) + ", { at = [0, 0, 0], normal = [0, 1, 0] }";
    const case_data::Case input =
        case_of(cut_strut(planes == 1 ? kAcross : two, 9e4 / (1 << planes)));
    const whole::WholeSystem whole = whole::whole_system(
        input, case_data::evaluate(input, case_data::initial_design(input))
                   .film_system);
    EXPECT_THAT(whole.mirrors, IsEmpty());
    EXPECT_EQ(whole.system.caps.size(), 2U);
    const TempFolder folder;
    CutSaid said;
    step_parts::export_step(folder / "part.step", whole.system,
                            {.title = "part", .edge = 4.0, .monitor = &said});
    const std::string before = "valid closed solid of ";
    const std::size_t at = said.text.find(before);
    ASSERT_NE(at, std::string::npos) << said.text;
    EXPECT_NEAR(
        std::strtod(said.text.c_str() + at + before.size(), nullptr) / 9e4, 1.0,
        kOfSolid);
  }
}

}  // namespace
}  // namespace meniscus::cut_step_test
