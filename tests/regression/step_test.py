#!/usr/bin/env python3
"""STEP files of the cases: true to the film, closed, and read by gmsh."""
import json
import os
import re
import shutil
import subprocess
import unittest

import program

MOST_GAP = 0.01  # mm
MOST_DEVIATION = 0.1  # of the film's edge
MOST_BREAK = 1.0  # degrees between faces of one film
MOST_VOLUME_ERROR = 1e-3
# Straight sides where the run has curved ones, edges of 20 mm.
MOST_FACETED = 0.05
NUMBER = r"([-+.\deE]+)"


def gmsh_volume(path):
    """Number of volumes in the file and the first one's, as gmsh reads them."""
    script = path.with_suffix(".geo")
    script.write_text(f"""SetFactory("OpenCASCADE");
v() = ShapeFromFile("{path}");
m() = Mass Volume{{v(0)}};
Printf("found %g of %.15g", #v(), m(0));
""")
    done = subprocess.run(["gmsh", script, "-", "-parse_and_exit"],
                          capture_output=True, text=True, timeout=120,
                          check=False)
    found = re.search(rf"found (\d+) of {NUMBER}", done.stdout + done.stderr)
    return (int(found.group(1)), float(found.group(2))) if found else (0, 0.0)


class Step(program.ProgramTest):
    def analysed(self, case, *settings):
        """The folder of a run of the case's initial design alone."""
        file = program.ROOT / "cases" / case / "case.toml"
        if case == "struts":
            file = program.ROOT / "tests" / "support" / "struts.toml"
        text = file.read_text()
        path = self.folder / f"{case}.toml"
        path.write_text(text[:text.index("[study]")] +
                        '[study]\nkind = "analyse"\n')
        out = self.folder / case
        self.expect(self.call("run", path, "--out", out, "--no-pictures",
                              "--quiet", *settings), 0)
        return out

    def export(self, run, *options, name="part.step"):
        file = self.folder / name
        done = self.expect(self.call("export", run, "--format", "step",
                                     "--out", file, *options), 0)
        return file, done.stdout + done.stderr

    def check(self, case, volume, faces, edge):
        run = self.analysed(case, "--set", f"resolution.fea={2 * edge}",
                            "--set", f"resolution.film={edge}")
        file, said = self.export(run)
        figures = [re.search(pattern, said) for pattern in (
            rf"(\d+) B-spline faces, (\d+) planes; valid closed solid of "
            rf"{NUMBER} mm3",
            rf"gap at edges {NUMBER} mm .*\({NUMBER} of its edge\)",
            rf"tangent breaks .* {NUMBER} degrees")]
        self.assertTrue(all(figures), said)
        self.assertEqual((int(figures[0][1]), int(figures[0][2])), faces)
        self.assertLess(float(figures[1][1]), MOST_GAP)
        self.assertLess(float(figures[1][2]), MOST_DEVIATION)
        self.assertLess(float(figures[2][1]), MOST_BREAK)
        self.assertLess(abs(float(figures[0][3]) / volume - 1.0),
                        MOST_VOLUME_ERROR)
        if not shutil.which("gmsh"):
            if os.environ.get("MENISCUS_NO_SKIPS"):
                self.fail("gmsh is not installed")
            self.skipTest("gmsh is not installed")
        count, found = gmsh_volume(file)
        self.assertEqual(count, 1)
        self.assertLess(abs(found / volume - 1.0), MOST_VOLUME_ERROR)
        return run, file

    def test_film_with_three_rims(self):
        run, file = self.check("two_arm", 1.7e6, (6, 3), 10)
        text = file.read_text()
        for name in ("skin", "support_pad", "left_pad", "right_pad"):
            self.assertIn(f"ADVANCED_FACE('{name}'", text)
        again, _ = self.export(run, name="again.step")
        self.assertEqual(file.read_bytes(), again.read_bytes())

        self.compare_with_itself(run, file)

    def compare_with_itself(self, run, file):
        """A run's own STEP file under its loads, named faces and all."""
        there = self.folder / "compared"
        self.expect(self.call("compare", run, file, "--out", there), 0)
        own, read = json.loads((there / "compare.json").read_text())["parts"]
        self.assertLess(abs(read["mass"] / own["mass"] - 1.0), MOST_FACETED)
        stiffness = [part["load_cases"]["service"]["stiffness"]
                     for part in (own, read)]
        self.assertLess(abs(stiffness[1] / stiffness[0] - 1.0), MOST_FACETED)

    def test_three_films_in_one_part(self):
        self.check("two_arm_sized", 8.2e5, (14, 3), 10)

    def test_strut_from_rounded_square_to_circle(self):
        volume = 70 * (38 ** 2 + 3.141592653589793 * 14 ** 2) / 2
        self.check("struts", volume, (4, 2), 5)

    def test_faceted_is_asked_for_by_name(self):
        run = self.analysed("struts", "--set", "resolution.fea=10",
                            "--set", "resolution.film=10")
        file = self.folder / "facets.step"
        self.expect(self.call("export", run, "--format", "step-faceted",
                              "--out", file), 0)
        self.assertGreater(file.read_text().count("ADVANCED_FACE"), 100)


if __name__ == "__main__":
    unittest.main()
