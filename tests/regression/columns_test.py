#!/usr/bin/env python3
"""Columns: what a run says of their buckling, and the stiffest of a mass."""
import math
import unittest

from program import ProgramTest

COLUMN = """title = "A column of rectangular section"
units = "mm-N-MPa"

[design.w]
initial = 14.0
bounds = [6.0, 20.0]

[design.h]
initial = 8.0
bounds = [6.0, 20.0]

[parameters]
length = 150.0

[curves.low]
kind = "polygon"
points = [["-w/2", "-h/2", 0], ["w/2", "-h/2", 0],
          ["w/2", "h/2", 0], ["-w/2", "h/2", 0]]

[curves.high]
kind = "polygon"
points = [["-w/2", "-h/2", "length"], ["w/2", "-h/2", "length"],
          ["w/2", "h/2", "length"], ["-w/2", "h/2", "length"]]

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
yield_strength = 355.0

[load_cases.push]
supports = [{ on = "foot", fix = "xyz" }]
loads = [{ on = "top", force = [0, 0, -2000] }]

[responses.stable]
kind = "buckling_factor"

[responses.mass]
kind = "mass"

[responses.softness]
kind = "expression"
value = "10 / stable"
"""
ANALYSE = """
[study]
kind = "analyse"
"""
STIFFEST = """
[study]
kind = "minimize"
objective = "softness"
constraints = [{ response = "mass", max = 1.3e-4 }]
"""
# Of the bound of two equal factors below them: 1 / (1.1 - 0.1 / 2^(1/3)).
OF_TWO = 1 / (1.1 - 0.1 / 2 ** (1 / 3))
# Of Euler's load of a solid column: its clamp, and its shear at 15 widths.
OF_A_BEAM = 0.02
# The stiffest column is square as far as the mesh is: free tetrahedra bend
# otherwise along each side.
SQUARE = 0.02


def euler(w, h, length):
    """Factor of a cantilever of the loads."""
    return math.pi ** 2 * 210000 * w * h ** 3 / 12 / (2 * length) ** 2 / 2000


class Columns(ProgramTest):
    def run_column(self, text, *more):
        case = self.folder / "case.toml"
        case.write_text(text)
        out = self.folder / "out"
        done = self.call("run", case, "--no-pictures", "--no-report",
                         "--out", out, *more)
        self.expect(done, 0)
        return self.result(out), done

    def test_a_slender_column_has_eulers_factor_within_its_error(self):
        result, _ = self.run_column(COLUMN + ANALYSE)
        told = result["buckling"]["push"]
        factor, error = told["factors"][0], told["errors"][0]
        true = euler(14, 8, 150)
        self.assertEqual(told["verdict"], "stands")
        self.assertAlmostEqual(factor / true, 1, delta=OF_A_BEAM)
        self.assertLess(error / factor, 0.1)
        self.assertAlmostEqual(told["above"], factor - error)
        stress = told["stress"][0]
        self.assertAlmostEqual(stress["von_mises"] / (2000 / (14 * 8)), 1,
                               delta=0.05)
        self.assertAlmostEqual(
            stress["slenderness"] / math.sqrt(355 / (true * 2000 / 112)), 1,
            delta=0.05)
        self.assertTrue(stress["matters"])
        # The response is the same factor, with its own error.
        self.assertAlmostEqual(result["responses"]["stable"] / factor, 1, 4)
        self.assertGreater(result["response_errors"]["stable"], 0)

    def test_a_column_that_buckles_is_told(self):
        result, done = self.run_column(
            COLUMN.replace("-2000", "-40000") + ANALYSE)
        self.assertEqual(result["buckling"]["push"]["verdict"], "buckles")
        self.assertRegex(done.stderr + done.stdout, "buckling factor below 1")

    def test_a_stub_buckles_in_no_way_that_matters(self):
        result, done = self.run_column(COLUMN + ANALYSE, "--set", "length=14")
        told = result["buckling"]["push"]
        self.assertEqual(told["verdict"], "beyond_yield")
        self.assertFalse(told["stress"][0]["matters"])
        self.assertLess(told["stress"][0]["slenderness"], 0.2)
        self.assertRegex(done.stderr + done.stdout,
                         "none that matters below .* times yield")

    def test_the_stiffest_of_a_mass_is_square(self):
        result, _ = self.run_column(COLUMN + STIFFEST)
        self.assertEqual(result["status"], "converged")
        w, h = result["parameters"]["w"], result["parameters"]["h"]
        side = math.sqrt(1.3e-4 / (7.85e-9 * 150))
        self.assertAlmostEqual(w / side, 1, delta=SQUARE)
        self.assertAlmostEqual(h / side, 1, delta=SQUARE)
        self.assertAlmostEqual(
            result["responses"]["stable"] / (OF_TWO * euler(w, w, 150)), 1,
            delta=0.03)


if __name__ == "__main__":
    unittest.main(verbosity=2)
