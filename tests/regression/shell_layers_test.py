#!/usr/bin/env python3
"""Shells of orthotropic materials and of layers, from outside: closed forms,
exact gradients by what they are made of, and what is refused."""
import math
import random
import unittest

import shells_test
from program import ProgramTest
from shells_test import STRIP, TUBE

CARBON = """[materials.carbon]
youngs_moduli = ["135 GPa", "10 GPa", "10 GPa"]
poisson_ratios = [0.3, 0.3, 0.45]
shear_moduli = ["5 GPa", "5 GPa", "3.5 GPa"]
density = "{density}"
axes = [[0, 0, 1], [1, 0, 0]]

[materials.steel]"""
E1, E2 = 135e3, 10e3

# Three layers; angles, a modulus and a density follow the design.
LAYERED = (TUBE.replace('material = "steel"\n', """layers = [
  { material = "carbon", angle = "turn" },
  { material = "steel", share = 0.5 },
  { material = "carbon", share = 2, angle = "-2 * turn" },
]
""", 1).replace("[materials.steel]", CARBON.format(density="1.6e-9 * rho"))
    .replace('youngs_modulus = "210 GPa"', 'youngs_modulus = "2e5 * soft"')
    .replace("[design.fill]", """[design.turn]
initial = "25 deg"
bounds = ["-80 deg", "80 deg"]

[design.rho]
initial = 1
bounds = [0.5, 2]

[design.soft]
initial = 0.3
bounds = [0.1, 1]

[design.fill]"""))
# What criteria of strength say of it.
STRENGTH = """
[responses.ratio]
kind = "stress_ratio"
load_case = "many"
allowable = 100

[responses.pulled]
kind = "stress_ratio"
measure = "tension"
load_case = "many"
allowable = "80 MPa"

[responses.lasts]
kind = "fatigue"
load_cases = ["many", "pull"]

[responses.mean]
kind = "von_mises_ks"
load_case = "many"
scale = 50

[load_cases.pull]
supports = [{ on = "skin/rim:low", fix = "xyz", fix_rotation = "xyz" }]
loads = [{ on = "skin/rim:high", force = [0, "500 * inside", 900] }]
"""


def enduring(text):
    return text.replace('density = "', 'endurance_limit = "160 MPa"\n'
                        'tensile_strength = "500 MPa"\ndensity = "')


def of_layers(text, *layers):
    """The tube of carbon alone, at these angles [deg]."""
    rows = ", ".join(f'{{ material = "carbon", angle = "{a} deg" }}'
                     for a in layers)
    return text.replace('material = "steel"\n', f"layers = [{rows}]\n",
                        1).replace("[materials.steel]",
                                   CARBON.format(density="1600 kg/m3"))


