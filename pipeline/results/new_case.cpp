#include "pipeline/results/new_case.h"

namespace meniscus::results {

namespace {

constexpr const char* kText = R"(
# Every number may also be an expression ("2 * gap") or a value with a unit
# ("20 mm", "71.7 GPa"). Check with `meniscus check`, run with `meniscus run`.
units = "mm-N-MPa" # lengths in mm, forces in N, stresses in MPa, mass in tonne

[parameters] # named numbers for expressions; override with --set load=2000
load = 1000.0 # N
length = 60.0 # mm

[design.foot_radius] # a design variable: what the study moves
initial = 25.0 # mm
bounds = [20.0, 32.0]

[curves.foot] # closed curves hold the liquid film
kind = "circle"
center = [0, 0, 0]
normal = [0, 0, -1] # out of the part
radius = "foot_radius"

[curves.head]
kind = "circle"
center = [0, 0, "length"]
normal = [0, 0, 1]
radius = 20

[films.skin] # the film between them
kind = "branch" # or "loft" between exactly two curves, "disk" across one
curves = ["foot", "head"]
tension = 1.0

[solids.foot_pad] # flat caps across the rims, named so that loads find them
kind = "cap"
curve = "foot"

[solids.head_pad]
kind = "cap"
curve = "head"

[bodies.part] # film and caps enclose the part
enclosed_by = ["skin", "foot_pad", "head_pad"]
volume = 9e4 # mm3
material = "aluminium"

[resolution] # edge lengths in mm: shorter is more accurate and slower
fea = 6.0 # of the film that is filled with elements
film = 3.0 # of its nested refinement

[materials.aluminium]
youngs_modulus = "71.7 GPa"
poisson_ratio = 0.33
density = "2800 kg/m3"
yield_strength = 400.0 # MPa

[load_cases.service]
supports = [{ on = "foot_pad", fix = "xyz" }]
loads = [{ on = "head_pad", force = ["load", 0, 0] }] # total, in N

[responses.sway] # mean displacement of the head along x, in mm
kind = "mean_displacement"
on = "head_pad"
direction = [1, 0, 0]
load_case = "service"

[responses.mass]
kind = "mass"

# [analysis] # modes of these go into part.vtu
# frequencies = 6 # lowest natural ones, in Hz
# buckling = 2 # smallest factors per load case

[study]
kind = "match" # or "analyse": the initial design only
targets = { sway = 0.0065 } # mm
tolerance = 1e-3 # relative
)";

}  // namespace

std::string new_case_text(const std::string& name) {
  std::string title = "title = \"";
  for (const char c : name) {
    if (c == '"' || c == '\\') {
      title += '\\';
    }
    title += static_cast<unsigned char>(c) < ' ' ? ' ' : c;
  }
  return title + "\"" + kText;
}

}  // namespace meniscus::results
