#!/usr/bin/env python3
"""Walls from outside: a pipe with a bulkhead is run, differentiated, exported
and refused where it must be."""
import json
import math
import random
import re
import unittest

from export_test import run_program
from program import ProgramTest, some

# Two bands and a disk meet at a circle; 2000 elements.
PIPE = """title = "A pipe with a bulkhead"
units = "mm-N-MPa"

[design.radius]
initial = 30.0
bounds = [29.0, 31.0]

[design.wall]
initial = 3.0
bounds = [2.5, 4.0]

[curves.base]
kind = "circle"
center = [0, 0, 0]
normal = [0, 0, -1]
radius = "radius"

[curves.waist]
kind = "circle"
center = [0, 0, 12]
normal = [0, 0, 1]
radius = 26

[curves.head]
kind = "circle"
center = [0, 0, 24]
normal = [0, 0, 1]
radius = 30

[films.low]
kind = "loft"
curves = ["base", "waist"]

[films.high]
kind = "loft"
curves = ["waist", "head"]

[films.plate]
kind = "disk"
curves = ["waist"]

[walls.pipe]
films = ["low", "high"]
thickness = "wall"
material = "steel"

[walls.bulkhead]
films = ["plate"]
thickness = 4
fillet = 2
material = "steel"

[resolution]
fea = 6
film = 3

[materials.steel]
youngs_modulus = "210 GPa"
poisson_ratio = 0.3
density = "7850 kg/m3"
yield_strength = "355 MPa"

[load_cases.service]
supports = [{ on = "low/rim:base", fix = "xyz" }]
loads = [{ on = "plate", pressure = 2 }, { on = "high/rim:head", force = [0, 100, 0] }]

[responses.dip]
kind = "mean_displacement"
on = "plate/back"
direction = [0, 0, 1]

[responses.mass]
kind = "mass"
"""
FILES = ["result.json", "film.vtp", "part.vtu", "part_surface.vtp",
         "part_5.stl", "report.html"]
FORMATS = ["stl", "3mf", "obj", "step", "step-faceted", "fe", "inp", "bdf", "msh",
           "vtu"]


