#!/usr/bin/env python3
"""Solids of STEP files as they are: volumes against OpenCASCADE's own, films
that grow from their edges, and what is refused. The files are made here."""
import math
import os
import re
import shutil
import subprocess
import unittest

from program import ProgramTest
from step_test import gmsh_volume, surface_kinds

# Ten-node elements with mid-sides on the exact faces: fourth order in the edge,
# here about a third of the radii.
MOST_OFF = 4e-4  # of OpenCASCADE's volume
MOST_FUSED = 1e-6  # of the volume that the writer has measured
MOST_FILM_OFF = 1e-3  # of a volume beside films of flat facets

CASE = """title = "Solid"
units = "mm-N-MPa"

[solids.plate]
kind = "step"
file = "part.step"
{keys}
{films}
[bodies.part]
enclosed_by = [{surfaces}]
material = "steel"
{volume}
[materials.steel]
youngs_modulus = "210 GPa"
poisson_ratio = 0.3
density = "7850 kg/m3"

[load_cases.pull]
supports = [{{ on = "plate/face_1", fix = "xyz" }}]
loads = [{{ gravity = [0, 0, -9810] }}]

[responses.volume]
kind = "volume"

[resolution]
fea = {fea}

[study]
kind = "analyse"
"""

PLATE = """Box(1) = {0, 0, 0, 40, 30, 6};
Cylinder(2) = {20, 15, 5, 0, 0, 13, 9};
BooleanUnion(3) = { Volume{1}; Delete; }{ Volume{2}; Delete; };
Cylinder(4) = {20, 15, -1, 0, 0, 30, 4};
BooleanDifference(5) = { Volume{3}; Delete; }{ Volume{4}; Delete; };
"""
PARTS = {
    "plate": (PLATE, 3.0),
    "cone with a ball's hollow": ("""Cone(1) = {1, 2, 3, 4, 5, 20, 12, 7};
Sphere(2) = {1, 2, 3, 6};
BooleanDifference(3) = { Volume{1}; Delete; }{ Volume{2}; Delete; };
""", 2.5),
    "drilled with a cone's tip": ("""Box(1) = {-10, -10, 0, 20, 20, 20};
Cone(2) = {0, 0, 8, 0, 0, 4, 0, 4};
Cylinder(3) = {0, 0, 12, 0, 0, 9, 4};
BooleanDifference(4) = { Volume{1}; Delete; }{ Volume{2, 3}; Delete; };
""", 2.5),
    "rounded": ("""Box(1) = {0, 0, 0, 20, 16, 12};
Fillet{1}{1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12}{3}
""", 2.0),
    "ring": ("""Torus(1) = {0, 0, 0, 10, 3, 2 * Pi};
""", 1.5),
    "cut across": ("""Cylinder(1) = {0, 0, 0, 0, 0, 30, 10};
Cylinder(2) = {-20, 2, 15, 40, 0, 0, 5};
BooleanDifference(3) = { Volume{1}; Delete; }{ Volume{2}; Delete; };
""", 2.5),
    "loft of splines": ("""Circle(1) = {0, 0, 0, 8};
Ellipse(2) = {0, 0, 20, 12, 6};
Circle(3) = {2, 0, 30, 5};
Curve Loop(1) = {1}; Curve Loop(2) = {2}; Curve Loop(3) = {3};
ThruSections(1) = {1, 2, 3};
""", 2.5),
}


