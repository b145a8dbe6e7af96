#!/usr/bin/env python3
"""STEP files of the cases: true to the film, closed, and read by gmsh."""
import ctypes
import json
import math
import os
import pathlib
import re
import shutil
import signal
import subprocess
import time
import unittest

import program
from export_test import Array, Gmsh

MOST_GAP = 0.01  # mm
MOST_DEVIATION = 0.1  # of the film's edge
MOST_BREAK = 1.0  # degrees between faces of one film
MOST_VOLUME_ERROR = 1e-3
# Straight sides where the run has curved ones, edges of 20 mm.
MOST_FACETED = 0.05
NUMBER = r"([-+.\deE]+)"
MOST_FLAT = 1e-3  # of flat facets of a twentieth of the radius
CATENOID = """title = "Catenoid"
units = "mm-N-MPa"
[curves.low]
kind = "file"
file = "can.step"
edge = {low}
[curves.high]
kind = "file"
file = "can.step"
edge = {high}
[films.skin]
kind = "loft"
curves = ["low", "high"]
[walls.web]
films = ["skin"]
thickness = 0.1
[resolution]
fea = 1.0
"""


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


HEAD = """title = "Simple"
units = "mm-N-MPa"
[curves.foot]
kind = "circle"
center = [0, 0, 0]
normal = [0, 0, -1]
radius = 20
[solids.foot_pad]
kind = "cap"
curve = "foot"
[resolution]
fea = 8.0
film = 4.0
[materials.aluminium]
youngs_modulus = "71.7 GPa"
poisson_ratio = 0.33
density = 2.8e-9
[load_cases.weight]
supports = [{ on = "foot_pad", fix = "xyz" }]
loads = [{ gravity = [0, 0, -9810] }]
[responses.mass]
kind = "mass"
[study]
kind = "analyse"
"""
POST = """[curves.head]
kind = "circle"
center = [0, 0, 40]
normal = [0, 0, 1]
radius = 20
[films.skin]
kind = "loft"
curves = ["foot", "head"]
[solids.head_pad]
kind = "cap"
curve = "head"
[bodies.part]
enclosed_by = ["skin", "foot_pad", "head_pad"]
material = "aluminium"
volume = "40 * pi * 20^2%s"
"""
ROUND = """kind = "circle"
center = [0, 0, 0]
normal = [0, 0, -1]
radius = 20
"""
SPLINE = """kind = "spline"
points = [[20, 0, 0], [15, 14, 0], [0, 22, 0], [-15, 14, 0], [-22, 0, 0],
          [-12, -16, 0], [0, -20, 0], [16, -12, 0]]
"""
VASE = """[curves.head]
kind = "copy"
of = "foot"
move = [0, 0, 25]
[films.skin]
kind = "loft"
curves = ["foot", "head"]
[solids.head_pad]
kind = "cap"
curve = "head"
[bodies.part]
enclosed_by = ["skin", "foot_pad", "head_pad"]
material = "aluminium"
volume = 32000
"""
DROP = """[films.skin]
kind = "disk"
curves = ["foot"]
[bodies.part]
enclosed_by = ["skin", "foot_pad"]
material = "aluminium"
volume = "pi * 14 * (3 * 20^2 + 14^2) / 6"
"""
REST = """[resolution]
fea = 8.0
film = 4.0
[materials.aluminium]
youngs_modulus = "71.7 GPa"
poisson_ratio = 0.33
density = 2.8e-9
[load_cases.weight]
supports = [{ on = "bottom", fix = "xyz" }]
loads = [{ gravity = [0, 0, -9810] }]
[responses.mass]
kind = "mass"
[study]
kind = "analyse"
"""
EXACT = 1e-9  # planes and cylinders, of the volume


def polygon(name, points):
    return f'[curves.{name}]\nkind = "polygon"\npoints = {points}\n'


def circle(name, x, y, z, radius):
    return (f'[curves.{name}]\nkind = "circle"\ncenter = {[x, y, z]}\n'
            f"normal = [0, 0, 1]\nradius = {radius}\n")


