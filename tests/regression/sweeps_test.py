#!/usr/bin/env python3
"""Sweeps from a case file to the table, and several designs side by side."""
import csv
import json
import re
import signal
import sqlite3
import time
import unittest

import program
from program import COARSE, ProgramTest, without_seconds

SWEEP = """
[responses.mass]
kind = "mass"

[study]
kind = "sweep"
"""
# Of an evaluation, all that does not tell the time.
COLUMNS = ("number, key, model, phase, input_names, inputs, response_names, "
           "responses, gradient, mismatch, failure, failure_message, figures")


class SweepTest(ProgramTest):
    def sweep(self, text, *replacements):
        """A case whose sweep is `text`; wide bounds, so that designs fail."""
        return self.write_case(
            (r"^\[curves.support\]",
             "[design.radius]\ninitial = 34\nbounds = [28, 42]\n\n"
             "[curves.support]"),
            (r"^radius = 35", 'radius = "radius"'),
            (r"(?s)^\[study\].*", SWEEP + text), *replacements)

    def run_case(self, case, name, *more, **options):
        out = self.folder / name
        done = self.call("run", case, *COARSE, "--no-pictures", "--out", out,
                         *more, **options)
        return done, out

    def records(self, out):
        with sqlite3.connect(out / "study.sqlite") as database:
            return database.execute(
                f"SELECT {COLUMNS} FROM evaluation ORDER BY number").fetchall()

    def models(self, out):
        return [record[2] for record in self.records(out)]

    def kept(self, out):
        """What of result.json must not depend on when or how fast."""
        return json.dumps(without_seconds(self.result(out)))

    def rows(self, out):
        with open(out / "history.csv", newline="") as file:
            return list(csv.DictReader(file))

    def assert_same(self, a, b):
        self.assertEqual(self.records(a), self.records(b))
        self.assertEqual(self.kept(a), self.kept(b))


