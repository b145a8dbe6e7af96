#!/usr/bin/env python3
"""Pressures and temperatures of shells that differ from place to place, and
loads that follow the design, from outside."""
import math
import random
import unittest

import shells_test
from program import ProgramTest, some

LENGTH = 100

# Water in the tube: its mean pressure is that of the middle, which `swell` is
# symmetric about.
WATER = shells_test.TUBE.replace(
    'pressure = "inside"', 'pressure = "inside * (1 - z / 50)"')

HOT = shells_test.STRIP.replace(
    "poisson_ratio = 0",
    "poisson_ratio = 0.3\nthermal_expansion = 2e-5").replace(
    '{ on = "plate/rim:end", force = [0, 0, 0.1] }',
    '{ temperature = "20 + 0.7 * x - y", reference = 20 }').replace(
    '{ on = "plate/rim:root", fix = "xyz", fix_rotation = "xyz" }',
    '{ on = "plate", at = [0, 0, 0], fix = "xyz", fix_rotation = "xyz" }'
    ).replace("direction = [0, 0, 1]", "direction = [1, 0, 0]")

# Every load of `many` follows the design or its place, and so does what asks
# for stresses by them.
ALL = shells_test.TUBE.replace(
    'pressure = "inside"', 'pressure = "inside * (1 - z / 70) + x / 90"'
    ).replace(
    '{ on = "skin/outside", pressure = 0.1 }',
    '{ on = "skin/outside", pressure = "0.1 * inside + z / 400" }').replace(
    "{ gravity = [0, 0, -9810] }",
    '{ gravity = [0, "2000 * inside", "-9810 * ring / 50"] }').replace(
    "spin = 100, at = [0, 0, 0]",
    'spin = "60 * inside", at = [0, "ring / 9", 0]').replace(
    "[responses.energy]\n", """[responses.warm]
kind = "compliance"
load_case = "warm"

[responses.warm_stress]
kind = "von_mises_norm"
power = 6
load_case = "warm"

[responses.warm_ks]
kind = "von_mises_ks"
load_case = "warm"

[responses.ratio]
kind = "stress_ratio"
load_case = "warm"

[responses.first]
kind = "buckling_factor"
load_case = "warm"

[responses.energy]
""").replace("[responses.swell]", """[load_cases.warm]
supports = [{ on = "skin/rim:low", fix = "xyz" }, { on = "skin/rim:high", fix = "xyz" }]
loads = [
  { temperature = "20 + 3 * inside + z / 5 + x / 20", reference = "18 + inside" },
  { on = "skin/outside", pressure = "2 * inside + y / 300" },
  { gravity = [0, "4e5 * inside", 100] },
]

[responses.swell]""", 1).replace(
    "poisson_ratio = 0.3", "poisson_ratio = 0.3\nthermal_expansion = 1.2e-5")


class FieldsTest(ProgramTest):

    def run_case(self, text, *arguments, name="out"):
        out = self.folder / name
        self.expect(self.call(
            "run", self.case(text), "--no-pictures", "--no-report", "--out", out, *arguments), 0)
        return self.result(out)["responses"]

    def test_water_widens_a_tube_by_its_pressure(self):
        for pressure, wall in ((2, 1), (0.5, 0.4)):
            arguments = ("--set", f"design.wall.initial={wall}", "--set",
                         f"design.inside.initial={pressure}")
            found = self.run_case(WATER, *arguments, name=f"out_{wall}")
            even = self.run_case(shells_test.TUBE, *arguments,
                                 name=f"even_{wall}")
            self.assertLess(abs(found["swell"] / even["swell"] - 1), 1e-3)
            # Work is that of p^2: 1 + 1 / 3 times the even one's far from the
            # rings, that of R^2 p^2 / (E t).
            ideal = 2 * math.pi * 50 * LENGTH * 50 ** 2 / (210e3 * wall) * (
                pressure ** 2 * 4 / 3)
            self.assertLess(abs(found["stretch"] / ideal - 1),
                            3 * math.sqrt(50 * wall) / LENGTH)

    def test_a_field_of_one_value_is_its_number(self):
        number = self.run_case(shells_test.TUBE, name="number")
        text = shells_test.TUBE.replace('pressure = "inside"',
                                        'pressure = "inside + 0 * z"')
        field = self.run_case(text, name="field")
        for name in ("swell", "stretch"):
            self.assertLess(abs(field[name] / number[name] - 1), 1e-11)

    # x + y bend a plate in its plane, without stress.
    def test_a_linear_temperature_does_not_stress(self):
        found = self.run_case(HOT)
        mean = 2e-5 * (0.7 * (100 ** 2 - 20 ** 2 / 3) / 2 - 100 * 20 / 2)
        self.assertLess(abs(found["dip"] / mean - 1), 1e-8)
        self.assertLess(found["peak"], 1e-6 * 1000 * 2e-5 * 70)

    # A rim is where nodes are: a field may have a value there and no slope.
    def test_a_field_without_a_slope_is_loaded_and_not_differentiated(self):
        text = shells_test.TUBE.replace('pressure = "inside"',
                                        'pressure = "inside * sqrt(50 - z)"')
        self.assertGreater(self.run_case(text)["swell"], 0)
        done = self.call("check-gradient", self.case(text))
        self.assertEqual(done.returncode, 3)
        self.assertRegex(
            done.stdout + done.stderr,
            r"no finite gradient at \(.*50\), which derivatives ask for")
        text = text.replace("sqrt(50 - z)", "log(-z)")
        done = self.expect(self.call("run", self.case(text), "--out",
                                     self.folder / "log"), 3)
        said = done.stdout + done.stderr
        self.assertRegex(said, "load case 'inner': the pressure on 'skin.*' at ")
        self.assertNotIn("load case 'inner': load case", said)

    def test_has_exact_gradients(self):
        self.expect(self.call("check-gradient", self.case(ALL), "--set",
                              "resolution.fea=14"), 0)

    def test_has_exact_gradients_of_films_drawn_at_random(self):
        for seed in some((11, 12)):
            with self.subTest(seed=seed):
                roll = random.Random(seed)
                text = shells_test.drawn(seed)
                force = text[text.index("pressure = "):]
                text = text.replace(
                    force[:force.index(" }")],
                    f'pressure = "{roll.uniform(-2, 2):.3f} + pull * x / 900 '
                    f'+ {roll.uniform(-1, 1):.3f} * sin(z / 9)"')
                text = text.replace(
                    "{ gravity = [0, -9810, 0] }",
                    '{ gravity = [0, -9810, "9e4 * pull"] },\n  { temperature '
                    '= "20 + pull / 9 + x / 8 + z * y / 90", reference = 20 }')
                text = text.replace("poisson_ratio",
                                    "thermal_expansion = 1e-5\npoisson_ratio")
                self.expect(self.call("check-gradient", self.case(text)), 0)


if __name__ == "__main__":
    unittest.main()
