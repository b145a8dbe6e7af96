#!/usr/bin/env python3
"""Films that meet along a free curve, from outside: chambers of two materials and
walls about a line that no curve holds, drawn at random; gradients, files, halves,
bits."""
import json
import random
import re
import unittest

from program import ProgramTest, some, without_seconds
from walls_test import PIPE

# Two chambers of a tube, their bulkhead's rim free.
TUBE = """title = "A tube with a bulkhead"
units = "mm-N-MPa"

[design.foot]
initial = {foot}
bounds = [20.0, 40.0]

[design.aside]
initial = {aside}
bounds = [-10.0, 10.0]

[design.fill]
initial = {fill}
bounds = [1e4, 2e5]

[design.pull]
initial = {pull}
bounds = [0.3, 1.8]

[curves.base]
kind = "circle"
center = [0, 0, 0]
normal = [0, 0, -1]
radius = "foot"

[curves.line]
kind = "circle"
center = [{x}, 0, {z}]
normal = [0, 0, 1]
radius = 27
free = true

[curves.head]
kind = "circle"
center = ["aside", 0, 50]
normal = [0, 0, 1]
radius = 28
{top}
[films.lower]
kind = "loft"
curves = ["base", "line"]

[films.upper]
kind = "loft"
curves = ["line", "head"]

[films.web]
kind = "disk"
curves = ["line"]
tension = "pull"

[solids.foot_pad]
kind = "cap"
curve = "base"

[solids.head_pad]
kind = "cap"
curve = "head"

[bodies.down]
enclosed_by = ["lower", "web", "foot_pad"]
volume = "{half} * fill"
material = "steel"

[bodies.up]
enclosed_by = ["upper", "web", "head_pad"]
volume = "{half} * {up}"
material = "brass"

[materials.steel]
youngs_modulus = 210000
poisson_ratio = 0.3
density = "7850 kg/m^3"

[materials.brass]
youngs_modulus = 100000
poisson_ratio = 0.33
density = "8500 kg/m^3"

[load_cases.service]
supports = [{{ on = "foot_pad", fix = "xyz" }}]
loads = [{{ on = "head_pad", force = ["{half} * 2000", 0, 0] }}]

[responses.sway]
kind = "mean_displacement"
on = "head_pad"
direction = [1, 0, 0]

[responses.mass]
kind = "mass"

[responses.pressure]
kind = "pressure"
body = "down"

[analysis]
buckling = 0

[resolution]
fea = {edge}
"""
# Three plates about an axis that finds its place between two points.
PLATES = """title = "Plates about an axis"
units = "mm-N-MPa"

[design.lean]
initial = 4.0
bounds = [-10.0, 10.0]

[curves.plate]
repeat = 3
kind = "polygon"
points = [
  [0, 0, 0],
  [0, 0, 40],
  ["30 * cos(2 * pi / 3 * {i}) + lean", "30 * sin(2 * pi / 3 * {i})", 40],
  ["30 * cos(2 * pi / 3 * {i})", "30 * sin(2 * pi / 3 * {i}) + lean", 0],
]
free = [1]

[films.plate]
repeat = 3
kind = "disk"
curves = ["plate_{i}"]

[walls.plates]
films = [{ name = "plate_{i}", repeat = 3 }]
thickness = 3
fillet = 2
material = "steel"

[materials.steel]
youngs_modulus = 210000
poisson_ratio = 0.3
density = "7850 kg/m^3"

[load_cases.service]
supports = [{ on = "plate_1/rim:plate_1", fix = "xyz" }]
loads = [{ on = "plate_2", pressure = 0.1 }]

[responses.mass]
kind = "mass"

[responses.dip]
kind = "mean_displacement"
on = "plate_3/back"
direction = [1, 0, 0]

[analysis]
buckling = 0

[resolution]
fea = 6
"""
HALF = """
[symmetry]
planes = [{ at = [0, 0, 0], normal = [0, -1, 0] }]
"""


def tube(seed, **changed):
    """One drawn at random: numbers, and where its line begins."""
    draw = random.Random(seed)
    numbers = {"foot": draw.uniform(26, 31), "aside": draw.uniform(-4, 4),
               "fill": draw.uniform(6e4, 7.5e4), "up": draw.uniform(5e4, 6e4),
               "pull": draw.uniform(0.5, 1.4), "x": draw.uniform(-2, 2),
               "z": draw.uniform(22, 29), "edge": draw.uniform(6, 9),
               "top": "", "half": "1"}
    return TUBE.format(**{**numbers, **changed})


