#!/usr/bin/env python3
"""What a run says first: the worst load case by its name, the peak beside a mean
of stress; and what it leaves beside it: nothing of an earlier answer."""
import json
import re
import unittest

from program import ROOT, ProgramTest, strut

CASE = """title = "A strut pushed and pulled"
units = "mm-N-MPa"

[parameters]
length = 60.0
push = "1 kN"

[design.foot]
initial = 25.0
bounds = [20.0, 32.0]
""" + strut('"foot"', '"length"', "ground") + """
[resolution]
fea = 10.0
export = [8, 6]

[materials.aluminium]
youngs_modulus = 71700.0
poisson_ratio = 0.33
density = 2.8e-9
yield_strength = 300.0

[load_cases.pull]
supports = [{ on = "ground", fix = "xyz" }]
loads = [{ on = "top", force = [0, 0, "push"] }]

[load_cases.sway]
supports = [{ on = "ground", fix = "xyz" }]
loads = [{ on = "top", force = ["4 * push", 0, 0] }]

[load_cases.turn]
supports = [{ on = "ground", fix = "xyz" }]
loads = [{ on = "top", moment = [0, 0, "9 J"] }]

[responses.mass]
kind = "mass"

[responses.sigma]
kind = "von_mises_norm"
load_case = "sway"
power = 2

[analysis]
buckling = 0
"""
SIZED = """
[study]
kind = "minimize"
objective = "mass"
constraints = [{ response = "sigma", max = "20 MPa" }]
"""


