#!/usr/bin/env python3
"""Parts of several bodies beside one of one piece: an H of four plates, as STL
whose plates share facets and as STEP whose plates only touch."""
import json
import os
import shutil
import subprocess
import unittest

from program import ProgramTest

CASE = """title = "Bar"
units = "mm-N-MPa"

[curves.low]
kind = "polygon"
points = [[0, 10, 0], [0, 20, 0], [0, 20, 10], [0, 10, 10]]

[curves.high]
kind = "polygon"
points = [[40, 10, 0], [40, 20, 0], [40, 20, 10], [40, 10, 10]]

[solids.foot]
kind = "cap"
curve = "low"

[solids.head]
kind = "cap"
curve = "high"

[solids.skin]
kind = "sides"
curves = ["low", "high"]

[bodies.bar]
enclosed_by = ["foot", "head", "skin"]
material = "steel"

[materials.steel]
youngs_modulus = "210 GPa"
poisson_ratio = 0.3
density = "7850 kg/m3"

[load_cases.pull]
supports = [{ on = "foot", fix = "xyz" }]
loads = [{ on = "head", force = [1000, 0, 0] }]

[responses.mass]
kind = "mass"

[resolution]
fea = 5

[study]
kind = "analyse"
"""
EDGE = 10  # mm, of the cells that plates are made of
FLANGES = [(i, j, 0) for i in (0, 3) for j in range(3)]
WEB = [(1, 1, 0), (2, 1, 0)]
PLATES = {**{cell: cell[0] // 3 for cell in FLANGES}, WEB[0]: 2, WEB[1]: 3}
# Meshes of their own; edges in the corners of the H.
MOST_OFF = 0.02


def stl(path, body_of):
    """The bodies' cells, each body closed by itself."""
    faces = {"foot": [], "head": [], "rest": []}
    for cell, body in body_of.items():
        for axis in range(3):
            for step in (-1, 1):
                beside = tuple(c + step * (k == axis)
                               for k, c in enumerate(cell))
                if body_of.get(beside) == body:
                    continue
                name = {(0, -1, 0): "foot", (0, 1, 3): "head"}.get(
                    (axis, step, cell[0]), "rest")
                u, v = (axis + 1) % 3, (axis + 2) % 3
                ring = []
                for du, dv in ((0, 0), (1, 0), (1, 1), (0, 1)):
                    corner = list(cell)
                    corner[axis] += step > 0
                    corner[u] += du
                    corner[v] += dv
                    ring.append([EDGE * c for c in corner])
                ring[1:] = ring[1:] if step > 0 else ring[:0:-1]
                faces[name] += [(ring[0], ring[1], ring[2]),
                                (ring[0], ring[2], ring[3])]
    lines = []
    for name, triangles in faces.items():
        lines.append(f"solid {name}")
        for triangle in triangles:
            lines += ["facet normal 0 0 0", "outer loop"]
            lines += [f"vertex {x} {y} {z}" for x, y, z in triangle]
            lines += ["endloop", "endfacet"]
        lines.append(f"endsolid {name}")
    path.write_text("\n".join(lines) + "\n")


class WeldedTest(ProgramTest):
    def compare(self, *parts):
        (self.folder / "case.toml").write_text(CASE)
        self.expect(self.call("run", "case.toml", "--out", "bar"), 0)
        self.expect(self.call("compare", "bar", *parts, "--out", "side"), 0)
        return json.loads((self.folder / "side" / "compare.json")
                          .read_text())["parts"]

    def check(self, part, parts, weld, one):
        self.assertEqual(part["parts"], parts)
        self.assertAlmostEqual(part["weld_length"], weld, delta=1e-6)
        self.assertAlmostEqual(part["mass"] / one["mass"], 1, delta=1e-9)
        stiffness = [p["load_cases"]["pull"]["stiffness"] for p in (part, one)]
        self.assertLess(abs(stiffness[0] / stiffness[1] - 1), MOST_OFF)

    def test_four_plates_and_one_piece_and_two_apart(self):
        stl(self.folder / "plates.stl", PLATES)
        stl(self.folder / "fused.stl", dict.fromkeys(PLATES, 0))
        stl(self.folder / "apart.stl", {(i, j, 0): j for i in range(4)
                                        for j in (0, 2)})
        bar, plates, fused, apart = self.compare("plates.stl", "fused.stl",
                                                 "apart.stl")
        self.assertEqual((bar["parts"], bar["weld_length"]), (1, 0))
        self.check(fused, 1, 0, fused)
        self.check(plates, 4, 3 * 4 * EDGE, fused)
        self.check(apart, 2, 0, apart)

    def test_plates_of_a_step_file_that_only_touch(self):
        """A flange's face is larger than the web that ends on it."""
        if not shutil.which("gmsh"):
            if os.environ.get("MENISCUS_NO_SKIPS"):
                self.fail("gmsh is not installed")
            self.skipTest("gmsh is not installed")
        script = self.folder / "plates.geo"
        script.write_text("""SetFactory("OpenCASCADE");
Box(1) = {0, 0, 0, 10, 30, 10};
Box(2) = {10, 10, 0, 10, 10, 10};
Box(3) = {20, 10, 0, 10, 10, 10};
Box(4) = {30, 0, 0, 10, 30, 10};
Save "plates.step";
""")
        subprocess.run(["gmsh", script, "-", "-parse_and_exit"], check=True,
                       capture_output=True, timeout=120, cwd=self.folder)
        stl(self.folder / "fused.stl", dict.fromkeys(PLATES, 0))
        fused, plates = self.compare(
            "fused.stl", "plates.step", "--face", "plates.step:foot=face_1",
            "--face", "plates.step:head=face_20")[1:]
        self.check(plates, 4, 3 * 4 * EDGE, fused)


if __name__ == "__main__":
    unittest.main()
