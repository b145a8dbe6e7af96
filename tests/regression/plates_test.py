#!/usr/bin/env python3
"""Parts of plane faces, without any film: a block that is pulled, a plate with
a bore, faces that do not close."""
import json
import unittest

from program import ProgramTest

# A block w x d x t of faces joined side by side; `holes` in its upper face.
BLOCK = """title = "A block of plane faces"
units = "mm-N-MPa"

[design.w]
initial = 20.0
bounds = [14.0, 26.0]

[design.t]
initial = 60.0
bounds = [40.0, 80.0]

[curves.low]
kind = "polygon"
points = [[0, 0, 0], ["w", 0, 0], ["w", 10, 0], [0, 10, 0]]

[curves.high]
kind = "polygon"
points = [[0, 0, "t"], ["w", 0, "t"], ["w", 10, "t"], [0, 10, "t"]]

[solids.foot]
kind = "cap"
curve = "low"

[solids.sides]
kind = "sides"
curves = ["low", "high"]

[solids.top]
kind = "cap"
curve = "high"

[bodies.part]
enclosed_by = ["foot", "sides", "top"]
material = "steel"

[resolution]
fea = 7.0

[materials.steel]
youngs_modulus = 210000.0
poisson_ratio = 0.3
density = 7.85e-9

[load_cases.pull]
supports = [
  { on = "foot", fix = "z" },
  { on = "foot", stiffness = [1, 1, 0] },
]
loads = [{ on = "top", force = [0, 0, 2000] }]

[analysis]
buckling = 0

[responses.stretch]
kind = "mean_displacement"
on = "top"
direction = [0, 0, 1]

[responses.mass]
kind = "mass"
"""
STUDY = """
[study]
kind = "minimize"
objective = "mass"
constraints = [{ response = "stretch", max = 0.002 }]
"""
# Even tension is in the element's space: what is left are the solvers'
# residuals and the springs.
EXACT = 1e-6
# The bound on the stretch is met within the optimizer's tolerance, 1e-4.
SIZED = 2e-4


