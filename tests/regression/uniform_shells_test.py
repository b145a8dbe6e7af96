#!/usr/bin/env python3
"""Shells of constant mean curvature H under the pressure 2 H s and, at their
rims, the tension s along the conormal: stress evens out as they get thinner."""
import math
import unittest

from program import ProgramTest

# Half of the pressure on either face is what the film between feels. Loads
# balance, so that what is held only stops rigid motion: the rim's plane, and
# one node in it. `mean` has the least power that norms take.
CASE = """title = "One film under the paper's load"
units = "mm-N-MPa"

[parameters]
wall = 2
stress = 1
pressure = "{curvature} * stress * wall" # 2 H s

[curves.low]
kind = "circle"
center = [0, 0, 0]
normal = [0, 0, -1]
radius = {low}

{film}

[shells.skin]
films = ["skin"]
thickness = "wall"
material = "aluminium"

[resolution]
fea = 3
film = 0.75

[materials.aluminium]
youngs_modulus = "71.7 GPa"
poisson_ratio = 0.33
density = 2.8e-9

[load_cases.even]
supports = [
  {{ on = "skin/rim:low", fix = "z" }},
  {{ on = "skin/rim:low", at = [{low}, 0, 0], fix = "xy", fix_rotation = "z" }},
]
loads = [
  {{ on = {rims}, rim_tension = "stress * wall" }},
  {{ on = "skin/inside", pressure = "pressure / 2" }},
  {{ on = "skin/outside", pressure = "-pressure / 2" }},
]

[responses.mean]
kind = "von_mises_norm"
power = 1.0001

[responses.square]
kind = "von_mises_norm"
power = 2

[responses.variation]
kind = "expression"
value = "sqrt((square / mean)^2 - 1)"

[analysis]
buckling = 0
"""

RING = """[curves.high]
kind = "circle"
center = [0, 0, {height}]
normal = [0, 0, 1]
radius = {high}

[films.skin]
kind = "loft"
curves = ["low", "high"]
"""

DOME = """[films.skin]
kind = "disk"
curves = ["low"]
"""

GAS = """
[solids.low_end]
kind = "cap"
curve = "low"
{other_end}
[bodies.gas]
enclosed_by = [{walls}]
volume = {volume}
material = "void"
"""

HIGH_END = """
[solids.high_end]
kind = "cap"
curve = "high"
"""


def band(curvature, low, high, height, volume=None):
    """Between rings; without a volume a soap film."""
    film = RING.format(high=high, height=height)
    if volume is not None:
        film += GAS.format(other_end=HIGH_END, volume=volume,
                           walls='"skin", "low_end", "high_end"')
    return CASE.format(curvature=curvature, low=low, film=film,
                       rims='["skin/rim:low", "skin/rim:high"]')


def dome(radius):
    gas = GAS.format(other_end="", walls='"skin", "low_end"',
                     volume=2 * math.pi * radius ** 3 / 3)
    return CASE.format(curvature=2 / radius, low=radius, film=DOME + gas,
                       rims='"skin/rim:low"')


# As in cases/constant_mean_curvature, where heights and volumes of unduloid and
# nodoid come from.
FILMS = {
    "cylinder": band(0.05, 20, 20, 30, math.pi * 20 ** 2 * 30),
    "unduloid": band(0.05, 20, 20, 55.276562319656, 46528.138264343),
    "nodoid": band(0.1, 20, 20, 24.941564865793, 46109.584757562),
    "sphere": dome(20),
}
PLANE = band(0, 40, 20, 0)
CATENOID = band(0, 40, 40, 40)


class UniformShells(ProgramTest):
    def figures(self, text, wall, *arguments):
        out = self.folder / "out"
        self.expect(self.call("run", self.case(text), "--out", out,
                              "--no-pictures", "--set", f"wall={wall}",
                              *arguments), 0)
        return self.result(out)["responses"]

    def order(self, text):
        thick = self.figures(text, 2)
        thin = self.figures(text, 1)
        # Of second order: what bends for the ratio of the faces.
        self.assertLess(abs(thick["mean"] - 1), 6e-3)
        self.assertLess(abs(thin["mean"] - 1), 2e-3)
        return math.log2(thick["variation"] / thin["variation"]), thin

    def test_stress_evens_out_at_first_order(self):
        for name, text in FILMS.items():
            with self.subTest(film=name):
                order, _ = self.order(text)
                self.assertGreater(order, 0.9)
                self.assertLess(order, 1.1)

    # Its curvatures cancel: what is of first order is at the rims alone, in a
    # band that gets narrower as the root of the thickness.
    def test_a_catenoid_bends_at_its_rims_alone(self):
        order, thin = self.order(CATENOID)
        self.assertGreater(order, 0.9)
        self.assertLess(order, 1.3)
        self.assertLess(thin["variation"], 0.01)

    # Exact but for what curved edges leave of a facet's strain, whatever the
    # thickness.
    def test_a_plane_has_one_stress(self):
        coarse = self.figures(PLANE, 2, "--set", "resolution.fea=6",
                              "--set", "resolution.film=3")
        fine = self.figures(PLANE, 2)
        thin = self.figures(PLANE, 1)
        self.assertLess(fine["variation"], 1e-4)
        self.assertLess(abs(thin["variation"] - fine["variation"]), 1e-6)
        self.assertLess(fine["variation"], coarse["variation"] / 4)

    # The same shell under the same pressure, but held where it was pulled.
    def test_another_load_is_another_stress(self):
        held = FILMS["sphere"].replace(
            'fix = "z" }', 'fix = "xyz", fix_rotation = "xyz" }', 1)
        self.assertGreater(self.figures(held, 1)["variation"], 0.2)


if __name__ == "__main__":
    unittest.main()
