#!/usr/bin/env python3
"""Exact gradients and the studies that use them, from a case file to the
answer."""
import itertools
import json
import re
import unittest

import program
from program import COARSE, SIZED_STRUT, ProgramTest, some

SIZED = """
[responses.mass]
kind = "mass"

[responses.difference]
kind = "expression"
value = "left_deflection - right_deflection"

[study]
kind = "minimize"
objective = "mass"
constraints = [
  { response = "difference", min = 0, max = 0 },
  { response = "left_deflection", max = 0.09 },
]
"""


class Gradients(ProgramTest):
    def test_another_design_than_the_initial_one(self):
        done = self.expect(
            self.call("check-gradient", program.CASE, *COARSE, "--at",
                      "support_x=-20"), 0, r"at support_x = -20")
        self.assertNotIn("DIFFERS", done.stdout)

    def test_wrong_places_are_told(self):
        for place, told in (("support_y=1", "did you mean 'support_x'"),
                            ("support_x=900", "outside the bounds -40 to 40"),
                            ("support_x", "expected NAME=VALUE")):
            self.expect(self.call("check-gradient", program.CASE, "--at",
                                  place), 2, told)

    def test_a_match_to_a_millionth_takes_few_evaluations(self):
        out = self.folder / "out"
        self.expect(self.call("run", program.CASE, *COARSE, "--set",
                              "study.tolerance=1e-6", "--no-pictures", "--out",
                              out), 0)
        result = self.result(out)
        self.assertRegex(result["message"], "matched.*The tolerance 1.0e-06 "
                         "is below the mesh's own error of the mismatch")
        self.assertLessEqual(result["evaluations"], 6)
        self.assertGreater(result["gradient_evaluations"], 0)
        for constraint in result["constraints"].values():
            self.assertLess(constraint["value"], 1e-6)


class Sized(ProgramTest):
    """The two-arm bracket of least mass at equal deflections."""

    def sized(self, *replacements):
        case = self.write_case(
            (r"^\[curves.support\]",
             "[design.fill]\ninitial = 1.7e6\nbounds = [1.4e6, 2.2e6]\n\n"
             "[design.radius]\ninitial = 35\nbounds = [30, 40]\n\n"
             "[curves.support]"),
            (r"^radius = 35", 'radius = "radius"'),
            (r"^volume = 1.7e6", 'volume = "fill"'),
            (r"(?s)^\[study\].*", SIZED), *replacements)
        return case

    def least(self):
        """The same case sized without more: its case, how the run ended, its
        result, its folder."""
        case = self.sized()
        folder, (done, result) = program.once(
            "least mass", lambda folder: self.minimum(case, folder / "out"))
        self.expect(done, 0)
        return case, done, result, folder / "out"

    def minimum(self, case, name, *more):
        out = self.folder / name
        done = self.call("run", case, *COARSE, "--no-pictures", "--out", out,
                         *more)
        return done, self.result(out)


