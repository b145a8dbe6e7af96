#include "tests/support/field_case.h"

#include <fmt/format.h>

namespace meniscus {

std::string field_case(int along, int around, double edge) {
  return fmt::format(R"(title = "A strut with a field of tension"
units = "mm-N-MPa"

[design.t]
shape = [{}, {}]
initial = 1.0
bounds = [0.5, 2.0]

[shapes.skin_tension]
kind = "axis"
from = [0, 0, 0]
to = [0, 0, 60]
coefficients = "t"

[curves.base]
kind = "circle"
center = [0, 0, 0]
normal = [0, 0, -1]
radius = 25

[curves.head]
kind = "circle"
center = [5, 0, 60]
normal = [0, 0, 1]
radius = 20

[films.skin]
kind = "loft"
curves = ["base", "head"]
tension = "skin_tension"

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
fea = {}

[materials.aluminium]
youngs_modulus = 71700.0
poisson_ratio = 0.33
density = 2.8e-9

[load_cases.service]
supports = [{{ on = "foot_pad", fix = "xyz" }}]
loads = [{{ on = "head_pad", force = [1000, 0, 0] }}]

[responses.sway]
kind = "mean_displacement"
on = "head_pad"
direction = [1, 0, 0]

[study]
kind = "analyse"
)",
                     along, around, edge);
}

}  // namespace meniscus