class Plates(ProgramTest):
    def block(self, *replacements, more=""):
        text = BLOCK
        for old, new in replacements:
            self.assertIn(old, text)
            text = text.replace(old, new)
        case = self.folder / "case.toml"
        case.write_text(text + more)
        return case

    def run_block(self, case, code=0, *more):
        out = self.folder / "out"
        self.expect(self.call("run", case, "--no-pictures", "--no-report",
                              "--out", out, *more), code)
        return self.result(out)

    def test_a_pulled_block_is_a_bar(self):
        responses = self.run_block(self.block())["responses"]
        self.assertAlmostEqual(responses["mass"] / (20 * 10 * 60 * 7.85e-9), 1,
                               delta=EXACT)
        self.assertAlmostEqual(
            responses["stretch"] / (2000 * 60 / (210000 * 200)), 1,
            delta=EXACT)

    def test_its_gradients_are_exact(self):
        self.expect(self.call("check-gradient", self.block()), 0)

    def test_the_lightest_block_is_the_shortest_and_thinnest(self):
        result = self.run_block(self.block(more=STUDY))
        # F t / (E 10 w) = 0.002 at the least t: w = 2000 * 40 / (21e5 * 2e-3)
        wanted = 2000 * 40 / (210000 * 10 * 0.002)
        self.assertAlmostEqual(result["parameters"]["t"], 40, places=6)
        self.assertAlmostEqual(result["parameters"]["w"] / wanted, 1,
                               delta=SIZED)

    def test_files_of_a_block(self):
        result = self.run_block(self.block(), 0, "--export", "obj",
                                "--export", "inp")
        out = self.folder / "out"
        self.assertEqual(result["film"]["facets"] > 0, True)
        for name in ("part_3.5.stl", "part_3.5.obj", "part_7.inp"):
            self.assertGreater((out / name).stat().st_size, 300, name)
        files = {f["name"]: f for f in result["ledger"]["files"]}
        self.assertTrue(files["part_7.inp"]["written"])
        self.assertEqual(files["part_3.5.obj"]["bytes"],
                         (out / "part_3.5.obj").stat().st_size)
        self.assert_no_half_files(out)

    def test_a_bore_goes_through(self):
        """A plate with a bore of plane faces' own: volume by Pappus."""
        bore = """
[curves.bore_low]
kind = "polygon"
points = [[8, 3, 0], [12, 3, 0], [12, 7, 0], [8, 7, 0]]

[curves.bore_high]
kind = "polygon"
points = [[8, 3, "t"], [12, 3, "t"], [12, 7, "t"], [8, 7, "t"]]

[solids.bore]
kind = "sides"
curves = ["bore_low", "bore_high"]
"""
        case = self.block(
            ('curve = "low"', 'curve = "low"\nholes = ["bore_low"]'),
            ('curve = "high"', 'curve = "high"\nholes = ["bore_high"]'),
            ('"sides", "top"]', '"sides", "top", "bore"]'), more=bore)
        responses = self.run_block(case)["responses"]
        self.assertAlmostEqual(
            responses["mass"] / ((200 - 16) * 60 * 7.85e-9), 1, delta=EXACT)
        self.assertAlmostEqual(
            responses["stretch"] / (2000 * 60 / (210000 * 184)), 1,
            delta=EXACT)
        self.expect(self.call("check-gradient", case), 0)

    def test_wrong_faces_are_told(self):
        for old, new, told in (
                ('["w", 10, "t"], [0, 10, "t"]]',
                 '["w", 11, "t"], [0, 10, "t"], [0, 5, "t"]]',
                 r"case.toml:\d+: solids.sides.curves: .*as many points"),
                ('"sides", "top"]', '"sides"]', r"case.toml:\d+: .*top"),
                ('curves = ["low", "high"]', 'curves = ["low", "hihg"]',
                 r"case.toml:\d+: there is no curve 'hihg'; there are low, high"),
                ('curve = "low"\n', "", r"has no 'curve'"),
                ('curve = "low"', 'curve = "low"\ncurves = ["low"]',
                 r"solids.foot.curves does not belong to a cap"),
                ('curve = "low"', 'curve = "low"\nholes = ["low"]',
                 r"names curve 'low' twice"),
                ('material = "steel"', 'material = "steel"\nvolume = 9000',
                 r"case.toml:\d+: bodies.part.volume: the case has no films"),
                ('kind = "mass"', 'kind = "collapse_margin"',
                 r"case.toml:\d+: responses.mass is a collapse_margin, and "
                 r"the case has no films")):
            with self.subTest(new=new):
                self.expect(self.call("check", self.block((old, new))), 2,
                            told)

    def test_an_open_side_is_told(self):
        lid = """
[curves.lid]
kind = "polygon"
points = [[0, 0, "t"], ["w / 2", 0, "t"], ["w", 0, "t"], ["w", 10, "t"], [0, 10, "t"]]
"""
        case = self.block(('kind = "cap"\ncurve = "high"',
                           'kind = "cap"\ncurve = "lid"'), more=lid)
        self.expect(self.call("check", case), 2,
                    r"case.toml:\d+: body 'part' is not closed at the side "
                    r"from \(.*\) to \(.*\).*add a corner")

    def test_faces_that_part_are_told(self):
        """The lid follows another expression than the sides."""
        lid = """
[curves.lid]
kind = "polygon"
points = [[0, 0, 60], ["w", 0, 60], ["w", 10, 60], [0, 10, 60]]
"""
        case = self.block(('kind = "cap"\ncurve = "high"',
                           'kind = "cap"\ncurve = "lid"'), more=lid)
        self.expect(self.call("check", case), 2, "is not closed at the side")


if __name__ == "__main__":
    unittest.main(verbosity=2)
