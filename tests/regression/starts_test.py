#!/usr/bin/env python3
"""Films are found whatever the edge length: coarse facets may fold on their way,
and more easily on one processor than on another."""
import json
import unittest

import program

# Edges [mm] whose coarse start folds, somewhere at least, beside ones that do
# not; and the film's area [mm2], which is within 2 % for all of them.
STRUT = (11.5, 12, 12.5, 13, 13.5)
SIZED = (19, 21, 21.5, 22, 23, 24)
MOST_SPREAD = 0.02


class Starts(program.ProgramTest):
    def areas(self, name, edges):
        case = program.ROOT / "cases" / name / "case.toml"
        for edge in edges:
            out = self.folder / f"{name}_{edge}"
            self.expect(self.call(
                "evolve", case, "--set", f"resolution.fea={edge}", "--set",
                f"resolution.film={edge / 2}", "--no-pictures", "--out", out),
                0)
            film = json.loads((out / "film.json").read_text())
            self.assertEqual(film["index"], 0, edge)
            yield film["area"]

    def test_strut(self):
        areas = list(self.areas("strut_family", STRUT))
        self.assertLess(max(areas) / min(areas) - 1, MOST_SPREAD, areas)

    def test_arms(self):
        areas = list(self.areas("two_arm_sized", SIZED))
        self.assertLess(max(areas) / min(areas) - 1, MOST_SPREAD, areas)


if __name__ == "__main__":
    unittest.main(verbosity=2)
