#!/usr/bin/env python3
"""Solids of STEP files as they are: volumes and faces against OpenCASCADE's own,
films that grow from their edges, and what is refused. The files are made here."""
import ctypes
import math
import os
import re
import shutil
import subprocess
import unittest

from export_test import Array, Gmsh
from program import ProgramTest
from step_test import gmsh_volume

# Ten-node elements with mid-sides on the exact faces: fourth order in the edge,
# here about a third of the radii.
MOST_OFF = 4e-4
SAME = 1e-9  # areas and volumes of the same faces, as OpenCASCADE sums them
SAME_WALL = 1e-7  # of files of twelve digits
MOST_FILM_OFF = 2e-3  # of a volume beside films of flat facets

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

# Planes, cylinders, a cone, a sphere, a torus.
PLATE = """Box(1) = {0, 0, 0, 40, 30, 8};
Cylinder(2) = {20, 15, 5, 0, 0, 15, 9};
BooleanUnion(3) = { Volume{1}; Delete; }{ Volume{2}; Delete; };
foot() = Curve In BoundingBox {10.9, 5.9, 7.9, 29.1, 24.1, 8.1};
round() = Fillet{3}{foot()}{2};
Cone(4) = {20, 15, 4, 0, 0, 2, 0, 4};
Cylinder(5) = {20, 15, 6, 0, 0, 20, 4};
Sphere(6) = {0, 0, 10, 6};
BooleanDifference(7) = { Volume{round()}; Delete; }{ Volume{4, 5, 6}; Delete; };
"""
LOFT = """Circle(1) = {0, 0, 0, 8};
Ellipse(2) = {0, 0, 20, 12, 6};
Circle(3) = {2, 0, 30, 5};
Curve Loop(1) = {1}; Curve Loop(2) = {2}; Curve Loop(3) = {3};
ThruSections(1) = {1, 2, 3};
"""
BOSS = """Box(1) = {-20, -15, 0, 40, 30, 6};
Cylinder(2) = {0, 0, 5, 0, 0, 6, 9};
BooleanUnion(3) = { Volume{1}; Delete; }{ Volume{2}; Delete; };
"""
# A drop on a wall near the origin, which it wets on the side of +z.
DROP = """title = "Drop"
units = "mm-N-MPa"

[curves.rim]
kind = "circle"
center = [0, 0, {height}]
normal = [0, 0, 1]
radius = 6

[films.dome]
kind = "disk"
curves = ["rim"]

[solids.sole]
kind = "wetted"
curve = "rim"
{wall}
contact_angle = "80 deg"

[bodies.part]
enclosed_by = ["dome", "sole"]
volume = 260
material = "steel"

[materials.steel]
youngs_modulus = "210 GPa"
poisson_ratio = 0.3
density = "7850 kg/m3"

[load_cases.pull]
supports = [{{ on = "sole", fix = "xyz" }}]
loads = [{{ on = "dome", pressure = 1 }}]

[responses.volume]
kind = "volume"

[resolution]
fea = 4

[study]
kind = "analyse"
"""
# The solid, the place of its face, its wall by numbers, height of the rim.
WALLS = {
    "plane": ("Box(1) = {-20, -20, -9, 40, 40, 9};", (0, 0, 0),
              'at = [0, 0, 0]\nnormal = [0, 0, 1]', 0),
    "cylinder": ("Cylinder(1) = {-30, 0, -20, 60, 0, 0, 20};", None,
                 'wall = "cylinder"\nat = [0, 0, -20]\naxis = [1, 0, 0]\n'
                 "radius = 20", 0),
    "sphere": ("Sphere(1) = {0, 0, -20, 20};", None,
               'wall = "sphere"\nat = [0, 0, -20]\nradius = 20', -0.9212),
    # A funnel, which gmsh draws from its point or from its mouth.
    "cone": ("Box(1) = {-20, -20, -12, 40, 40, 20}; "
             "Cone(2) = {0, 0, -7.15, 0, 0, 16, 0, 13.4}; "
             "BooleanDifference(3) = { Volume{1}; Delete; }"
             "{ Volume{2}; Delete; };", None,
             'wall = "cone"\nat = [0, 0, -7.15]\naxis = [0, 0, 1]\n'
             'half_angle = "atan(13.4 / 16)"', 0),
    "cone ": ("Box(1) = {-20, -20, -12, 40, 40, 20}; "
              "Cone(2) = {0, 0, 8.85, 0, 0, -14.4, 13.4, 1.34}; "
              "BooleanDifference(3) = { Volume{1}; Delete; }"
              "{ Volume{2}; Delete; };", None,
              'wall = "cone"\nat = [0, 0, -7.15]\naxis = [0, 0, 1]\n'
              'half_angle = "atan(13.4 / 16)"', 0),
}


