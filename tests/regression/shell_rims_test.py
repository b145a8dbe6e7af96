#!/usr/bin/env python3
"""Rims and films of shells that move as rigid bodies, from outside."""
import math
import random
import re

import bulk_data
import program
import shells_test
from export_test import nodal_field
from program import ProgramTest
from shells_test import STRIP, TUBE

WORK = """
[responses.work]
kind = "compliance"
load_case = "{}"
"""
END = '{ on = "plate/rim:end", force = [0, 0, 0.1] }'
BENDING = 1000 * 20 / 12  # of the strip

# A tube of a twelfth of its radius at low, whose other rim is rigid.
TWISTED = TUBE[:TUBE.index("[load_cases.inner]")].replace(
    "initial = 1\nbounds = [0.2, 5]", "initial = 4\nbounds = [0.2, 15]") + """
[load_cases.all]
supports = [{ on = "skin/rim:low", fix = "xyz", fix_rotation = "xyz" }]
loads = [{ on = "skin/rim:high", by = "rigid", moment = [0, 0, 1e6], at = [7, 3, 50] }]

[responses.mass]
kind = "mass"

[analysis]
buckling = 0
"""


class ShellRims(ProgramTest):
    def run_case(self, text, *arguments, name="out"):
        out = self.folder / name
        self.expect(self.call("run", self.case(text), "--no-pictures",
                              "--no-report", "--out", out, *arguments), 0)
        return self.result(out)

    # T L / (G J); the work is the moment's on what it turns.
    def test_a_rigid_end_twists_a_tube(self):
        errors = []
        for edge in ("32", "16"):
            found = self.run_case(TWISTED + WORK.format("all"), "--set",
                                  f"resolution.fea={edge}", name=f"out{edge}")
            J = 2 * math.pi * 50 ** 3 * 4 * (1 + (4 / 100) ** 2)
            turn = 1e6 * 100 / (210e3 / 2.6 * J)
            errors.append(abs(found["responses"]["work"] / (1e6 * turn) - 1))
        self.assertLess(errors[1], 6e-3, errors)
        self.assertLess(errors[1], 0.4 * errors[0], errors)

    # By a force on a lever beyond it and a moment; where it may not turn; and
    # where it is turned, or held so that it turns, as nodes or as one.
    def test_a_rigid_end_bends_a_strip(self):
        P, M, lever = 0.1, 2.0, 30.0
        all_of_it = M + P * lever
        beyond = ('{ on = "plate/rim:end", by = "rigid", force = [0, 0, 0.1], '
                  'moment = [0, -2, 0], at = [130, 10, 0] }')
        guide = (', { on = "plate/rim:end", by = "rigid", at = [130, 10, 0], '
                 'fix_rotation = "y"%s }')
        clamp = 'fix_rotation = "xyz" }'
        turned = (', { on = "plate/rim:end", fix_rotation = "y", rotation = '
                  '[0, -0.02, 0] }')
        shear = P * 100 / (5 / 6 * 500 * 20)
        for loads, held, exact in (
                (beyond, "", P * 1e6 / 3 / BENDING + shear
                 + all_of_it * 1e4 / 2 / BENDING),
                (beyond, guide % "", P * 1e6 / 12 / BENDING + shear),
                ("", guide % ", rotation = [0, -0.02, 0]", 0.02 * 100 / 2),
                ("", turned, 0.02 * 100 / 2)):
            text = STRIP.replace(clamp, clamp + held).replace(
                END if loads else f"loads = [{END}]\n", loads)
            found = self.run_case(text)["responses"]
            self.assertLess(abs(found["dip"] / exact - 1), 5e-4)

    # Clamped, guided at the other end: buckles as pi^2 E I / L^2, sways with
    # cos(b) cosh(b) of the guided beam, b = 2.36502.
    def test_a_guided_strip_sways(self):
        text = STRIP.replace(END, '{ on = "plate/rim:end", by = "rigid", '
                             'force = [-1, 0, 0], at = [300, 10, 0] }').replace(
            'fix_rotation = "xyz" }]', 'fix_rotation = "xyz" }, { on = '
            '"plate/rim:end", by = "rigid", at = [90, -9, 7], '
            'fix_rotation = "xyz" }]').replace(
            "buckling = 0", "buckling = 1\nfrequencies = 1")
        found = self.run_case(text)
        factor = found["buckling"]["tip"]["factors"][0]
        tone = found["natural_frequencies"]["values"][0]
        self.assertLess(abs(factor / (math.pi ** 2 * BENDING / 1e4) - 1), 2e-3)
        self.assertLess(abs(tone / (
            2.36502 ** 2 / (2 * math.pi) * math.sqrt(
                BENDING / (1e-9 * 20 * 100 ** 4))) - 1), 2e-3)

    def test_a_rigid_rim_held_in_all_is_a_clamp(self):
        for seed in (31,):
            text = shells_test.drawn(seed)
            text = re.sub(r'fix = "xyz", fix_rotation = "\w+"',
                          'fix = "xyz", fix_rotation = "xyz"', text, count=1)
            rigid = text.replace(
                '{ on = "skin/rim:low", fix = ', '{ on = "skin/rim:low", '
                'by = "rigid", at = [3, "lean", -9], fix = ', 1)
            self.assertNotEqual(text, rigid)
            one, two = (self.run_case(t, name=n)["responses"]
                        for t, n in ((text, "clamp"), (rigid, "rigid")))
            for name, value in one.items():
                self.assertLess(abs(two[name] / value - 1), 1e-8, name)

    def test_has_exact_gradients_of_films_drawn_at_random(self):
        for seed in (41, 43):
            with self.subTest(seed=seed):
                self.expect(self.call("check-gradient", self.case(
                    self.drawn(seed)), "--set", "resolution.fea=18"), 0)

    def drawn(self, seed):
        """Low held as one about a point of the design, in part, at numbers of
        the design; high free, loaded beside its middle."""
        roll = random.Random(seed)
        text = shells_test.drawn(seed)
        fix = roll.choice(["xy", "xz", "y"])
        free = "".join(sorted(set("xyz") - set(fix)))
        text = re.sub(
            r'\{ on = "skin/rim:low", fix = "xyz", fix_rotation = "\w+" \}',
            '{ on = "skin/rim:low", by = "rigid", at = ["lean", 5, "-wall"], '
            f'fix = "xyz", displacement = ["0.01 * wall", 0, "0.0002 * pull"], '
            'fix_rotation = "xyz", rotation = [0.001, "1e-4 * lean", 0] }, '
            f'{{ on = "skin/rim:high", by = "rigid", at = [9, "lean", "ring"], '
            f'fix = "{fix}", fix_rotation = "{free}" }}', text, count=1)
        text = text.replace(
            '{ on = "skin/rim:high", force = [1, "pull", 0]',
            '{ on = "skin/rim:high", by = "rigid", force = [1, "pull", 0]')
        self.assertEqual(text.count('by = "rigid"'), 3)
        text += shells_test.MODAL.format("one")
        return text.replace('[responses.hum]\nkind = "frequency"', """
[responses.hum]
kind = "frequency"
load_case = "one\"""") + """
[responses.turned]
kind = "rotation"
on = "skin"
axis = [1, 0, 2]
load_case = "one"

[responses.energy]
kind = "strain_energy"
load_case = "one"
"""

    # Half of the tube, with its rigid end guided in the plane.
    def test_a_plane_of_symmetry_cuts_a_rigid_rim(self):
        whole = TWISTED.replace(
            "moment = [0, 0, 1e6], at = [7, 3, 50]",
            "force = [3e3, 0, -5e3], moment = [0, 4e5, 0], at = [7, 0, 60]")
        whole = whole.replace("buckling = 0", "buckling = 0\nfrequencies = 1")
        whole += WORK.format("all")
        half = whole.replace("ring^2 * 100", "ring^2 * 50").replace(
            "[shells.tube]", "[symmetry]\nplanes = [{ at = [0, 0, 0], "
            "normal = [0, 1, 0] }]\n\n[shells.tube]").replace(
            "force = [3e3, 0, -5e3], moment = [0, 4e5, 0]",
            "force = [1.5e3, 0, -2.5e3], moment = [0, 2e5, 0]")
        guided = half.replace(
            'fix_rotation = "xyz" }]', 'fix_rotation = "xyz" }, { on = '
            '"skin/rim:high", by = "rigid", at = [0, 0, 0], fix = "y", '
            'fix_rotation = "xz" }]')
        one, two = (self.run_case(t, "--set", "resolution.fea=12", name=n)
                    for t, n in ((whole, "whole"), (guided, "half")))
        self.assertLess(abs(two["responses"]["work"]
                            / one["responses"]["work"] - 1), 1e-3)
        self.expect(self.call("check-gradient", self.case(guided), "--set",
                              "resolution.fea=20"), 0)
        done = self.call("run", self.case(half), "--out", self.folder / "no",
                         "--set", "resolution.fea=20")
        self.expect(done, 3)
        self.assertIn("held by a support otherwise than that moves",
                      done.stdout + done.stderr)

    def test_the_nastran_deck_says_it(self):
        text = STRIP.replace(END, '{ on = "plate/rim:end", by = "rigid", '
                             'force = [0, 0, 0.1], at = [130, 10, 0] }').replace(
            'fix_rotation = "xyz" }]', 'fix_rotation = "xyz" }, { on = '
            '"plate/rim:end", by = "rigid", at = [130, 10, 0], axes = '
            '[[0, 1, 0], [1, 0, 0]], fix = "x", displacement = [0.3, 0, 0], '
            'fix_rotation = "yz" }]')
        self.run_case(text)
        file = self.folder / "deck.bdf"
        self.expect(self.call("export", self.folder / "out", "--format", "bdf",
                              "--out", file), 0)
        bulk = bulk_data.read(file.read_text())
        (point, nodes), = bulk.rigid
        self.assertEqual(bulk.grids[point], [130, 10, 0])
        self.assertEqual(sorted(nodes), sorted(
            n for n, x in bulk.grids.items()
            if abs(x[0] - 100) < 1e-9 and n != point))
        self.assertIn(point, bulk.frames)
        held = sorted((components, value) for components, rows, value
                      in bulk.held[1] if point in rows)
        self.assertEqual(held, [("1", 0.3), ("5", 0.0), ("6", 0.0)])
        # No node of the rigid one is held by itself.
        for _, rows, _ in bulk.held[1]:
            self.assertFalse(set(rows) & set(nodes))
        force = [sum(f[k] for rows in bulk.forces.values()
                     for n, first, f in rows if first == 1) for k in range(3)]
        self.assertLess(max(abs(a - b) for a, b in
                            zip(force, [0, 0, 0.1])), 1e-9)
        done = self.expect(self.call("export", self.folder / "out", "--format",
                                     "inp"), 2)
        self.assertIn("write the deck of Nastran (bdf)", done.stderr)
        # The film's own figures obey what the deck says.
        msh = self.folder / "deck.msh"
        self.expect(self.call("export", self.folder / "out", "--format", "msh",
                              "--out", msh), 0)
        turned = nodal_field(msh.read_text(), "rotation, tip ")
        end = [turned[n - 1] for n in nodes]
        for w in end:
            self.assertLess(max(abs(a - b) for a, b in zip(w, end[0])), 1e-9)

    # Shells are all that this case has: no body lends it a yield strength.
    def test_strength_needs_one(self):
        for kind, said in (("von_mises_ks", "has no 'scale'"),
                           ("stress_ratio", "yield_strength")):
            text = STRIP + f"""
[responses.strength]
kind = "{kind}"
load_case = "tip"
"""
            self.assertNotIn("yield_strength", text)
            self.assertNotIn("[bodies", text)
            done = self.expect(self.call("check", self.case(text)), 2)
            self.assertIn(said, done.stderr)

    def test_says_what_does_not_fit(self):
        rigid = ('{ on = "skin/rim:high", by = "rigid", at = [0, 0, 50], '
                 'fix = "x" }')
        for supports, said in (
                (rigid + ", " + rigid, "of two rigid pins"),
                (rigid + ', { on = "skin/rim:high", fix = "z" }',
                 "and held by nodes"),
                (rigid.replace("at = [0, 0, 50], ", ""),
                 "is rigid and has no 'at'"),
                (rigid.replace("rim:high", "rim:hihg"),
                 "there is no surface 'skin/rim:hihg'"),
                (rigid.replace(' }', ', rotation = [1, 0, 0] }'),
                 "fix_rotation does not hold that component"),
                ('{ on = "skin/rim:low", fix = "x", rotation = [1, 0, 0] }',
                 "fix_rotation does not hold that component")):
            text = TWISTED.replace("supports = [", f"supports = [{supports}, ")
            done = self.expect(self.call("check", self.case(text)), 2)
            self.assertIn(said, done.stderr)
            self.assertRegex(done.stderr, r"case\.toml(:\d+)?: ")
        done = self.expect(self.call("check", self.case(TWISTED.replace(
            "moment = [0, 0, 1e6], at = [7, 3, 50]", "force = [1, 0, 0]").replace(
                'by = "rigid"', 'by = "bearing"'))), 2)
        self.assertIn("a bearing load, which shells do not know", done.stderr)
        # What the film tells: a node of two, and what is free to move.
        for supports, said in (
                ('{ on = "skin", by = "rigid", at = [0, 0, 0], fix = "x" }',
                 "name both in one entry"),
                (None, "is free to")):
            text = (TWISTED.replace("supports = [", f"supports = [{supports}, ")
                    if supports else TWISTED.replace(
                        'fix = "xyz", fix_rotation = "xyz"',
                        'by = "rigid", at = [0, 0, 9], fix = "xyz", '
                        'fix_rotation = "xy"'))
            done = self.call("run", self.case(text), "--out",
                             self.folder / "no", "--set", "resolution.fea=20")
            self.expect(done, 3)
            self.assertIn(said, done.stdout + done.stderr)


if __name__ == "__main__":
    program.unittest.main()
