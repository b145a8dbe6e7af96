#!/usr/bin/env python3
"""A study that leaves the reach of its frozen mesh goes on with a new one,
also after it was killed."""
import os
import random
import shutil
import signal
import subprocess
import unittest

from killed_test import Study
from results_test import documented

# A tube that is bent: the film settled at 30 degrees is not the one that can
# follow to 115.
ELBOW = """title = "An elbow"
units = "mm-N-MPa"

[design.angle]
initial = 30.0
bounds = [15.0, 135.0]

[curves.base]
kind = "circle"
center = [0, 0, 0]
normal = [0, 0, -1]
radius = 20

[curves.head]
kind = "circle"
center = ["60 * (1 - cos(angle * deg))", 0, "20 + 60 * sin(angle * deg)"]
normal = ["sin(angle * deg)", 0, "cos(angle * deg)"]
radius = 20

[films.skin]
kind = "branch"
curves = ["base", "head"]

[solids.foot_pad]
kind = "cap"
curve = "base"

[solids.top]
kind = "cap"
curve = "head"

[bodies.part]
enclosed_by = ["skin", "foot_pad", "top"]
volume = "1193 * (20 + 60 * angle * deg)"
material = "aluminium"

[resolution]
fea = 8.0

[materials.aluminium]
youngs_modulus = 71700.0
poisson_ratio = 0.33
density = 2.8e-9

[load_cases.service]
supports = [{ on = "foot_pad", fix = "xyz" }]
loads = [{ on = "top", force = [1000, 0, 0] }]

[responses.middle]
kind = "centre_of_mass"
direction = [1, 0, 0]

[responses.sway]
kind = "mean_displacement"
on = "top"
direction = [1, 0, 0]

[analysis]
buckling = 0

[study]
kind = "match"
targets = { middle = 33 }
"""
KILLS = 2


class Refreeze(Study):
    def setUp(self):
        super().setUp()
        self.case.write_text(ELBOW)

    def test_a_target_beyond_the_frozen_mesh_is_reached(self):
        out = self.folder / "out"
        done = self.expect(self.call("run", self.case, "--no-pictures",
                                     "--out", out, env=self.env), 0,
                           r"a new model is frozen at evaluation \d+: ",
                           r"frozen anew at evaluation \d+.*changes 'sway' by")
        result = self.result(out)
        self.assertAlmostEqual(result["responses"]["middle"], 33, 1)
        self.assertEqual(result["evaluations"], len(
            (out / "history.csv").read_text().splitlines()) - 1)
        self.assertTrue(1 <= len(result["refrozen"]) <= 7)
        for refrozen in result["refrozen"]:
            self.assertEqual(set(refrozen), documented()["refrozen"])
            self.assertRegex(refrozen["reason"],
                             "dihedral|invert|a mesh of its own")
            # The mesh before, and what the new one changes.
            self.assertGreater(refrozen["responses"]["sway"], 0)
            self.assertTrue(15 < refrozen["parameters"]["angle"] < 135)
            # Another mesh of the same part.
            self.assertTrue(0 < abs(refrozen["shift"]["sway"]) < 0.1 *
                            result["responses"]["sway"])
        last = result["refrozen"][-1]["evaluation"]
        self.expect(self.call("study", "show", out), 0,
                    f"frozen at evaluation {last} start")
        self.assertIn(f"evaluation {last}", done.stdout + done.stderr)
        # The part is made again from the model that answered.
        self.expect(self.call("export", out, "--format", "inp"), 0)

        plain = self.folder / "plain"
        self.expect(self.run_study(plain, "--set", "study.refreeze=false"), 3)
        # It goes on from no new model, but its answer is judged on one.
        self.assertEqual([r["reason"] for r in
                          self.result(plain).get("refrozen", [])],
                         ["the answer on a mesh of its own"])

    def test_the_answer_is_judged_on_its_own_mesh(self):
        out = self.folder / "out"
        self.expect(self.call("run", self.case, "--no-pictures",
                              "--set", "study.targets.middle=25",
                              "--out", out, env=self.env), 0)
        result = self.result(out)
        last = result["refrozen"][-1]
        # The model that the answer is of was frozen within a hundredth of the
        # ranges of it, and what it says of the answer is what the study says.
        self.assertLess(abs(last["parameters"]["angle"] -
                            result["parameters"]["angle"]), 0.01 * 120)
        self.assertTrue(all(c["satisfied"]
                            for c in result["constraints"].values()))
        self.assertLess(abs(result["responses"]["middle"] / 25 - 1), 1e-3)
        # A case of its own, frozen at the answer, is another mesh yet; it
        # agrees with the judged answer at least as well as the dragged mesh.
        alone = self.folder / "alone"
        self.expect(self.call(
            "run", self.case, "--no-pictures", "--set", "study.kind=analyse",
            "--set", f"angle={result['parameters']['angle']!r}",
            "--out", alone, env=self.env), 0)
        sway = self.result(alone)["responses"]["sway"]
        self.assertLess(abs(result["responses"]["sway"] / sway - 1), 0.02)

    def test_killed_it_ends_with_the_same_bits(self):
        whole = self.undisturbed()
        models = {row[2] for row in whole[0][0]}
        self.assertGreater(len(models), 1)
        choice = random.Random(5)
        for number in range(KILLS):
            out = self.folder / f"killed {number}"
            running = self.start_study(out, start_new_session=True)
            # In the second half of the run, where models change.
            try:
                running.wait(self.seconds * (
                    0.4 + 0.6 * (number + choice.random()) / KILLS))
            except subprocess.TimeoutExpired:
                os.killpg(running.pid, signal.SIGKILL)
            running.communicate()
            self.expect(self.run_study(out, "--resume"), 0)
            self.assert_same(whole, self.outcome(out))
            shutil.rmtree(out)


if __name__ == "__main__":
    unittest.main(verbosity=2)