class Sweeps(SweepTest):
    def test_a_grid_is_the_same_for_any_number_of_jobs(self):
        case = self.sweep('method = "grid"\n'
                          'levels = { support_x = 3, radius = 2 }\n'
                          'objective = "mass"\n')
        done, one = self.run_case(case, "one")
        self.expect(done, 0, "looked at all 6 designs")
        done, three = self.run_case(case, "three", "--jobs", "3",
                                    env={"OMP_NUM_THREADS": "2"})
        self.expect(done, 0)
        self.assert_same(one, three)
        result = self.result(three)
        # The start is one, too, and so is the best design on its own mesh.
        self.assertEqual(result["evaluations"], 8)
        self.assertEqual(result["evaluations"], len(self.rows(three)))
        self.expect(done, 0, r"least [0-9.e-]+ kg at support_x", "accuracy: ")
        sweep = result["sweep"]
        self.assertEqual((sweep["designs"], sweep["looked_at"],
                          sweep["failed"]), (6, 6, 0))
        mass = sweep["responses"]["mass"]
        rows = self.rows(three)
        swept = [row for row in rows if row["phase"] == "sweep"]
        # The last variable runs fastest.
        self.assertEqual([(row["support_x"], row["radius"]) for row in swept],
                         [(x, r) for x in ("-40", "0", "40")
                          for r in ("28", "42")])
        masses = [float(row["mass"]) for row in swept]
        self.assertEqual((mass["least"], mass["largest"]),
                         (min(masses), max(masses)))
        self.assertAlmostEqual(mass["mean"] / (sum(masses) / 6), 1.0, 12)
        # The best is the least mass, on a mesh made for it: both are told.
        best = swept[masses.index(min(masses))]
        self.assertEqual(result["parameters"]["radius"], float(best["radius"]))
        self.assertEqual(self.models(three)[-1],
                         f"frozen at evaluation {best['evaluation']}")
        self.assertEqual(result["objective"], float(rows[-1]["mass"]))
        self.assertEqual(result["objective"], result["responses"]["mass"])
        dragged = result["refrozen"][-1]["responses"]["mass"]
        self.assertEqual(dragged, min(masses))
        self.assertAlmostEqual(result["objective"] / dragged, 1.0, 2)
        self.expect(done, 0, f"the best has mass = {1e3 * dragged:.6g} kg",
                    f"On a mesh made for it: mass "
                    f"{1e3 * result['objective']:.6g} kg")
        self.assertEqual(mass["least_at"]["radius"],
                         result["parameters"]["radius"])
        self.assertTrue((three / "part.vtu").exists())

    def test_samples_fill_the_bounds_and_a_longer_sweep_goes_on(self):
        case = self.sweep('method = "sobol"\ncount = 3\n')
        done, out = self.run_case(case, "out", "--jobs", "2")
        self.expect(done, 0)
        first = self.records(out)
        case.write_text(case.read_text().replace("count = 3", "count = 5"))
        done, _ = self.run_case(case, "out", "--jobs", "2", "--resume")
        self.expect(done, 0, "looked at all 5 designs")
        self.assertEqual(self.records(out)[:len(first)], first)
        self.assertIsNone(self.result(out)["objective"])  # it has none
        for row in self.rows(out):
            self.assertTrue(28 <= float(row["radius"]) <= 42)
        shown = self.expect(self.call("study", "show", out), 0, "sweep")
        self.assertEqual(len(re.findall(r"\bsweep\b", shown.stdout)), 5)

    def test_a_longer_sweep_is_answered_by_its_own_best(self):
        # Of the least radius: the fourth of Sobol's designs beats the first
        # two by it, so that a mesh for the shorter sweep's best is there.
        case = self.sweep('method = "sobol"\ncount = 2\nobjective = "mass"\n')
        self.expect(self.run_case(case, "out")[0], 0)
        case.write_text(case.read_text().replace("count = 2", "count = 7"))
        done, out = self.run_case(case, "out", "--resume")
        self.expect(done, 0, "looked at all 7 designs")
        alone = self.run_case(case, "alone")[1]
        grown, straight = self.result(out), self.result(alone)
        self.assertEqual(grown["parameters"], straight["parameters"])
        self.assertEqual(grown["responses"], straight["responses"])
        self.assertEqual(len(set(self.models(out))), 3, self.models(out))
        # What is made of the results later is of the same mesh.
        for name in ("out", "alone"):
            self.expect(self.call("export", self.folder / name, "--format",
                                  "stl", "--out",
                                  self.folder / f"{name}.stl"), 0)
        self.assertEqual((self.folder / "out.stl").read_bytes(),
                         (self.folder / "alone.stl").read_bytes())

    def test_designs_that_fail_are_rows_with_their_cause(self):
        # Past some volume the film of this case has no equilibrium.
        case = self.sweep(
            'method = "grid"\nlevels = { fill = 2 }\n',
            (r"^\[curves.support\]", "[design.fill]\ninitial = 1.7e6\n"
             "bounds = [1e5, 1.8e6]\n\n[curves.support]"),
            (r"^volume = 1.7e6", 'volume = "fill"'))
        done, out = self.run_case(case, "out", "--jobs", "2")
        self.expect(done, 0, "1 of them cannot be evaluated")
        sweep = self.result(out)["sweep"]
        self.assertEqual(sweep["failed"], 1)
        self.assertEqual(sum(sweep["failures"].values()), 1)
        failed = [row for row in self.rows(out) if row["status"] != "ok"]
        self.assertEqual(len(failed), 1)
        self.assertIn(failed[0]["status"], sweep["failures"])
        self.assertTrue(failed[0]["message"])

    def test_a_sweep_without_any_answer_says_what_to_change(self):
        # The volume is a number at the bounds alone.
        case = self.sweep(
            'method = "grid"\nlevels = { fill = 1 }\n',
            (r"^\[curves.support\]", "[design.fill]\ninitial = 1.7e6\n"
             "bounds = [1e6, 1.7e6]\n\n[curves.support]"),
            (r"^volume = 1.7e6",
             'volume = "1.7e6 + sqrt((fill - 1e6)*(fill - 1.7e6))"'))
        done, out = self.run_case(case, "out")
        self.expect(done, 3, "none of the 1 designs can be evaluated",
                    "bring the bounds of the design variables nearer")
        self.assertEqual(self.result(out)["status"], "failed")

    def test_constraints_that_no_design_keeps_are_told(self):
        case = self.sweep('method = "sobol"\ncount = 2\nobjective = "mass"\n'
                          'constraints = [{ response = "left_deflection", '
                          'max = 0.001 }]\n')
        done, out = self.run_case(case, "out")
        self.expect(done, 3, "none keeps every constraint")
        self.assertEqual(self.result(out)["status"], "infeasible")

    def test_what_is_wrong_is_told_by_line(self):
        for text, told in (
                ('method = "grid"', "study.levels is missing"),
                ('method = "grid"\nlevels = { suport_x = 2 }',
                 "did you mean 'support_x'"),
                ('method = "grid"\nlevels = { radius = 0 }',
                 "expected a whole number from 1"),
                ('method = "grid"\nlevels = { radius = 2 }\ncount = 3',
                 "a grid's levels say how many"),
                ('method = "grid"\n'
                 'levels = { radius = 9999, support_x = 9999 }',
                 "take fewer levels"),
                ('method = "sobol"', "needs study.count"),
                ('method = "sobol"\ncount = 0', "a whole number from 1"),
                ('method = "sobol"\ncount = 3\nseed = 2', "nothing random"),
                ('method = "sobel"\ncount = 3', "did you mean 'sobol'"),
                ('count = 3\ntolerance = 1e-3',
                 'belongs to kind = "match" or "minimize"'),
                ('count = 3\nobjective = "mas"', "did you mean 'mass'"),
                ('count = 3\nconstraints = [{ response = "mass", max = 1 }]',
                 "study.objective which is the best")):
            with self.subTest(text=text):
                self.expect(self.call("check", self.sweep(text)), 2,
                            re.escape(told), r"case.toml:\d+")
        for option in ("--jobs", "--time-limit"):
            done = self.call("run", self.sweep("count = 2"), option, "0")
            self.expect(done, 2, option)
            self.assertRegex(done.stderr,
                             r"^.*0.*; see 'meniscus run --help'\n$")


