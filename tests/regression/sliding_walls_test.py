#!/usr/bin/env python3
"""Walls of films that slide, from outside: on planes at any angle, in planes of
symmetry and in cells of planes. Thickness, ends in their planes, closed forms,
halves and wholes, gradients, files, refusals."""
import json
import math
import random
import re
import unittest

from program import ProgramTest, some
from walls_test import PIPE

STEEL = """
[materials.steel]
youngs_modulus = 1000
poisson_ratio = 0.3
density = "7850 kg/m^3"

[analysis]
buckling = 0
"""
# A band that slides on the floor and is held at the roof.
BAND = """title = "A band on a floor"
units = "mm-N-MPa"

[design.fill]
initial = {fill}
bounds = [1e4, 6e4]

[design.wall]
initial = {wall}
bounds = [0.5, 8]

[design.angle]
initial = {angle}
bounds = [0.8, 2.4]
{top}
[curves.low]
kind = "circle"
center = [{x}, {y}, 0]
normal = [0, 0, 1]
radius = 20

[curves.high]
kind = "circle"
center = [0, 0, 20]
normal = [0, 0, 1]
radius = {radius}

[films.skin]
kind = "loft"
curves = ["low", "high"]

[solids.floor]
{foot}
curve = "low"

[solids.roof]
{roof}
curve = "high"

[bodies.room]
enclosed_by = ["skin", "floor", "roof"]
volume = "fill"
material = "void"

[walls.shell]
films = ["skin"]
thickness = "wall"
side = "{side}"
material = "steel"

[load_cases.service]
supports = [{{ on = "skin/rim:{base}", fix = "xyz" }}]
loads = [{{ on = "skin/rim:{end}", force = ["{share} * 100", 0, "-1000 * {share}"] }}]

[responses.sway]
kind = "mean_displacement"
on = "skin/rim:{end}"
direction = [1, 0, 1]

[responses.volume]
kind = "volume"

[responses.area]
kind = "film_area"

[resolution]
fea = {edge}
""" + STEEL
ON_FLOOR = """kind = "wetted"
at = [0, 0, 0]
normal = [0, 0, 1]
contact_angle = "angle\""""
HELD = {"foot": 'kind = "cap"', "base": "low"}
HALF = """
[symmetry]
planes = [{ at = [0, 0, 0], normal = [0, -1, 0] }]
"""
QUARTER = HALF.replace("}]", "}, { at = [0, 0, 0], normal = [1, 0, 0] }]")
# The film begins on a triangle, one side in each of three planes.
BALL = """title = "An eighth of a ball's shell"
units = "mm-N-MPa"

[design.fill]
initial = {fill}
bounds = [100, 1000]

[design.wall]
initial = 1.0
bounds = [0.5, 2]

[symmetry]
planes = [
  {{ at = [0, 0, 0], normal = [-1, 0, 0] }},
  {{ at = [0, 0, 0], normal = [0, -1, 0] }},
  {{ at = [0, 0, 0], normal = [0, 0, -1] }},
]

[curves.rim]
kind = "polygon"
points = [[10, 0, 0], [0, 10, 0], [0, 0, 10]]

[films.skin]
kind = "disk"
curves = ["rim"]

[bodies.room]
enclosed_by = ["skin"]
volume = "fill"
material = "void"

[walls.shell]
films = ["skin"]
thickness = "wall"
material = "steel"

[load_cases.inner]
supports = [{{ on = "skin/symmetry_2", fix = "symmetry" }}]
loads = [{{ on = "skin/inside", pressure = 1 }}]

[responses.volume]
kind = "volume"

[responses.area]
kind = "film_area"

[responses.pressure]
kind = "pressure"
body = "room"

[responses.swelling]
kind = "mean_displacement"
on = "skin/outside"
direction = [1, 1, 1]

[resolution]
fea = {edge}
""" + STEEL


def band(seed=0, **changed):
    draw = random.Random(seed)
    numbers = {"fill": draw.uniform(2.6e4, 3.2e4), "wall": draw.uniform(1, 3),
               "angle": math.radians(draw.uniform(60, 120)),
               "x": draw.uniform(-2, 2), "y": draw.uniform(-2, 2),
               "radius": 20, "edge": draw.uniform(4, 5), "side": "both",
               "roof": 'kind = "cap"', "end": "high", "top": "", "share": "1",
               "foot": ON_FLOOR, "base": "floor"}
    return BAND.format(**{**numbers, **changed})