def cap(name, curve, *holes):
    return (f'[solids.{name}]\nkind = "cap"\ncurve = "{curve}"\n' +
            (f"holes = {list(holes)}\n" if holes else ""))


def ring(name, curve, inner):
    return (f'[solids.{name}]\nkind = "ring"\ncurve = "{curve}"\n'
            f'inner = "{inner}"\n')


def sides(name, low, high):
    return f'[solids.{name}]\nkind = "sides"\ncurves = {[low, high]}\n'


def part_of(pieces, surfaces):
    """A case whose body has these surfaces; its "bottom" is on the ground."""
    return ('title = "Plates"\nunits = "mm-N-MPa"\n' + "".join(pieces) +
            f"[bodies.part]\nenclosed_by = {surfaces}\n"
            'material = "aluminium"\n' + REST)


def at_height(outline, z):
    return [[x, y, z] for x, y in outline]


def walls(low, high):
    """A polygon and a cap, wall_0 ..., over each side of an outline."""
    pieces = []
    for k, a in enumerate(low):
        b = (k + 1) % len(low)
        pieces += [polygon(f"side_{k}", [a, low[b], high[b], high[k]]),
                   cap(f"wall_{k}", f"side_{k}")]
    return pieces, [f"wall_{k}" for k in range(len(low))]


def area_of(outline):
    turned = outline[1:] + outline[:1]
    return 0.5 * sum(a[0] * b[1] - a[1] * b[0]
                     for a, b in zip(outline, turned))


def volume_between(low, high, height):
    """Of what straight lines fill from one outline to the other: Simpson's
    rule is exact."""
    middle = [[0.5 * (a[0] + b[0]), 0.5 * (a[1] + b[1])]
              for a, b in zip(low, high)]
    return height / 6 * (area_of(low) + 4 * area_of(middle) + area_of(high))


def face_names(path):
    """How many faces have which name."""
    names = {}
    for name in re.findall(r"ADVANCED_FACE\('([^']*)'", path.read_text()):
        names[name] = names.get(name, 0) + 1
    return names


