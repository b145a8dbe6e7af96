#!/usr/bin/env python3
"""Every folder of cases/ is a whole case, and what compares them with their
expected.json can fail."""
import copy
import json
import pathlib
import re
import shlex
import subprocess
import sys
import unittest

import program
from program import ProgramTest

sys.path.insert(0, str(program.ROOT / "scripts"))
import cases  # noqa: E402  (scripts/ is found only now)
import gallery  # noqa: E402
import peers  # noqa: E402

GOOD = {
    "runs": [{
        "name": "film", "command": "evolve case.toml", "quick": "--set a=1",
        "expected": {"film.area": {"value": 100.0, "kind": "film"}},
        "expected_quick": {"film.area": {"value": 90.0, "kind": "film"}},
    }],
}


class Cases(ProgramTest):
    def test_every_folder_is_a_case(self):
        self.assertGreater(len(cases.folders()), 2)
        for folder in cases.folders():
            with self.subTest(case=folder.name):
                spec = cases.read(folder)
                text = (folder / "README.md").read_text(encoding="utf-8")
                for word in ("**Sketch.**", "**Physics.**", "**Source.**",
                             "**Ours.**", "**Run.**", "<!-- results -->",
                             f"docs/gallery/{folder.name}"):
                    self.assertIn(word, text)
                for run in spec["runs"]:
                    file = run["command"].split()[1]
                    if "{out}" not in file:
                        self.assertTrue((folder / file).exists(), file)
                for path in re.findall(r"\]\(([^)#:]+)\)", text):
                    self.assertTrue((folder / path).exists(), path)
                if (folder / "case.toml").exists():
                    self.expect(self.call("check", folder / "case.toml"), 0)

    def test_gradients_are_checked_at_a_quick_size(self):
        """By regression.case.NAME, wherever there are design variables."""
        for folder in cases.folders():
            checked = {shlex.split(run["command"])[1]
                       for run in cases.read(folder)["runs"]
                       if run["command"].startswith("check-gradient ")
                       and "quick" in run}
            for file in folder.glob("*.toml"):
                if "[design." in file.read_text(encoding="utf-8"):
                    self.assertIn(file.name, checked, folder.name)

    def read(self, spec):
        (self.folder / "expected.json").write_text(json.dumps(spec))
        return cases.read(self.folder)

    def test_the_format_is_checked(self):
        self.read(GOOD)
        figure = ("runs", 0, "expected", "film.area")
        for path, new, told in (
                (("runs", 0, "comand"), "x", "unknown key 'comand'"),
                (("prepare",), "nowhere.py", "prepare: no nowhere.py"),
                (("runs", 0, "command"), "ls", "the command is none of"),
                (("runs", 0, "expected_quick"), None, "'expected_quick'"),
                (("runs", 0, "quick"), None, "no run has a quick size"),
                ((*figure, "kind"), "guess", "kind 'guess'"),
                ((*figure, "reference"), 99.0, "says of whom"),
                ((*figure, "of"), "the paper", "says of whom"),
                (("runs", 0, "calculix"), {"displacement": 1e-6},
                 "'calculix' is for quick sizes of 'run'"),
                (("runs", 0, "evolver"), 1e-10, "'evolver' is for"),
                ((*figure, "relative"), 0.006, "more room.*say 'why'"),
                ((*figure, "absolute"), 0.6, "more room.*say 'why'"),
                (figure, {"value": 1.0}, "no 'kind'"),
                ((*figure, "value"), None, "neither 'value'"),
                (figure, {"value": 1.0, "absolute": 0.1}, "say 'why'"),
                (figure, {"kind": "film"}, "neither 'value'"),
                (figure, 1.5, "a table is expected")):
            with self.subTest(told=told):
                spec = copy.deepcopy(GOOD)
                *keys, last = path
                table = spec
                for key in keys:
                    table = table[key]
                if new is None:
                    del table[last]
                else:
                    table[last] = new
                with self.assertRaisesRegex(cases.BadFormat, told):
                    self.read(spec)

    def test_figures_without_another_source_are_called_snapshots(self):
        for of, told in (({}, "snapshot"),
                         ({"reference": 101.0, "of": "the paper"},
                          "101, the paper")):
            run = copy.deepcopy(GOOD["runs"][0])
            run["expected"]["film.area"].update(of)
            outcome = cases.Outcome(run)
            outcome.rows = [cases.Row("film.area", run["expected"]["film.area"],
                                      100.1)]
            self.assertIn(f"| {told} |", "\n".join(gallery.run_table(outcome,
                                                                     [])))

    def test_the_stress_of_calculix_is_read_as_it_prints_it(self):
        """Jacobians of an element, the lines of a deck, the measure itself."""
        self.assertAlmostEqual(peers.von_mises([3.0, 0, 0, 0, 0, 0]), 3.0)
        self.assertAlmostEqual(peers.von_mises([0, 0, 0, 0, 1.0, 0]), 3 ** 0.5)
        corners = [[0, 0, 0], [1, 0, 0], [0, 1, 0], [0, 0, 2]]
        nodes = corners + [[(a + b) / 2 for a, b in
                            zip(corners[c], corners[d])]
                           for c, d in peers.EDGES]
        for point in peers.POINTS:
            self.assertAlmostEqual(peers.jacobian(nodes, point), 2.0)
        deck = ("*NODE, NSET=NALL\n1, 0., 0., 0.\n2, 1., 0., 0.\n"
                "*ELEMENT, TYPE=C3D10, ELSET=ALL\n7, 1, 2, 3, 4, 5, 6, 7, 8,\n"
                "9, 10\n*NSET, NSET=X\n1, 2\n")
        found, elements = peers.mesh_of(deck)
        self.assertEqual(found[2], [1.0, 0.0, 0.0])
        self.assertEqual(elements, {7: list(range(1, 11))})

    def test_figures_without_a_value_are_told(self):
        spec = copy.deepcopy(GOOD)
        spec["runs"][0]["expected"]["film.area"]["value"] = None
        with self.assertRaisesRegex(cases.BadFormat, "--fill"):
            self.read(spec)
        cases.read(self.folder, unfilled=True)
        self.assertEqual(json.loads(cases.text_of(spec)), spec)

    def test_later_runs_are_filled_from_earlier_ones_of_their_size(self):
        spec = copy.deepcopy(GOOD)
        spec["runs"][0]["expected"]["film.area"]["value"] = None
        spec["runs"][0]["expected_quick"]["film.area"]["value"] = None
        spec["runs"].append({
            "name": "both", "command": "compare {out}/film",
            "expected": {"film.area": {"value": None, "kind": "film"}}})
        (self.folder / "expected.json").write_text(json.dumps(spec))
        stub = self.folder / "stub.py"
        stub.write_text(
            f"#!{sys.executable}\n"
            "import json, pathlib, sys\n"
            "out = pathlib.Path(sys.argv[sys.argv.index('--out') + 1])\n"
            "out.mkdir(parents=True)\n"
            "area, name = 90 if '--set' in sys.argv else 100, 'film.json'\n"
            "if sys.argv[1] == 'compare':\n"
            "    earlier = pathlib.Path(sys.argv[2]) / name\n"
            "    area = json.loads(earlier.read_text())['film']['area']\n"
            "    name = 'compare.json'\n"
            "(out / name).write_text(json.dumps({'film': {'area': area}}))\n")
        stub.chmod(0o755)
        cases.fill(stub, self.folder, self.folder / "out")
        film, both = cases.read(self.folder)["runs"]
        self.assertEqual(film["expected"]["film.area"]["value"], 100)
        self.assertEqual(film["expected_quick"]["film.area"]["value"], 90)
        self.assertEqual(both["expected"]["film.area"]["value"], 100)

    def test_files_are_prepared(self):
        script = self.folder / "make.py"
        script.write_text(
            "import pathlib, sys\n"
            "(pathlib.Path(sys.argv[1]) / 'made').write_text(sys.argv[2])\n")
        out = self.folder / "out"
        cases.prepare("the program", self.folder, {"prepare": "make.py"}, out)
        self.assertEqual((out / "made").read_text(), "the program")
        script.write_text("raise SystemExit(1)\n")
        with self.assertRaises(subprocess.CalledProcessError):
            cases.prepare("", self.folder, {"prepare": "make.py"}, out)

    def test_folders_may_have_spaces(self):
        run = {"name": "r", "command": "run a.toml --set x={out}/s.stl",
               "quick": "--set 'y=1 mm'"}
        out = pathlib.Path("/a place")
        self.assertEqual(cases.arguments_of(run, out, True, False),
                         ["run", "a.toml", "--set", "x=/a place/s.stl",
                          "--set", "y=1 mm", "--out", "/a place/r", "--quiet",
                          "--no-pictures"])

    def row(self, figure, found):
        return cases.Row("x", figure, found).fine

    def test_figures_that_are_off_are_told(self):
        for kind, room in (("film", 0.005), ("displacement", 0.02),
                           ("stress", 0.05)):
            figure = {"value": -2.0, "kind": kind}
            self.assertTrue(self.row(figure, -2.0 * (1 + 0.99 * room)))
            self.assertFalse(self.row(figure, -2.0 * (1 + 1.01 * room)))
        for found in (None, "2", float("nan")):
            self.assertFalse(self.row({"value": 2.0, "kind": "film"}, found))
        self.assertTrue(self.row({"at_most": 3, "at_least": 1}, 2))
        self.assertFalse(self.row({"at_most": 3, "at_least": 1}, 4))
        self.assertFalse(self.row({"at_most": 3, "at_least": 1}, 0))
        self.assertTrue(self.row("stable", "stable"))
        self.assertFalse(self.row("stable", "unstable"))
        self.assertFalse(self.row(0, 1))
        self.assertFalse(self.row(0, None))

    def test_figures_are_found_by_path(self):
        result = {"a": {"b.c": 1}, "members": [{"name": "s60", "mass": 2}]}
        self.assertEqual(cases.find(result, "a.b.c"), 1)
        self.assertEqual(cases.find(result, "members.s60.mass"), 2)
        self.assertEqual(cases.find(result, "members.0.mass"), 2)
        self.assertIsNone(cases.find(result, "members.1.mass"))
        self.assertIsNone(cases.find(result, "a.b"))

    def test_orders_are_judged(self):
        item = {"path": "area", "runs": ["a", "b", "c"], "exact": 1.0,
                "order": 2, "absolute": 0.1}

        def rate(*values):
            outcomes = {}
            for name, value in zip(item["runs"], values):
                outcomes[name] = cases.Outcome({})
                outcomes[name].result = {"area": value}
            return cases.Rate(item, outcomes).problems()

        self.assertEqual(rate(1.16, 1.04, 1.01), [])
        self.assertEqual(len(rate(1.16, 1.04, 1.02)), 1)
        self.assertEqual(len(rate(1.0, 1.0, 1.0)), 1)


if __name__ == "__main__":
    unittest.main(verbosity=2)
