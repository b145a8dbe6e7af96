#!/usr/bin/env python3
"""Every case at its default size ends with the figures of its expected.json."""
import json
import unittest

import program
from program import ProgramTest


class Cases(ProgramTest):
    def check(self, folder):
        out = self.folder / "out"
        self.expect(self.call("run", folder / "case.toml", "--out", out,
                              timeout=300), 0)
        result = self.result(out)
        for path, wanted in json.loads(
                (folder / "expected.json").read_text()).items():
            value = result
            for key in path.split("."):
                value = value[key]
            if isinstance(wanted, str):
                self.assertEqual(value, wanted, path)
            else:
                room = wanted.get("absolute",
                                  abs(wanted["value"]) *
                                  wanted.get("relative", 0))
                self.assertLessEqual(abs(value - wanted["value"]), room,
                                     f"{path} is {value}")
        for name in ("film.vtp", "part.vtu", "history.csv", "study.sqlite",
                     "part.png", "film.png", "overview.png"):
            self.assertGreater((out / name).stat().st_size, 300, name)
        self.assertTrue(list(out.glob("part_*.stl")))

    def test_all(self):
        folders = sorted(p.parent for p in
                         program.ROOT.glob("cases/*/expected.json"))
        self.assertGreater(len(folders), 0)
        for folder in folders:
            with self.subTest(case=folder.name):
                self.check(folder)


if __name__ == "__main__":
    unittest.main(verbosity=2)
