#!/usr/bin/env python3
"""Where shells are better taken as walls, and walls as shells: told by `check`
from the curves, by `run` from the settled film."""
import random
import re
import unittest

import shells_test
from program import ProgramTest

THICK = r"shells\.\w+ is (\S+) mm thick at \((.*?)\), where"
BENDS = r"bends with a radius of (\S+) mm: (\S+) of it"
# The same part as walls.
WALLS = (shells_test.TUBE.replace("[shells.tube]", "[walls.tube]")
         .replace(', fix_rotation = "xyz"', "")
         .replace('{ on = "skin/rim:high", rim_tension = "20 * inside" },', ""))


class Advice(ProgramTest):
    def check(self, text, *sets):
        path = self.folder / "case.toml"
        path.write_text(text)
        settings = [x for pair in sets for x in ("--set", pair)]
        return self.expect(self.call("check", path, *settings), 0).stdout

    def warnings(self, text, name, *sets):
        path = self.folder / f"{name}.toml"
        path.write_text(text)
        settings = [x for pair in sets for x in ("--set", pair)]
        out = self.folder / name
        self.expect(self.call("run", path, "--no-pictures", "--no-report",
                              "--out", out, *settings), 0)
        return " ".join(self.result(out)["warnings"])

    def test_thin_walls_are_told_of_shells(self):
        draw = random.Random(7)
        for _ in range(6):
            edge, wall = draw.uniform(6, 12), draw.uniform(0.25, 4.9)
            said = self.check(WALLS, f"design.wall.initial={wall}",
                              f"resolution.fea={edge}")
            self.assertIn(f"walls.tube is {wall:.4g} mm thick at (", said)
            self.assertIn(f"edges of {edge:.4g} mm", said)
            self.assertIn("[shells.tube] in place of [walls.tube]", said)
            times = re.search(r"they are (\d+) times as long", said)
            self.assertEqual(bool(times), wall < edge / 10)
            if times:
                self.assertAlmostEqual(float(times[1]), edge / wall, delta=1)
            self.assertRegex(said, r"case\.toml:\d+: walls")

    def test_halves_of_thin_walls_are_told_of_shells(self):
        text = shells_test.THICK.format(
            name="all", supports='{ on = "skin/rim:low", fix = "xyz" }',
            load='{ on = "skin/rim:high", force = [0, 0, -4000] }').replace(
            "ring^2 * 100", "ring^2 * 50").replace("[shells.tube]", """[symmetry]
planes = [{ at = [0, 0, 0], normal = [0, 1, 0] }]

[walls.tube]""")
        self.assertIn("[shells.tube] in place of [walls.tube]",
                      self.check(text, "design.wall.initial=2"))
        self.check(text.replace("[walls.tube]", "[shells.tube]"),
                   "design.wall.initial=2")

    def test_the_thinnest_place_is_named(self):
        said = self.check(WALLS.replace('"wall"', '"wall * (1 + z / 100)"'))
        self.assertRegex(said, r"is 0\.5 mm thick at \(\S+, \S+, -50\)")

    def test_walls_with_elements_through_them_are_left_alone(self):
        for text, sets in (
                (WALLS, ["resolution.fea=2", "design.wall.initial=3"]),
                # What shells do not have:
                (WALLS.replace('kind = "compliance"', 'kind = "thickness"')
                 .replace('kind = "thickness"\nload_case = "inner"',
                          'kind = "thickness"'), []),
                (WALLS.replace('[materials.steel]',
                               '[materials.steel]\nthermal_expansion = 1e-5')
                 .replace("{ gravity = [0, 0, -9810] }",
                          "{ temperature = 20 }"), [])):
            self.assertNotIn("shells", self.check(text, *sets))

    def test_walls_of_no_material_are_left_alone(self):
        rim = 'kind = "circle"\ncenter = [0, 0, {}]\nnormal = [0, 0, 1]\nradius = 10\n'
        self.assertNotIn("shells", self.check(
            'title = "Catenoid"\nunits = "mm-N-MPa"\n'
            f"[curves.low]\n{rim.format(0)}[curves.high]\n{rim.format(9)}"
            '[films.skin]\nkind = "loft"\ncurves = ["low", "high"]\n'
            '[walls.web]\nfilms = ["skin"]\nthickness = 0.1\n'
            "[resolution]\nfea = 1\n"))

    def test_a_run_says_it_of_the_film(self):
        said = self.warnings(WALLS.replace('kind = "compliance"',
                                           'kind = "strain_energy"'),
                             "walls", "design.wall.initial=4",
                             "resolution.fea=10")
        self.assertIn("walls.tube is 4 mm thick at (", said)
        self.assertIn("[shells.tube] in place of [walls.tube]", said)

    def test_thick_shells_are_told_of_walls(self):
        draw = random.Random(8)
        text = shells_test.TUBE.replace("[0.2, 5]", "[0.2, 30]")
        for share in (0.15, 0.19, 0.22, 0.4):
            ring = draw.uniform(42, 58)
            wall = share * ring
            sets = [f"design.ring.initial={ring}",
                    f"design.wall.initial={wall}"]
            told = [self.check(text, *sets),
                    self.warnings(text, f"thick_{share}", *sets)]
            for said in told:
                found = re.search(THICK, said)
                self.assertEqual(bool(found), share > 0.2, said)
                if found:
                    self.assertAlmostEqual(float(found[1]), wall, delta=0.01)
                    radius, part = re.search(BENDS, said).groups()
                    self.assertAlmostEqual(float(radius) / ring, 1, delta=0.01)
                    self.assertAlmostEqual(float(part), share, delta=0.01)
                    self.assertIn("[walls.tube]", said)

    # A soap film between rings: both radii at its waist are the waist's.
    def test_the_film_bends_more_than_its_curves(self):
        text = shells_test.drawn(1)
        text = re.sub(r"(?s)\[curves.low\].*?(?=\[films)", """[curves.low]
kind = "circle"
center = [0, 0, -30]
normal = [0, 0, -1]
radius = 50

[curves.high]
kind = "circle"
center = [0, 0, 30]
normal = [0, 0, 1]
radius = 50

""", text)
        text = re.sub(r'thickness = ".*"', "thickness = 9", text)
        text = re.sub(r"(?s)\[design.ring\].*?\n\n", "", text)
        text = re.sub(r"fea = .*", "fea = 8", text)
        # cosh(30 / a) = 50 / a at a = 37.25: 9 is 0.24 of it, 0.18 of the ring.
        self.assertNotIn("above a fifth", self.check(text))
        said = self.warnings(text, "catenoid")
        radius, part = re.search(BENDS, said).groups()
        waist = 37.25
        self.assertAlmostEqual(float(radius) / waist, 1, delta=0.03)
        self.assertAlmostEqual(float(part), 9 / waist, delta=0.01)
        place = [float(x) for x in re.search(THICK, said)[2].split(",")]
        self.assertLess(abs(place[2]), 8)

    def test_flat_shells_have_no_radius(self):
        text = shells_test.STRIP.replace("[0.2, 2]", "[0.2, 20]")
        self.assertNotIn("above a fifth",
                         self.check(text, "design.wall.initial=15"))
        self.assertNotIn("above a fifth", self.warnings(
            text, "flat", "design.wall.initial=15"))


if __name__ == "__main__":
    unittest.main()