class Walls(ProgramTest):
    def case(self, text=PIPE, name="case.toml"):
        return super().case(text, name)

    def test_are_run_and_exported(self):
        out = self.folder / "out"
        self.expect(self.call("run", self.case(), "--set", "resolution.fea=10",
                              "--set", "resolution.film=5", "--out", out), 0)
        result = self.result(out)
        self.assertEqual(result["status"], "converged")
        self.assertGreater(result["responses"]["mass"], 0)
        for name in FILES:
            self.assertTrue((out / name).exists(), name)
        for form in FORMATS:
            self.expect(self.call("export", out, "--format", form), 0)
        self.expect(self.call("export", out, "--format", "stl", "--edge", "5"),
                    0)

    # Smooth STEP of walls drawn at random, as it says and as Gmsh finds it.
    def step_of(self, text):
        out = self.folder / "out"
        self.expect(self.call("run", self.case(text), "--out", out), 0)
        file = self.folder / "part.step"
        done = self.expect(self.call("export", out, "--format", "step",
                                     "--out", file), 0)
        said = done.stdout + done.stderr
        gap, off = re.search(r"gap at edges (\S+) mm.*\((\S+) of its edge\)",
                             said).groups()
        self.assertLess(float(gap), 0.01)
        self.assertLess(float(off), 0.1)
        script = self.folder / "measure.geo"
        script.write_text(f"""SetFactory("OpenCASCADE");
v() = ShapeFromFile("{file}");
For i In {{0 : #v() - 1}}
  m() = Mass Volume{{v(i)}};
  Printf("solid of %.15g", m(0));
EndFor
""")
        found = re.findall(r"solid of (\S+)", run_program(
            "gmsh", script, "-", "-parse_and_exit"))
        return said, [float(volume) for volume in found], file

    def test_smooth_step_is_the_wall(self):
        for seed in some((1, 2)):
            draw = random.Random(seed)
            text = (PIPE.replace("initial = 30.0",
                                 f"initial = {draw.uniform(29, 31):.4f}")
                    .replace("radius = 26", f"radius = {draw.uniform(25, 28):.4f}")
                    .replace("initial = 3.0", f"initial = {draw.uniform(2.5, 4):.4f}")
                    .replace("fillet = 2", f"fillet = {draw.uniform(1.5, 3):.4f}"))
            with self.subTest(seed=seed):
                said, solids, file = self.step_of(text)
                self.assertEqual(len(solids), 1)
                self.assertRegex(said, r"tangent breaks \D*0\.\d+ degrees")
                told = float(re.search(r"closed solid of (\S+) mm3",
                                       said).group(1))
                self.assertAlmostEqual(solids[0] / told, 1, delta=1e-4)
                # The wall's facets cut its curves' corners by some 0.2 %.
                self.expect(self.call("evolve", self.case(text), "--out",
                                      self.folder / "film"), 0)
                wall = json.loads(
                    (self.folder / "film/wall_pipe.json").read_text())
                self.assertAlmostEqual(solids[0] / wall["volume"], 1,
                                       delta=5e-3)
                faces = file.read_text()
                for name in ("low", "high/back", "plate", "low/rim:base"):
                    self.assertIn(f"'{name}'", faces)

    # Two walls that do not meet are two solids, by their names.
    def test_walls_apart_are_solids_of_their_own(self):
        text = (PIPE.replace('films = ["low", "high"]', 'films = ["low"]')
                .replace('films = ["plate"]', 'films = ["lid"]')
                + """
[curves.far]
kind = "circle"
center = [0, 0, 60]
normal = [0, 0, 1]
radius = 26

[films.lid]
kind = "disk"
curves = ["far"]
""")
        for unused in ("high", "plate"):
            text = re.sub(rf"\[films\.{unused}\]\n(.+\n)+", "", text)
        text = (text.replace('"plate/back"', '"lid/back"')
                .replace('[{ on = "low/rim:base", fix = "xyz" }]',
                         '[{ on = "low/rim:base", fix = "xyz" },'
                         ' { on = "lid/rim:far", fix = "xyz" }]')
                .replace('[{ on = "plate", pressure = 2 }, { on ='
                         ' "high/rim:head", force = [0, 100, 0] }]',
                         '[{ on = "lid", pressure = 2 }]'))
        said, solids, file = self.step_of(text)
        self.assertEqual(len(solids), 2)
        self.assertIn("2 valid closed solids", said)
        for name in ("pipe", "bulkhead"):
            self.assertIn(f"PRODUCT('{name}'", file.read_text())

    def test_gradients_are_exact(self):
        self.expect(self.call("check-gradient", self.case()), 0)

    def test_evolve_tells_the_largest_safe_thickness(self):
        out = self.folder / "out"
        self.expect(self.call("evolve", self.case(), "--out", out), 0,
                    "largest safe thickness")
        self.assertTrue((out / "wall_pipe.stl").exists())
        wall = json.loads((out / "wall_pipe.json").read_text())
        self.assertEqual(wall["length_unit"], "mm")
        self.assertEqual(wall["findings"], "")
        self.assertLess(abs(wall["thinnest"]["value"]
                            / wall["thinnest"]["asked"] - 1), 0.05)
        self.assertGreater(wall["safe"]["value"], wall["safe"]["asked"])
        # Two cones of 3 x 12.65 about 28, a plate of 4 and radius 26: 21.8e3
        self.assertGreater(wall["volume"], 20e3)
        self.assertLess(wall["volume"], 24e3)

    def test_a_wall_thicker_than_its_gap_is_refused_with_the_place(self):
        case = self.case(PIPE.replace("initial = 3.0", "initial = 70.0")
                         .replace("[2.5, 4.0]", "[2.5, 80.0]"))
        self.expect(self.call("run", case, "--out", self.folder / "out"), 3,
                    r"walls\.pipe cannot be meshed: (.|\n)*at most near \(")

    # Cones between circles end in planes where they are flush, and what follows
    # the design follows them there.
    def test_flush_ends_are_planes(self):
        flush = PIPE.replace('thickness = "wall"\n',
                             'thickness = "wall"\nflush = ["base"]\n')
        out = self.folder / "flush"
        self.expect(self.call("run", self.case(flush), "--out", out), 0)
        done = self.expect(self.call("export", out, "--format", "step"), 0,
                           r"low/rim:base is a plane; the film leaves it by")
        self.assertNotIn("high/rim:head is a plane", done.stdout + done.stderr)
        self.expect(self.call("check-gradient", self.case(flush)), 0)
        self.expect(self.call("check", self.case(
            flush.replace('["base"]', '["bass"]'))), 2,
            r"case\.toml:45: there is no curve 'bass'; did you mean 'base'")
        # A plate in the plane of its own rim has no such end.
        flat = flush.replace("fillet = 2\n", 'fillet = 2\nflush = ["waist"]\n')
        self.expect(self.call("run", self.case(flat)), 2,
                    r"flush at curve 'waist', and film 'plate' meets")
        bent = (flush.replace('["base"]', '["bent"]') +
                "\n[curves.bent]\nkind = \"polygon\"\n"
                "points = [[0, 0, 0], [9, 0, 0], [9, 9, 3], [0, 9, 0]]\n")
        self.expect(self.call("check", self.case(bent)), 2,
                    r"walls\.pipe: .*'bent', which lies in no plane")

    def test_what_cannot_be_analysed_is_refused(self):
        case = self.case(PIPE.replace('thickness = 4\nfillet = 2\n'
                                      'material = "steel"\n',
                                      "thickness = 4\n"))
        self.expect(self.call("run", case), 2, r"case\.toml:\d+: .*material")


