#!/usr/bin/env python3
"""Tensions that turn with their films, as users write them: `drop` of a film
makes printable arms and box-like drops; exact gradients, symmetry, files for
others, and messages."""
import math
import pathlib
import unittest

from program import ProgramTest

CUBE = pathlib.Path(__file__).parents[2] / "cases/cube_to_sphere/cube.fe"

COMMON = """
[materials.steel]
youngs_modulus = 2e5
poisson_ratio = 0.3
density = 7.85e-9

[responses.mass]
kind = "mass"

[responses.overhang]
kind = "overhang"
direction = [0, 0, 1]
"""

DROP = """title = "A drop"
units = "mm-N-MPa"

[films.skin]
kind = "file"
file = "cube.fe"
scale = 10
{drop}

[bodies.drop]
enclosed_by = ["skin"]
volume = 1000
material = "steel"

[load_cases.service]
supports = [{ on = "skin", fix = "xyz" }]
loads = [{ gravity = [0, 0, -9810] }]

[responses.energy]
kind = "film_energy"

[resolution]
fea = 1.2
""" + COMMON

ARM = """title = "An arm across"
units = "mm-N-MPa"
{top}
[curves.wall]
kind = "circle"
center = [0, 0, 0]
normal = [-1, 0, 0]
radius = 6

[curves.tip]
kind = "circle"
center = [60, 0, 0]
normal = [1, 0, 0]
radius = 6

[films.skin]
kind = "spines"
curves = ["wall", "tip"]
{drop}

[spines.arm]
points = [[0, 0, 0], [60, 0, 0]]
radius = 6
tension = 1

[solids.foot]
kind = "cap"
curve = "wall"

[solids.end]
kind = "cap"
curve = "tip"

[bodies.part]
enclosed_by = ["skin", "foot", "end"]
material = "steel"

[load_cases.service]
supports = [{ on = "foot", fix = "xyz" }]
loads = [{ on = "end", force = [0, 0, -100] }]

[responses.sag]
kind = "mean_displacement"
on = "end"
direction = [0, 0, -1]

[responses.margin]
kind = "collapse_margin"

[resolution]
fea = 4
film = 2
""" + COMMON

# Eight needles steeper than 45 degrees: no face of their sum is less steep.
PRINTABLE = ('drop = [{ axis = ["cos(i * pi / 4)", "sin(i * pi / 4)", 1.3], '
             'along = 0.25, across = 0.025, repeat = 8 }]')

STRUT = """title = "A strut of liquid that turns"
units = "mm-N-MPa"
{top}
[curves.base]
kind = "circle"
center = [0, 0, 0]
normal = [0, 0, -1]
radius = 25

[curves.head]
kind = "circle"
center = [4, 0, 50]
normal = [0, 0, 1]
radius = 20

[films.skin]
kind = "loft"
curves = ["base", "head"]
{drop}
{more}
[solids.foot]
kind = "cap"
curve = "base"

[solids.top]
kind = "cap"
curve = "head"

[bodies.part]
enclosed_by = ["skin", "foot", "top"]
material = "steel"
volume = {volume}

[load_cases.service]
supports = [{ on = "foot", fix = "xyz" }]
loads = [{ on = "top", force = [1000, 0, 0] }]

[responses.sway]
kind = "mean_displacement"
on = "top"
direction = [1, 0, 0]

[responses.margin]
kind = "collapse_margin"

[resolution]
fea = 9
""" + COMMON


def filled(text, **parts):
    for name in ("top", "drop", "more", "volume"):
        text = text.replace("{" + name + "}", str(parts.get(name, "")))
    return text


