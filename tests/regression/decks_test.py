#!/usr/bin/env python3
"""`meniscus solve` and decks in `meniscus compare`, as a user meets them."""
import json
import unittest

from program import COARSE, ROOT, CASE, ProgramTest

DECK = (ROOT / "tests/fuzz/corpus/deck/steps.inp").read_text()
# Numbers have 13 digits in a deck.
WRITTEN = 1e-7


class Decks(ProgramTest):
    def write(self, text, name="part.inp"):
        (self.folder / name).write_text(text)
        return name

    def test_all_steps_are_solved_and_told(self):
        said = self.expect(self.call("solve", self.write(DECK)), 0).stdout
        for pattern in ("two tetrahedra: 5 nodes, 2 C3D4",
                        "all in the deck's own units", "step 'pull', static",
                        "step 'turn', static", "step 'step_3', buckle",
                        "natural frequencies", r"not needed: \*NODE FILE "
                        r"\(part.inp:39\)", "written to results/part"):
            self.assertRegex(said, pattern)
        out = self.folder / "results" / "part"
        result = json.loads((out / "result.json").read_text())
        self.assertIsNone(result["units"])
        self.assertEqual([s["procedure"] for s in result["steps"]],
                         ["static", "static", "buckle", "frequency"])
        for name in ("part.vtu", "part_surface.vtp", "part.frd"):
            self.assertGreater((out / name).stat().st_size, 300)
        self.assertFalse(list(out.glob(".*")))

    def test_units_that_are_named_are_shown(self):
        name = self.write(DECK)
        said = self.expect(self.call("solve", name, "--units", "mm-N-MPa",
                                     "--out", "out"), 0).stdout
        self.assertRegex(said, r"mass .* kg")
        self.assertRegex(said, r"von Mises .* MPa at")
        self.expect(self.call("solve", name, "--units", "cm"), 2, "cm")

    def test_the_same_bits_for_any_number_of_threads(self):
        name = self.write(DECK)
        texts = []
        for threads in ("1", "2"):
            self.expect(self.call("solve", name, "--out", threads, "--quiet",
                                  env={"OMP_NUM_THREADS": threads}), 0)
            texts.append((self.folder / threads / "part.frd").read_bytes())
        self.assertEqual(*texts)

    def test_wrong_decks_leave_nothing(self):
        for old, new, line, says in (
                ("*NODE FILE", "*CONTACT PAIR", 39, "common nodes"),
                ("FOOT, 1, 3", "FOOT, 1, 3, 0.1", 28, "before the first"),
                ("5, 3, 1.\n", "5, 3, x\n", 35, "no finite number"),
                ("0.3\n", "0.5\n", 19, "Poisson")):
            name = self.write(DECK.replace(old, new, 1))
            self.expect(self.call("solve", name, "--out", "out"), 2,
                        rf"part\.inp:{line}: ", says)
            self.assertFalse((self.folder / "out" / "result.json").exists())
        self.expect(self.call("solve", "nowhere.inp"), 2, "nowhere.inp")

    def test_a_conventional_part_beside_a_run(self):
        self.expect(self.call("run", CASE, "--out", "run", "--no-pictures",
                              "--no-frames", "--no-report", *COARSE), 0)
        self.expect(self.call("export", "run", "--format", "inp", "--out",
                              "own.inp"), 0)
        self.expect(self.call("compare", "run", "own.inp", "--out", "out"), 0)
        self.expect(self.call("solve", "own.inp", "--out", "run"), 2,
                    "holds a run")
        run, own = json.loads(
            (self.folder / "out/compare.json").read_text())["parts"]
        self.assertEqual(list(run["load_cases"]), list(own["load_cases"]))
        self.assertLess(abs(own["mass"] / run["mass"] - 1.0), WRITTEN)
        for name, figures in run["load_cases"].items():
            for key in ("work", "max_von_mises"):
                self.assertLess(
                    abs(own["load_cases"][name][key] / figures[key] - 1.0),
                    WRITTEN, f"{name} {key}")
        self.assertTrue((self.folder / "out/part_2.vtp").exists())
        self.expect(self.call("compare", "own.inp", "run"), 2, "must be a run")
        self.expect(self.call("compare", "run", self.write(
            DECK.replace("10.", "1."), "small.inp"),
                              "--out", "out"), 2, "across")


if __name__ == "__main__":
    unittest.main(verbosity=2)
