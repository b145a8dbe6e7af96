#!/usr/bin/env python3
"""Shells from outside: films of a thickness are run, differentiated, studied
and refused where they must be."""
import csv
import math
import os
import random
import unittest

from program import ROOT, ProgramTest

# Gas keeps the film a cylinder. In the middle, seven lengths of its edge effect
# from either ring, `swell` is half of the radial displacement times the mean of
# its weight over the length.
TUBE = """title = "A tube under pressure"
units = "mm-N-MPa"

[design.ring]
initial = 50
bounds = [40, 60]

[design.wall]
initial = 1
bounds = [0.2, 5]

[design.inside]
initial = 2
bounds = [0.1, 5]

[design.fill]
initial = 1
bounds = [0.9, 1.1]

[curves.low]
kind = "circle"
center = [0, 0, -50]
normal = [0, 0, -1]
radius = "ring"

[curves.high]
kind = "circle"
center = [0, 0, 50]
normal = [0, 0, 1]
radius = "ring"

[films.skin]
kind = "loft"
curves = ["low", "high"]

[solids.low_end]
kind = "cap"
curve = "low"

[solids.high_end]
kind = "cap"
curve = "high"

[bodies.gas]
enclosed_by = ["skin", "low_end", "high_end"]
volume = "fill * pi * ring^2 * 100"
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

[load_cases.inner]
supports = [{ on = "skin/rim:low", fix = "xyz" }, { on = "skin/rim:high", fix = "xy" }]
loads = [{ on = "skin/inside", pressure = "inside" }]

[load_cases.many]
supports = [{ on = "skin/rim:low", fix = "xyz", fix_rotation = "xyz" }]
loads = [
  { on = "skin/rim:high", force = [1000, 0, "ring * 10"] },
  { on = "skin", force = ["100 * inside", 0, 0] },
  { on = "skin", traction = [0, 0.01, "0.001 * x"] },
  { on = "skin/outside", pressure = 0.1 },
  { gravity = [0, 0, -9810] },
  { spin = 100, at = [0, 0, 0], axis = [0, 0, 1] },
]

[responses.swell]
kind = "mean_displacement"
on = "skin"
direction = [1, 0, 0]
weight = "x / 50 * exp(-(z / 10)^2)"
load_case = "inner"

[responses.mass]
kind = "mass"

[responses.volume]
kind = "volume"

[responses.stretch]
kind = "compliance"
load_case = "inner"

[responses.energy]
kind = "strain_energy"
load_case = "many"

[responses.tip]
kind = "mean_displacement"
on = "skin/rim:high"
direction = [1, 0, 0.2]
load_case = "many"

[responses.turned]
kind = "rotation"
on = "skin"
axis = [0, 1, 0]
load_case = "many"

[responses.stress]
kind = "von_mises_norm"
power = 8
load_case = "many"

[responses.most]
kind = "displacement_norm"
on = "skin/inside"
direction = [1, 0, 0]
load_case = "many"

[analysis]
buckling = 0
"""
LENGTH, MODULUS = 100, 210e3

# A soap film between two circles that stand aslant, drawn at random.
DRAWN = """title = "A film drawn at random"
units = "mm-N-MPa"

[design.ring]
initial = {ring:.3f}
bounds = [10, 100]

[design.lean]
initial = {lean:.3f}
bounds = [-30, 30]

[design.wall]
initial = {wall:.3f}
bounds = [0.01, 20]

[design.pull]
initial = {pull:.3f}
bounds = [-100, 100]

[curves.low]
kind = "circle"
center = [0, 0, 0]
normal = [{tilt:.3f}, 0, -1]
radius = "ring"

[curves.high]
kind = "circle"
center = ["lean", {aside:.3f}, {height:.3f}]
normal = [0, {tilt:.3f}, 1]
radius = {radius:.3f}

[films.skin]
kind = "loft"
curves = ["low", "high"]

[shells.skin]
films = ["skin"]
thickness = "wall * (1 + {rough:.3f} * sin(x / 20 + z / 15))"
side = "{side}"
material = "steel"

[resolution]
fea = {edge:.3f}

[materials.steel]
youngs_modulus = 210e3
poisson_ratio = {ratio:.3f}
density = 7.85e-9

[load_cases.one]
supports = [{{ on = "skin/rim:low", fix = "xyz", fix_rotation = "{turn}" }}]
loads = [
  {{ on = "skin/rim:high", force = ["pull", {force:.3f}, 30] }},
  {{ on = "skin/{face}", pressure = {pressure:.4f} }},
  {{ on = "skin", force = [0, "2 * pull", 1], moment = [0, 100, "pull"], at = ["lean", 0, 20] }},
  {{ gravity = [0, -9810, 0] }},
]

[responses.work]
kind = "compliance"

[responses.tip]
kind = "mean_displacement"
on = "skin/rim:high"
direction = [1, 1, 1]

[responses.stress]
kind = "von_mises_norm"
power = {power:.0f}

[responses.mass]
kind = "mass"

[analysis]
buckling = 0
"""