class Tolerances(SweepTest):
    def study(self, text):
        return self.sweep("", (r'(?s)^kind = "sweep".*',
                               'kind = "tolerance"\n' + text))

    def test_gradient_and_samples_agree(self):
        case = self.study("deviations = { support_x = 0.5, radius = 0.2 }\n"
                          "count = 30\n")
        done, one = self.run_case(case, "one")
        self.expect(done, 0, "spread of 3 responses by gradient, confirmed by "
                    "30 samples")
        _, two = self.run_case(case, "two", "--jobs", "2")
        self.assert_same(one, two)
        self.assertEqual(self.result(one)["gradient_evaluations"], 1)
        tolerance = self.result(one)["tolerance"]
        self.assertEqual(tolerance["deviations"],
                         {"support_x": 0.5, "radius": 0.2})
        for name, response in tolerance["responses"].items():
            with self.subTest(response=name):
                self.assertAlmostEqual(sum(response["shares"].values()), 1, 12)
                sampled = response["sampled"]
                self.assertLess(
                    abs(sampled["deviation"] - response["deviation"]),
                    3 * sampled["deviation_error"])
        # An arm's deflection moves with the foot, the mass with its size.
        shares = tolerance["responses"]
        self.assertGreater(shares["left_deflection"]["shares"]["support_x"],
                           0.5)
        self.assertGreater(shares["mass"]["shares"]["radius"], 0.9)

    def test_what_is_wrong_is_told_by_line(self):
        for text, told in (
                ("", "study.deviations is missing"),
                ("deviations = { radius = 0 }", "must be above 0"),
                ('deviations = { radius = "5 kN" }', "5 kN"),
                ("deviations = { radios = 1 }", "did you mean 'radius'"),
                ("deviations = { radius = 1 }\ncount = 1",
                 "a whole number from 2"),
                ("deviations = { radius = 1 }\nmethod = \"sobol\"\nseed = 2",
                 "nothing random"),
                ("deviations = { radius = 1 }\nlevels = { radius = 2 }",
                 'study.levels belongs to kind = "sweep"')):
            with self.subTest(text=text):
                self.expect(self.call("check", self.study(text)), 2,
                            re.escape(told), r"case.toml:\d+")


