#!/usr/bin/env python3
"""Shells that end on solids, from outside: a plate that goes on from a block, a
tube on a flange; run, differentiated and refused where they must be."""
import random
import unittest

from program import ProgramTest

# A block from x = -40 to 0 and a plate that goes on from the middle of its end.
BAR = """title = "A block with a plate"
units = "mm-N-MPa"

[design.wall]
initial = 4
bounds = [1, 8]

[design.out]
initial = 40
bounds = [30, 50]

[design.width]
initial = 20
bounds = [15, 25]

[design.load]
initial = 1
bounds = [0.1, 5]

[curves.outline]
kind = "polygon"
points = [[0, 0, 0], ["out", 0, 0], ["out", "width", 0], [0, "width", 0]]

[curves.end]
kind = "polygon"
points = [["out", 0, 0], ["out", "width", 0], ["out", "width", -9], ["out", 0, -9]]

[solids.base]
kind = "block"
at = [-20, "width / 2", 0]
axis = [0, 0, 1]
across = [1, 0, 0]
size = [40, "width", 4]

[films.plate]
kind = "disk"
curves = ["outline"]

[bodies.block]
enclosed_by = ["base"]
material = "model"

[shells.strip]
films = ["plate"]
thickness = "wall"
material = "model"

[resolution]
fea = 5

[materials.model]
youngs_modulus = 1000
poisson_ratio = 0
density = "1000 kg/m3"
yield_strength = 10

[load_cases.tip]
supports = [{ on = "base/left", fix = "xyz" }]
loads = [{ on = "plate/rim:end", force = [0, 0, "load"] }]

[load_cases.many]
supports = [{ on = "base/left", fix = "xyz" }]
loads = [
  { on = "plate/rim:end", force = ["load", 2, 0] },
  { on = "base/top", force = [0, 1, "-3 * load"] },
  { on = "plate", traction = [0, 0.01, "0.001 * x"] },
  { on = "plate/outside", pressure = 0.01 },
  { gravity = [0, 0, -9810] },
]

[responses.dip]
kind = "mean_displacement"
on = "plate/rim:end"
direction = [0, 0, 1]
load_case = "tip"

[responses.mass]
kind = "mass"

[responses.volume]
kind = "volume"

[responses.work]
kind = "compliance"
load_case = "many"

[responses.energy]
kind = "strain_energy"
load_case = "tip"

[responses.most]
kind = "displacement_norm"
on = "plate"
direction = [0, 0, 1]
load_case = "many"

[responses.top_moves]
kind = "mean_displacement"
on = "base/top"
direction = [1, 1, 1]
load_case = "many"

[responses.turned]
kind = "rotation"
on = "plate"
axis = [0, 1, 0]
load_case = "many"

[responses.peak]
kind = "max_von_mises"
load_case = "tip"
"""

MODULUS = 1000
SAME = 1e-6


def deflection(length=80, height=4, width=20):
    """Of a cantilever under 1 N, with shear; Poisson's ratio is 0."""
    inertia = width * height**3 / 12
    return (length**3 / (3 * MODULUS * inertia) +
            length / (5 / 6 * MODULUS / 2 * width * height))


def bar_of(height, out, width):
    """Block and plate as thick as each other."""
    return (BAR.replace("initial = 4\n", f"initial = {height}\n")
            .replace('"width", 4]', f'"width", {height}]')
            .replace("initial = 40\n", f"initial = {out}\n")
            .replace("initial = 20\n", f"initial = {width}\n"))


# A tube of shells on a round flange with a bore, bent by its other end; `foot`
# stands within the flange's upper face.
TUBE = """title = "A tube on a flange"
units = "mm-N-MPa"

[design.radius]
initial = 30
bounds = [25, 35]

[design.wall]
initial = 2
bounds = [1, 4]

[design.plate]
initial = 10
bounds = [8, 14]

[curves.under]
kind = "circle"
center = [0, 0, 0]
normal = [0, 0, -1]
radius = 45

[curves.over]
kind = "circle"
center = [0, 0, "plate"]
normal = [0, 0, 1]
radius = 45

[curves.foot]
kind = "circle"
center = [0, 0, "plate"]
normal = [0, 0, -1]
radius = "radius"

[curves.head]
kind = "circle"
center = [0, 0, "plate + 40"]
normal = [0, 0, 1]
radius = "radius"

[films.skin]
kind = "loft"
curves = ["foot", "head"]

[solids.ground]
kind = "cap"
curve = "under"

[solids.side]
kind = "ring"
curve = "under"
inner = "over"

[solids.face]
kind = "cap"
curve = "over"

[solids.low_end]
kind = "cap"
curve = "foot"

[solids.high_end]
kind = "cap"
curve = "head"

[bodies.flange]
enclosed_by = ["ground", "side", "face"]
material = "steel"

[bodies.gas]
enclosed_by = ["skin", "low_end", "high_end"]
volume = "pi * radius^2 * 40"
material = "void"

[shells.tube]
films = ["skin"]
thickness = "wall"
material = "steel"

[resolution]
fea = 8

[materials.steel]
youngs_modulus = "210 GPa"
poisson_ratio = 0.3
density = "7850 kg/m3"
yield_strength = "355 MPa"

[load_cases.bent]
supports = [{ on = "ground", fix = "xyz" }]
loads = [{ on = "skin/rim:head", force = [1000, 0, 0] }]

[responses.sway]
kind = "mean_displacement"
on = "skin/rim:head"
direction = [1, 0, 0]

[responses.mass]
kind = "mass"

[responses.work]
kind = "compliance"

[responses.peak]
kind = "max_von_mises"
"""

