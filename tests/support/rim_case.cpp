#include "tests/support/rim_case.h"

#include <cmath>
#include <numbers>

#include <fmt/format.h>

namespace meniscus {

namespace {

constexpr double kBallRadius = 80.0;

struct Rim {
  const char* name;
  int first;  // of the part's points
  int side;   // -1 or 1: turns counter-clockwise seen from there along z
  double z;
};

std::string curve_text(const Rim& rim, int points, int variables) {
  std::string text =
      fmt::format("[curves.{}]\nkind = \"polygon\"\npoints = [\n", rim.name);
  for (int i = 0; i < points / 2; ++i) {
    const double angle = rim.side * 4.0 * std::numbers::pi * i / points;
    const int variable = (rim.first + i) * variables / points;
    text += fmt::format("[\"{:.15f} * r{}\", \"{:.15f} * r{}\", {}],\n",
                        std::cos(angle), variable, std::sin(angle), variable,
                        rim.z);
  }
  return text + "]\n";
}

}  // namespace

std::string rim_case(int points, int variables, double length, double edge) {
  std::string text = "title = \"A rim of many points\"\nunits = \"mm-N-MPa\"\n";
  for (int j = 0; j < variables; ++j) {
    text += fmt::format("[design.r{}]\ninitial = {}\nbounds = [70, 90]\n", j,
                        kBallRadius);
  }
  text += curve_text({"base", 0, -1, 0.0}, points, variables);
  text += curve_text({"head", points / 2, 1, length}, points, variables);
  return text + fmt::format(R"([films.skin]
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
volume = {}
material = "aluminium"

[resolution]
fea = {}
film = {}

[materials.aluminium]
youngs_modulus = "71.7 GPa"
poisson_ratio = 0.33
density = 2.8e-9

[load_cases.service]
supports = [{{ on = "foot_pad", fix = "xyz" }}]
loads = [{{ on = "head_pad", force = [1000, 0, 0] }}]

[responses.sway]
kind = "mean_displacement"
on = "head_pad"
direction = [1, 0, 0]

[responses.mass]
kind = "mass"

[study]
kind = "analyse"
)",
                            20000.0 * length, edge, 0.5 * edge);
}

}  // namespace meniscus