def ball(**changed):
    return BALL.format(**{"fill": math.pi * 1000 / 6, "edge": 1.5, **changed})


class SlidingWalls(ProgramTest):
    def evolve(self, text, name="film"):
        out = self.folder / name
        self.expect(self.call("evolve", self.case(text, name + ".toml"),
                              "--out", out), 0)
        return json.loads((out / "wall_shell.json").read_text())

    def nodes_of(self, out):
        """Of the part, with all their digits."""
        path = self.folder / "part.inp"
        self.expect(self.call("export", self.folder / out, "--format", "inp",
                              "--out", path), 0)
        block = re.search(r"\*NODE\b[^\n]*\n(.*?)\n\*", path.read_text(),
                          re.S).group(1)
        return [[float(x) for x in line.split(",")[1:4]]
                for line in block.splitlines()]

    def test_gradients_are_exact_at_any_angle(self):
        for seed in some(range(6), 3):
            side = ("both", "inside", "outside")[seed % 3]
            self.expect(self.call("check-gradient", self.case(
                band(seed, side=side))), 0, "all 9 derivatives agree")

    # Also with facets that are smaller than the wall is thick, which would lie
    # beyond the plane.
    def test_walls_are_as_thick_as_asked(self):
        for seed, degrees in some(enumerate((60, 120, 75, 105)), 2):
            for edge, wall in ((4, 2), (4, 5), (1.5, 4)):
                found = self.evolve(band(seed, angle=math.radians(degrees),
                                         edge=edge, wall=wall))
                self.assertEqual(found["findings"], "", (degrees, edge, wall))
                for end in ("thinnest", "thickest"):
                    self.assertLess(abs(found[end]["value"] /
                                        found[end]["asked"] - 1), 0.05,
                                    (degrees, edge, wall, end))

    def test_ends_lie_in_their_planes(self):
        for seed, degrees in enumerate((65, 90, 115)):
            self.run_at(band(seed, angle=math.radians(degrees)))
            heights = [p[2] for p in self.nodes_of("out")]
            self.assertGreater(min(heights), -1e-12)
            there = [h for h in heights if h < 1e-6]
            self.assertGreater(len(there), 100)
            self.assertLess(max(there), 1e-12)

    # Between two planes at 90 degrees. Errors of the film are of second order.
    def test_a_tube_has_its_volume(self):
        wetted = 'kind = "wetted"\nat = [0, 0, 20]\nnormal = [0, 0, 1]'
        radius = math.sqrt(3e4 / (math.pi * 20))
        off = []
        for edge in (6, 3):
            found = self.run_at(band(
                fill=3e4, wall=4, angle=math.pi / 2, x=0, y=0, edge=edge,
                roof=wetted, end="roof"), f"tube_{edge}")
            exact = 2 * math.pi * radius * 4 * 20
            off.append(abs(found["responses"]["volume"] / exact - 1))
        self.assertLess(off[1], 2e-3)
        self.assertLess(off[1], 0.4 * off[0])

    # From its waist, where it stands upright, it flares towards the roof.
    def test_a_catenoid_has_its_volume(self):
        waist, height = 18.0, 20.0
        x = height / waist
        flare = math.acos(math.tanh(x))
        area = math.pi * waist**2 * (x + math.sinh(2 * x) / 2)
        wetted = ('kind = "wetted"\nat = [0, 0, 20]\nnormal = [0, 0, 1]\n'
                  f"contact_angle = {flare}")
        found = self.run_at(band(
            fill=math.pi * waist**2 / 2 * (height + waist / 2 *
                                           math.sinh(2 * x)),
            wall=1, angle=math.pi / 2, x=0, y=0, edge=3, roof=wetted,
            end="roof"))
        self.assertLess(abs(found["film"]["bodies"]["room"]["pressure"]), 2e-4)
        self.assertAlmostEqual(found["responses"]["area"] / area, 1, delta=2e-3)
        self.assertAlmostEqual(found["responses"]["volume"] / area, 1,
                               delta=5e-3)

    # A plane cuts films of a void along their axis, and the floor on which they
    # slide at an angle of their own.
    def test_a_half_and_a_quarter_are_the_whole(self):
        held, floor = ("held", HELD), ("floor", {})
        half, quarter = (HALF, 2, 100), (QUARTER, 4, 0)
        for (name, foot), (top, share, load) in some((
                (held, half), (floor, quarter), (held, quarter),
                (floor, half)), 2):
            way = "[1, 0, 1]" if load else "[0, 0, 1]"
            found = []
            for parts in (1, share):
                text = band(fill=3e4 / parts, top=top if parts > 1 else "",
                            share=f"1 / {parts}", angle=1.2, x=0, y=0,
                            edge=3, wall=2, **foot)
                text = text.replace("* 100", f"* {load}").replace(
                    "bounds = [1e4, 6e4]", "bounds = [5e3, 6e4]").replace(
                    "[1, 0, 1]", way)
                found.append(self.run_at(text, f"{name}_{share}_{parts}"))
            whole, part = found
            self.assertEqual(part["symmetry"]["parts"], share)
            for response, room in (("volume", 3e-3), ("sway", 0.02)):
                self.assertAlmostEqual(part["responses"][response] /
                                       whole["responses"][response], 1,
                                       delta=room, msg=response)
            self.expect(self.call("check-gradient", self.folder /
                                  f"{name}_{share}_{share}.toml"), 0)

    # It begins at a closed curve in the plane.
    def test_the_upper_half_is_the_whole(self):
        energy = """
[responses.energy]
kind = "strain_energy"
"""
        load = 'loads = [{ on = "skin/inside", pressure = 0.1 }]'
        both = ('supports = [{ on = "skin/rim:low", fix = "xyz" }, '
                '{ on = "skin/rim:high", fix = "xyz" }]')
        upper = 'supports = [{ on = "skin/rim:high", fix = "xyz" }]'
        found = []
        for parts in (1, 2):
            text = band(x=0, y=0, edge=3, wall=2, fill=6e4 / parts, **HELD)
            text = re.sub(r"loads = .*", load, text)
            text = re.sub(r"supports = .*", both if parts == 1 else upper, text)
            text = text.replace("bounds = [1e4, 6e4]", "bounds = [1e4, 7e4]")
            if parts == 1:
                text = text.replace("[0, 0, 0]", "[0, 0, -20]")
            else:
                text = text.replace('[solids.floor]\nkind = "cap"\n'
                                    'curve = "low"\n', HALF.replace(
                                        "[0, -1, 0]", "[0, 0, -1]"))
                text = text.replace('"skin", "floor", "roof"', '"skin", "roof"')
            found.append(self.run_at(text + energy, f"barrel_{parts}"))
        whole, half = found
        for response, room in (("volume", 2e-3), ("energy", 0.01)):
            self.assertAlmostEqual(half["responses"][response] /
                                   whole["responses"][response], 1, delta=room,
                                   msg=response)
        self.expect(self.call("check-gradient", self.folder / "barrel_2.toml"),
                    0)

    # Its films bound no body; their junction and its fillet end in the plane.
    def test_films_that_meet_are_cut(self):
        for free in some((True, False)):
            text = PIPE.replace("radius = 26\n", "radius = 26\nfree = true\n"
                                if free else "radius = 26\n")
            text = text.replace("fea = 6\nfilm = 3", "fea = 4\nfilm = 2")
            half = text.replace("force = [0, 100, 0]", "force = [0, 50, 0]")
            half = half.replace('units = "mm-N-MPa"\n', 'units = "mm-N-MPa"\n' +
                                HALF.replace("[0, -1, 0]", "[1, 0, 0]"))
            whole = self.run_at(text, f"whole_{free}")
            part = self.run_at(half, f"half_{free}")
            for response, room in (("mass", 1e-3), ("dip", 0.01)):
                self.assertAlmostEqual(part["responses"][response] /
                                       whole["responses"][response], 1,
                                       delta=room, msg=response)
            self.assertLess(max(p[0] for p in self.nodes_of(f"half_{free}")),
                            1e-12)
            # One closed solid of both halves.
            told = self.call("export", self.folder / f"half_{free}", "--format",
                             "step")
            self.expect(told, 0)
            solid = re.search(r"valid closed solid of ([\d.]+) mm3",
                              told.stdout + told.stderr)
            self.assertAlmostEqual(float(solid[1]) * 7.85e-9 /
                                   part["responses"]["mass"], 1, delta=4e-3)
            self.expect(self.call("check-gradient", self.folder /
                                  f"half_{free}.toml"), 0)

    def test_files_are_of_the_whole(self):
        self.run_at(band(top=HALF, x=0, y=0, angle=1.3, fill=1.5e4,
                         share="1 / 2", **HELD))
        for form in ("stl", "obj", "step-faceted", "vtu", "3mf"):
            self.expect(self.call("export", self.folder / "out", "--format",
                                  form), 0)
        self.expect(self.call("export", self.folder / "out", "--format", "obj",
                              "--out", self.folder / "whole.obj"), 0)
        ys = [float(line.split()[2]) for line in
              (self.folder / "whole.obj").read_text().splitlines()
              if line.startswith("v ")]
        self.assertAlmostEqual(min(ys), -max(ys), delta=1e-6)
        self.assertNotIn("symmetry_1", (self.folder / "whole.obj").read_text())

    # Lame's thick sphere.
    def test_an_eighth_of_a_ball(self):
        off = []
        a, b, young, poisson = 9.5, 10.5, 1000.0, 0.3
        exact = {"area": 400 * math.pi,
                 "volume": 4 / 3 * math.pi * (b**3 - a**3)}
        radial = a**3 / (b**3 - a**3) / young * (
            (1 - 2 * poisson) * b + (1 + poisson) * b / 2)
        for edge in (2, 1):
            found = self.run_at(ball(edge=edge))
            self.assertEqual(found["film"]["index"], 0)
            off.append([abs(found["responses"][r] / exact[r] - 1)
                        for r in exact])
        for coarse, fine in zip(*off):
            self.assertLess(fine, 2e-3)
            self.assertLess(fine, 0.4 * coarse)
        self.assertAlmostEqual(found["responses"]["pressure"], 0.2, delta=1e-3)
        # The mean of a direction over an eighth of a sphere.
        self.assertAlmostEqual(found["responses"]["swelling"] /
                               (radial * math.sqrt(3) / 2), 1, delta=2e-3)
        self.expect(self.call("check-gradient", self.case(ball())), 0,
                    "all 8 derivatives agree")

    def refused(self, text, *says):
        done = self.expect(self.call("check", self.case(text)), 2, *says)
        self.assertRegex(done.stderr, r"case\.toml:\d+: ")

    def test_what_cannot_be_is_refused(self):
        bent = band(roof='kind = "wetted"\nwall = "sphere"\nat = [0, 0, 0]\n'
                         "radius = 28.28427", end="roof")
        self.refused(bent, r"walls\.shell is of a film that slides on the bent "
                           "wall of 'roof'")
        held = band(top=HALF.replace("at = [0, 0, 0], normal = [0, -1, 0]",
                                     "at = [0, 0, 20], normal = [0, 0, 1]"))
        rims = band().replace('thickness = "wall"', 'thickness = "along"')
        rims = rims.replace("[walls.shell]", """[shapes.along]
kind = "rims"
curves = ["low", "high"]
coefficients = "wall"

[walls.shell]""").replace("[design.wall]", "[design.wall]\nshape = [3]")
        self.refused(rims, "the film only begins at 'low' and slides: take "
                           "curves that hold it")
        slanting = band(top=HALF.replace("[0, -1, 0]", "[1, 0, 1]"), x=0, y=0)
        self.refused(slanting, "a solid that is wetted on a bent or slanting "
                               "wall, at a curve that plane 1 of symmetry cuts; "
                               "expected a plane at right angles to it")
        self.refused(held, "walls.shell is of a film that solid 'roof' holds "
                           "in plane 1")
        self.refused(ball().replace("[0, 0, 10]]", "[1, 0, 10]]"),
                     "side 2 of curve 'rim' lies in the plane of none")
        self.refused(ball().replace("[0, 10, 0],", "[0, 10, 0], [5, 5, 5],"),
                     "side 2 of curve 'rim' lies in the plane of none")



if __name__ == "__main__":
    unittest.main()