class JointTest(ProgramTest):

    def figures(self, text, *options, name="case"):
        out = self.folder / name
        done = self.expect(self.call(
            "run", self.case(text, name + ".toml"), "--out", out,
            "--no-pictures", "--no-report", *options), 0)
        result = self.result(out)
        return result, result["responses"], done.stdout, out

    def test_bends_as_a_beam_does(self):
        result, responses, said, out = self.figures(BAR)
        exact = deflection()
        self.assertAlmostEqual(responses["dip"] / exact, 1.0, delta=1e-3)
        self.assertAlmostEqual(responses["energy"], responses["dip"] / 2,
                               delta=SAME * exact)
        self.assertAlmostEqual(responses["volume"], 80 * 20 * 4, delta=1e-5)
        self.assertLess(result["fea"]["reaction_imbalance"], 1e-9)
        self.assertLess(result["fea"]["residual"], 1e-9)
        self.assertGreater(result["tet"]["shell_facets"], 50)
        self.assertRegex(said, "six-node facets of shells")
        for file in ("part.vtu", "part_surface.vtp", "part_2.5.stl"):
            self.assertTrue((out / file).exists(), file)
        # At the root 6 M / (b t^2); the clamp has its own peak, of Poisson 0
        # a small one.
        self.assertAlmostEqual(responses["peak"], 80 / (20 * 16 / 6), delta=0.02)

    def test_bends_as_beams_drawn_at_random(self):
        draw = random.Random(41)
        for k in range(4):
            height = draw.uniform(1.5, 6)
            out = draw.uniform(30, 50)
            width = draw.uniform(15, 25)
            with self.subTest(height=height, out=out, width=width):
                _, responses, _, _ = self.figures(
                    bar_of(height, out, width), name=f"bar_{k}")
                exact = deflection(40 + out, height, width)
                self.assertAlmostEqual(responses["dip"] / exact, 1.0,
                                       delta=2e-3)

    # All of solids with edges of 3, 119,664 unknowns: 5.25062e-3.
    def test_stands_on_a_flange_as_a_solid_does(self):
        for edge, share in ((8, 0.01), (5, 0.003)):
            _, responses, _, _ = self.figures(
                TUBE, "--set", f"resolution.fea={edge}", name=f"tube_{edge}")
            self.assertAlmostEqual(responses["sway"] / 5.25062e-3, 1.0,
                                   delta=share)

    def test_has_exact_gradients(self):
        self.expect(self.call("check-gradient", self.case(BAR)), 0)
        self.expect(self.call("check-gradient", self.case(TUBE, "tube.toml")), 0)

    def test_says_what_both_cannot_do(self):
        wrong = [
            ("[resolution]", "[analysis]\nbuckling = 1\n\n[resolution]",
             "buckling factors cannot yet"),
            ('kind = "volume"', 'kind = "uniformity"',
             "responses.volume"),
            ('on = "base/left", fix = "xyz" }', 'on = "plate/rim:end", '
             'fix = "xyz", displacement = [1, 0, 0] }',
             "an enforced displacement cannot yet"),
            ('{ on = "base/top", force = [0, 1, "-3 * load"] }',
             '{ temperature = 50 }', "a temperature cannot yet"),
            ('on = "base/left", fix = "xyz" }', 'on = "base/left", '
             'fix = "xyz", displacement = [1, 0, 0] }',
             "an enforced displacement cannot yet"),
            ('on = "base/left", fix = "xyz" }',
             'on = "base/left", by = "rigid", at = [-40, 0, 0], fix = "xyz" }',
             "a rigid support cannot yet"),
            ('{ on = "base/top", force = [0, 1, "-3 * load"] }',
             '{ on = ["base/top", "plate"], force = [0, 1, 0] }',
             "a load on both together cannot yet"),
            ('youngs_modulus = 1000', 'youngs_modulus = "100 * out"',
             "'model', which follows the design, cannot yet"),
            ("[resolution]", "[analysis]\nadapt = true\n\n[resolution]",
             "analysis.adapt is of solids"),
        ]
        for old, new, said in wrong:
            self.assertIn(old, BAR)
            done = self.expect(self.call("check", self.case(
                BAR.replace(old, new, 1))), 2)
            self.assertIn(said, done.stderr)
            self.assertRegex(done.stderr, r"case\.toml(:\d+)?: ")
        out = self.folder / "out"
        self.expect(self.call("run", self.case(BAR), "--out", out,
                              "--no-pictures", "--no-report", "--quiet"), 0)
        self.expect(self.call("export", out, "--format", "inp"), 2,
                    "cannot yet hold shells.strip beside solid bodies")

    def test_tells_of_a_plate_that_does_not_touch(self):
        away = BAR.replace("points = [[0, 0, 0], [", "points = [[1, 0, 0], [", 1
                           ).replace('[0, "width", 0]]', '[1, "width", 0]]', 1)
        self.assertNotEqual(away, BAR)
        self.expect(self.call("run", self.case(away), "--out",
                              self.folder / "away", "--no-pictures",
                              "--no-report"), 3,
                    "is free to", "edge lie on the solid's surface")


if __name__ == "__main__":
    unittest.main()
