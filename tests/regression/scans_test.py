#!/usr/bin/env python3
"""Scans: rims proposed, and a femur's numbers found again in a noisy one."""
import random
import re
import struct
import unittest

import program
from program import ProgramTest

FIT = program.ROOT / "cases" / "femur" / "fit.toml"
TRUE = {"head_radius": 24.0, "head_offset": 41.0, "neck_shaft_degrees": 130.0,
        "version_degrees": 13.0, "shaft_width": 15.2, "volume": 67000.0}
NOISE = 0.5  # mm, standard deviation per coordinate
COARSE = ["--set", "resolution.fea=8", "--set", "resolution.film=4"]


def read_stl(path):
    """Corners of a binary STL's facets."""
    data = path.read_bytes()
    count = struct.unpack_from("<I", data, 80)[0]
    return [struct.unpack_from("<9f", data, 84 + 50 * k + 12)
            for k in range(count)]


def write_stl(path, facets):
    with open(path, "wb") as out:
        out.write(b"scan".ljust(80) + struct.pack("<I", len(facets)))
        for facet in facets:
            out.write(struct.pack("<12fH", 0, 0, 0, *facet, 0))


def noisy(facets, spread):
    """The same surface, each of its points moved at random."""
    chance = random.Random(5)
    moved = {}
    result = []
    for facet in facets:
        corners = []
        for k in range(0, 9, 3):
            corner = facet[k:k + 3]
            if corner not in moved:
                moved[corner] = [x + chance.gauss(0, spread) for x in corner]
            corners += moved[corner]
        result.append(corners)
    return result


class Scans(ProgramTest):
    def film_of(self, name, numbers):
        """The fit's own case at other numbers, as an STL file."""
        text = FIT.read_text()
        text = text[:text.index("[responses.off]")] + (
            '[responses.mass]\nkind = "mass"\n\n[study]\nkind = "analyse"\n')
        case = self.folder / f"{name}.toml"
        case.write_text(text)
        sets = [word for item in numbers.items()
                for word in ("--set", "%s=%r" % item)]
        out = self.folder / name
        self.expect(self.call("run", case, *COARSE, *sets, "--no-pictures",
                              "--no-report", "--out", out), 0)
        return read_stl(next(out.glob("part_*.stl")))

    def test_a_femurs_numbers_come_back_from_a_scan_with_noise(self):
        write_stl(self.folder / "scan.stl",
                  noisy(self.film_of("true", TRUE), NOISE))
        (self.folder / "fit.toml").write_text(FIT.read_text())
        out = self.folder / "fit"
        self.expect(self.call("run", self.folder / "fit.toml", *COARSE,
                              "--no-pictures", "--no-report", "--out", out,
                              timeout=900), 0, "converged")
        result = self.result(out)
        for name, value in TRUE.items():
            with self.subTest(parameter=name):
                # 1 % of the number; of angles of 1 radian.
                near = (0.57 if "degrees" in name else 0.01 * value)
                self.assertLess(abs(result["parameters"][name] - value), near)
        found = result["responses"]
        self.assertLess(found["off_mean"], found["off"])
        self.assertLess(found["off"], NOISE)
        self.assertLess(found["off_95"], 2.5 * NOISE)
        self.assertLess(found["off"], 0.4 * result["start"]["responses"]["off"])

    def test_curves_proposes_the_rims_of_a_tube(self):
        write_stl(self.folder / "scan.stl", noisy(self.film_of("true", {}), 0.1))
        done = self.expect(self.call("curves", self.folder / "scan.stl"), 0)
        rims = re.findall(r"\[curves\.rim_\d+\]", done.stdout)
        self.assertGreaterEqual(len(rims), 2)
        self.assertIn("points = [", done.stdout)

    def test_wrong_scans_are_told(self):
        self.expect(self.call("curves", self.folder / "none.stl"), 2,
                    "none.stl")
        self.expect(self.call("curves", FIT), 2, "ends in .stl or .obj")
        self.expect(self.call("check", FIT), 2, "there is no file")


if __name__ == "__main__":
    unittest.main(verbosity=2)
