#!/usr/bin/env python3
"""Rings are ruled: a thick tube made of them is Lame's, its STEP file has the
cylinders, and its gradients are exact where the rims leave their planes."""
import json
import math
import random
import unittest

from program import ProgramTest

INSIDE, OUTSIDE, LENGTH = 10.0, 20.0, 30.0
PRESSURE, MODULUS, RATIO = 100.0, 2e5, 0.3


def circle(name, height, radius, normal):
    return f"""
[curves.{name}]
kind = "circle"
center = [0, 0, {height}]
normal = {normal}
radius = {radius}
"""


def ring(name, curve, inner):
    return f"""
[solids.{name}]
kind = "ring"
curve = "{curve}"
inner = "{inner}"
"""


TUBE = f"""title = "A thick tube of rings"
units = "mm-N-MPa"

[design.wide]
initial = {OUTSIDE}
bounds = [15.0, 25.0]

[design.tilt]
initial = 0.0
bounds = [-0.2, 0.2]
""" + (
    circle("in_low", 0, INSIDE, [0, 0, 1]) +
    circle("in_high", LENGTH, INSIDE, '["tilt", 0, -1]') +
    circle("out_low", 0, '"wide"', [0, 0, 1]) +
    circle("out_high", LENGTH, OUTSIDE, [0, 0, 1]) +
    ring("bore", "in_low", "in_high") +
    ring("mantle", "out_low", "out_high") +
    ring("foot", "out_low", "in_low") +
    ring("head", "out_high", "in_high")) + f"""
[bodies.tube]
enclosed_by = ["bore", "mantle", "foot", "head"]
material = "steel"

[materials.steel]
youngs_modulus = {MODULUS}
poisson_ratio = {RATIO}
density = 7.85e-9

[load_cases.pressed]
supports = [
  {{ on = "foot", fix = "z" }},
  {{ on = "head", fix = "z" }},
  {{ on = "mantle", stiffness = [1, 1, 1] }},
]
loads = [{{ on = "bore", pressure = {PRESSURE} }}]

[analysis]
buckling = 0

[responses.work]
kind = "compliance"

[responses.mass]
kind = "mass"

[resolution]
fea = 5.0
"""