class StepSolids(ProgramTest):
    def setUp(self):
        super().setUp()
        if not shutil.which("gmsh"):
            if os.environ.get("MENISCUS_NO_SKIPS"):
                self.fail("gmsh is not installed")
            self.skipTest("gmsh is not installed")

    def make(self, script):
        """part.step, and its volume as OpenCASCADE has it."""
        geo = self.folder / "make.geo"
        part = self.folder / "part.step"
        geo.write_text(f'SetFactory("OpenCASCADE");\n{script}\n'
                       f'Save "{part}";\n')
        subprocess.run(["gmsh", geo, "-", "-parse_and_exit"],
                       capture_output=True, timeout=120, check=True)
        count, volume = gmsh_volume(part)
        self.assertEqual(count, 1)
        return volume

    def write(self, keys="", films="", surfaces='"plate"', volume="", fea=3.0):
        case = self.folder / "case.toml"
        case.write_text(CASE.format(keys=keys, films=films, surfaces=surfaces,
                                    volume=volume, fea=fea))
        return case

    def volume_of(self, case):
        out = self.folder / "out"
        self.expect(self.call("run", case, "--out", out, "--no-pictures",
                              "--no-report", "--quiet"), 0)
        return self.result(out)["responses"]["volume"]

    def edge_at(self, kind, length, *place):
        """Its number, as check tells it."""
        said = self.call("check", self.write("rims = [999]")).stderr
        for found in re.finditer(
                r"(\d+): (\w+) of length ([\d.e+]+) about "
                r"\(([^,]+), ([^,]+), ([^)]+)\)", said):
            number, its, long, *at = found.groups()
            if its == kind and abs(float(long) - length) < 0.01 and all(
                    abs(float(a) - b) < 0.01 for a, b in zip(at, place)):
                return int(number)
        self.fail(said)
        return 0

    def face_at(self, kind, *place):
        said = self.call("check", self.write("open = [999]")).stderr
        for found in re.finditer(
                r"(face_\d+): (\w+) about \(([^,]+), ([^,]+), ([^)]+)\)", said):
            name, its, *at = found.groups()
            if its == kind and all(
                    abs(float(a) - b) < 0.01 for a, b in zip(at, place)):
                return name
        self.fail(said)
        return ""

    def test_volumes_are_those_of_the_faces(self):
        for name, (script, fea) in PARTS.items():
            with self.subTest(name):
                volume = self.make(script)
                found = self.volume_of(self.write(fea=fea))
                self.assertLess(abs(found / volume - 1.0), MOST_OFF)

    def test_film_grows_from_an_edge(self):
        own = self.make("""Box(1) = {-20, -15, 0, 40, 30, 6};
Cylinder(2) = {0, 0, 5, 0, 0, 6, 9};
BooleanUnion(3) = { Volume{1}; Delete; }{ Volume{2}; Delete; };
""")
        edge = self.edge_at("circle", 18 * math.pi, 0, 0, 11)
        top = self.face_at("plane", 0, 0, 11)
        film = 2.0 * math.pi * 9 ** 2 * 10
        case = self.write(
            f'rims = [{edge}]\nopen = ["{top}"]', f"""
[curves.head]
kind = "circle"
center = [0, 0, 31]
normal = [0, 0, 1]
radius = 9

[films.skin]
kind = "loft"
curves = ["plate/edge_{edge}", "head"]

[solids.cap]
kind = "cap"
curve = "head"
""", '"plate", "skin", "cap"', f"volume = {own + film:.17g}", 2.0)
        self.assertLess(abs(self.volume_of(case) / (own + film) - 1.0),
                        MOST_FILM_OFF)
        # His faces as they were, but the one that the film covers.
        file = self.folder / "fused.step"
        said = self.expect(self.call("export", self.folder / "out", "--format",
                                     "step", "--out", file), 0)
        before = surface_kinds(self.folder / "part.step")
        count, fused = gmsh_volume(file)
        self.assertEqual(count, 1)
        self.assertLess(abs(fused / (own + film) - 1.0), MOST_FILM_OFF)
        found = re.search(r"valid closed solid of ([-+.\deE]+)",
                          said.stdout + said.stderr)
        self.assertLess(abs(fused / float(found.group(1)) - 1.0), MOST_FUSED)
        kinds = surface_kinds(file)
        self.assertGreaterEqual(kinds["Cylinder"], before["Cylinder"])
        self.assertEqual(kinds["Plane"], before["Plane"])

    def test_gradient_by_a_motion(self):
        """Film and load between a plate that stands and one that moves."""
        self.make("Cylinder(1) = {0, 0, 0, 0, 0, 6, 12};")
        edge = self.edge_at("circle", 24 * math.pi, 0, 0, 6)
        top = self.face_at("plane", 0, 0, 6)
        case = self.write(f'rims = [{edge}]\nopen = ["{top}"]', f"""
[design.up]
initial = 30
bounds = [27, 33]

[design.tilt]
initial = 0.1
bounds = [0.0, 0.2]

[solids.moved]
kind = "step"
file = "part.step"
rims = [{edge}]
open = ["{top}"]
rotate = "pi + tilt"
axis = [0, 1, 0]
about = [0, 0, 6]
move = ["up / 20", 1, "up"]

[films.skin]
kind = "loft"
curves = ["plate/edge_{edge}", "moved/edge_{edge}"]

[responses.lift]
kind = "mean_displacement"
on = "moved/face_1"
direction = [0, 0.3, 1]
""", '"plate", "skin", "moved"', "volume = 12000", 5.0)
        self.expect(self.call("check-gradient", case), 0)

    def refuse(self, case, pattern, *says):
        line = self.line_of(case, pattern)
        self.expect(self.call("check", case), 2, f"case.toml:{line}: ", *says)

    def test_what_is_refused(self):
        self.make(PLATE)
        self.refuse(self.write("rims = [999]"), "^rims",
                    "no edge '999'.*circle of length")
        self.refuse(self.write("open = [999]"), "^open",
                    "no face '999'.*plane about")
        straight = self.edge_at("line", 6, 0, 0, 3)
        self.refuse(self.write(f"rims = [{straight}]"), "^rims",
                    "do not close")
        self.refuse(self.write('open = ["face_2"]'), "^enclosed_by",
                    "not closed")

    def test_two_solids_in_one_file(self):
        geo = self.folder / "make.geo"
        geo.write_text('SetFactory("OpenCASCADE");\n'
                       "Box(1) = {0, 0, 0, 1, 1, 1};\n"
                       "Box(2) = {3, 0, 0, 1, 1, 1};\n"
                       f'Save "{self.folder / "part.step"}";\n')
        subprocess.run(["gmsh", geo, "-", "-parse_and_exit"],
                       capture_output=True, timeout=120, check=True)
        self.refuse(self.write(), "^file", "2 solids")

    def test_faces_without_a_solid(self):
        geo = self.folder / "make.geo"
        geo.write_text('SetFactory("OpenCASCADE");\n'
                       "Rectangle(1) = {0, 0, 0, 4, 5};\n"
                       f'Save "{self.folder / "part.step"}";\n')
        subprocess.run(["gmsh", geo, "-", "-parse_and_exit"],
                       capture_output=True, timeout=120, check=True)
        self.refuse(self.write(), "^file", "0 solids")


if __name__ == "__main__":
    unittest.main()
