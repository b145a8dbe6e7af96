#!/usr/bin/env python3
"""A strut that planes of symmetry cut along its axis: one line, and the volume
and force that a half or a quarter has, give the whole's answers and files."""
import struct
import unittest

from program import SIZED_STRUT, ProgramTest

PLANES = ["{ at = [0, 0, 0], normal = [0, 1, 0] }",
          "{ at = [0, 0, 0], normal = [1, 0, 0] }"]
VOLUME, FORCE = 9e4, 1000.0
MESH = 2e-3     # of mass, on other facets
SWAY = 1.5e-2   # of deflections, on other elements
FACETS = 1e-6   # single precision of an STL


def strut(planes):
    """Pressed along the axis, in both planes."""
    parts = 2 ** planes
    text = SIZED_STRUT.split("[study]")[0]
    text = text.replace("initial = 9e4\nbounds = [7e4, 1.2e5]",
                        f"initial = {VOLUME / parts}\n"
                        f"bounds = [{7e4 / parts}, {1.2e5 / parts}]")
    text = text.replace("[1000, 0, 0]", f"[0, 0, {-FORCE / parts}]")
    text = text.replace("direction = [1, 0, 0]", "direction = [0, 0, -1]")
    if planes:
        text += ("[symmetry]\nplanes = [" + ", ".join(PLANES[:planes]) + "]\n")
    return text + '[study]\nkind = "analyse"\n'


def stl_volume(path):
    data = path.read_bytes()
    total = 0.0
    for at in range(84, len(data), 50):
        a, b, c = (struct.unpack_from("<3f", data, at + 12 * k)
                   for k in (1, 2, 3))
        total += (a[0] * (b[1] * c[2] - b[2] * c[1]) +
                  a[1] * (b[2] * c[0] - b[0] * c[2]) +
                  a[2] * (b[0] * c[1] - b[1] * c[0])) / 6.0
    return total


class Symmetry(ProgramTest):
    def run_part(self, planes):
        case = self.folder / f"part_{planes}.toml"
        case.write_text(strut(planes))
        out = self.folder / f"out_{planes}"
        self.expect(self.call("run", case, "--out", out, "--no-pictures",
                              "--no-report", "--no-frames"), 0)
        return out, self.result(out)

    def test_parts_answer_as_the_whole(self):
        _, whole = self.run_part(0)
        for planes in (1, 2):
            out, part = self.run_part(planes)
            self.assertEqual(part["symmetry"]["parts"], 2 ** planes)
            for name, within in (("mass", MESH), ("sway", SWAY)):
                self.assertAlmostEqual(
                    part["responses"][name] / whole["responses"][name], 1.0,
                    delta=within, msg=f"{planes} planes, {name}")
            stl = next(out.glob("part_*.stl"))
            self.assertAlmostEqual(stl_volume(stl) / VOLUME, 1.0,
                                   delta=FACETS)
            for kind in ("step", "step-faceted"):
                self.expect(
                    self.call("export", out, "--format", kind, "--out",
                              self.folder / f"{kind}.step"), 0)

    def test_a_curve_off_the_plane_is_told_with_its_line(self):
        case = self.folder / "case.toml"
        case.write_text(strut(1).replace("center = [0, 0, 60]",
                                         "center = [0, 3, 60]"))
        line = self.line_of(case, r"\[curves.head\]")
        self.expect(self.call("check", case), 2,
                    rf"case.toml:{line}: curve 'head' crosses plane 1 of "
                    r"symmetry and is not its own image there: it is 12 off")


if __name__ == "__main__":
    unittest.main()