class Pareto(SweepTest):
    SOFTNESS = '[responses.softness]\nkind = "compliance"\n\n[study]'

    def study(self, text):
        return self.sweep(
            "", (r"^\[curves.support\]", "[design.fill]\ninitial = 1.7e6\n"
                 "bounds = [1.4e6, 2.2e6]\n\n[curves.support]"),
            (r"^volume = 1.7e6", 'volume = "fill"'),
            (r'(?s)^kind = "sweep".*', text), (r"^\[study\]", self.SOFTNESS))

    def test_the_front_runs_from_one_minimum_to_the_other(self):
        front = 'kind = "pareto"\nobjectives = ["mass", "softness"]\n'
        done, out = self.run_case(self.study(front + "count = 4\n"), "out")
        self.expect(done, 0, "a front of 4 designs")
        result = self.result(out)
        points = result["front"]["points"]
        self.assertEqual(len(points), 4)
        for a, b in zip(points, points[1:]):
            self.assertLess(a["mass"], b["mass"])
            self.assertGreater(a["softness"], b["softness"])
        self.assertIn(result["parameters"]["fill"],
                      [p["parameters"]["fill"] for p in points[1:3]])
        for point, name in ((points[0], "mass"), (points[-1], "softness")):
            done, alone = self.run_case(
                self.study(f'kind = "minimize"\nobjective = "{name}"\n'),
                name)
            self.expect(done, 0)
            # Both are converged to 1e-4 of it, and looked at on a mesh made
            # for it: 1.1e-3 and 2.1e-3 were seen between the dragged mesh
            # and that, as rounding falls.
            own = point.get("own_mesh", point)
            self.assertLess(
                abs(self.result(alone)["objective"] / own[name] - 1), 4e-3)
        # The points say what they are on meshes of their own.
        for point in points:
            if "own_mesh" in point:
                self.assertTrue(point["own_mesh"]["kept"])
                self.assertLess(abs(point["own_mesh"]["mass"] /
                                    point["mass"] - 1), 0.02)
        self.assertTrue(any("own_mesh" in p for p in points))

    def test_what_is_wrong_is_told_by_line(self):
        for text, told in (
                ("", "two different responses"),
                ('objectives = ["mass", "mass"]',
                 "two different responses; found mass, mass"),
                ('objectives = ["mass", "softnes"]',
                 "did you mean 'softness'"),
                ('objectives = ["mass", "softness"]\ncount = 2',
                 "a whole number from 3")):
            with self.subTest(text=text):
                self.expect(
                    self.call("check", self.study('kind = "pareto"\n' + text)),
                    2, re.escape(told), r"case.toml:\d+")