def surface_kinds(path):
    """How many faces of which kind OpenCASCADE finds, as gmsh names them."""
    gmsh = Gmsh(path)
    try:
        tags = Array(ctypes.c_int)
        gmsh.call("ModelGetEntities", *tags.out(), 2)
        kinds = {}
        for tag in tags.values()[1::2]:
            kind = ctypes.c_char_p()
            gmsh.call("ModelGetType", 2, tag, ctypes.byref(kind))
            name = kind.value.decode()
            kinds[name] = kinds.get(name, 0) + 1
        return kinds
    finally:
        gmsh.close()


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
            rf"(\d+) B-spline faces, (\d+) planes, 0 cylinders, 0 cones, 0 spheres; "
            rf"valid closed solid of {NUMBER} mm3",
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
        self.refuse_another_size(run, file)

    def refuse_another_size(self, run, file):
        """A file in another unit, and one with a point far away: told before
        a surface of millions of facets is filled."""
        own = self.folder / "own.obj"
        self.expect(self.call("export", run, "--format", "obj", "--out", own),
                    0)
        large = self.folder / "large.obj"
        large.write_text(re.sub(
            r"(?m)^v (\S+) (\S+) (\S+)", lambda found: " ".join(
                ["v", *(str(1000.0 * float(x)) for x in found.groups())]),
            own.read_text()))
        points = re.findall(r"CARTESIAN_POINT\('[^']*',\(([^)]*)\)\)",
                            file.read_text())
        far = self.folder / "far.step"
        x, y, z = points[len(points) // 2].split(",")
        far.write_text(file.read_text().replace(
            f"({x},{y},{z})", f"({x},-344690258.,{z})"))
        # The reader may find the far point first, or give up in time.
        for path, says in ((large, "mm across"),
                           (far, "mm across|OpenCASCADE|cannot be tessellated")):
            begun = time.monotonic()
            self.expect(self.call("compare", run, path, "--out",
                                  self.folder / "refused"), 2,
                        re.escape(path.name), says)
            self.assertLess(time.monotonic() - begun, 30.0)

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

    def test_curves_from_a_file_of_gmsh(self):
        """A catenoid between the rims of a can that gmsh has written."""
        if not shutil.which("gmsh"):
            if os.environ.get("MENISCUS_NO_SKIPS"):
                self.fail("gmsh is not installed")
            self.skipTest("gmsh is not installed")
        script = self.folder / "can.geo"
        can = self.folder / "can.step"
        script.write_text(f"""SetFactory("OpenCASCADE");
Cylinder(1) = {{0, 0, 0, 0, 0, 10, 10}};
Save "{can}";
""")
        subprocess.run(["gmsh", script, "-", "-parse_and_exit"],
                       capture_output=True, timeout=120, check=True)
        case = self.folder / "rims.toml"

        def check(low, high):
            case.write_text(CATENOID.format(low=low, high=high))
            return self.call("check", case)

        there = check(99, 98).stderr
        circles = sorted(set(
            re.findall(rf"(\d+): circle of length {NUMBER} about", there)))
        self.assertEqual(len(circles), 2, there)
        self.assertIn("rims.toml:6: curves.low.edge", there)
        for _, length in circles:
            self.assertAlmostEqual(float(length), 62.832, places=3)
        done = self.expect(check(*(number for number, _ in circles)), 0)
        self.assertEqual(done.stdout.count("a circle of radius 10 mm, exact"),
                         2)
        out = self.folder / "film"
        done = self.expect(self.call("evolve", case, "--out", out,
                                     "--no-pictures"), 0)
        area = float(re.search(rf"area {NUMBER}", done.stdout).group(1))
        self.assertLess(abs(area / 599.179697580228 - 1.0), MOST_FLAT)

    def simple(self, films, head=HEAD):
        """The exported part of a small case and what was said of it."""
        path = self.folder / "simple.toml"
        path.write_text(head + films)
        run = self.folder / "simple"
        self.expect(self.call("run", path, "--out", run, "--no-pictures",
                              "--quiet"), 0)
        return self.export(run)

    def test_post_is_a_cylinder(self):
        file, said = self.simple(POST % "")
        self.assertIn("0 B-spline faces, 2 planes, 1 cylinder, 0 cones, 0 spheres", said)
        self.assertIn("skin is a cylinder of radius 20 mm", said)
        self.assertEqual(surface_kinds(file), {"Plane": 2, "Cylinder": 1})
        count, volume = gmsh_volume(file)
        self.assertEqual(count, 1)
        self.assertAlmostEqual(volume / (40 * math.pi * 20 ** 2), 1, delta=1e-7)

    def test_post_that_bulges_is_none(self):
        file, said = self.simple(POST % " * 1.02")
        self.assertIn("4 B-spline faces, 2 planes, 0 cylinders", said)
        self.assertEqual(surface_kinds(file), {"Plane": 2, "BSpline surface": 4})

    def test_closed_splines_are_read_as_they_are(self):
        file, said = self.simple(VASE, HEAD.replace(ROUND, SPLINE))
        self.assertIn("4 B-spline faces, 2 planes", said)
        count, volume = gmsh_volume(file)
        self.assertEqual(count, 1)
        self.assertAlmostEqual(volume / 32000, 1, delta=1e-4)

    def test_drop_is_a_sphere(self):
        file, said = self.simple(DROP)
        self.assertIn("0 B-spline faces, 1 plane, 0 cylinders, 0 cones, 1 sphere", said)
        self.assertEqual(surface_kinds(file), {"Plane": 1, "Sphere": 1})
        count, volume = gmsh_volume(file)
        self.assertEqual(count, 1)
        exact = math.pi * 14 * (3 * 20 ** 2 + 14 ** 2) / 6
        self.assertAlmostEqual(volume / exact, 1, delta=MOST_VOLUME_ERROR)

    def test_drop_on_an_ellipse_is_five_patches(self):
        path = HEAD.replace('"circle"', '"ellipse"').replace(
            "radius = 20", "axis = [1, 0, 0]\nradius_1 = 24\nradius_2 = 16")
        drop = DROP.replace("volume = ", "volume = 9000 #")
        self.assertNotEqual(path, HEAD)
        file = self.folder / "oval.toml"
        file.write_text(path + drop)
        run = self.folder / "oval"
        self.expect(self.call("run", file, "--out", run, "--no-pictures",
                              "--quiet"), 0)
        step, said = self.export(run)
        self.assertIn("5 B-spline faces, 1 plane", said)
        self.assertLess(float(re.search(rf"\({NUMBER} of its edge\)",
                                        said)[1]), MOST_DEVIATION)
        count, volume = gmsh_volume(step)
        self.assertEqual(count, 1)
        self.assertAlmostEqual(volume / 9000, 1, delta=MOST_VOLUME_ERROR)

    def test_square_rims_corners(self):
        corners = "[[-20, -20, %s], [20, -20, %s], [20, 20, %s], [-20, 20, %s]]"
        square = 'kind = "polygon"\npoints = '
        head = HEAD.replace(
            'kind = "circle"\ncenter = [0, 0, 0]\nnormal = [0, 0, -1]\n'
            "radius = 20", square + corners % ((0,) * 4))
        post = (POST % "").replace(
            'kind = "circle"\ncenter = [0, 0, 40]\nnormal = [0, 0, 1]\n'
            "radius = 20", square + corners % ((40,) * 4)).replace(
                "40 * pi * 20^2", "52000")
        file = self.folder / "square.toml"
        file.write_text(head + post)
        run = self.folder / "square"
        self.expect(self.call("run", file, "--out", run, "--no-pictures",
                              "--quiet"), 0)
        step, said = self.export(run)
        self.assertIn("4 B-spline faces, 2 planes", said)
        self.assertLess(float(re.search(rf"\({NUMBER} of its edge\)",
                                        said)[1]), MOST_DEVIATION)
        count, volume = gmsh_volume(step)
        self.assertEqual(count, 1)
        self.assertAlmostEqual(volume / 52000, 1, delta=MOST_VOLUME_ERROR)

    def plates(self, text, kinds, names, volume, accuracy=EXACT):
        """Exports a case whose part has these faces; the run and the file."""
        path = self.folder / "plates.toml"
        path.write_text(text)
        run = self.folder / "plates"
        self.expect(self.call("run", path, "--out", run, "--no-pictures",
                              "--quiet"), 0)
        file, said = self.export(run)
        self.assertIn("valid closed solid", said)
        self.assertEqual(face_names(file), names)
        self.assertEqual(surface_kinds(file), kinds)
        count, found = gmsh_volume(file)
        self.assertEqual(count, 1)
        self.assertAlmostEqual(found / volume, 1, delta=accuracy)
        return run, file

    def test_plates_of_caps_with_bores(self):
        """Caps around a plate of six corners, bored through twice."""
        outline = [[0, 0], [60, 0], [60, 20], [30, 20], [30, 45], [0, 45]]
        low, high = at_height(outline, 0), at_height(outline, 7)
        around, names = walls(low, high)
        pieces = [polygon("low", low), polygon("high", high), *around,
                  cap("bottom", "low", "hole_0", "hole_2"),
                  cap("top", "high", "hole_1", "hole_3")]
        for k, (x, y, r) in enumerate([(15, 30, 6), (45, 10, 4)]):
            pieces = [circle(f"hole_{2 * k}", x, y, 0, r),
                      circle(f"hole_{2 * k + 1}", x, y, 7, r), *pieces,
                      ring(f"bore_{k}", f"hole_{2 * k}", f"hole_{2 * k + 1}")]
        names += ["bottom", "top", "bore_0", "bore_1"]
        volume = 7 * (area_of(outline) - math.pi * (6 ** 2 + 4 ** 2))
        run, file = self.plates(part_of(pieces, names),
                                {"Plane": 8, "Cylinder": 2},
                                {name: 1 for name in names}, volume)
        self.expect(self.call("compare", run, file, "--out",
                              self.folder / "compared"), 0)
        own, read = json.loads((self.folder / "compared" / "compare.json")
                               .read_text())["parts"]
        self.assertLess(abs(read["mass"] / own["mass"] - 1.0), MOST_FACETED)

    def test_faces_of_sides(self):
        """Two of the five sides lie in one plane, all have the one name."""
        low = [[-30, -20], [0, -20], [30, -20], [30, 20], [-30, 20]]
        high = [[-20, -12], [0, -12], [20, -12], [20, 12], [-20, 12]]
        pieces = [polygon("low", at_height(low, 0)),
                  polygon("high", at_height(high, 25)), cap("bottom", "low"),
                  cap("top", "high"), sides("skirt", "low", "high")]
        self.plates(part_of(pieces, ["bottom", "top", "skirt"]), {"Plane": 7},
                    {"bottom": 1, "top": 1, "skirt": 5},
                    volume_between(low, high, 25))

    def test_plates_of_a_case(self):
        """An H that tapers under a plate, whose face it is a hole in."""
        text = (program.ROOT / "cases" / "bracket_vs_solid" /
                "plates.toml").read_text()
        low = [[-30, -37], [-24.5, -37], [-24.5, -2], [44.5, -2], [44.5, -37],
               [50, -37], [50, 37], [44.5, 37], [44.5, 2], [-24.5, 2],
               [-24.5, 37], [-30, 37]]
        high = [[44, -19], [49.5, -19], [49.5, -2], [70.5, -2], [70.5, -19],
                [76, -19], [76, 19], [70.5, 19], [70.5, 2], [49.5, 2],
                [49.5, 19], [44, 19]]
        self.plates(text[:text.index("[study]")] +
                    '[study]\nkind = "analyse"\n', {"Plane": 19},
                    {"foot": 1, "column": 12, "top_face": 1, "top_edges": 4,
                     "pad": 1},
                    volume_between(low, high, 115) + 44 * 44 * 5)

    def test_rings_between_polygons(self):
        """No curve runs along the corners of a ring: they are its creases."""
        outline = [[-20, -15], [0, -15], [20, -15], [20, 15], [-20, 15]]
        window = [[-8, -5], [8, -5], [8, 5], [-8, 5]]
        pieces = [polygon("low", at_height(outline, 0)),
                  polygon("high", at_height(outline, 8)),
                  polygon("from", at_height(window, 0)),
                  polygon("to", at_height(window, 8)),
                  cap("bottom", "low", "from"), cap("top", "high", "to"),
                  ring("skin", "low", "high"), ring("window", "from", "to")]
        self.plates(part_of(pieces, ["bottom", "top", "skin", "window"]),
                    {"Plane": 10},
                    {"bottom": 1, "top": 1, "skin": 4, "window": 4},
                    8 * (area_of(outline) - area_of(window)))

    def test_bore_between_a_circle_and_its_copy(self):
        outline = [[-20, -15], [20, -15], [20, 15], [-20, 15]]
        pieces = [polygon("low", at_height(outline, 0)),
                  polygon("high", at_height(outline, 8)),
                  circle("from", 0, 0, 0, 6),
                  '[curves.to]\nkind = "copy"\nof = "from"\nmove = [0, 0, 8]\n',
                  cap("bottom", "low", "from"), cap("top", "high", "to"),
                  sides("edges", "low", "high"), ring("bore", "from", "to")]
        self.plates(part_of(pieces, ["bottom", "top", "edges", "bore"]),
                    {"Plane": 6, "Cylinder": 1},
                    {"bottom": 1, "top": 1, "edges": 4, "bore": 1},
                    8 * (area_of(outline) - math.pi * 6 ** 2))

    def test_film_on_plates(self):
        """A film's patches have corners on sides that it shares with caps: a
        body of each, and between them a cap that is no face of the part."""
        outline = [[-20, -15], [20, -15], [20, 15], [-20, 15]]
        low, high = at_height(outline, 0), at_height(outline, 10)
        around, names = walls(low, high)
        pieces = [polygon("high", high), polygon("low", low), *around,
                  circle("head", 0, 0, 40, 12), cap("bottom", "low"),
                  cap("between", "high"), cap("top", "head"),
                  '[films.skin]\nkind = "loft"\ncurves = ["high", "head"]\n',
                  '[bodies.post]\nenclosed_by = ["between", "skin", "top"]\n'
                  'material = "aluminium"\nvolume = 24000\n']
        self.plates(part_of(pieces, [*names, "bottom", "between"]),
                    {"Plane": 6, "BSpline surface": 4},
                    {**{name: 1 for name in names}, "bottom": 1, "top": 1,
                     "skin": 4}, 12000 + 24000, MOST_VOLUME_ERROR)

    def test_the_ledger_notes_what_was_exported(self):
        run = self.analysed("strut_family", "--set", "resolution.fea=10",
                            "--set", "resolution.film=10")
        before = json.loads((run / "result.json").read_text())
        self.expect(self.call("export", run, "--format", "step"), 0)
        elsewhere = self.folder / "deck.inp"
        self.expect(self.call("export", run, "--format", "inp", "--out",
                              elsewhere), 0)
        after = json.loads((run / "result.json").read_text())
        files = {file["name"]: file for file in after["ledger"]["files"]}
        step = files["part_10.step"]
        self.assertTrue(step["written"])
        self.assertEqual(step["bytes"], (run / "part_10.step").stat().st_size)
        deck = files["part_10.inp"]
        self.assertFalse(deck["written"])
        self.assertEqual(deck["bytes"], elsewhere.stat().st_size)
        self.assertEqual(len(files), len(before["ledger"]["files"]) + 1)
        before["ledger"]["files"] = after["ledger"]["files"]
        self.assertEqual(before, after)

    def test_faceted_is_asked_for_by_name(self):
        run = self.analysed("struts", "--set", "resolution.fea=10",
                            "--set", "resolution.film=10")
        file = self.folder / "facets.step"
        self.expect(self.call("export", run, "--format", "step-faceted",
                              "--out", file), 0)
        self.assertGreater(file.read_text().count("ADVANCED_FACE"), 100)


class Helper(program.ProgramTest):
    """OpenCASCADE is in meniscus-step alone."""

    def libraries(self, file):
        return subprocess.run(["ldd", file], capture_output=True, text=True,
                              check=True).stdout

    def test_the_program_loads_no_opencascade(self):
        helper = program.PROGRAM.parent / "meniscus-step"
        self.assertIn("libTKernel", self.libraries(helper))
        self.assertNotIn("libTK", self.libraries(program.PROGRAM))

    def helper_runs(self, process):
        """Whether meniscus-step is a child of the process."""
        try:
            children = " ".join(
                path.read_text() for path in
                pathlib.Path(f"/proc/{process}/task").glob("*/children"))
            return any(pathlib.Path(f"/proc/{child}/comm").read_text().strip()
                       == "meniscus-step" for child in children.split())
        except OSError:  # a thread has ended since it was listed
            return False

    def test_a_stop_is_heard_while_a_file_is_written(self):
        run = self.folder / "run"
        self.expect(self.call("run", program.CASE, "--out", run, "--no-pictures",
                              "--no-report", "--quiet", *program.COARSE), 0)
        file = self.folder / "part.step"
        # Thousands of planes: half a minute, if nobody stops it.
        running = self.start("export", run, "--format", "step-faceted",
                             "--edge", "5", "--out", file)
        while running.poll() is None and not self.helper_runs(running.pid):
            time.sleep(0.05)
        running.send_signal(signal.SIGINT)
        _, said = running.communicate(timeout=60)
        self.assertEqual(running.returncode, 130, said)
        self.assertIn("while a STEP file was written", said)
        self.assertFalse(file.exists())
        self.assert_no_half_files(self.folder)


if __name__ == "__main__":
    unittest.main()
