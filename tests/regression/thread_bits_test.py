#!/usr/bin/env python3
"""Films of many bodies, whose dense products are wide: the same bits for any
number of threads."""
import json
import pathlib
import unittest

from program import ProgramTest, without_seconds

CASES = pathlib.Path(__file__).resolve().parents[2] / "cases"


class ThreadBitsTest(ProgramTest):
    def test_films_of_the_femur(self):
        found = []
        for threads in ("1", "2", "3"):
            out = self.folder / f"out_{threads}"
            self.expect(self.call("evolve", CASES / "femur" / "case.toml",
                                  "--out", out, "--quiet", "--no-pictures",
                                  env={"OMP_NUM_THREADS": threads}), 0)
            film = json.loads((out / "film.json").read_text())
            found.append(((out / "film.vtp").read_bytes(),
                          json.dumps(without_seconds(film))))
        # Not assertEqual, which would look for what differs in megabytes.
        self.assertTrue(found[0] == found[1], "1 and 2 threads")
        self.assertTrue(found[0] == found[2], "1 and 3 threads")


if __name__ == "__main__":
    unittest.main()