def drawn(seed):
    roll = random.Random(seed)
    ring = roll.uniform(35, 60)
    return DRAWN.format(
        ring=ring, lean=roll.uniform(-8, 8), wall=roll.uniform(0.3, 3),
        pull=roll.uniform(-50, 50), tilt=roll.uniform(-0.08, 0.08),
        aside=roll.uniform(-6, 6), height=roll.uniform(20, 30),
        radius=roll.uniform(0.8, 1.2) * ring, rough=roll.uniform(-0.4, 0.4),
        side=roll.choice(["both", "inside", "outside"]),
        edge=roll.uniform(10, 16), ratio=roll.uniform(0, 0.45),
        turn=roll.choice(["xyz", "z", "xy"]), force=roll.uniform(-40, 40),
        face=roll.choice(["inside", "outside"]),
        pressure=roll.uniform(-0.2, 0.2), power=roll.choice([4, 8, 16]))

# A strip across a rectangle; `root` holds nothing and names its foot.
STRIP = """title = "A strip, clamped at one end"
units = "mm-N-MPa"

[design.wall]
initial = 1
bounds = [0.2, 2]

[curves.outline]
kind = "polygon"
points = [[0, 0, 0], [100, 0, 0], [100, 20, 0], [0, 20, 0]]

[curves.root]
kind = "polygon"
points = [[0, 0, 0], [0, 20, 0], [0, 20, -9], [0, 0, -9]]

[curves.end]
kind = "polygon"
points = [[100, 0, 0], [100, 20, 0], [100, 20, -9], [100, 0, -9]]

[films.plate]
kind = "disk"
curves = ["outline"]

[shells.strip]
films = ["plate"]
thickness = "wall"
material = "model"

[resolution]
fea = 7

[materials.model]
youngs_modulus = 1000
poisson_ratio = 0
density = "1000 kg/m3"

[load_cases.tip]
supports = [{ on = "plate/rim:root", fix = "xyz", fix_rotation = "xyz" }]
loads = [{ on = "plate/rim:end", force = [0, 0, 0.1] }]

[responses.dip]
kind = "mean_displacement"
on = "plate/rim:end"
direction = [0, 0, 1]

[responses.peak]
kind = "max_von_mises"

[responses.mass]
kind = "mass"

[analysis]
buckling = 0
"""