class WorstCase(ProgramTest):
    def run_case(self, text, *options, out="out", code=0, pictures=False):
        path = self.folder / "case.toml"
        path.write_text(text)
        done = self.call("run", path, "--out", out, "--no-frames", *options,
                         pictures=pictures)
        self.assertEqual(done.returncode, code, done.stderr + done.stdout)
        folder = self.folder / out
        return folder, json.loads((folder / "result.json").read_text()), done

    def test_the_worst_load_case_is_told_by_name(self):
        out, result, done = self.run_case(CASE, "--no-pictures")
        safety = {name: figures["safety_factor"]["smallest"]
                  for name, figures in result["stress"].items()}
        self.assertEqual(min(safety, key=safety.get), "sway")
        self.assertEqual(result["worst_load_case"], "sway")
        lines = re.findall(r"peak stress, (\w+) .*safety ([\d.]+)(.*)",
                           done.stdout)
        self.assertEqual([line[0] for line in lines], ["pull", "sway", "turn"])
        for name, shown, mark in lines:
            self.assertAlmostEqual(float(shown) / safety[name], 1, 2)
            self.assertEqual("worst" in mark, name == "sway")

    def test_the_parts_fields_are_of_the_worst_and_of_each(self):
        out, result, _ = self.run_case(CASE, "--no-pictures")
        page = (out / "report.html").read_text()
        self.assertIn('"load_case":"sway"', page)
        for name in ("pull", "sway", "turn"):
            self.assertIn(f'"von_mises:{name}"', page)
            self.assertIn(f'Name="von_mises_{name}"'.encode(),
                          (out / "part.vtu").read_bytes())
            self.assertIn(f'Name="displacement_{name}"'.encode(),
                          (out / "part_surface.vtp").read_bytes())

    def test_each_load_case_has_its_picture(self):
        out, _, _ = self.run_case(CASE, pictures=True)
        names = {path.name for path in out.glob("*.png")}
        self.assertEqual(names, {
            "film.png", "overview.png", "part.png", "part_pull.png",
            "part_sway.png", "part_turn.png"})
        before = {name: (out / name).read_bytes() for name in names}
        self.assertNotEqual(before["part_pull.png"], before["part_turn.png"])
        # Drawn again from the files, they are what they were.
        done = self.call("report", "out")
        self.assertEqual(done.returncode, 0, done.stderr)
        for name in names:
            self.assertEqual((out / name).read_bytes(), before[name], name)

    def test_a_mean_that_hides_its_peak_is_told(self):
        _, result, done = self.run_case(CASE + SIZED, "--no-pictures",
                                        "--no-report")
        self.assertTrue(result["constraints"]["sigma"]["satisfied"])
        beside = result["norm_peaks"]["sigma"]
        self.assertEqual(beside["load_case"], "sway")
        self.assertEqual(beside["bound"], 20)
        self.assertLessEqual(beside["norm"], 20 * (1 + 1e-3))
        self.assertGreater(beside["peak"], 25)
        self.assertFalse(beside["peak_within_bound"])
        self.assertAlmostEqual(
            beside["peak"], result["stress"]["sway"]["max_von_mises"])
        self.assertTrue(any("'sigma' keeps its bound and the peak does not" in w
                            for w in result["warnings"]), result["warnings"])
        self.assertRegex(done.stdout, r"sigma .*nodal peak of 'sway' is .*ABOVE")
        self.assertRegex(done.stdout, r"sigma .*at most 20 MPa: kept\n")
        self.assertRegex(done.stdout, r"foot +32 +at its upper bound\n")
        # A bound that the peak keeps, too, is not warned of.
        _, loose, _ = self.run_case(CASE + SIZED.replace("20 MPa", "900 MPa"),
                                    "--no-pictures", "--no-report")
        self.assertTrue(loose["norm_peaks"]["sigma"]["peak_within_bound"])
        self.assertFalse(any("keeps its bound" in w for w in loose["warnings"]))

    def test_a_bound_of_stress_keeps_the_peak_itself(self):
        text = CASE.replace("[analysis]", """[responses.stress]
kind = "stress_ratio"
allowable = "90 MPa"
load_cases = ["pull", "sway", "turn"]

[analysis]
exclude = [{ near = "ground", distance = "12 mm" }]""") + """
[study]
kind = "minimize"
objective = "mass"
constraints = [{ response = "stress", max = 1 }]
"""
        _, result, done = self.run_case(text, "--no-pictures", "--no-report")
        self.assertTrue(result["constraints"]["stress"]["satisfied"])
        values = result["responses"]
        self.assertEqual(result["envelopes"]["stress"]["most"], "stress[sway]")
        self.assertEqual(result["envelopes"]["stress"]["value"],
                         values["stress[sway]"])
        for name in ("pull", "sway", "turn"):
            readings = result["stress"][name]["readings"]
            nodal = max(readings["recovered"], readings["averaged"]) / 90
            ratio = values[f"stress[{name}]"]
            self.assertGreaterEqual(ratio, nodal)
            self.assertLessEqual(ratio, 1.02 * nodal)
            self.assertGreaterEqual(values["stress"], ratio)
            self.assertLessEqual(nodal, 1 + 1e-3)
            beside = result["norm_peaks"][f"stress[{name}]"]
            self.assertEqual((beside["of"], beside["bound"]), ("bound", 1))
        self.assertLessEqual(values["stress"], 1 + 1e-3)
        self.assertRegex(done.stdout, r"stress +[\d.]+.*most 'stress\[sway\]'")
        self.assertRegex(done.stdout,
                         r"stress\[sway\] +is a bound of the nodal peak")

    def test_masses_are_read_in_kilograms(self):
        _, result, done = self.run_case(CASE, "--no-pictures", "--no-report")
        shown = float(re.search(r"mass +([\d.]+) kg", done.stdout).group(1))
        self.assertAlmostEqual(shown, 1e3 * result["responses"]["mass"], 5)

    def test_nothing_of_an_earlier_answer_stays(self):
        out, _, _ = self.run_case(CASE, pictures=True)
        mine = {"notes.txt": "mine", "part_final.stl": "mine", "mine.png": "mine"}
        for name, text in mine.items():
            (out / name).write_text(text)
        self.assertTrue((out / "part_8.stl").exists())
        # Another resolution: other STL files, and no pictures this time.
        self.run_case(CASE.replace("export = [8, 6]", "export = [7]"),
                      "--no-pictures")
        self.assertTrue((out / "part_7.stl").exists())
        for name in ("part_8.stl", "part_6.stl", "part.png", "part_turn.png",
                     "film.png", "overview.png"):
            self.assertFalse((out / name).exists(), name)
        # What `export` put beside the answer goes with it, too.
        self.assertEqual(self.call("export", out, "--format", "obj").returncode, 0)
        exported = list(out.glob("*.obj"))
        self.assertEqual(len(exported), 1)
        # A film that does not stand leaves its picture, and no part.
        _, failed, done = self.run_case(CASE, "--set", "length=150", code=3,
                                        pictures=True)
        self.assertEqual(failed["status"], "failed")
        for name in ("part.vtu", "part_surface.vtp", "part_7.stl"):
            self.assertFalse((out / name).exists(), name)
        self.assertFalse(exported[0].exists())
        self.assertTrue((out / "film.png").exists())
        self.assertIn("film.png", done.stderr)
        page = (out / "report.html").read_text()
        self.assertIn('"parts":[]', page.replace(" ", ""))
        # And that picture goes with the next good answer's own.
        self.run_case(CASE, "--no-pictures")
        self.assertFalse((out / "film.png").exists())
        for name, text in mine.items():
            self.assertEqual((out / name).read_text(), text)

    def test_a_film_alone_goes_to_no_runs_folder(self):
        out, result, _ = self.run_case(CASE, "--no-pictures")
        film = (out / "film.vtp").read_bytes()
        done = self.call("evolve", self.folder / "case.toml", "--out", out)
        self.assertEqual(done.returncode, 2)
        self.assertIn("holds a run", done.stderr)
        self.assertEqual((out / "film.vtp").read_bytes(), film)

    def test_an_older_films_picture_goes(self):
        path = self.folder / "case.toml"
        path.write_text(CASE)
        for options, there in ((["--out", "film"], True),
                               (["--out", "film", "--no-pictures"], False)):
            done = self.call("evolve", path, *options, pictures=True)
            self.assertEqual(done.returncode, 0, done.stderr)
            self.assertEqual((self.folder / "film" / "film.png").exists(), there)
        # One that is the user's stays.
        (self.folder / "own").mkdir()
        (self.folder / "own" / "film.png").write_text("mine")
        self.call("evolve", path, "--out", "own", "--no-pictures")
        self.assertEqual((self.folder / "own" / "film.png").read_text(), "mine")

    def test_compare_tells_what_is_left_out_of_each_part(self):
        text = CASE.replace(
            "buckling = 0",
            'buckling = 0\nexclude = [{ near = "ground", distance = 9 }]')
        for out, foot in (("a", 25), ("b", 30), ("c", 21)):
            self.run_case(text, "--no-pictures", "--no-report", "--set",
                          f"foot={foot}", out=out)
        done = self.call("compare", "a", "b", "c", "--out", "side")
        self.assertEqual(done.returncode, 0, done.stderr)
        row = re.search(r"left out of stresses \[% of the volume\](.*)",
                        done.stdout).group(1).split()
        parts = json.loads(
            (self.folder / "side" / "compare.json").read_text())["parts"]
        shown = [float(row[k]) for k in (0, 1, 3)]
        for value, part in zip(shown, parts):
            share = 100 * part["exclusion"]["volume_share"]
            self.assertGreater(share, 5)
            self.assertAlmostEqual(value / share, 1, 4)
            self.assertEqual(len(part["exclusion"]["zones"]), 1)
        self.assertNotAlmostEqual(shown[0], shown[1], 3)
        self.assertTrue((self.folder / "side" / "part_3.vtp").exists())
        self.call("compare", "a", "b", "--out", "side")
        self.assertFalse((self.folder / "side" / "part_3.vtp").exists())

    def test_faces_are_told_so_that_one_finds_them(self):
        self.run_case(CASE, "--no-pictures", "--no-report")
        done = self.call("export", "out", "--format", "obj")
        self.assertEqual(done.returncode, 0, done.stderr)
        file = next((self.folder / "out").glob("part*.obj"))
        text = file.read_text().replace("g ground", "g a").replace("g top", "g b")
        for name in ("one.obj", "two.obj"):
            (self.folder / name).write_text(text)
        lost = self.call("compare", "out", "one.obj", "--out", "x")
        self.assertEqual(lost.returncode, 2)
        self.assertRegex(lost.stderr, r"a: plane at \([^)]*\), outwards "
                         r"\(0, 0, -1\), area [\d.e+]+ mm2")
        self.assertRegex(lost.stderr, r"skin: curved at ")
        # Names of one file alone come before those of all.
        (self.folder / "two.obj").write_text(
            text.replace("g a", "g p").replace("g b", "g q"))
        found = self.call("compare", "out", "one.obj", "two.obj", "--out", "x",
                          "--face", "ground=a", "--face", "top=b",
                          "--face", "two.obj:ground=p", "--face",
                          "two.obj:top=q")
        self.assertEqual(found.returncode, 0, found.stderr)
        parts = json.loads(
            (self.folder / "x" / "compare.json").read_text())["parts"]
        self.assertEqual(parts[1]["mass"], parts[2]["mass"])
        wrong = self.call("compare", "out", "one.obj", "--out", "x", "--face",
                          "other.obj:ground=a")
        self.assertEqual(wrong.returncode, 2)
        self.assertIn("'other.obj' is none of the parts", wrong.stderr)

    def test_advice_was_tried(self):
        path = self.folder / "case.toml"
        path.write_text(CASE)
        done = self.call("evolve", path, "--no-pictures",
                         "--set", "bodies.part.volume=4.5e4")
        self.assertEqual(done.returncode, 3)
        found = re.search(r"tried: with .* the volume of 'part' "
                          r"\(volume = ([\d.e+]+ mm3), .*case\.toml: --set "
                          r"bodies\.part\.volume=4\.5e4\) the film stands",
                          done.stderr)
        self.assertTrue(found, done.stderr)
        held = self.call("evolve", path, "--no-pictures", "--set",
                         f"bodies.part.volume={found.group(1)}")
        self.assertEqual(held.returncode, 0, held.stderr)
        # Where nothing helps, it says what was tried, and nothing would help.
        lost = self.call("evolve", path, "--no-pictures", "--set", "length=300")
        self.assertEqual(lost.returncode, 3)
        self.assertIn("tried in vain", lost.stderr)
        self.assertIn("docs/arms.md", lost.stderr)

    def test_volumes_that_cannot_stand(self):
        """A volume a hundred times too large or too small, of an eye about a
        bore: named with its line and its way, which was tried; by evolve too."""
        text = (ROOT / "cases/bell_crank/case.toml").read_text()
        given = re.search(r"\[bodies\.end_b\]\n.*\nvolume = (\".*\")", text)
        line = text[:given.start(1)].count("\n") + 1
        for volume, factor in (("50 mm3", r"\d{2,3}"), ("2000 cm3", r"0\.\d+")):
            path = self.folder / "crank.toml"
            path.write_text(text[:given.start(1)] + f'"{volume}"' +
                            text[given.end(1):])
            calls = [("evolve",), ("run", "--set", "study.kind=analyse")]
            for command, *more in calls:
                with self.subTest(volume=volume, command=command):
                    done = self.call(command, path, "--no-pictures", *more,
                                     "--out", f"{command}_{volume[:2]}")
                    self.assertEqual(done.returncode, 3, done.stderr)
                    found = re.search(
                        r"tried: with (" + factor + r") times the volume of "
                        r"'end_b' \(volume = ([\d.e+]+ mm3), .*crank\.toml:"
                        rf"{line}\) the film stands", done.stderr)
                    self.assertTrue(found, done.stderr)
            held = self.call("evolve", path, "--no-pictures", "--set",
                             f"bodies.end_b.volume={found.group(2)}")
            self.assertEqual(held.returncode, 0, held.stderr)


if __name__ == "__main__":
    unittest.main()