# Four sides of plates, one with a door, and a plate over them with a brim that
# is hardly wider than the walls are thick; the foot names what stands on it.
STOOL = """title = "A stool"
units = "mm-N-MPa"

[curves.foot]
kind = "polygon"
points = [[0, 0, 0], [12, 0, 0], [28, 0, 0], [40, 0, 0], [40, 30, 0], [0, 30, 0]]

[curves.front]
kind = "polyline"
points = [
  [0, 0, 0], [12, 0, 0], { through = [20, 0, 25] }, [28, 0, 0], [40, 0, 0],
  [40, 0, 40], [0, 0, 40],
]

[curves.back]
kind = "polygon"
points = [[0, 30, 0], [40, 30, 0], [40, 30, 40], [0, 30, 40]]

[curves.left]
kind = "polygon"
points = [[0, 0, 0], [0, 30, 0], [0, 30, 40], [0, 0, 40]]

[curves.right]
kind = "polygon"
points = [[40, 0, 0], [40, 30, 0], [40, 30, 40], [40, 0, 40]]

[curves.head]
kind = "polygon"
points = [[0, 0, 40], [40, 0, 40], [40, 30, 40], [0, 30, 40]]

[curves.rim]
kind = "polygon"
points = [[-4, -4, 40], [44, -4, 40], [44, 34, 40], [-4, 34, 40]]

[films.front]
kind = "disk"
curves = ["front"]

[films.back]
kind = "disk"
curves = ["back"]

[films.left]
kind = "disk"
curves = ["left"]

[films.right]
kind = "disk"
curves = ["right"]

[films.lid]
kind = "disk"
curves = ["head"]

[films.brim]
kind = "disk"
curves = ["rim", "head"]

[walls.along]
films = ["front", "back"]
thickness = 3
material = "steel"

[walls.across]
films = ["left", "right"]
thickness = 3
material = "steel"

[walls.cover]
films = ["lid", "brim"]
thickness = 3
material = "steel"

[resolution]
fea = 6
film = 3

[materials.steel]
youngs_modulus = "210 GPa"
poisson_ratio = 0.3
density = "7850 kg/m3"

[load_cases.sit]
supports = [{ on = ["front/rim:foot", "back/rim:foot", "left/rim:foot", "right/rim:foot"], fix = "xyz" }]
loads = [{ on = ["lid", "brim"], force = [0, 0, -1000] }]

[responses.volume]
kind = "volume"
"""
# Fillets of 1.5 mm along 280 mm of the lid's lines, cut across by facets.
WITHIN = 0.02


def areas(obj):
    """Of the groups of an OBJ file."""
    points, area, group = [], {}, ""
    for line in obj.read_text().splitlines():
        kind, *rest = line.split() or [""]
        if kind == "v":
            points.append([float(x) for x in rest])
        elif kind == "g":
            group = " ".join(rest)
        elif kind == "f":
            a, b, c = (points[int(k.split("/")[0]) - 1] for k in rest)
            u = [q - p for p, q in zip(a, b)]
            v = [q - p for p, q in zip(a, c)]
            n = [u[1] * v[2] - u[2] * v[1], u[2] * v[0] - u[0] * v[2],
                 u[0] * v[1] - u[1] * v[0]]
            area[group] = area.get(group, 0.0) + math.hypot(*n) / 2
    return area


class Stool(ProgramTest):
    def test_plates_that_share_sides_are_one_body_on_what_the_foot_names(self):
        case = self.folder / "stool.toml"
        case.write_text(STOOL)
        out = self.folder / "stool"
        done = self.call("run", case, "--no-pictures", "--no-report",
                         "--export", "obj", "--out", out)
        self.expect(done, 0)
        self.assertNotIn("'foot'", done.stderr)  # it holds nothing, and names
        radius = (8 ** 2 + 25 ** 2) / (2 * 25)  # of the door
        door = (radius ** 2 * math.acos((radius - 25) / radius)
                - (radius - 25) * 8)
        volume = 3 * (48 * 38 + 140 * 38.5 - door)
        found = self.result(out)["responses"]["volume"]
        self.assertLess(abs(found / volume - 1), WITHIN)
        area = areas(out / "part_3.obj")
        rims = {name: a for name, a in area.items() if "/rim:" in name}
        self.assertEqual(set(rims), {
            "front/rim:foot", "front/rim:front", "back/rim:foot",
            "left/rim:foot", "right/rim:foot", "brim/rim:rim"})
        standing = sum(a for name, a in rims.items() if name.endswith(":foot"))
        self.assertLess(abs(standing / (3 * (140 - 16)) - 1), WITHIN)
        self.assertLess(abs(rims["brim/rim:rim"] / (3 * 172) - 1), WITHIN)


if __name__ == "__main__":
    unittest.main()