class FreeLines(ProgramTest):
    def test_gradients_are_exact(self):
        for seed in some(range(4), 2):
            self.expect(self.call("check-gradient", self.case(tube(seed))), 0,
                        "all 12 derivatives agree")

    # The curve is where films begin, no more.
    def test_the_line_forgets_where_it_began(self):
        for seed in some((5, 6)):
            found = [self.run_at(tube(seed, x=x, z=z, edge=6), f"from_{x}_{z}")
                     for x, z in ((0, 24), (2, 28), (-2, 22))]
            for response in ("sway", "pressure"):
                values = [r["responses"][response] for r in found]
                self.assertLess(max(values) / min(values) - 1, 0.02, response)

    def test_a_half_is_the_whole(self):
        for seed in some((7, 8)):
            whole = self.run_at(tube(seed, edge=5), f"whole_{seed}")
            half = self.run_at(tube(seed, edge=5, top=HALF, half="1 / 2"),
                               f"half_{seed}")
            for response in ("sway", "mass", "pressure"):
                self.assertAlmostEqual(
                    half["responses"][response] / whole["responses"][response],
                    1, delta=0.01, msg=response)
            self.expect(self.call("check-gradient",
                                  self.folder / f"half_{seed}.toml"), 0)

    def test_same_bits_for_any_thread_count(self):
        found = []
        for threads in ("1", "2"):
            result = self.run_at(tube(9), f"threads_{threads}",
                                 env={"OMP_NUM_THREADS": threads})
            for key in ("ledger", "case", "case_hash", "process_memory"):
                result.pop(key, None)
            found.append(json.dumps(without_seconds(result)))
        self.assertEqual(found[0], found[1])

    # The line is an edge of three faces; gaps and deviation as of others.
    def test_step_has_the_line(self):
        self.run_at(tube(10), "out")
        done = self.expect(self.call("export", self.folder / "out", "--format",
                                     "step"), 0)
        gap, off = re.search(r"gap at edges (\S+) mm.*\((\S+) of its edge\)",
                             done.stdout + done.stderr).groups()
        self.assertLess(float(gap), 0.01)
        self.assertLess(float(off), 0.1)

    def test_walls_and_their_fillets_go_with_it(self):
        text = PIPE.replace("radius = 26\n", "radius = 26\nfree = true\n")
        out = self.folder / "walls"
        case = self.case(text)
        self.expect(self.call("evolve", case, "--out", out), 0)
        wall = json.loads((out / "wall_pipe.json").read_text())
        self.assertEqual(wall["findings"], "")
        for end in ("thinnest", "thickest"):
            self.assertLess(abs(wall[end]["value"] / wall[end]["asked"] - 1),
                            0.05)
        self.expect(self.call("check-gradient", case), 0)

    def test_plates_meet_along_a_free_side(self):
        result = self.run_at(PLATES, "plates")
        self.assertEqual(result["film"]["index"], 0)
        self.expect(self.call("check-gradient", self.folder / "plates.toml"),
                    0)

    # A film that free curves alone bound has its inside where it ends, however
    # its first facets ran.
    def test_a_film_of_free_curves_has_an_inside(self):
        free = PIPE.replace("radius = 26\n", "radius = 26\nfree = true\n")
        body = """
[solids.lid]
kind = "cap"
curve = "{}"

[bodies.room]
enclosed_by = ["{}", "plate", "lid"]
pressure = 0.02
material = "void"
"""
        dips = []
        for chamber in (("base", "low"), ("head", "high")):
            text = free.replace('on = "plate", pressure',
                                'on = "plate/outside", pressure').replace(
                'on = "plate/back"', 'on = "plate/outside"')
            text = text.replace("[walls.pipe]",
                                body.format(*chamber) + "\n[walls.pipe]")
            dips.append(self.run_at(text, chamber[0])["responses"]["dip"])
        self.assertLess(dips[0] * dips[1], 0, dips)

    def test_curves_in_one_place_hold_where_one_does(self):
        again = ('[curves.again]\nkind = "circle"\ncenter = [{x}, 0, {z}]\n'
                 "normal = [0, 0, 1]\nradius = 27\n\n[curves.line]")
        numbers = re.search(r"center = \[(\S+), 0, (\S+)\]\nnormal = "
                            r"\[0, 0, 1\]\nradius = 27", tube(0)).groups()
        text = tube(0).replace("[curves.line]", again.format(
            x=numbers[0], z=numbers[1])).replace(
            'curves = ["line"]', 'curves = ["again"]')
        self.expect(self.call("check", self.case(text)), 0,
                    "one curve.*it holds films, as one of the two is not free")

    def test_the_start_that_has_no_film_is_named(self):
        text = tube(0).replace('units = "mm-N-MPa"',
                               'units = "mm-N-MPa"\nstart = { foot = -5 }')
        done = self.expect(self.call("evolve", self.case(text)), 2,
                           "at the values of 'start'")
        self.assertNotRegex(done.stderr, r"case\.toml: \S*case\.toml")

    def test_what_a_line_cannot_bear_is_refused_with_the_place(self):
        two = PIPE.replace("radius = 26\n", "radius = 26\nfree = true\n")
        at, end = two.index("[films.plate]"), two.index("[walls.pipe]")
        two = two[:at] + two[end:]
        at, end = two.index("[walls.bulkhead]"), two.index("[resolution]")
        two = re.sub(r"\[load_cases(.|\n)*\[responses.mass", "[responses.mass",
                     two[:at] + two[end:])
        lid = tube(0).replace('["lower", "web", "foot_pad"]',
                              '["lower", "lid", "foot_pad"]').replace(
            "[bodies.down]",
            '[solids.lid]\nkind = "cap"\ncurve = "line"\n\n[bodies.down]')
        plates = two_plates = PLATES
        plates = plates.replace("free = [1]", "free = [5]")
        two_plates = two_plates.replace("repeat = 3", "repeat = 2").replace(
            "plate_3", "plate_2")
        for text, table, message in (
                (plates, "free = [5]",
                 r"curves.plate_1.free has 5; its sides are 1 to 4"),
                (two_plates, "[curves.plate]",
                 r"the side from \(0, 0, 0\) to \(0, 0, 40\) of curve "
                 "'plate_1' is free, and 2 films end there, plate_1, plate_2"),
                (two, "[curves.waist]",
                 "curve 'waist' is free and 2 films end there"),
                (lid, "[solids.lid]",
                 "solid 'lid' ends at curve 'line', which is free"),
                (tube(0).replace("free = true", "free = true\npieces = 2"),
                 "[curves.line]", "curve 'line' has pieces and is free")):
            place = text.split("\n").index(table) + 1
            self.expect(self.call("check", self.case(text)), 2,
                        f"case.toml:{place}: {message}")


if __name__ == "__main__":
    unittest.main()
