#!/usr/bin/env python3
"""No answer is lost on its way out, none is told of another design, and what is
told beside it covers what it leaves open."""
import json
import math
import time
import unittest

from program import COARSE, SIZED_STRUT, ProgramTest

LINK = """title = "Two arms on a foot, rims near the hull of all"
units = "mm-N-MPa"

[design.r0]
initial = 22
bounds = [20, 27]

[curves.support]
kind = "circle"
center = [0, 0, 0]
normal = [0, 0, -1]
radius = 22

[curves.arm0]
kind = "circle"
center = [45.161, 0, 23.311]
normal = ["sin(72 * deg)", 0, "cos(72 * deg)"]
radius = "r0"

[curves.arm1]
kind = "circle"
center = [-45.161, 0, 23.311]
normal = ["-sin(45 * deg)", 0, "cos(45 * deg)"]
radius = 22.5617

[films.skin]
kind = "branch"
curves = ["support", "arm0", "arm1"]

[solids.support_pad]
kind = "cap"
curve = "support"

[solids.arm0_pad]
kind = "cap"
curve = "arm0"

[solids.arm1_pad]
kind = "cap"
curve = "arm1"

[bodies.part]
enclosed_by = ["skin", "support_pad", "arm0_pad", "arm1_pad"]
volume = "0.8*(pi*22^2*23.31*0.7 + pi*(r0^2 + 22.5617^2)*45.16*0.9)"
material = "aluminium"

[resolution]
fea = 11.29
film = 5.65

[materials.aluminium]
youngs_modulus = 71700.0
poisson_ratio = 0.33
density = 2.8e-9

[load_cases.service]
supports = [{ on = "support_pad", fix = "xyz" }]
loads = [{ on = "arm0_pad", force = [0, 0, -1849.4] }]

[responses.sink]
kind = "mean_displacement"
on = "arm0_pad"
direction = [0, 0, -1]

[responses.mass]
kind = "mass"

[analysis]
buckling = 0

[study]
kind = "minimize"
objective = "sink"
"""

WEDGE = """title = "A wedge"
units = "mm-N-MPa"

[design.high]
initial = 20
bounds = [1.3, 30]

[curves.front]
kind = "polygon"
points = [[0, 0, 0], [100, 0, 0], [100, 0, "high"]]

[curves.back]
kind = "polygon"
points = [[0, 20, 0], [100, 20, 0], [100, 20, "high"]]

[solids.near]
kind = "cap"
curve = "front"

[solids.far]
kind = "cap"
curve = "back"

[solids.round]
kind = "sides"
curves = ["front", "back"]

[bodies.wedge]
enclosed_by = ["near", "far", "round"]
material = "steel"

[resolution]
fea = 12

[materials.steel]
youngs_modulus = "210 GPa"
poisson_ratio = 0.3
density = "7850 kg/m3"

[load_cases.pull]
supports = [{ on = "near", fix = "xyz" }]
loads = [{ on = "far", force = ["1 N", 0, 0] }]

[responses.mass]
kind = "mass"

[study]
kind = "minimize"
objective = "mass"
"""


