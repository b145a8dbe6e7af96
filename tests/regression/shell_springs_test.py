#!/usr/bin/env python3
"""Shells on beds of springs, from outside."""
import math
import random
import unittest

import shells_test
from program import ProgramTest, some

CLAMP = '{ on = "plate/rim:root", fix = "xyz", fix_rotation = "xyz" }'

# Films drawn at random, held by springs beside half of their clamp.
EIGENVALUES = """
[responses.first]
kind = "buckling_factor"
load_case = "one"

[responses.tone]
kind = "frequency"
load_case = "one"
"""


class SpringsTest(ProgramTest):

    def run_case(self, text, *arguments, name="out"):
        out = self.folder / name
        self.expect(self.call("run", self.case(text), "--no-pictures",
                              "--no-report", "--out", out, *arguments), 0)
        return self.result(out)["responses"]

    # F / (k A) everywhere, along each axis.
    def test_a_plate_sinks_into_its_bed(self):
        roll = random.Random(5)
        for axis in range(3):
            stiffness = [roll.uniform(0.5, 3) for _ in range(3)]
            force = [0, 0, 0]
            force[axis] = roll.uniform(1, 9)
            way = [int(k == axis) for k in range(3)]
            for total in (False, True):
                said = [round(k * (2000 if total else 1), 4)
                        for k in stiffness]
                text = shells_test.STRIP.replace(
                    CLAMP, f'{{ on = "plate", stiffness = {said}'
                    + (', stiffness_of = "total" }' if total else " }"))
                text = text.replace('on = "plate/rim:end", force = [0, 0, 0.1]',
                                    f'on = "plate", force = {force}')
                text = text.replace('direction = [0, 0, 1]',
                                    f'direction = {way}')
                found = self.run_case(text, name=f"out_{axis}_{total}")
                exact = force[axis] / (said[axis] * (1 if total else 2000))
                self.assertLess(abs(found["dip"] / exact - 1), 1e-7)

    # The end of a long beam on a foundation: 2 P lambda / (k b) with
    # lambda^4 = k b / (4 E I) (Hetenyi 1946).
    def test_a_strip_bends_on_its_foundation(self):
        for length in (0.08, 0.11):
            bed = 4 * (1000 * 20 / 12) * length ** 4
            text = shells_test.STRIP.replace(
                CLAMP, '{ on = "plate", normal_stiffness = %.9g }, '
                '{ on = "plate", at = [0, 0, 0], fix = "xy", '
                'fix_rotation = "z" }' % (bed / 20))
            found = self.run_case(text, name=f"out_{length}")
            exact = 2 * 0.1 * length / bed
            self.assertLess(abs(found["dip"] / exact - 1), 5e-3)

    # Up and down, and tilting: f = sqrt(k / (rho t)) / (2 pi), a little lower
    # where the wall turns with it.
    def test_a_plate_bounces_on_its_bed(self):
        text = shells_test.STRIP.replace(
            CLAMP, '{ on = "plate", stiffness = [9, 9, 2e-3] }').replace(
            "youngs_modulus = 1000", "youngs_modulus = 1e6").replace(
            "buckling = 0", "buckling = 0\nfrequencies = 4")
        out = self.folder / "out"
        self.expect(self.call("run", self.case(text), "--no-pictures",
                              "--no-report", "--out", out), 0)
        found = self.result(out)["natural_frequencies"]["values"]
        exact = math.sqrt(2e-3 / 1e-9) / (2 * math.pi)
        for value in found[:3]:
            self.assertLess(abs(value / exact - 1), 1.5e-3)
        self.assertGreater(found[3], 5 * exact)

    def test_has_exact_gradients_of_films_drawn_at_random(self):
        for seed in some((21, 22, 23)):
            with self.subTest(seed=seed):
                roll = random.Random(seed)
                bed = roll.choice([
                    f'stiffness = [{roll.uniform(1, 9):.3f}, '
                    f'{roll.uniform(1, 9):.3f}, 2]',
                    f'normal_stiffness = {roll.uniform(1, 9):.3f}',
                    'stiffness = [5000, 0, 900], stiffness_of = "total", axes '
                    '= [[1, 1, 0], [0, 1, 1]]'])
                text = shells_test.drawn(seed).replace(
                    'supports = [', 'supports = [{ on = "skin/inside", '
                    + bed + " }, ", 1)
                self.expect(self.call("check-gradient", self.case(
                    text + EIGENVALUES)), 0)

    def test_says_what_springs_are_not(self):
        text = shells_test.STRIP.replace(
            CLAMP, '{ on = "plate", stiffness = [1, 1, 1] }')
        done = self.expect(self.call("check", self.case(text + """
[responses.energy]
kind = "strain_energy"
""")), 2)
        self.assertIn("which has springs; of shells take compliance",
                      done.stderr)
        text = text.replace("stiffness = [1, 1, 1]", "normal_stiffness = 1")
        done = self.expect(self.call(
            "run", self.case(text), "--out", self.folder / "free"), 3)
        self.assertRegex(done.stdout + done.stderr,
                         r"free to (move along|turn about)")


if __name__ == "__main__":
    unittest.main()