class Jobs(SweepTest):
    def test_neighbours_of_a_difference_side_by_side(self):
        case = self.sweep("", (r'(?s)kind = "sweep".*',
                               'kind = "match"\nequal = ["left_peak", '
                               '"right_peak"]\nmax_evaluations = 7\n'),
                          (r"^\[responses.mass\]",
                           "".join(f'[responses.{side}_peak]\n'
                                   'kind = "max_von_mises"\n'
                                   f'load_case = "{side}"\n\n'
                                   for side in ("left", "right")) +
                           "[responses.mass]"),
                          (r"^\[load_cases.service\]",
                           "".join(f'[load_cases.{side}]\nsupports = '
                                   '[{ on = "support_pad", fix = "xyz" }]\n'
                                   f'loads = [{{ on = "{side}_pad", force = '
                                   '[0, 0, -4e4] }]\n\n'
                                   for side in ("left", "right")) +
                           "[load_cases.service]"))
        _, one = self.run_case(case, "one")
        _, two = self.run_case(case, "two", "--jobs", "2")
        self.assertIn("difference", {row["phase"] for row in self.rows(two)})
        self.assert_same(one, two)

    def test_killed_in_the_middle_it_goes_on_with_the_same_bits(self):
        case = self.sweep("count = 12\n")
        _, whole = self.run_case(case, "whole", "--jobs", "2")
        for stop in (signal.SIGKILL, signal.SIGINT):
            with self.subTest(stop=stop):
                out = self.folder / stop.name
                with self.start("run", case, *COARSE, "--no-pictures", "--out",
                                out, "--jobs", "2") as run:
                    self.wait_for(run, "evaluation 4 ")
                    run.send_signal(stop)
                    asked = time.monotonic()
                    run.communicate(timeout=60)
                    self.assertLess(time.monotonic() - asked, 10)
                self.assertEqual(run.returncode, 130 if stop == signal.SIGINT
                                 else -stop)
                done = self.records(out)
                self.assertGreaterEqual(len(done), 4)
                # What is there is the beginning of the whole.
                self.assertEqual(done, self.records(whole)[:len(done)])
                again, _ = self.run_case(case, stop.name, "--jobs", "2",
                                         "--resume")
                self.expect(again, 0)
                self.assert_same(whole, out)

    def wait_for(self, run, text):
        for line in run.stderr:
            if text in line:
                return
        self.fail(f"no {text!r} was said")

    def test_the_time_limit_ends_all_workers(self):
        case = self.sweep("count = 500\n")
        began = time.monotonic()
        done, out = self.run_case(case, "out", "--jobs", "2", "--time-limit",
                                  "1")
        self.assertLess(time.monotonic() - began, 30)
        self.expect(done, 3, "time limit of 1 s", "--resume")
        sweep = self.result(out)["sweep"]
        self.assertLess(sweep["looked_at"], 500)
        self.assertEqual(self.result(out)["evaluations"],
                         len(self.records(out)))
        # The start is no part of it.
        self.assertEqual(len(self.records(out)), sweep["looked_at"] + 1)

    def test_the_case_may_limit_the_time(self):
        done, out = self.run_case(
            self.sweep('count = 500\ntime_limit = "0.02 min"\n'), "out",
            "--time-limit", "60")
        self.expect(done, 3, "time limit of 1.2 s")
        self.expect(self.call("check", self.sweep(
            "count = 500\ntime_limit = 0\n")), 2,
            r"case.toml:\d+: study.time_limit is 0; it must be above 0")


class OtherKind(SweepTest):
    def test_keys_of_the_file_wait_while_set_asks_for_another_kind(self):
        done = self.expect(
            self.call("run", program.CASE, *COARSE, "--no-pictures", "--set",
                      "study.kind=sweep", "--set", "study.count=2", "--out",
                      self.folder / "out"), 0, "looked at all 2 designs",
            "the file's study.equal, study.tolerance belong to another kind")
        self.assertIn("--set study.kind=sweep", done.stderr)
        # What --set itself gives must fit.
        self.expect(self.call("run", program.CASE, "--set",
                              "study.kind=sweep", "--set", "study.count=2",
                              "--set", "study.max_evaluations=3"), 2,
                    'study.max_evaluations belongs to kind')


if __name__ == "__main__":
    unittest.main(verbosity=2)