class DropShapesTest(ProgramTest):
    def setUp(self):
        super().setUp()
        (self.folder / "cube.fe").write_text(CUBE.read_text())

    def responses(self, name, text, *more):
        (self.folder / f"{name}.toml").write_text(text)
        self.expect(self.call("run", f"{name}.toml", "--out", name,
                              "--no-pictures", "--no-report", *more), 0)
        return self.result(self.folder / name)["responses"]

    def check_gradient(self, text):
        (self.folder / "case.toml").write_text(text)
        self.expect(self.call("check-gradient", "case.toml", timeout=400), 0,
                    r"all \d+ derivatives agree")

    def refuse(self, text, *expected):
        (self.folder / "case.toml").write_text(text)
        done = self.call("check", "case.toml")
        self.expect(done, 2, *expected)

    def test_a_free_drop_is_its_spheroid(self):
        found = self.responses("drop", filled(
            DROP, drop="drop = [{ axis = [1, 2, 3], along = 1.4, "
            "across = 0.8 }]\ntension = 1.5"))
        whole = 4 / 3 * math.pi * 1.4 * 0.8 ** 2
        exact = 1.5 * 3 * (whole * 1000 ** 2) ** (1 / 3)
        self.assertAlmostEqual(found["energy"] / exact, 1.0, 2)
        self.assertGreater(found["energy"], exact)

    def test_steep_needles_need_no_supports(self):
        """A ball has 2 pi r^2 (1 - cos 45) of overhang; this one almost none,
        nor an arm across with ends of such a shape."""
        ball = self.responses("ball", filled(DROP))["overhang"]
        r = (1000 * 3 / 4 / math.pi) ** (1 / 3)
        exact = 2 * math.pi * r ** 2 * (1 - math.sqrt(0.5))
        self.assertAlmostEqual(ball / exact, 1.0, 1)
        drop = self.responses("drop", filled(DROP, drop=PRINTABLE))["overhang"]
        self.assertLess(drop, 0.15 * ball)
        arm = self.responses("arm", filled(ARM))
        steep = self.responses("steep", filled(ARM, drop=PRINTABLE))
        self.assertLess(steep["overhang"], 0.4 * arm["overhang"])

    def test_gradients_by_axes_lengths_and_tensions(self):
        self.check_gradient(filled(STRUT, volume=6.5e4, top="""
[design.lean]
initial = 0.3
bounds = [0, 1]

[design.long]
initial = 0.8
bounds = [0.5, 1]

[design.flat]
initial = 0.5
bounds = [0.2, 0.8]

[design.strength]
initial = 1.2
bounds = [0.5, 2]
""", drop="""
tension = "strength * (1 + 0.004 * z)"
drop = [
  { axis = ["lean", 0.2, 1], along = "long", across = 0.4 },
  { axis = [1, "-lean", 0], along = "flat", across = "long / 2" },
]
"""))

    def test_gradients_of_a_turning_film_along_a_spine(self):
        self.check_gradient(filled(ARM, top="""
[design.steep]
initial = 1.3
bounds = [1, 2]

[design.round]
initial = 0.1
bounds = [0.05, 0.2]

[design.strength]
initial = 0.95
bounds = [0.5, 2]
""", drop='tension = "strength"\n' + PRINTABLE.replace(
            "1.3", '"steep"').replace("0.025", '"round"')))

    def test_gradients_of_a_free_drop(self):
        """By its tension alone, too: its energy over the tension."""
        self.check_gradient(filled(DROP, drop="""
tension = "strength"
drop = [
  { axis = [1, "lean", 3], along = 1.4, across = 0.8 },
  { axis = ["-lean", 2, 0], along = 0.3, across = 0.6 },
]
""", top="").replace("[films.skin]", """[design.strength]
initial = 1.3
bounds = [0.5, 2]

[design.lean]
initial = 0.4
bounds = [0, 1]

[films.skin]""", 1))

    def test_half_a_part_is_half_of_the_whole(self):
        drop = ("drop = [{ axis = [1, 1, 2], along = 0.6, across = 0.3 }, "
                "{ axis = [1, -1, 2], along = 0.6, across = 0.3 }, "
                "{ axis = [0, 1, 0], along = 0.3, across = 0.5 }]")
        whole = self.responses("whole", filled(STRUT, volume=6.5e4, drop=drop))
        half = self.responses("half", filled(
            STRUT, volume=3.25e4, drop=drop, more="""
[symmetry]
planes = [{ at = [0, 0, 0], normal = [0, -1, 0] }]
""").replace("force = [1000,", "force = [500,"))
        for name, room in {"sway": 5e-3, "overhang": 0.02}.items():
            self.assertAlmostEqual(half[name] / whole[name], 1.0, None, name,
                                   room)

    def test_half_a_part_wants_a_drop_that_is_its_own_image(self):
        self.refuse(filled(STRUT, volume=3.25e4, more="""
[symmetry]
planes = [{ at = [0, 0, 0], normal = [0, -1, 0] }]
""", drop="drop = [{ axis = [1, 1, 2], along = 0.9, across = 0.4 }]"),
            r"case\.toml:\d+: the `drop` of film 'skin' is not symmetric")

    def test_a_pole_acts_on_its_body_not_on_its_area(self):
        pole = """
[fields.pull]
kind = "point"
at = [40, 0, 25]
strength = 0.1
core = 10
films = ["skin"]
"""
        drop = "drop = [{ axis = [0, 0, 1], along = 0.9, across = 0.4 }]"
        text = filled(STRUT, volume=6.5e4, more=pole, drop=drop)
        self.refuse(text, r"acts on the area of film 'skin'")
        (self.folder / "body.toml").write_text(
            text.replace('films = ["skin"]', 'body = "part"'))
        self.expect(self.call("evolve", "body.toml", "--set",
                              "resolution.fea=16", "--out", "body"), 0,
                    "film: stable")

    def test_datafiles_say_it_as_integrals_of_normals(self):
        self.responses("drop", filled(STRUT, volume=6.5e4, drop=(
            "drop = [{ axis = [1, 0, 2], along = 0.9, across = 0.4 }]")))
        self.expect(self.call("export", "drop", "--format", "fe"), 0)
        text = next((self.folder / "drop").glob("*.fe")).read_text()
        self.assertRegex(text, r"facet_general_integral\nscalar_integrand: "
                         r"\(1\) \* \(sqrt\(0\.16\d*\*\(x4\^2")

    def test_says_what_a_spheroid_lacks(self):
        for drop, expected in {
                "{ axis = [0, 0, 0], along = 1, across = 1 }":
                    r"case\.toml:\d+: .*drop\[0\]\.axis is \(0, 0, 0\)",
                "{ axis = [0, 0, 1], along = 0, across = 1 }":
                    r"along.* 0.*above 0",
                "{ axis = [0, 0, 1], along = 1, across = -2 }":
                    r"across.*-2.*above 0",
                "{ axis = [0, 0, 1], along = 1 }": "across",
                "{ axis = [0, 0, 1], along = 1, across = 1, acros = 2 }":
                    "unknown key 'acros'"}.items():
            with self.subTest(drop):
                self.refuse(filled(DROP, drop=f"drop = [{drop}]"), expected)

    def test_a_spine_around_it_has_a_tension_of_its_own(self):
        self.refuse(filled(ARM, drop=PRINTABLE).replace(
            "radius = 6\ntension = 1\n", "radius = 6\n"),
            "does not know the tension")


if __name__ == "__main__":
    unittest.main()
