#!/usr/bin/env python3
"""Scans: rims proposed, and a femur's numbers found again in a noisy one."""
import math
import re
import sys
import tomllib
import unittest

import program
from program import ProgramTest

sys.dont_write_bytecode = True  # cases/ is for cases
sys.path.insert(0, str(program.ROOT / "cases" / "femur"))
import make_scan  # noqa: E402  (the folder is found only now)
from make_scan import FIT, NOISE, TRUE, noisy, read_stl, write_stl  # noqa: E402

COARSE = ["--set", "resolution.fea=8", "--set", "resolution.film=4"]


class Scans(ProgramTest):
    def film_of(self, name, numbers):
        """The fit's own case at other numbers, as an STL file."""
        case = self.folder / f"{name}.toml"
        case.write_text(make_scan.case_text())
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

    def rims_of(self, scan, *options):
        """Of the curves proposed: centre, mean radius, points; the turn falls
        from one to the next."""
        text = self.expect(self.call("curves", scan, *options), 0).stdout
        turns = [float(x) for x in re.findall(r"turns by (\d+) degrees", text)]
        self.assertEqual(turns, sorted(turns, reverse=True))
        centres = [[float(x) for x in item.split(",")]
                   for item in re.findall(r"# center \[([^]]*)\]", text)]
        radii = [float(x) for x in re.findall(r"mean radius ([\d.]+);", text)]
        rims = tomllib.loads(text)["curves"].values()
        self.assertEqual(len(rims), len(radii))
        return list(zip(centres, radii, [rim["points"] for rim in rims]))

    def assert_rim(self, rims, centre, radius, near):
        """One of them is there, within `near` mm, and is a closed curve."""
        for found, mean, points in rims:
            if math.dist(found, centre) < near and abs(mean - radius) < near:
                self.assertGreaterEqual(len(points), 6)
                return
        self.fail(f"no rim of {radius} mm about {centre} in {rims}")

    def test_curves_proposes_where_a_femur_is_cut_off(self):
        facets = self.film_of("true", {})
        scan = self.folder / "scan.stl"
        write_stl(scan, facets)
        rims = self.rims_of(scan, "--angle", "15")
        self.assert_rim(rims, [0, 0, -85], 15.5, 0.3)      # the shaft
        self.assert_rim(rims, [-21, -3, -14], 11.4, 0.3)   # the trochanter
        write_stl(scan, noisy(facets, 0.2))
        # 0.01 to 1.0 mm off, as the noise falls.
        self.assert_rim(self.rims_of(scan), [0, 0, -85], 15.5, 1.2)

    def test_curves_finds_the_waist_of_the_neck_in_a_noisy_scan(self):
        make_scan.main(self.folder, str(program.PROGRAM))
        rims = self.rims_of(self.folder / "scan.stl", "--angle", "15",
                            "--radius", "8")
        # 24 mm below the head's centre on the neck's axis.
        self.assert_rim(rims, [23.1, 5.3, -15.4], 14.5, 3.0)

    def test_wrong_scans_are_told(self):
        self.expect(self.call("curves", self.folder / "none.stl"), 2,
                    "none.stl")
        self.expect(self.call("curves", FIT), 2, "ends in .stl or .obj")
        self.expect(self.call("check", FIT), 2, "there is no file")


if __name__ == "__main__":
    unittest.main(verbosity=2)
