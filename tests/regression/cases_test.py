#!/usr/bin/env python3
"""Every case at its default size ends with the figures of its expected.json."""
import json
import unittest

import program
from program import ProgramTest


class Cases(ProgramTest):
    def check(self, folder):
        out = self.folder / "out"
        # Of a family one picture would do, and each costs seconds.
        family = "[study.members" in (folder / "case.toml").read_text()
        self.expect(self.call("run", folder / "case.toml", "--out", out,
                              *(["--no-pictures"] if family else []),
                              timeout=300), 0)
        result = self.result(out)
        for path, wanted in json.loads(
                (folder / "expected.json").read_text()).items():
            value = result
            for key in path.split("."):
                value = (next(v for v in value if v["name"] == key)
                         if isinstance(value, list) else value[key])
            if isinstance(wanted, str):
                self.assertEqual(value, wanted, path)
            else:
                room = wanted.get("absolute",
                                  abs(wanted["value"]) *
                                  wanted.get("relative", 0))
                self.assertLessEqual(abs(value - wanted["value"]), room,
                                     f"{path} is {value}")
        parts = [out / m["folder"] for m in result.get("members", [])] or [out]
        for part in parts:
            self.assertTrue(list(part.glob("part_*.stl")), part)
            for name in ("film.vtp", "part.vtu", "history.csv",
                         "study.sqlite", *(() if family else (
                             "part.png", "film.png", "overview.png"))):
                self.assertGreater((part / name).stat().st_size, 300, name)

    def test_all(self):
        folders = sorted(p.parent for p in
                         program.ROOT.glob("cases/*/expected.json"))
        self.assertGreater(len(folders), 0)
        for folder in folders:
            with self.subTest(case=folder.name):
                self.check(folder)


if __name__ == "__main__":
    unittest.main(verbosity=2)