class ShellLayers(ProgramTest):
    def case(self, text=TUBE, name="case.toml"):
        return super().case(text, name)

    def check_gradient(self, text, *arguments):
        self.expect(self.call("check-gradient", self.case(text), "--set",
                              "resolution.fea=25", *arguments), 0)

    def run_case(self, text, *arguments, name="out"):
        out = self.folder / name
        self.expect(self.call("run", self.case(text), "--no-pictures",
                              "--out", out, *arguments), 0)
        return self.result(out)

    # u_r = p r (r - t/2) / (E t) with E that around the tube: axis 1 along it,
    # then around. Along stiff fibres what the rings hold reaches twice as far.
    def test_swells_by_the_modulus_around(self):
        share = math.sqrt(math.pi) * 10 * math.erf(5) / shells_test.LENGTH
        for angle, E in ((0, E2), (90, E1)):
            result = self.run_case(of_layers(TUBE, angle), name=f"at_{angle}")
            radial = result["responses"]["swell"] / (0.5 * share)
            ideal = 2 * 50 * (50 - 0.5) / (E * 1)
            self.assertLess(abs(radial / ideal - 1), 2e-2)
            self.assertLess(abs(result["responses"]["mass"] /
                                (1.6e-9 * result["responses"]["volume"]) - 1),
                            1e-9)

    # [0/90]s as a cantilever: E I = b / d_11, without contraction.
    def test_bends_as_a_crossed_strip_does(self):
        text = STRIP.replace('material = "model"', """layers = [
  { material = "fibre" }, { material = "fibre", angle = "90 deg" },
  { material = "fibre", angle = "90 deg" }, { material = "fibre" },
]
direction = [1, 0, 0]""").replace("[materials.model]", """[materials.fibre]
youngs_moduli = [1000, 40, 40]
poisson_ratios = [0, 0, 0]
shear_moduli = [60, 60, 60]
density = "1000 kg/m3"

[materials.model]""")
        result = self.run_case(text)
        bending = 20 / 12 * (1000 * 7 / 8 + 40 / 8)
        shear = 0.1 * 100 / (5 / 6 * 60 * 20)
        ideal = 0.1 * 100 ** 3 / (3 * bending) + shear
        self.assertLess(abs(result["responses"]["dip"] / ideal - 1), 1e-4)
        # Its largest stress is along the outer layers, at the root.
        stress = 0.1 * 100 * 0.5 * 1000 / bending
        self.assertLess(abs(result["responses"]["peak"] / stress - 1), 1e-2)

    # The same twice: layers cut in two, and a direction of another length.
    def test_does_not_mind_how_layers_are_said(self):
        first = self.run_case(of_layers(TUBE, 30, -60, 10), name="first")
        same = self.run_case(of_layers(TUBE, 30, 30, -60, -60, 10, 10),
                             name="same")
        back = self.run_case(of_layers(TUBE, 30, -60, 10).replace(
            "layers = [", "direction = [0, 0, 7]\nlayers = ["), name="back")
        for name, value in first["responses"].items():
            for other in (same, back):
                if name == "stress" and other is same:
                    continue  # a mean over more faces
                self.assertLess(abs(other["responses"][name] / value - 1), 1e-7,
                                name)

    def test_has_exact_gradients_by_angles_and_materials(self):
        self.check_gradient(LAYERED)

    def test_has_exact_gradients_of_eigenvalues_by_layers(self):
        self.check_gradient(LAYERED + shells_test.MODAL.format("many"))

    def test_has_exact_gradients_of_moments_by_layers(self):
        draw = random.Random(3)
        turn, rho = draw.uniform(-1, 1), draw.uniform(0.6, 1.8)
        self.check_gradient(LAYERED + shells_test.MASSES, "--set",
                            f"design.turn.initial={turn}", "--set",
                            f"design.rho.initial={rho}")

    def test_has_exact_gradients_of_criteria_of_strength(self):
        for text in (TUBE, LAYERED):
            self.check_gradient(enduring(text + STRENGTH))

    # The ratio of the largest von Mises stress at the nodes, by its excess.
    def test_bounds_the_largest_stress(self):
        result = self.run_case(enduring(TUBE + STRENGTH))
        peak = result["stress"]["many"]["max_von_mises"] / 100
        self.assertGreaterEqual(result["responses"]["ratio"], 0.97 * peak)
        self.assertLess(result["responses"]["ratio"], 1.03 * peak)
        self.assertLess(result["responses"]["mean"], 100 * peak)

    def test_has_exact_gradients_of_a_spin(self):
        text = TUBE.replace("{ spin = 100, at = [0, 0, 0], axis = [0, 0, 1] }",
                            '{ spin = "900 * inside", at = ["ring / 9", 0, 0],'
                            ' axis = [0, "wall", 1] }')
        a = text.index("[responses.stress]")
        b = text.index("[responses.most]")
        self.check_gradient(text[:a] + text[b:])

    def test_says_what_layers_are_not(self):
        wrong = [
            ('material = "steel"\n', "", "has none of 'material' and 'layers'"),
            ('material = "steel"\n',
             'material = "steel"\nlayers = [{ material = "steel" }]\n',
             "has both of 'material' and 'layers'"),
            ('material = "steel"\n', 'layers = [{ material = "stele" }]\n',
             "there is no material 'stele'"),
            ('material = "steel"\n',
             'layers = [{ material = "steel", share = 0 }]\n', "share is 0"),
            ('material = "steel"\n',
             'layers = [{ material = "steel", share = "ring" }]\n', "share"),
            ('material = "steel"\n', "layers = []\n", "at least one"),
            ('material = "steel"\n',
             'material = "steel"\ndirection = [0, 0, 0]\n', "direction is 0"),
        ]
        for old, new, said in wrong:
            done = self.expect(self.call("check", self.case(
                TUBE.replace(old, new, 1))), 2)
            self.assertIn(said, done.stderr)
            self.assertRegex(done.stderr, r"case\.toml(:\d+)?: ")
        other = of_layers(TUBE, 30).replace("layers = [", """layers = [
  { material = "other" }, """).replace("[materials.steel]", CARBON.format(
            density="1 kg/m3").replace("carbon", "other").replace(
            "[0, 0, 1], [1, 0, 0]", "[1, 0, 0], [0, 0, 1]"))
        done = self.expect(self.call("check", self.case(other)), 2)
        self.assertIn("whose axes 1 differ", done.stderr)
        # Its projection on a film across it is none.
        done = self.call("run", self.case(of_layers(TUBE, 30).replace(
            "layers = [", "direction = [1, 0, 0]\nlayers = [")), "--out",
            self.folder / "none")
        self.assertNotEqual(done.returncode, 0)
        self.assertIn("direction", done.stderr)


if __name__ == "__main__":
    unittest.main()
