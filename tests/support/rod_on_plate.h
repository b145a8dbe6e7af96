/// A part with a fillet.
#pragma once

#include <string>

namespace meniscus {

/// A rod of radius 8 and length 20 on a round plate of radius 24.
inline std::string rod_on_plate() {
  return R"toml(title = "A rod on a plate"
units = "mm-N-MPa"

[design.fillet]
initial = 4.0
bounds = [0.0, 6.0]

[design.foot]
initial = 8.0
bounds = [6.0, 12.0]

[design.tilt]
initial = 0.0
bounds = [-0.2, 0.2]

[curves.foot]
kind = "circle"
center = [0, 0, 0]
normal = [0, 0, 1]
radius = "foot"

[curves.head]
kind = "circle"
center = ["20 * tilt", 0, 20]
normal = ["tilt", 0, 1]
radius = 8

[solids.plate]
kind = "flange"
at = [0, 0, 0]
axis = [0, 0, 1]
radius = 24
thickness = 5
curves = ["foot"]

[solids.end]
kind = "cap"
curve = "head"

[films.skin]
kind = "loft"
curves = ["foot", "head"]

[fillets.root]
curves = ["foot"]
radius = "fillet"

[bodies.part]
enclosed_by = ["skin", "plate", "end"]
volume = "pi * (8^2 * 20 + 24^2 * 5)"
material = "steel"

[resolution]
fea = 5.0
film = 2.5

[materials.steel]
youngs_modulus = 210000
poisson_ratio = 0.3
density = 1.0

[load_cases.pull]
supports = [{ on = "plate/bottom", fix = "xyz" }]
loads = [{ on = "end", force = [0, 0, 20106] }]

[responses.mass]
kind = "mass"

[responses.stress]
kind = "von_mises_norm"
power = 8

[responses.peak]
kind = "max_von_mises"

[responses.give]
kind = "compliance"

[study]
kind = "match"
targets = { mass = 1.0 }
)toml";
}

}  // namespace meniscus
