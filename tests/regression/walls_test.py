#!/usr/bin/env python3
"""Walls from outside: a pipe with a bulkhead is run, differentiated, exported
and refused where it must be."""
import json
import unittest

from program import ProgramTest

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
         "part_3.stl", "report.html"]
FORMATS = ["stl", "3mf", "obj", "step-faceted", "fe", "inp", "bdf", "msh",
           "vtu"]


class Walls(ProgramTest):
    def case(self, text=PIPE):
        path = self.folder / "case.toml"
        path.write_text(text, encoding="utf-8")
        return path

    def test_are_run_and_exported(self):
        out = self.folder / "out"
        self.expect(self.call("run", self.case(), "--out", out), 0)
        result = self.result(out)
        self.assertEqual(result["status"], "converged")
        self.assertGreater(result["responses"]["mass"], 0)
        for name in FILES:
            self.assertTrue((out / name).exists(), name)
        for form in FORMATS:
            self.expect(self.call("export", out, "--format", form), 0)
        self.expect(self.call("export", out, "--format", "stl", "--edge", "5"),
                    0)
        self.expect(self.call("export", out, "--format", "step"), 2,
                    "step-faceted")

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

    def test_what_cannot_be_analysed_is_refused(self):
        case = self.case(PIPE.replace('thickness = 4\nfillet = 2\n'
                                      'material = "steel"\n',
                                      "thickness = 4\n"))
        self.expect(self.call("run", case), 2, r"case\.toml:\d+: .*material")


if __name__ == "__main__":
    unittest.main()
