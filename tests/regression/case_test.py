#!/usr/bin/env python3
"""One case at its quick size ends with the figures of its expected.json, and
the wrong cases made from it end with the messages told there."""
import json
import os
import re
import sys
import unittest

import program
from program import ProgramTest

sys.path.insert(0, str(program.ROOT / "scripts"))
import cases  # noqa: E402  (scripts/ is found only now)

NAME = os.environ["MENISCUS_CASE"]
# The case whose pictures are drawn, too: one will do, and each costs seconds.
PICTURED = "two_arm"
# Coordinates and forces have 13 digits in a deck; a clamp's peak feels most.
WRITTEN = 1e-7


def joins_nodes(deck):
    """Has the deck an equation between several nodes?"""
    for block in re.split(r"^\*EQUATION.*\n", deck, flags=re.M)[1:]:
        lines = block.split("*")[0].strip().splitlines()
        terms = re.split(r"[,\s]+", " ".join(lines[1:]).strip(" ,"))
        if len(set(terms[0::3])) > 1:
            return True
    return False


class Case(ProgramTest):
    def test_at_its_quick_size(self):
        folder = cases.CASES / NAME
        spec = cases.read(folder)
        outcomes, rates = cases.run_case(program.PROGRAM, folder, spec,
                                         self.folder, quick=True,
                                         pictures=NAME == PICTURED,
                                         more=program.MORE)
        for name, outcome in outcomes.items():
            with self.subTest(run=name):
                self.assertEqual(outcome.problems, [])
                if not outcome.run["command"].startswith("check-gradient"):
                    self.assertGreater(len(outcome.rows), 0)
                self.check_files(outcome)
        for rate in rates:
            with self.subTest(rate=rate.item["path"]):
                self.assertEqual(rate.problems(), [])

    def check_deck(self, part):
        """What `export --format inp` writes is solved to the run's figures."""
        result = json.loads((part / "result.json").read_text())
        if not result.get("stress") or "shell" in result:  # has no deck
            return
        self.expect(self.call("export", part, "--format", "inp", "--out",
                              "own.inp"), 0)
        deck = self.call("solve", "own.inp", "--out", "solved")
        if joins_nodes((self.folder / "own.inp").read_text()):
            # A rigid pin's equations are refused by line (docs/decks.md).
            self.expect(deck, 2, "own.inp:", "EQUATION between several nodes")
            return
        self.expect(deck, 0)
        solved = json.loads((self.folder / "solved/result.json").read_text())
        self.assertEqual(list(solved["stress"]), list(result["stress"]))
        pairs = [(solved["fea"]["strain_energy"],
                  result["fea"]["strain_energy"])]
        zones = "exclusion" in result  # whose peaks a deck does not leave out
        for name, stress in () if zones else result["stress"].items():
            pairs.append((solved["stress"][name]["readings"]["points"],
                          stress["readings"]["points"]))
        for found, expected in pairs:
            self.assertLess(abs(found / expected - 1.0), WRITTEN,
                            f"{part}: {found}, {expected}")

    def check_files(self, outcome):
        out = outcome.folder
        if outcome.run["command"].startswith("evolve"):
            self.assertGreater((out / "film.vtp").stat().st_size, 300)
        if not outcome.run["command"].startswith("run"):
            return
        members = outcome.result.get("members", [])
        for part in [out / m["folder"] for m in members] or [out]:
            self.assertTrue(list(part.glob("part_*.stl")), part)
            self.check_deck(part)
            for name in ("film.vtp", "part.vtu", "history.csv",
                         "study.sqlite"):
                self.assertGreater((part / name).stat().st_size, 100, name)
        if NAME == PICTURED:
            for name in ("part.png", "film.png", "overview.png"):
                self.assertGreater((out / name).stat().st_size, 10000, name)

    def test_wrong_cases_are_told(self):
        folder = cases.CASES / NAME
        for item in cases.read(folder).get("wrong", []):
            with self.subTest(what=item["what"]):
                self.assertEqual(
                    cases.run_wrong(program.PROGRAM, folder, item), "")


if __name__ == "__main__":
    unittest.main(verbosity=2)
