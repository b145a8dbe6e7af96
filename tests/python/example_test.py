#!/usr/bin/env python3
"""The SciPy example finds what the program finds."""
import contextlib
import io
import json
import runpy
import unittest

import meniscus
from support import CASE, ROOT, PackageTest

# Both matches end below 1e-9 of the deflections, which change by 10 % a mm.
FOOT = 1e-6  # [mm]
# Two SLSQPs, each to a first-order residual below 1e-4 of the mass; it is flat
# there, so that variables differ by the root.
MASS = 1e-6
SIZES = 1e-3


class Example(PackageTest):
    def test_scipy_and_the_program_agree(self):
        said = io.StringIO()
        with contextlib.redirect_stdout(said):
            found = runpy.run_path(
                str(ROOT / "python" / "examples" / "two_arm_scipy.py"))
        self.assertIn("lightest", said.getvalue())
        out = self.folder()
        self.run_program("run", CASE, "--set", "resolution.fea=20", "--set",
                         "resolution.film=10", "--set", "study.tolerance=1e-9",
                         "--no-pictures", "--out", out / "bracket")
        result = json.loads((out / "bracket" / "result.json").read_text())
        # Both on the mesh of the initial design, which SciPy stays on.
        same_mesh = result["refrozen"][0]["parameters"]["support_x"]
        self.assertLess(abs(found["foot"] - same_mesh), FOOT)
        (out / "case.toml").write_text(meniscus.case_text(found["tree"]))
        self.run_program("run", out / "case.toml", "--no-pictures", "--out",
                         out / "strut")
        result = json.loads((out / "strut" / "result.json").read_text())
        best = found["best"]
        before = result["refrozen"][0]
        self.assertLess(
            abs(best["mass"] / before["responses"]["mass"] - 1), MASS)
        for variable, size in zip(found["strut"].design, best.design):
            theirs = before["parameters"][variable.name]
            self.assertLess(abs(size / theirs - 1), SIZES, variable.name)
        self.assertLess(best["deflection"], 0.1 * (1 + MASS))


if __name__ == "__main__":
    unittest.main(verbosity=2)
