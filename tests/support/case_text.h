/// Small case files to break in tests.
#pragma once

#include <string>
#include <utility>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "pipeline/reader/case_reader.h"

namespace meniscus {

/// The shipped case, found from the tests' source folder.
inline std::string two_arm_path() {
  return MENISCUS_SOURCE_DIR "/cases/two_arm/case.toml";
}

/// A complete case on as few lines as it takes; "case.toml:LINE" of tests
/// counts these.
inline std::string strut() {
  return R"(title = "A strut"
units = "mm-N-MPa"

[parameters]
load = 1000.0
length = 60.0

[design.foot]
initial = 25.0
bounds = [20.0, 32.0]

[curves.base]
kind = "circle"
center = [0, 0, 0]
normal = [0, 0, -1]
radius = "foot"

[curves.head]
kind = "circle"
center = [0, 0, "length"]
normal = [0, 0, 1]
radius = 20

[films.skin]
kind = "branch"
curves = ["base", "head"]

[solids.foot_pad]
kind = "cap"
curve = "base"

[solids.head_pad]
kind = "cap"
curve = "head"

[bodies.part]
enclosed_by = ["skin", "foot_pad", "head_pad"]
volume = 9e4
material = "aluminium"

[resolution]
fea = 6.0
film = 3.0

[materials.aluminium]
youngs_modulus = 71700.0
poisson_ratio = 0.33
density = 2.8e-9

[load_cases.service]
supports = [{ on = "foot_pad", fix = "xyz" }]
loads = [{ on = "head_pad", force = ["load", 0, 0] }]

[responses.sway]
kind = "mean_displacement"
on = "head_pad"
direction = [1, 0, 0]

[responses.mass]
kind = "mass"

[study]
kind = "match"
targets = { sway = 0.01 }
)";
}

/// `text` with the one place where `from` stands replaced by `to`.
inline std::string changed(std::string text, const std::string& from,
                           const std::string& to) {
  const std::size_t at = text.find(from);
  EXPECT_NE(at, std::string::npos) << "the case has no '" << from << "'";
  return at == std::string::npos ? text : text.replace(at, from.size(), to);
}

/// Whose head stands off by the design variable `lean`, and rises with it.
inline std::string leaning_strut() {
  const std::string text = changed(strut(), "[curves.base]",
                                   "[design.lean]\ninitial = 3.0\n"
                                   "bounds = [-10.0, 10.0]\n\n"
                                   "[curves.base]");
  return changed(text, "center = [0, 0, \"length\"]",
                 "center = [\"lean\", 0, \"length + lean / 4\"]");
}

/// Whose foot is a spline through six points, a vector's element from the axis
/// each: the corner case of many design variables under one name. Line 8 is
/// [design.t].
inline std::string petal_strut() {
  const std::string text = changed(
      strut(), "[design.foot]\ninitial = 25.0\nbounds = [20.0, 32.0]\n",
      "[design.t]\nshape = [2, 3]\ninitial = 25.0\nbounds = [20.0, 32.0]\n");
  return changed(text,
                 "kind = \"circle\"\ncenter = [0, 0, 0]\n"
                 "normal = [0, 0, -1]\nradius = \"foot\"\n",
                 "kind = \"spline\"\npoints = [{ at = [\n"
                 "  \"t[i, j] * cos((j + 3 * i) * pi / 3)\",\n"
                 "  \"t[i, j] * sin((j + 3 * i) * pi / 3)\", 0], "
                 "repeat = [2, 3] }]\n");
}

/// The case of a text without problems.
inline case_data::Case case_of(const std::string& text) {
  reader::CaseReading reading = reader::read_case_text(text, "case.toml");
  EXPECT_THAT(reading.problems, testing::IsEmpty());
  return std::move(*reading.input);
}

/// The strut's film as a wall, without body, loads and study.
inline std::string tube(const std::string& wall) {
  const std::string films =
      changed(strut().substr(0, strut().find("[solids.foot_pad]")),
              "load = 1000.0\n", "");
  return changed(films, "\"length\"", "\"length - 40\"") + "[walls.web]\n" +
         wall + "[resolution]\nfea = 6\nfilm = 3\n";
}

inline std::string strut_without_head() {
  return changed(strut(),
                 "[curves.head]\nkind = \"circle\"\n"
                 "center = [0, 0, \"length\"]\nnormal = [0, 0, 1]\n"
                 "radius = 20\n",
                 "");
}

inline std::vector<std::string> problems_of(const std::string& text) {
  return reader::read_case_text(text, "case.toml").problems;
}

}  // namespace meniscus
