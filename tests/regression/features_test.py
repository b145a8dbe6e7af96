#!/usr/bin/env python3
"""Bosses, flanges, lugs and blocks: volumes in closed form, exact gradients at
drawn designs, exact faces in STEP, films that grow from them, and what is
refused."""
import json
import math
import random
import unittest

from program import ProgramTest
from step_test import gmsh_volume, surface_kinds

HEAD = """title = "Features"
units = "mm-N-MPa"

[materials.steel]
youngs_modulus = "210 GPa"
poisson_ratio = 0.3
density = "7850 kg/m3"

[load_cases.pull]
supports = [{{ on = "{held}", fix = "xyz" }}]
loads = [{{ on = "{loaded}", force = [100, 200, 300] }}]

[responses.volume]
kind = "volume"

[responses.moved]
kind = "mean_displacement"
on = "{loaded}"
direction = [1, 2, 3]

[resolution]
fea = {fea}
"""

# Mid-sides lie on the cylinders: volumes are of fourth order in the edge.
MOST_OFF = 2e-4  # of a volume, edges about a third of the radii
EXACT = 1e-7  # of a CAD volume


def variables(**initial):
    """Design variables that may move by a tenth, the values drawn."""
    return "".join(
        f"\n[design.{name}]\ninitial = {value}\n"
        f"bounds = [{value - 0.1 * abs(value)}, {value + 0.1 * abs(value)}]\n"
        for name, value in initial.items())


def draw(seed):
    return random.Random(seed)


def lug(rng):
    bore = rng.uniform(5, 9)
    radius = bore + rng.uniform(4, 8)
    numbers = dict(bore=bore, radius=radius, thickness=rng.uniform(5, 12),
                   length=rng.uniform(1.4, 2) * radius,
                   width=rng.uniform(1.6, 3) * radius,
                   tilt=rng.uniform(0.1, 0.8))
    text = HEAD.format(held="foot", loaded="lug/bore",
                       fea=0.35 * bore) + variables(**numbers) + """
[solids.lug]
kind = "lug"
at = [3, "tilt", 5]
axis = [0, 1, "tilt"]
foot = ["tilt", 0.3, -1]
radius = "radius"
bore = "bore"
thickness = "thickness"
length = "length"
width = "width"

[solids.foot]
kind = "cap"
curve = "lug/foot"

[bodies.part]
enclosed_by = ["lug", "foot"]
material = "steel"
"""
    # Sides are tangents from the foot's corners to the round end.
    half, length = numbers["width"] / 2, numbers["length"]
    far = math.hypot(half, length)
    side = math.sqrt(far ** 2 - radius ** 2)
    # Of half the outline: the kite between middle, corner and shoulder, what
    # is left of the foot, and the sector beyond.
    sector = math.pi - math.atan2(half, length) - math.atan2(side, radius)
    area = (radius * side + half * length + sector * radius ** 2
            - math.pi * bore ** 2)
    return text, area * numbers["thickness"], {"Plane": 5, "Cylinder": 2}


def boss(rng):
    bore = rng.uniform(3, 5)
    numbers = dict(bore=bore, radius=bore + rng.uniform(4, 6),
                   base_radius=bore + rng.uniform(7, 9),
                   height=rng.uniform(12, 20), depth=rng.uniform(6, 9),
                   chamfer=rng.uniform(0.8, 1.5), tilt=rng.uniform(0.1, 0.8))
    text = HEAD.format(held="base", loaded="boss/bore",
                       fea=0.5 * bore) + variables(**numbers) + """
[solids.boss]
kind = "boss"
at = [1, "tilt", 2]
axis = ["tilt", -1, 0.5]
radius = "radius"
base_radius = "base_radius"
height = "height"
bore = "bore"
depth = "depth"
chamfer = "chamfer"

[solids.base]
kind = "cap"
curve = "boss/base"

[bodies.part]
enclosed_by = ["boss", "base"]
material = "steel"
"""
    def frustum(a, b, height):
        return math.pi * height / 3 * (a * a + a * b + b * b)
    n, c = numbers, numbers["chamfer"]
    volume = (frustum(n["radius"], n["base_radius"], n["height"])
              - frustum(bore, bore + c, c)
              - math.pi * bore ** 2 * (n["depth"] - c))
    return text, volume, {"Plane": 3, "Cylinder": 1, "Cone": 2}