class Shells(ProgramTest):
    def case(self, text=TUBE, name="case.toml"):
        return super().case(text, name)

    def run_case(self, text, *arguments, name="out"):
        out = self.folder / name
        done = self.expect(self.call("run", self.case(text), "--out", out,
                                     *arguments), 0)
        return self.result(out), done.stdout, out

    # u_r = p r (r - t/2) / (E t) where the rings are far: the pressure acts on
    # the inner face, and squeezes the wall by Poisson's ratio.
    def test_swells_as_a_cylinder_does(self):
        for pressure, wall in ((2, 1), (0.5, 0.4)):
            result, said, out = self.run_case(
                TUBE, "--set", f"design.wall.initial={wall}", "--set",
                f"design.inside.initial={pressure}", name=f"out_{wall}")
            share = math.sqrt(math.pi) * 10 * math.erf(5) / LENGTH
            radial = result["responses"]["swell"] / (0.5 * share)
            ideal = pressure * 50 * (50 - wall / 2) / (MODULUS * wall)
            self.assertLess(abs(radial / ideal - 1), 5e-3)
            # Facets bulge by what a quadratic through three points of an arc
            # leaves.
            self.assertLess(abs(result["responses"]["volume"] /
                                (2 * math.pi * 50 * LENGTH * wall) - 1), 1e-3)
            self.assertLess(abs(result["responses"]["mass"] /
                                (7.85e-9 * result["responses"]["volume"]) - 1),
                            1e-9)
            self.assertIn("six-node facets of shells", said)
            self.assertEqual(result["shell"]["facets"] % 2, 0)
            for name in ("film.vtp", "part.vtu", "part_surface.vtp",
                         "part.png", "overview.png", "report.html"):
                self.assertTrue((out / name).exists(), name)

    def test_bends_as_a_strip_does(self):
        for wall in (1, 0.2):
            result, _, _ = self.run_case(STRIP, "--no-pictures", "--set",
                                         f"design.wall.initial={wall}")
            inertia = 20 * wall ** 3 / 12
            shear = 0.1 * 100 / (5 / 6 * 500 * 20 * wall)
            ideal = 0.1 * 100 ** 3 / (3 * 1000 * inertia) + shear
            self.assertLess(abs(result["responses"]["dip"] / ideal - 1), 1e-6)
            stress = 0.1 * 100 * wall / 2 / inertia
            self.assertLess(abs(result["responses"]["peak"] / stress - 1), 1e-6)
            self.assertLess(abs(result["responses"]["mass"] / (2e-6 * wall)
                                - 1), 1e-9)

    # The same strip of two films that share a side, and of two shells.
    def test_joins_films_that_share_a_side(self):
        whole, _, _ = self.run_case(STRIP, "--no-pictures")
        halves = STRIP.replace(
            "[[0, 0, 0], [100, 0, 0], [100, 20, 0], [0, 20, 0]]",
            "[[0, 0, 0], [50, 0, 0], [50, 20, 0], [0, 20, 0]]").replace(
            "[curves.root]", """[curves.other]
kind = "polygon"
points = [[50, 0, 0], [100, 0, 0], [100, 20, 0], [50, 20, 0]]

[curves.root]""").replace("[shells.strip]", """[films.rest]
kind = "disk"
curves = ["other"]

[shells.rest]
films = ["rest"]
thickness = "wall"
material = "model"

[shells.strip]""").replace("plate/rim:end", "rest/rim:end")
        parts, _, _ = self.run_case(halves, "--no-pictures", name="halves")
        for name in ("dip", "peak", "mass"):
            self.assertLess(abs(parts["responses"][name] /
                                whole["responses"][name] - 1), 1e-6)

    def test_has_exact_gradients(self):
        for side in ("both", "outside"):
            text = TUBE.replace('material = "steel"\n',
                                f'material = "steel"\nside = "{side}"\n', 1)
            self.expect(self.call("check-gradient", self.case(text)), 0)

    def test_has_exact_gradients_of_films_drawn_at_random(self):
        for seed in range(4):
            with self.subTest(seed=seed):
                self.expect(self.call("check-gradient",
                                      self.case(drawn(seed))), 0)

    def test_takes_its_thickness_along(self):
        text = TUBE.replace('thickness = "wall"',
                            'thickness = "wall * (1 + z^2 / 5000)"')
        self.expect(self.call("check-gradient", self.case(text)), 0)

    def test_is_sized(self):
        study = """
[study]
kind = "minimize"
objective = "mass"
constraints = [{ response = "dip", max = 10 }]
"""
        result, _, _ = self.run_case(STRIP + study, "--no-pictures")
        self.assertEqual(result["status"], "converged")
        ideal = (0.1 * 100 ** 3 * 12 / (3 * 1000 * 20 * 10)) ** (1 / 3)
        self.assertLess(abs(result["parameters"]["wall"] / ideal - 1), 2e-3)

    def test_has_the_same_bits_for_any_number_of_threads(self):
        figures = []
        for threads in ("1", "3"):
            environment = dict(os.environ, OMP_NUM_THREADS=threads)
            out = self.folder / f"out_{threads}"
            self.expect(self.call("run", self.case(), "--out", out,
                                  "--no-pictures", env=environment), 0)
            result = self.result(out)
            figures.append((result["responses"], result["response_errors"],
                            result["stress"]))
        self.assertEqual(*figures)

    def test_is_exported_as_facets_and_film(self):
        _, _, out = self.run_case(STRIP, "--no-pictures")
        for form in ("vtu", "fe"):
            self.expect(self.call("export", out, "--format", form), 0)

    # Members stand in pairs of one shape under 2 and 3.5 kN.
    def test_analyses_thirty_thin_struts(self):
        out = self.folder / "struts"
        self.expect(self.call(
            "run", ROOT / "cases" / "strut_family" / "shells.toml", "--jobs",
            "2", "--no-pictures", "--no-report", "--out", out), 0)
        rows = list(csv.DictReader((out / "family.csv").open()))
        self.assertEqual(len(rows), 30)
        masses = set()
        for light, heavy in zip(rows[::2], rows[1::2]):
            self.assertEqual((light["load"], heavy["load"]), ("2000", "3500"))
            self.assertEqual(light["mass"], heavy["mass"])
            masses.add(light["mass"])
            for name in ("deflection", "stress"):
                ratio = float(heavy[name]) / float(light[name])
                self.assertLess(abs(ratio / 1.75 - 1), 1e-9)
        self.assertEqual(len(masses), 15)

    def test_says_what_it_does_not_do(self):
        wrong = [
            ('supports = [{ on = "skin/rim:low", fix = "xyz" }',
             'supports = [{ on = "skin/rim:low", fix = "normal" }',
             "a support along normals"),
            ('fix = "xyz" }', 'stiffness = [1, 1, 1] }', "springs"),
            ('fix = "xyz" }', 'fix = "xyz", displacement = [1, 0, 0] }',
             "an enforced displacement"),
            ('force = [1000, 0, "ring * 10"]',
             'by = "rigid", force = [1000, 0, 0]', "a rigid or bearing load"),
            ("{ gravity = [0, 0, -9810] }", "{ temperature = 20 }",
             "a temperature"),
            ("pressure = 0.1", 'pressure = "0.1 + z"', "a pressure of place"),
            ("spin = 100", 'spin = "inside"', "a spin that follows the design"),
            ('kind = "mass"', 'kind = "frequency"',
             "responses.mass is of kind frequency, which shells do not have"),
            ('power = 8\nload_case = "many"', 'power = 8\nload_case = "inner"',
             "whose pressure follows the design"),
            ("fea = 8", "fea = 8\nfilm = 8", "resolution.film is as long"),
            ("buckling = 0", "buckling = 1", "analysis.buckling is of solids"),
            ('youngs_modulus = "210 GPa"', 'youngs_modulus = "1e5 * fill"',
             "'steel' follows the design"),
            ('material = "void"', 'material = "steel"',
             "shells.tube stands beside bodies.gas, which is solid"),
            ('"skin/rim:high", fix', '"skin/rim:hihg", fix',
             "there is no surface 'skin/rim:hihg'"),
        ]
        for old, new, said in wrong:
            self.assertIn(old, TUBE)
            done = self.expect(self.call("check", self.case(
                TUBE.replace(old, new, 1))), 2)
            self.assertIn(said, done.stderr)
            self.assertRegex(done.stderr, r"case\.toml(:\d+)?: ")

    def test_tells_of_a_shell_that_can_move(self):
        text = STRIP.replace(', fix_rotation = "xyz"', "")
        done = self.call("run", self.case(text), "--out", self.folder / "out")
        self.expect(done, 3)
        self.assertRegex(done.stdout + done.stderr, "turn|move")


if __name__ == "__main__":
    unittest.main()