class Rings(ProgramTest):
    def tube(self):
        case = self.folder / "case.toml"
        case.write_text(TUBE)
        return case

    def test_a_thick_tube_is_lames(self):
        out = self.folder / "out"
        self.expect(self.call("run", self.tube(), "--no-pictures",
                              "--no-report", "--out", out), 0)
        result = self.result(out)
        a2, b2 = INSIDE**2, OUTSIDE**2
        opening = ((1 + RATIO) * PRESSURE * INSIDE / (MODULUS * (b2 - a2)) *
                   ((1 - 2 * RATIO) * a2 + b2))
        work = PRESSURE * 2 * math.pi * INSIDE * LENGTH * opening
        found = result["responses"]["work"]
        self.assertAlmostEqual(found / work, 1, delta=5e-3)
        self.assertLess(abs(found - work), result["response_errors"]["work"])
        mass = math.pi * (b2 - a2) * LENGTH * 7.85e-9
        self.assertAlmostEqual(result["responses"]["mass"] / mass, 1,
                               delta=1e-3)
        step = self.folder / "tube.step"
        self.expect(self.call("export", out, "--format", "step", "--out",
                              step), 0)
        text = step.read_text()
        self.assertEqual(text.count("CYLINDRICAL_SURFACE"), 2)
        self.assertEqual(text.count("PLANE("), 2)
        self.compare_as_step(out, step, work)

    def compare_as_step(self, out, step, work):
        """The tube again from its STEP file: curved faces, Lame's peak."""
        a2, b2 = INSIDE**2, OUTSIDE**2
        around = PRESSURE * (a2 + b2) / (b2 - a2)
        along = RATIO * (around - PRESSURE)
        peak = math.sqrt(0.5 * ((around + PRESSURE)**2 +
                                (around - along)**2 +
                                (along + PRESSURE)**2))
        there = self.folder / "compare"
        self.expect(self.call("compare", out, step, "--out", there), 0)
        parts = json.loads((there / "compare.json").read_text())["parts"]
        self.assertEqual(len(parts), 2)
        for part in parts:
            figures = part["load_cases"]["pressed"]
            with self.subTest(part=part["name"]):
                self.assertAlmostEqual(figures["work"] / work, 1, delta=5e-3)
                self.assertAlmostEqual(figures["max_von_mises"] / peak, 1,
                                       delta=0.06)

    def test_the_safety_of_any_tube_is_lames(self):
        """Walls of any thickness at edges of any length: what the elements'
        points say is mended by their neighbours, or the smaller one counts."""
        draw = random.Random(20261124)
        for k in range(6):
            inside = draw.uniform(6, 14)
            outside = inside * draw.uniform(1.3, 2.6)
            edge = draw.uniform(0.3, 0.7) * (outside - inside)
            case = self.folder / f"case {k}.toml"
            case.write_text(
                TUBE.replace("radius = 10.0", f"radius = {inside}")
                .replace("radius = 20.0", f"radius = {outside}")
                .replace("initial = 20.0", f"initial = {outside}")
                .replace("bounds = [15.0, 25.0]", "bounds = [7.0, 40.0]")
                .replace("fea = 5.0", f"fea = {edge}")
                .replace("density", "yield_strength = 500\ndensity"))
            out = self.folder / f"out {k}"
            self.expect(self.call("run", case, "--no-pictures", "--no-report",
                                  "--out", out), 0)
            a2, b2 = inside**2, outside**2
            around = PRESSURE * (a2 + b2) / (b2 - a2)
            along = RATIO * (around - PRESSURE)
            peak = math.sqrt(0.5 * ((around + PRESSURE)**2 +
                                    (around - along)**2 +
                                    (along + PRESSURE)**2))
            figures = self.result(out)["stress"]["pressed"]["safety_factor"]
            with self.subTest(inside=inside, outside=outside, edge=edge):
                found = figures["smallest"] * peak / 500
                self.assertLess(found, 1.02)
                self.assertGreater(found, 0.9)

    def test_walls_one_element_thick_are_warned_of(self):
        """Edges longer than the wall: neither safety nor +- are sure."""
        draw = random.Random(26)
        for k, (least, most, warned) in enumerate(
                [(1.1, 1.5, True), (1.5, 2.0, True), (0.25, 0.35, False),
                 (0.35, 0.45, False)]):
            wall = draw.uniform(3, 6)
            edge = draw.uniform(least, most) * wall
            case = self.folder / f"wall {k}.toml"
            case.write_text(
                TUBE.replace("radius = 20.0", f"radius = {10 + wall}")
                .replace("initial = 20.0", f"initial = {10 + wall}")
                .replace("bounds = [15.0, 25.0]", "bounds = [11.0, 40.0]")
                .replace("fea = 5.0", f"fea = {edge}"))
            out = self.folder / f"thin {k}"
            self.expect(self.call("run", case, "--no-pictures", "--no-report",
                                  "--out", out), 0)
            with self.subTest(wall=wall, edge=edge):
                told = any("one element through" in text
                           for text in self.result(out)["warnings"])
                self.assertEqual(told, warned)

    def test_what_springs_hardly_hold_is_solved(self):
        """Nearly incompressible on soft springs: multigrid comes to a halt."""
        case = self.folder / "case.toml"
        case.write_text(
            TUBE.replace("radius = 10.0", "radius = 5.2")
            .replace("radius = 20.0", "radius = 14.4")
            .replace("initial = 20.0", "initial = 14.4")
            .replace("bounds = [15.0, 25.0]", "bounds = [10.0, 25.0]")
            .replace("poisson_ratio = 0.3", "poisson_ratio = 0.45")
            .replace("stiffness = [1, 1, 1]", "stiffness = [0.1, 0.1, 0.1]")
            .replace("on = \"bore\"", "on = \"mantle\""))
        works = []
        for solver in ("auto", "cholmod"):
            out = self.folder / solver
            self.expect(self.call("run", case, "--no-pictures", "--no-report",
                                  "--set", f"analysis.solver={solver}",
                                  "--out", out), 0)
            works.append(self.result(out)["responses"]["work"])
        self.assertAlmostEqual(works[0] / works[1], 1, delta=1e-8)

    def test_its_gradients_are_exact(self):
        self.expect(self.call("check-gradient", self.tube()), 0)


if __name__ == "__main__":
    unittest.main(verbosity=2)