def flange(rng):
    hole = rng.uniform(2, 3.5)
    numbers = dict(width=rng.uniform(50, 60), length=rng.uniform(38, 46),
                   corner=rng.uniform(4, 8), hole=hole,
                   thickness=rng.uniform(4, 8), out=rng.uniform(11, 14))
    text = HEAD.format(held="flange/hole_1", loaded="flange/hole_3",
                       fea=1.2 * hole) + variables(**numbers) + """
[solids.flange]
kind = "flange"
at = [0, 0, 3]
axis = [0.2, 0, 1]
across = [1, 0, 0.3]
width = "width"
length = "length"
corner_radius = "corner"
thickness = "thickness"
hole_radius = "hole"
hole_centers = [{ at = ["out * cos(i * pi / 2)", "out * sin(i * pi / 2)", 0], repeat = 4 }]

[bodies.part]
enclosed_by = ["flange"]
material = "steel"
"""
    n = numbers
    area = (n["width"] * n["length"] - (4 - math.pi) * n["corner"] ** 2
            - 4 * math.pi * hole ** 2)
    return text, area * n["thickness"], {"Plane": 6, "Cylinder": 8}


def block(rng):
    numbers = dict(a=rng.uniform(10, 30), b=rng.uniform(10, 30),
                   c=rng.uniform(10, 30), tilt=rng.uniform(0.1, 0.8))
    text = HEAD.format(held="block/top", loaded="block/front",
                       fea=5.0) + variables(**numbers) + """
[solids.block]
kind = "block"
at = ["tilt", 0, 3]
axis = [0, "tilt", 1]
across = [1, 0, "tilt"]
size = ["a", "b", "c"]

[bodies.part]
enclosed_by = ["block"]
material = "steel"
"""
    return text, numbers["a"] * numbers["b"] * numbers["c"], {"Plane": 6}


def boss_between_films(rng):
    """A pad of liquid between a boss's two rims and a far circle."""
    numbers = dict(radius=rng.uniform(7, 9), low=rng.uniform(2, 4),
                   lift=rng.uniform(8, 10))
    return HEAD.format(held="boss/bore", loaded="boss/seat",
                       fea=3.0) + variables(**numbers) + """
[solids.boss]
kind = "boss"
at = [0, 0, 12]
axis = [0, 0, 1]
radius = "radius"
height = 12
bore = 4
rims = ["low", "lift"]

[films.collar]
kind = "loft"
curves = ["boss/rim_1", "boss/rim_2"]

[bodies.part]
enclosed_by = ["collar", "boss"]
volume = "pi * radius^2 * 12 + 900"
material = "steel"
"""


LUG_ON_BOSS = HEAD.format(held="boss/seat", loaded="lug/bore", fea=4.0) + """
[design.reach]
initial = 60.0
bounds = [55.0, 66.0]

[design.radius]
initial = 12.0
bounds = [11.0, 14.0]

[solids.lug]
kind = "lug"
at = [0, 0, "reach"]
axis = [0, 1, 0.1]
foot = [0, 0, -1]
radius = 16
bore = 8.0
thickness = 10.0
length = 22.0
width = 36.0

[solids.boss]
kind = "boss"
at = [0, 0, 0]
axis = [0, 0, -1]
radius = "radius"
height = 8
bore = 5
depth = 5

[films.skin]
kind = "loft"
curves = ["lug/foot", "boss/base"]

[bodies.part]
enclosed_by = ["skin", "lug", "boss"]
volume = 2.2e4
material = "steel"
"""