class Minimize(Sized):
    def test_a_coarser_model_first_saves_evaluations(self):
        case, _, plain, _ = self.least()
        coarse = ("--set", "study.coarse_first=1.6")
        done, result = self.minimum(case, "both", *coarse)
        self.expect(done, 0)
        # Judged each on a mesh of its own: 4e-4 was seen between two.
        self.assertLess(abs(result["objective"] / plain["objective"] - 1),
                        3e-3)
        # The initial design is looked at on the way, but not begun from.
        self.assertLess(result["evaluations"] - 1, plain["evaluations"])
        self.assertGreater(result["coarse"]["evaluations"], 2)
        self.assertEqual(result["coarse"]["edge_factor"], 1.6)
        # The start that is told is the initial design on the case's model.
        self.assertEqual(result["start"], plain["start"])
        self.expect(self.call("study", "show", self.folder / "both"), 0,
                    "coarse x1.6 start", "coarse x1.6 step")
        again, replayed = self.minimum(case, "both", *coarse, "--resume")
        self.expect(again, 0)
        self.assertEqual(replayed["responses"], result["responses"])

    def test_a_coarser_model_that_fails_is_told_and_left(self):
        case = self.sized()
        done, result = self.minimum(case, "far", "--set",
                                    "study.coarse_first=8")
        self.expect(done, 0)
        self.assertIsNone(result["coarse"]["parameters"])
        self.assertTrue(any("coarser model gave no start" in text
                            for text in result["warnings"]))

    def test_a_coarser_film_without_vertices_is_told_and_left(self):
        """Between two caps a film's coarser start has rims alone: that model
        fails, and what the case's own model found is not lost."""
        source = program.ROOT / "cases" / "bell_crank" / "case.toml"
        case = self.folder / "analysed.toml"
        case.write_text(source.read_text().split("[study]")[0])
        out = self.folder / "analysed"
        self.expect(self.call("run", case, "--set", "resolution.fea=16",
                              "--set", "resolution.film=8", "--no-pictures",
                              "--out", out), 0)
        result = self.result(out)
        self.assertEqual(result["status"], "converged")
        self.assertGreater(result["response_errors"]["turn_a"], 0.0)

    def test_least_mass_at_equal_deflections(self):
        case, done, result, _ = self.least()
        self.expect(done, 0, "minimum found", "difference .*: kept")
        self.assertRegex(result["message"], "minimum found.*is below the "
                         "mesh's own error.*'left_deflection' stands")
        mass = result["objective"]
        best = result["parameters"]
        self.assertAlmostEqual(result["responses"]["difference"], 0, 6)
        self.assertLess(result["responses"]["left_deflection"], 0.09 + 1e-6)
        # Two other starts come to the same mass.
        for k, start in some(enumerate((("20", "2e6", "31"),
                                        ("-15", "1.5e6", "39")))):
            moved = [f"design.{name}.initial={value}" for name, value in zip(
                ("support_x", "fill", "radius"), start)]
            done, other = self.minimum(
                case, f"start{k}",
                *itertools.chain(*(("--set", m) for m in moved)))
            self.expect(done, 0)
            # Frozen elsewhere, it is another mesh.
            self.assertAlmostEqual(other["objective"] / mass, 1.0, 2)
        self.assertGreater(best["fill"], 1.4e6)

    def test_a_run_from_the_answer_of_another(self):
        case, _, first, answer = self.least()
        look = ("--set", "study.kind=analyse")
        done, again = self.minimum(case, "again", "--from", answer, *look)
        self.expect(done, 0)
        self.assertEqual(again["parameters"], first["parameters"])
        # Judged on a mesh made for it: nearly that one.
        self.assertLess(abs(again["responses"]["left_deflection"] /
                            first["responses"]["left_deflection"] - 1), 1e-2)
        # What --set says goes before it.
        done, moved = self.minimum(case, "moved", "--from", answer, "--set",
                                   "radius=33", *look)
        self.expect(done, 0)
        self.assertEqual(moved["parameters"],
                         {**first["parameters"], "radius": 33.0})
        # A sized part goes on from its answer and finds nothing much better.
        done, on = self.minimum(case, "on", "--from", answer)
        self.expect(done, 0)
        self.assertLess(abs(on["objective"] / first["objective"] - 1), 3e-3)
        self.expect(self.call("run", case, "--from", self.folder / "none"), 2,
                    "--from .*none")
        self.expect(self.call("run", program.ROOT / "cases" / "stepped_shaft" /
                              "case.toml", "--from", answer), 2,
                    "no design variable of this case")
        self.expect(self.call(
            "run", case, "--from", answer, "--set",
            "design.radius.bounds=[36.5, 40]"), 2, r"radius.*bounds")

    def test_a_method_without_gradients_finds_it_too(self):
        case, _, exact, _ = self.least()
        case.write_text(case.read_text() + 'method = "cobyla"\n'
                        "max_evaluations = 100\n")
        _, other = self.minimum(case, "cobyla")
        self.assertEqual(other["gradient_evaluations"], 0)
        self.assertLess(abs(other["objective"] / exact["objective"] - 1), 3e-3)

    def test_bounds_that_cannot_be_kept_end_with_what_to_change(self):
        case = self.sized((r"max = 0.09", "max = 0.001"))
        done, result = self.minimum(case, "out")
        self.expect(done, 3, "left_deflection")
        self.assertEqual(result["status"], "infeasible")
        # They pull at one another: which one is missed more is the mesh's.
        self.assertFalse(all(c["satisfied"]
                             for c in result["constraints"].values()))

    def test_equal_bounds_leave_nothing_to_move(self):
        case = self.write_case((r"^bounds = .*", "bounds = [0.0, 0.0]"))
        out = self.folder / "out"
        self.expect(self.call("run", case, *COARSE, "--no-pictures", "--out",
                              out), 3, "bounds")

    def test_check_says_what_it_read_in_the_units_of_people(self):
        """A plain number of mass is in tonnes where units are mm-N-MPa."""
        case = self.folder / "case.toml"
        case.write_text(program.SIZED_STRUT.replace(
            "max = 0.0075 }]",
            'max = 0.0075 }, { response = "mass", min = 1e-5, max = 4.7 }]'))
        self.expect(self.call("check", case), 0,
                    r"minimize mass; sway at most 0\.0075 mm; "
                    r"mass at least 0\.01 kg, at most 4700 kg")
        self.expect(self.call("check", program.CASE), 0,
                    "match left_deflection = right_deflection")

    def test_what_is_wrong_in_the_study_is_told_by_line(self):
        for old, new, told in (
                ('objective = "mass"', 'objective = "mas"',
                 "did you mean 'mass'"),
                (", min = 0, max = 0", "", "bounds nothing; add min or max"),
                ("min = 0, max = 0", "min = 2, max = 1",
                 "nothing lies between"),
                ('value = "left', 'value = "lfet', "left_deflection"),
                ('kind = "minimize"', 'kind = "minimize"\nequal = ["mass"]',
                 "belongs to kind = \"match\""),
                ('kind = "mass"', 'kind = "max_von_mises"',
                 "has no derivatives")):
            with self.subTest(new=new):
                case = self.sized()
                text = case.read_text()
                self.assertIn(old, text)
                case.write_text(text.replace(old, new, 1))
                self.expect(self.call("check", case), 2, re.escape(told),
                            r"case.toml:\d+")