class Answers(ProgramTest):
    def run_case(self, case, name, *more):
        out = self.folder / name
        return self.call("run", case, "--no-pictures", "--out", out,
                         *more), out

    def test_films_that_cannot_start_at_the_answer_lose_nothing(self):
        """At the largest rim its curves are off the hull of all; the model's
        film came from the initial design."""
        done, out = self.run_case(self.case(LINK), "out")
        self.assertNotEqual(done.returncode, 2, done.stderr)
        self.assertEqual(self.result(out)["parameters"]["r0"], 27)
        fresh, _ = self.run_case(self.case(LINK.replace(
            "initial = 22", "initial = 27"), "fresh.toml"), "fresh")
        self.assertIn("convex hull", fresh.stderr)  # or this tests nothing

    def test_a_surface_that_cannot_be_exported_ends_no_run(self):
        case = self.case(SIZED_STRUT)
        done, out = self.run_case(case, "out", "--set",
                                  "resolution.export=[0.001]")
        self.expect(done, 0, "not written as part_0.001.stl")
        self.assertTrue(self.result(out)["responses"])

    def test_a_damaged_result_stands_for_no_other_design(self):
        case = self.case(SIZED_STRUT)
        done, out = self.run_case(case, "out")
        self.expect(done, 0)
        file = out / "result.json"
        good = file.read_text()
        names = json.loads(good)
        for text in (good[:300], "[" * 5000,
                     json.dumps({**names, "parameters": [1]}),
                     json.dumps({**names, "parameters": {"foot": "a"}})):
            file.write_text(text)
            for command in (("export", out, "--format", "stl"),
                            ("check", case, "--from", out),
                            ("compare", out, out)):
                with self.subTest(command=command[0], text=text[:20]):
                    self.expect(self.call(*command), 2, "damaged")
        file.unlink()  # the database has it, too
        self.expect(self.call("export", out, "--format", "stl"), 0)

    def test_pictures_made_later_go_with_the_answer(self):
        case = self.case(SIZED_STRUT.replace('kind = "minimize"',
                                             'kind = "analyse"')
                         .split("objective")[0])
        done, out = self.run_case(case, "out")
        self.expect(done, 0)
        self.expect(self.call("report", out), 0)
        drawn = sorted(path.name for path in out.glob("*.png"))
        self.assertTrue(drawn)
        self.expect(self.run_case(case, "out", "--set", "foot=27")[0], 0)
        self.assertEqual(sorted(out.glob("*.png")), [])

    def test_a_family_takes_the_place_of_a_run(self):
        done, out = self.run_case(self.case(SIZED_STRUT), "out")
        self.expect(done, 0)
        family = self.case(
            SIZED_STRUT.split("[study]")[0] + """
[study]
kind = "family"
each = "analyse"

[study.members.a]
foot = 26
""", "family.toml")
        self.expect(self.run_case(family, "out")[0], 0)
        left = {path.name for path in out.iterdir()}
        self.assertFalse(left & {"part.vtu", "film.vtp", "study.sqlite",
                                 "history.csv"}, left)

    def test_variables_that_targets_leave_free_have_no_error(self):
        text = SIZED_STRUT.split("[study]")[0] + """
[study]
kind = "match"
targets = { sway = 0.007 }
"""
        done, out = self.run_case(self.case(text), "out")
        self.expect(done, 0, "not fixed by the targets")
        errors = self.result(out)["parameter_errors"]
        self.assertEqual(errors, {"foot": None, "fill": None})
        text = text.replace("sway = 0.007", "sway = 0.007, mass = 2.5e-4")
        done, out = self.run_case(self.case(text), "both")
        for name, error in self.result(out)["parameter_errors"].items():
            self.assertGreater(error, 0, name)

    def test_a_peak_has_its_error_and_safety_is_told_with_it(self):
        done, out = self.run_case(
            self.write_case((r"^yield_strength.*", "yield_strength = 400.0")),
            "out", *COARSE)
        self.expect(done, 0, r"peak stress, service +\S+ MPa  \+- \S+ MPa at")
        entry = self.result(out)["stress"]["service"]
        highest = max(entry["readings"].values())
        self.assertGreater(entry["error"], 0)
        self.assertAlmostEqual(
            entry["safety_factor"]["with_error"],
            400 / (entry["safety_factor"]["von_mises"] + entry["error"]), 9)
        self.assertAlmostEqual(entry["safety_factor"]["von_mises"], highest, 9)

    def test_smoothing_is_part_of_an_error(self):
        """A tube of rings whose meshes are all alike: its wall is known."""
        from rings_test import TUBE
        for inside, outside in ((8.7, 15.28), (10.0, 14.0), (17.09, 32.37)):
            text = (TUBE.replace("radius = 10.0", f"radius = {inside}")
                    .replace("radius = 20.0", f"radius = {outside}")
                    .replace("initial = 20.0", f"initial = {outside}")
                    .replace("bounds = [15.0, 25.0]", "bounds = [7.0, 40.0]")
                    .replace("fea = 5.0", "fea = 4.0") +
                    '\n[responses.wall]\nkind = "thickness"\n')
            done, out = self.run_case(self.case(text), f"tube {inside}")
            self.expect(done, 0)
            result = self.result(out)
            wall = result["responses"]["wall"]
            error = result["response_errors"]["wall"]
            with self.subTest(inside=inside):
                self.assertLessEqual(wall, outside - inside)
                self.assertGreater(error, 0.01 * wall)
                self.assertGreater(wall + 2 * error, outside - inside)
                self.assertLess(error, 0.3 * wall)
                mass = math.pi * (outside**2 - inside**2) * 30 * 7.85e-9
                told = result["response_errors"]["mass"]
                self.assertTrue(
                    told is None or
                    abs(result["responses"]["mass"] - mass) <= told, told)

    def test_bounds_have_the_dimension_of_what_they_bound(self):
        sized = SIZED_STRUT.replace("max = 0.0075 }]",
                                    'max = 0.0075 }, { response = "extra", '
                                    'min = BOUND }]')
        for response, wrong, right in (
                ('kind = "collapse_margin"', '"3 kg"', '"1e-5 N/mm3"'),
                ('kind = "collapse_margin"', '"0.5 mm"', "1e-5"),
                ('kind = "collapse_margin"', '"1e-4 MPa"', "1e-5"),
                ('kind = "mean_displacement"\non = "top"\nweight = 2\n'
                 "direction = [1, 0, 0]", '"5 kg"', '"1e-5 mm"'),
                ('kind = "mean_displacement"\non = "top"\nweight = "z / 60"\n'
                 "direction = [1, 0, 0]", '"5 kg"', "1e-5"),
                ('kind = "expression"\nvalue = "mass + sway"', '"5 MPa"',
                 "1e-5")):
            text = sized.replace("[analysis]",
                                 f"[responses.extra]\n{response}\n\n[analysis]")
            for bound, code in ((wrong, 2), (right, 0)):
                with self.subTest(response=response, bound=bound):
                    self.expect(self.call("check", self.case(
                        text.replace("BOUND", bound))), code)

    def test_numbers_that_nature_has_none_of_are_told(self):
        """A density in kg/m3 where the case counts in t/mm3."""
        good = self.call("check", self.case(SIZED_STRUT))
        self.assertNotIn("unit meant", good.stdout + good.stderr)
        for was, now, told in (
                ("density = 2.8e-9", "density = 2800",
                 r"density is 2800 t/mm3, which is 2.8e\+15 kg/m3"),
                ("youngs_modulus = 71700.0", "youngs_modulus = 71.7e9",
                 r"youngs_modulus is 7.17e\+10 MPa"),
                ("youngs_modulus = 71700.0", "youngs_modulus = 71.7",
                 "youngs_modulus is 0.0717 GPa at 2800 kg/m3, as soft as"),
                ("loads = [{", "loads = [{ gravity = [0, 0, -9.81] }, {",
                 "gravity of load case 'service' is 9.81 mm/s2")):
            done = self.call("check", self.case(SIZED_STRUT.replace(was, now)))
            self.expect(done, 0, told, "no errors, 1 warning:")
            self.assertNotIn("nothing wrong", done.stdout)

    def test_a_drop_that_hangs_to_a_side_is_told(self):
        """Between equal circles: with little liquid it stands upright, with
        much of it to which side is the mesh's, and figures are of that."""
        for volumes, hangs in ((1.5, False), (12.0, True)):
            text = SIZED_STRUT.replace("initial = 25.0", "initial = 20.0")
            text = text.replace("initial = 9e4",
                                f"initial = {volumes * math.pi * 20**2 * 60!r}")
            text = text.replace("[7e4, 1.2e5]", "[7e4, 2e6]")
            case = self.case(text)
            out = self.folder / f"drop_{hangs}"
            done = self.expect(self.call(
                "run", case, "--set", "study.kind=analyse", "--no-pictures",
                "--no-report", "--out", out), 0)
            film = self.expect(self.call("evolve", case, "--no-pictures",
                                         "--out", out / "film"), 0)
            told = "the film can move almost freely"
            for said in (done.stderr, film.stderr,
                         " ".join(self.result(out)["warnings"])):
                (self.assertIn if hangs else self.assertNotIn)(told, said)
        # One that fails to settle has other troubles.
        thin = self.case(SIZED_STRUT.replace("initial = 9e4", "initial = 7e3")
                         .replace("[7e4, 1.2e5]", "[6e3, 1e4]"))
        done = self.expect(self.call("evolve", thin, "--no-pictures", "--out",
                                     self.folder / "thin"), 3, "failed: ")
        self.assertNotIn("freely", done.stderr)

    def test_a_body_without_liquid_is_told(self):
        done = self.call("check", self.case(SIZED_STRUT.replace(
            'volume = "fill"', "")))
        self.expect(done, 0, "neither volume nor pressure: film 'skin'")
        self.assertNotIn("neither volume", self.call(
            "check", self.case(SIZED_STRUT)).stderr)

    def test_what_cannot_be_kept_ends_the_search(self):
        """A sway that no design has: told so, well before the limit."""
        text = SIZED_STRUT.replace("max = 0.0075", "max = 0.0005").replace(
            'method = "mma"', 'method = "slsqp"')
        done, out = self.run_case(self.case(text), "out")
        self.expect(done, 3, "no design was found that keeps")
        self.assertLess(self.result(out)["evaluations"], 60)

    def test_an_answer_that_no_mesh_can_be_made_for_is_not_converged(self):
        """At its lower bound the wedge has an edge of 0.7 degrees: a mesh
        follows it nearly there from 20 mm, and none can be made there."""
        done, out = self.run_case(self.case(WEDGE), "out")
        self.expect(done, 3, "nothing proves its figures")
        result = self.result(out)
        self.assertEqual(result["status"], "stopped")
        self.assertIn("no new model can be frozen there",
                      " ".join(result["warnings"]))
        self.assertLess(result["parameters"]["high"], 1.6)

    def test_a_thousand_variables_are_heard_and_done(self):
        """Their bounds once made one step of the search take minutes."""
        names = [f"d{k}" for k in range(1000)]
        designs = "".join(f"[design.{n}]\ninitial = 0\nbounds = [-1, 1]\n\n"
                          for n in names)
        text = SIZED_STRUT.replace("[curves", designs + "[curves", 1).replace(
            'volume = "fill"', 'volume = "fill + ' + " + ".join(names) + '"')
        self.assertIn("d999", text.split("volume", 1)[1])
        for method in ("mma", "slsqp"):
            began = time.monotonic()
            done, _ = self.run_case(
                self.case(text.replace('"mma"', f'"{method}"')), method)
            self.expect(done, 0, "converged")
            self.assertLess(time.monotonic() - began, 60)

    def test_slanting_faces_are_filled_at_any_height(self):
        """Points in line but for rounding are no crossing."""
        for high in (2.5, 6, 8, 13.7, 21.3, 28.9):
            text = WEDGE.replace("initial = 20", f"initial = {high}")
            done, _ = self.run_case(self.case(text), f"at_{high}", "--set",
                                    "study.kind=analyse")
            self.expect(done, 0, "analysed")


if __name__ == "__main__":
    unittest.main(verbosity=2)