class Features(ProgramTest):
    def run_case(self, text):
        out = self.folder / "run"
        self.expect(self.call("run", self.case(text), "--out", out,
                              "--no-pictures", "--quiet"), 0)
        return out

    def check_alone(self, make, seed):
        """Volume, gradient and STEP of one feature as a part of its own."""
        text, volume, kinds = make(draw(seed))
        out = self.run_case(text)
        result = json.loads((out / "result.json").read_text())
        self.assertAlmostEqual(result["responses"]["volume"] / volume, 1.0,
                               delta=MOST_OFF)
        self.expect(self.call("check-gradient", self.case(text)), 0)
        step = self.folder / "part.step"
        self.expect(self.call("export", out, "--format", "step", "--out",
                              step), 0)
        count, exact = gmsh_volume(step)
        self.assertEqual(count, 1)
        self.assertAlmostEqual(exact / volume, 1.0, delta=EXACT)
        self.assertEqual(surface_kinds(step), kinds)

    def test_lug(self):
        self.check_alone(lug, 181)

    def test_boss(self):
        self.check_alone(boss, 182)

    def test_flange(self):
        self.check_alone(flange, 183)

    def test_block(self):
        self.check_alone(block, 184)

    def test_liquid_around_a_boss(self):
        text = boss_between_films(draw(185))
        self.run_case(text)
        self.expect(self.call("check-gradient", self.case(text)), 0)

    def test_film_from_lug_to_boss(self):
        """One body whose STEP file has the features' own faces."""
        out = self.run_case(LUG_ON_BOSS)
        step = self.folder / "part.step"
        self.expect(self.call("export", out, "--format", "step", "--out",
                              step), 0)
        count, volume = gmsh_volume(step)
        self.assertEqual(count, 1)
        self.assertAlmostEqual(volume / 2.2e4, 1.0, delta=2e-4)
        kinds = surface_kinds(step)
        self.assertEqual((kinds["Plane"], kinds["Cylinder"]), (6, 4), kinds)
        self.expect(self.call("check-gradient", self.case(LUG_ON_BOSS)), 0)

    def refuse(self, text, *parts):
        done = self.call("check", self.case(text))
        self.assertEqual(done.returncode, 2, done.stdout + done.stderr)
        for part in parts:
            self.assertIn(part, done.stderr)

    def line(self, text, what):
        return f"case.toml:{text[:text.index(what)].count(chr(10)) + 1}:"

    def changed(self, old, new, text=LUG_ON_BOSS):
        self.assertEqual(text.count(old), 1, old)
        return text.replace(old, new)

    def test_what_is_refused(self):
        thin = self.changed("bore = 8.0", "bore = 16.5")
        self.refuse(thin, self.line(thin, "[solids.lug]"),
                    "radius is 16; it must be above bore = 16.5")
        zero = self.changed("axis = [0, 0, -1]", "axis = [0, 0, 0]")
        self.refuse(zero, self.line(zero, "[solids.boss]"),
                    "axis has length 0")
        through = self.changed("depth = 5\n", "")
        self.refuse(through, "a bore through ends in the liquid")
        off = self.changed('"boss/base"]', '"boss/rim"]')
        self.refuse(off, "boss/rim", "boss/base")
        down = self.changed("depth = 5\n", 'rims = ["seat", "base"]\n')
        self.refuse(down, self.line(down, "rims ="),
                    "rims go from the base to the seat")
        # Its back is a face like others, no side of a wall.
        side = self.changed('on = "lug/bore", force',
                            'on = "lug/inside", force')
        self.refuse(side, self.line(side, "loads ="), "'lug/inside'",
                    "lug/front, lug/back")
        low = self.changed("[0, 0, \"reach\"]", "[0, 0, \"reach - 55\"]")
        self.refuse(low, self.line(low, "[solids.boss]"),
                    "solids 'lug' and 'boss' overlap near")
        text, _, _ = flange(draw(183))
        meet = self.changed("repeat = 4", "repeat = 5", text)
        self.refuse(meet, self.line(meet, "[solids.flange]"),
                    "holes 1 and 5 meet")
        wide = self.changed('"out * cos', '"3 * out * cos', text)
        self.refuse(wide, "reaches across the edge")


if __name__ == "__main__":
    unittest.main()