class Unusable(ProgramTest):
    """Design spaces with nothing to find: exit 3, and what to change. One
    method of each family; all of them were tried by hand."""
    MINIMIZE = ("slsqp", "bobyqa", "isres")
    MATCH = ("ceres", "direct_l")

    def ends(self, study, replacements, *told):
        text = re.sub(r"(?s)\[study\].*", "", SIZED_STRUT) + study
        for old, new in replacements:
            self.assertIn(old, text)
            text = text.replace(old, new)
        case = self.folder / "case.toml"
        case.write_text(text)
        out = self.folder / "out"
        self.expect(self.call("run", case, "--no-pictures", "--out", out,
                              "--set", "resolution.fea=16"), 3)
        message = self.result(out)["message"]
        for pattern in told:
            self.assertRegex(message, pattern)

    def each(self, replacements, told, matched="sway = 0.0065",
             objective="mass", constraint='"sway", max = 0.0075',
             expression=None):
        response = "" if expression is None else (
            f'[responses.made]\nkind = "expression"\nvalue = "{expression}"\n')
        for method in some(self.MINIMIZE):
            with self.subTest(minimize=method):
                self.ends(f"""{response}
[study]
kind = "minimize"
objective = "{objective}"
constraints = [{{ response = {constraint} }}]
method = "{method}"
max_evaluations = 15
""", replacements, *told)
        for method in some(self.MATCH):
            with self.subTest(match=method):
                self.ends(f"""{response}
[study]
kind = "match"
targets = {{ {matched} }}
method = "{method}"
max_evaluations = 15
""", replacements, *told)

    def test_bounds_that_are_equal(self):
        self.each([("bounds = [20.0, 32.0]", "bounds = [25, 25]"),
                   ("bounds = [7e4, 1.2e5]", "bounds = [9e4, 9e4]")],
                  ["no design variable can move", "Widen them"])

    def test_what_nothing_changes(self):
        self.each([], ["(?i)no design variable changes it|does not change",
                       "Choose (another|variables)"],
                  matched="made = 3", objective="made",
                  constraint='"sway", max = 1', expression="5 + 0 * mass")

    def test_what_no_design_reaches(self):
        self.each([], [r"sway.*at most 1e-09|mismatch", "(?i)loosen|widen|add"],
                  matched="sway = 5", constraint='"sway", max = 1e-9')

    def test_expressions_without_a_value(self):
        self.each([], ["initial design cannot be evaluated",
                       r"case.toml:\d+: responses.made.value: log\(-",
                       r"in 'log\(sway - 1\)'"],
                  matched="made = 3", objective="made",
                  expression="log(sway - 1)")

    def test_expressions_with_a_value_at_the_start_alone(self):
        self.each([], ["(?i)responses.made.value: sqrt",
                       "(?i)bound|start elsewhere"],
                  matched="made = 0.0065", objective="made",
                  expression="sway + sqrt(-abs(foot - 25) - "
                             "abs(fill / 9e4 - 1))")

    def test_a_region_without_a_value(self):
        region = """[responses.made]
kind = "distance"
keep_out = "sqrt(x - 99)"
"""
        self.ends(region, [], "initial design cannot be evaluated",
                  r"responses.made.keep_out has no value at \(",
                  r"sqrt\(-")

    def test_a_curve_without_a_value_between_the_bounds(self):
        # Good at both ends and at the start, nowhere about 30.
        self.ends("""[study]
kind = "match"
targets = { sway = 0.5 }
method = "cobyla"
max_evaluations = 15
""", [('radius = "foot"', 'radius = "foot + sqrt(abs(foot - 30) - 1)"')],
                  "mismatch", "(?i)bound|start elsewhere")


class Resume(Sized):
    def test_a_minimum_resumes_with_the_same_bits(self):
        case, _, _, whole = self.least()
        part = self.folder / "part"
        cut = self.call("run", case, *COARSE, "--no-pictures", "--out", part,
                        "--set", "study.max_evaluations=3")
        self.expect(cut, 3)
        self.expect(self.call("run", case, *COARSE, "--no-pictures", "--out",
                              part, "--resume"), 0)
        keep = ("objective", "parameters", "responses", "evaluations",
                "gradient_evaluations")
        a, b = self.result(whole), self.result(part)
        self.assertEqual(json.dumps({k: a[k] for k in keep}),
                         json.dumps({k: b[k] for k in keep}))


if __name__ == "__main__":
    unittest.main(verbosity=2)