def faces_of(path):
    """Kind and area of each face, as gmsh finds them."""
    gmsh = Gmsh(path)
    try:
        tags = Array(ctypes.c_int)
        gmsh.call("ModelGetEntities", *tags.out(), 2)
        faces = []
        for tag in tags.values()[1::2]:
            kind = ctypes.c_char_p()
            gmsh.call("ModelGetType", 2, tag, ctypes.byref(kind))
            area = ctypes.c_double()
            gmsh.call("ModelOccGetMass", 2, tag, ctypes.byref(area))
            faces.append((kind.value.decode(), area.value))
        return sorted(faces)
    finally:
        gmsh.close()


class StepSolids(ProgramTest):
    def setUp(self):
        super().setUp()
        self.said = ""
        if not shutil.which("gmsh"):
            if os.environ.get("MENISCUS_NO_SKIPS"):
                self.fail("gmsh is not installed")
            self.skipTest("gmsh is not installed")

    def draw(self, script):
        geo = self.folder / "make.geo"
        part = self.folder / "part.step"
        geo.write_text(f'SetFactory("OpenCASCADE");\n{script}\n'
                       f'Save "{part}";\n')
        subprocess.run(["gmsh", geo, "-", "-parse_and_exit"],
                       capture_output=True, timeout=120, check=True)
        return part

    def make(self, script):
        """part.step, and its volume as OpenCASCADE has it."""
        count, volume = gmsh_volume(self.draw(script))
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

    def fused(self):
        """The STEP of the run, and its volume."""
        file = self.folder / "fused.step"
        self.expect(self.call("export", self.folder / "out", "--format",
                              "step", "--out", file), 0, "STEP solids; valid")
        count, volume = gmsh_volume(file)
        self.assertEqual(count, 1)
        return file, volume

    def expect_same(self, before, after):
        self.assertEqual([kind for kind, _ in before],
                         [kind for kind, _ in after])
        for (_, was), (_, area) in zip(before, after):
            self.assertLess(abs(area / was - 1.0), SAME)

    def look(self):
        """What check tells of the edges and faces that there are."""
        case = self.write("rims = [999]\nopen = [999]\nradius = 3")
        self.said = self.call("check", case).stderr

    def edge_at(self, kind, length, *place):
        """Its number."""
        for found in re.finditer(
                r"(\d+): (\w+) of length ([\d.e+]+) about "
                r"\(([^,]+), ([^,]+), ([^)]+)\)", self.said):
            number, its, long, *at = found.groups()
            if its == kind and abs(float(long) - length) < 0.01 and all(
                    abs(float(a) - b) < 0.01 for a, b in zip(at, place)):
                return int(number)
        self.fail(self.said)
        return 0

    def face_at(self, kind, *place):
        for found in re.finditer(
                r"(face_\d+): (\w+) about \(([^,]+), ([^,]+), ([^)]+)\)",
                self.said):
            name, its, *at = found.groups()
            if its == kind and all(
                    abs(float(a) - b) < 0.01 for a, b in zip(at, place)):
                return name
        self.fail(self.said)
        return ""

    def test_faces_and_volumes_are_his(self):
        for script in (PLATE, LOFT):
            volume = self.make(script)
            found = self.volume_of(self.write())
            self.assertLess(abs(found / volume - 1.0), MOST_OFF)
            file, exact = self.fused()
            self.assertLess(abs(exact / volume - 1.0), SAME)
            self.expect_same(faces_of(self.folder / "part.step"),
                             faces_of(file))

    def test_pull_is_uniform(self):
        """A bar held on three of its planes: a stress of 10 all over it."""
        volume = self.make("Box(1) = {1, 2, 3, 10, 8, 30};")
        self.look()
        foot = self.face_at("plane", 6, 6, 3)
        back = self.face_at("plane", 1, 6, 18)
        left = self.face_at("plane", 6, 2, 18)
        head = self.face_at("plane", 6, 6, 33)
        text = self.write(fea=6.0).read_text()
        text = re.sub(r"supports.*\nloads.*", f"""supports = [
  {{ on = "plate/{foot}", fix = "z" }}, {{ on = "plate/{back}", fix = "x" }},
  {{ on = "plate/{left}", fix = "y" }}]
loads = [{{ on = "plate/{head}", pressure = -10 }}]

[responses.longer]
kind = "mean_displacement"
on = "plate/{head}"
direction = [0, 0, 1]""", text)
        case = self.folder / "case.toml"
        case.write_text(text)
        self.assertLess(abs(self.volume_of(case) / volume - 1.0), SAME)
        found = self.result(self.folder / "out")["responses"]["longer"]
        self.assertLess(abs(found / (10.0 * 30.0 / 210e3) - 1.0), SAME)

    def test_film_grows_from_an_edge(self):
        own = self.make(BOSS)
        self.look()
        edge = self.edge_at("circle", 18 * math.pi, 0, 0, 11)
        top = self.face_at("plane", 0, 0, 11)
        film = 20.0 * math.pi * 9 ** 2
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
""", '"plate", "skin", "cap"', f"volume = {own + film:.17g}")
        self.assertLess(abs(self.volume_of(case) / (own + film) - 1.0),
                        MOST_FILM_OFF)
        # The film is a cylinder here; its cap is as large as the face that it
        # covers.
        file, fused = self.fused()
        self.assertLess(abs(fused / (own + film) - 1.0), SAME)
        before = faces_of(self.folder / "part.step")
        before.append(("Cylinder", 360.0 * math.pi))
        self.expect_same(sorted(before), faces_of(file))
        # Its faces have names now, for another case.
        os.replace(file, self.folder / "part.step")
        named = self.write(volume="").read_text().replace(
            "plate/face_1", "plate/cap").replace("-9810]", '-9810]'
            ' }, { on = "plate/skin", pressure = 0.1')
        (self.folder / "named.toml").write_text(named)
        self.expect(self.call("check", self.folder / "named.toml"), 0)

    def test_motion(self):
        """Film and load between a plate that stands and one that moves."""
        self.make("Cylinder(1) = {0, 0, 0, 0, 0, 7, 12};")
        self.look()
        edge = self.edge_at("circle", 24 * math.pi, 0, 0, 7)
        top = self.face_at("plane", 0, 0, 7)
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
about = [0, 0, 7]
move = ["up / 20", 1, "up"]

[films.skin]
kind = "loft"
curves = ["plate/edge_{edge}", "moved/edge_{edge}"]

[responses.lift]
kind = "mean_displacement"
on = "moved/face_1"
direction = [0, 0.3, 1]
""", '"plate", "skin", "moved"', "volume = 13000", 5.0)
        self.expect(self.call("check-gradient", case), 0)
        self.volume_of(case)
        file, _ = self.fused()
        found = [face for face in faces_of(file)
                 if face[0] != "BSpline surface"]
        self.expect_same(2 * [("Cylinder", 168.0 * math.pi)] +
                         2 * [("Plane", 144.0 * math.pi)], found)

    def drop_on(self, wall, height):
        case = self.folder / "drop.toml"
        case.write_text(DROP.format(wall=wall, height=height))
        self.expect(self.call("run", case, "--out", self.folder / "drop",
                              "--no-pictures", "--no-report", "--no-frames",
                              "--quiet"), 0)
        found = self.result(self.folder / "drop")
        return found["film"]["energy"], found["responses"]["volume"]

    def test_films_slide_on_its_faces(self):
        """As on the same walls by numbers."""
        for kind, (script, place, numbers, height) in WALLS.items():
            with self.subTest(kind=kind):
                self.draw(script)
                of_file = 'wall = "step"\nfile = "part.step"\nface = "{}"'
                case = self.folder / "drop.toml"
                case.write_text(DROP.format(wall=of_file.format("none"),
                                            height=height))
                self.said = self.call("check", case).stderr
                self.assertRegex(self.said, "drop.toml:19: .*no face 'none'")
                face = self.face_at(kind.strip(), *(place or ()))
                for own, other in zip(
                        self.drop_on(of_file.format(face), height),
                        self.drop_on(numbers, height)):
                    self.assertAlmostEqual(own / other, 1, delta=SAME_WALL)

    def test_faces_that_no_film_slides_on(self):
        self.make(PLATE)
        for face, says in (("face_99", "no face 'face_99'"), ("", "no face")):
            case = self.folder / "drop.toml"
            case.write_text(DROP.format(
                wall='wall = "step"\nfile = "part.step"\n'
                     f'face = "{face}"', height=0))
            self.expect(self.call("check", case), 2, "drop.toml:19: ", says)
        self.said = self.call("check", case).stderr
        torus = self.face_at("torus")
        case.write_text(case.read_text().replace('face = ""',
                                                 f'face = "{torus}"'))
        self.expect(self.call("check", case), 2, "drop.toml:19: ",
                    "this is .*torus about")
        case.write_text(case.read_text().replace('wall = "step"',
                                                 'wall = "cylinder"'))
        self.expect(self.call("check", case), 2,
                    "file is of other walls than a cylinder",
                    "has no 'at'; its wall is a cylinder, which needs at")

    def refuse(self, case, pattern, *says):
        line = self.line_of(case, pattern)
        self.expect(self.call("check", case), 2, f"case.toml:{line}: ", *says)

    def test_what_is_refused(self):
        self.make(BOSS)
        self.look()
        lines = self.said.splitlines()
        self.assertRegex(lines[0], r"case.toml:7: .*no edge '999'.*circle of")
        self.assertRegex(lines[1], r"case.toml:8: .*no face '999'.*plane about")
        self.assertRegex(lines[2], r"case.toml:9: .*radius does not belong")
        straight = self.edge_at("line", 6, -20, -15, 3)
        edge = self.edge_at("circle", 18 * math.pi, 0, 0, 11)
        self.refuse(self.write(f"rims = [{straight}]"), "^rims",
                    "do not close")
        self.refuse(self.write("rims = []"), "^rims", "expected loops")
        self.refuse(self.write(f"rims = [{edge}, [{edge}]]"), "^rims",
                    "two rims")
        self.refuse(self.write('open = ["face_2"]'), "^enclosed_by",
                    "not closed")
        again = '[solids.b]\nkind = "step"\nfile = "part.step"\n'
        self.refuse(self.write(films=again + "move = [3, 2, 1]",
                               surfaces='"plate", "b"'),
                    r"^\[solids.b\]", "'plate' and 'b' overlap near")

    def test_a_face_with_the_number_of_another(self):
        part = self.draw("Box(1) = {0, 0, 0, 4, 5, 6};")
        text, count = re.subn(r"(ADVANCED_FACE\(')'", "\\1face_1'",
                              part.read_text())
        self.assertEqual(count, 6)
        names = iter(["top", "face_1", "face_9", "", "", ""])
        part.write_text(re.sub(r"(?<=ADVANCED_FACE\(')face_1(?=')",
                               lambda _: next(names), text))
        case = self.write('open = ["none"]')
        said = self.call("check", case).stderr
        self.assertEqual(re.findall(r"(\w+): plane about", said),
                         ["top", "face_2", "face_9", "face_4", "face_5",
                          "face_6"])

    def test_a_solid_thinner_than_its_edges(self):
        """A slice off a cylinder: where edges are long its faces are one plane."""
        self.make("Cylinder(1) = {0, 0, 0, 0, 0, 4, 10};\n"
                  "Box(2) = {-5, 9.8, -1, 10, 5, 6};\n"
                  "BooleanIntersection(3) = { Volume{1}; Delete; }"
                  "{ Volume{2}; Delete; };")
        self.refuse(self.write(fea=6.0), "^enclosed_by",
                    "encloses no volume", "shorten resolution.fea")
        self.expect(self.call("check", self.write(fea=0.5)), 0)

    def test_files_that_are_no_solid(self):
        self.draw("Box(1) = {0, 0, 0, 1, 1, 1}; Box(2) = {3, 0, 0, 1, 1, 1};")
        self.refuse(self.write(), "^file", "2 solids")
        self.draw("Rectangle(1) = {0, 0, 0, 4, 5};")
        self.refuse(self.write(), "^file", "0 solids")


if __name__ == "__main__":
    unittest.main()
