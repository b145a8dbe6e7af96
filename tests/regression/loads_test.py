#!/usr/bin/env python3
"""Weight, springs, temperature and expressions of the place from a case file to
result.json, against what statics says of any shape."""
import unittest

from program import ProgramTest, strut

CASE = """title = "A strut on springs"
units = "mm-N-MPa"

[parameters]
length = 60.0
k = 2e4
""" + strut(24, '"length"', "foot") + """
[resolution]
fea = 10.0
film = 5.0

[materials.aluminium]
youngs_modulus = 71700.0
poisson_ratio = 0.33
density = 2.8e-9
thermal_expansion = 2.3e-5

[load_cases.weight]
supports = [{ on = "foot", stiffness = ["k", "k", "k"], stiffness_of = "total" }]
loads = [{ gravity = [0, 0, -9810] }]

[load_cases.push]
supports = [{ on = "foot", stiffness = ["k", "k", "k"], stiffness_of = "total" }]
loads = [{ on = "top", traction = [0, "(x + 100) / 100", "-1"] }]

[load_cases.heat]
supports = [{ on = "foot", fix = "symmetry" },
            { on = "foot", stiffness = [1e-6, 1e-6, 0] }]
loads = [{ temperature = 120, reference = 20 }]

[load_cases.turn]
supports = [{ on = "foot", fix = "xyz" }]
loads = [{ on = "top", force = [5, 0, 0], moment = [0, 300, 0], at = [0, 0, 60] }]

[responses.mass]
kind = "mass"

[responses.sag]
kind = "mean_displacement"
on = "foot"
direction = [0, 0, -1]
load_case = "weight"

[responses.sink]
kind = "mean_displacement"
on = "foot"
direction = [0, 0, -1]
load_case = "push"

[responses.shift]
kind = "mean_displacement"
on = "foot"
direction = [0, 1, 0]
load_case = "push"

[responses.growth]
kind = "mean_displacement"
on = "top"
direction = [0, 0, 1]
load_case = "heat"

[responses.heat_stress]
kind = "max_von_mises"
load_case = "heat"
"""

AREA = 3.14159265358979 * 20.0 ** 2  # of the top; its rim is a polygon


class Loads(ProgramTest):
    def test_statics_holds_from_file_to_result(self):
        path = self.folder / "case.toml"
        path.write_text(CASE)
        out = self.folder / "out"
        self.expect(self.call("run", path, "--out", out, "--no-pictures"), 0)
        values = self.result(out)["responses"]
        sag = values["mass"] * 9810 / 2e4
        self.assertAlmostEqual(values["sag"] / sag, 1.0, 7)
        # A traction of 1 on both: the same force up to the polygon's area.
        self.assertAlmostEqual(values["sink"] / (AREA / 2e4), 1.0, 1)
        self.assertAlmostEqual(values["shift"] / values["sink"], 1.0, 7)
        growth = 2.3e-5 * 100 * 60.0
        self.assertAlmostEqual(values["growth"] / growth, 1.0, 6)
        self.assertLess(values["heat_stress"], 1e-3)

    def test_frequencies_and_factors_reach_the_result(self):
        path = self.folder / "case.toml"
        path.write_text(CASE + """
[analysis]
frequencies = 8
supports_of = "weight"
buckling = 1
""")
        out = self.folder / "out"
        done = self.call("run", path, "--out", out, "--no-pictures")
        self.expect(done, 0)
        result = self.result(out)
        # A rigid part on springs: one mode goes straight up.
        up = (2e4 / result["responses"]["mass"]) ** 0.5 / 6.283185307179586
        found = result["natural_frequencies"]
        self.assertEqual(found["supports_of"], "weight")
        self.assertEqual(len(found["values"]), 8)
        self.assertLess(min(abs(f / up - 1) for f in found["values"]), 0.01)
        self.assertLess(max(found["residuals"]), 2e-6)
        self.assertEqual(set(result["buckling"]),
                         {"weight", "push", "heat", "turn"})
        self.assertIn(b'Name="mode_8"', (out / "part.vtu").read_bytes())

    def test_no_density_under_gravity_is_told_before_work(self):
        path = self.folder / "case.toml"
        path.write_text(CASE.replace("density = 2.8e-9", "density = 0"))
        done = self.call("run", path, "--out", self.folder / "out")
        self.expect(done, 2, r"materials.aluminium.density is 0, but load case "
                             r"'weight' has gravity")

    def test_a_deck_holds_springs(self):
        path = self.folder / "case.toml"
        path.write_text(CASE)
        out = self.folder / "out"
        self.expect(self.call("run", path, "--out", out, "--no-pictures"), 0)
        self.expect(self.call("export", out, "--format", "inp"), 0)
        deck = (out / "part_10.inp").read_text()
        # Three components of one bed for two load cases, and two of another.
        self.assertEqual(deck.count("*SPRING,"), 5)


if __name__ == "__main__":
    unittest.main(verbosity=2)
