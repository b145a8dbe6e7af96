#!/usr/bin/env python3
"""Fields that follow the design, as users write them: tension, pressure, poles
and wall thickness of x, y, z, of design variables and of shapes with
coefficients. Exact gradients, studies, and files that others read."""
import random
import unittest

from program import ProgramTest

HEAD = """title = "A strut in fields"
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
{film}
{more}
[materials.steel]
youngs_modulus = 2e5
poisson_ratio = 0.3
density = 7.85e-9

[responses.mass]
kind = "mass"
"""

SOLID = """
[solids.foot]
kind = "cap"
curve = "base"

[solids.top]
kind = "cap"
curve = "head"

[bodies.part]
enclosed_by = ["skin", "foot", "top"]
material = "steel"
{body}

[load_cases.service]
supports = [{ on = "foot", fix = "xyz" }]
loads = [{ on = "top", force = [1000, 200, 0] }]

[responses.sway]
kind = "mean_displacement"
on = "top"
direction = [1, 0, 0]

[responses.margin]
kind = "collapse_margin"

[resolution]
fea = 9
"""

AXIS = """
[shapes.around]
kind = "axis"
from = [0, 0, 0]
to = [4, 0, 50]
coefficients = "t"
"""

RIMS = """
[shapes.around]
kind = "rims"
curves = ["base", "head"]
coefficients = "t"
"""

CENTRES = "".join(f"""
[responses.c{"xyz"[k]}]
kind = "centre_of_mass"
direction = {[int(m == k) for m in range(3)]}
""" for k in range(3))


def vector(shape, initial, bounds, name="t"):
    return (f"\n[design.{name}]\nshape = {shape}\ninitial = {initial}\n"
            f"bounds = {bounds}\n")


def solid(top, film, fields="", body="volume = 6.5e4"):
    return HEAD.format(top=top, film=film,
                       more=fields) + SOLID.replace("{body}", body)


def wall(top):
    """A short film as a wall of thickness "around"."""
    return (HEAD.format(top=top, film="", more="""
[walls.shell]
films = ["skin"]
thickness = "around*(1 + 0.002*z)"
material = "steel"

[load_cases.service]
supports = [{ on = "skin/rim:base", fix = "xyz" }]
loads = [{ on = "skin/rim:head", force = [1000, 200, 0] }]

[resolution]
fea = 5
film = 5
""") + """
[responses.sway]
kind = "mean_displacement"
on = "skin/rim:head"
direction = [1, 0, 0]
""").replace("center = [4, 0, 50]", "center = [2, 0, 18]")


class FieldsTest(ProgramTest):
    def check_gradient(self, text):
        (self.folder / "case.toml").write_text(text)
        done = self.call("check-gradient", "case.toml", timeout=400)
        self.expect(done, 0, r"all \d+ derivatives agree")
        return done.stdout + done.stderr

    def run_case(self, name, text, *more):
        (self.folder / f"{name}.toml").write_text(text)
        self.expect(self.call("run", f"{name}.toml", "--out", name,
                              "--no-pictures", "--no-report", *more), 0)
        return self.result(self.folder / name)

    def test_a_tension_of_coefficients_has_exact_gradients(self):
        draw = random.Random(7)
        initial = [[round(draw.uniform(0.7, 1.4), 3) for _ in range(3)]
                   for _ in range(4)]
        said = self.check_gradient(solid(
            vector([4, 3], initial, [0.5, 2]) + AXIS, 'tension = "around"'))
        self.assertIn("t [4 x 3]: 8 of its 12 elements", said)

    def test_places_strengths_and_pressures_have_exact_gradients(self):
        self.check_gradient(solid("""
[design.steep]
initial = 0.2
bounds = [0.1, 0.3]

[design.off]
initial = 20
bounds = [10, 30]

[design.push]
initial = 4e-4
bounds = [1e-4, 1e-3]
""", 'tension = "1.2 + 0.05*steep*z"', """
[fields.pull]
kind = "point"
at = ["off", 0, 10]
strength = "steep"
core = "off"
films = ["skin"]

[fields.gas]
kind = "pressure"
body = "part"
pressure = "push*(50 - z)"
"""))

    def test_a_wall_of_a_field_has_exact_gradients(self):
        self.check_gradient(wall(vector([3, 2], 2.5, [2, 4]) + AXIS))

    def test_a_wall_follows_its_films_own_coordinates(self):
        """Harmonic ones: exact gradients, also by a design that moves the rims;
        the first row stands at the first curve, and the angle begins where it is
        asked to and runs as that curve does."""
        draw = random.Random(19)
        initial = [[round(draw.uniform(2.2, 3.4), 3) for _ in range(5)]
                   for _ in range(4)]
        said = self.check_gradient(wall(vector([4, 5], initial, [2, 4]) + RIMS
                                        + """
[design.up]
initial = 0
bounds = [-2, 2]
""").replace("[2, 0, 18]", '[2, 0, "18 + up"]'))
        self.assertIn("t [4 x 5]: 8 of its 20 elements", said)
        # Thick towards +y, then on one way around: x tells which.
        text = (wall(vector([1, 4], [[3, 2.6, 2.2, 2.2]], [2, 4])
                     + RIMS + "zero = [0, 1, 0]\n") + CENTRES).replace(
                         "[2, 0, 18]", "[0, 0, 18]").replace(
                             "radius = 20", "radius = 25")
        centre = {}
        for name, normal in (("down", "-1"), ("up", "1")):
            found = self.run_case(name, text.replace(
                "normal = [0, 0, -1]", f"normal = [0, 0, {normal}]"), "--set",
                "resolution.film=2.5")["responses"]
            centre[name] = found["cx"], found["cy"]
        self.assertGreater(centre["up"][1], 0.5)
        self.assertLess(centre["up"][0], -0.1)  # counter-clockwise from +y: -x
        self.assertAlmostEqual(centre["down"][0] / centre["up"][0], -1, 2)
        self.assertAlmostEqual(centre["down"][1] / centre["up"][1], 1, 2)
        # Rows: thick at the foot or at the head.
        for name, rows in (("low", [[3], [2.5], [2.5]]),
                           ("high", [[2.5], [2.5], [3]])):
            centre[name] = self.run_case(
                name, (wall(vector([3, 1], rows, [2, 4]) + RIMS) + CENTRES)
                .replace("[2, 0, 18]", "[0, 0, 18]")
                .replace("radius = 20", "radius = 25")
                .replace('*(1 + 0.002*z)', ''))["responses"]["cz"]
        self.assertLess(centre["low"], 8.9)
        self.assertAlmostEqual(centre["low"] + centre["high"], 18, 2)

    def test_a_shape_between_rims_is_of_its_walls_films(self):
        waist = wall(vector([4, 5], 2.5, [2, 4])
                     + RIMS.replace('"head"]', '"waist"]'))
        (self.folder / "case.toml").write_text(waist)
        self.expect(self.call("check", "case.toml"), 2,
                    r"case.toml:\d+: there is no curve 'waist'; there are base, "
                    r"head")
        (self.folder / "case.toml").write_text(waist.replace("[curves.head]", """
[curves.waist]
kind = "circle"
center = [1, 0, 9]
normal = [0, 0, 1]
radius = 22

[curves.head]"""))
        self.expect(self.call("check", "case.toml"), 2,
                    r"case.toml:\d+: walls.shell.thickness has a shape between "
                    r"curves 'base' and 'waist'; no film of walls.shell ends at "
                    r"'waist' \(they end at base, head\)")
        (self.folder / "case.toml").write_text(
            wall(vector([4, 5], 2.5, [2, 4]) + RIMS).replace(
                '"around*', '"(around - 2.2)*'))
        self.expect(self.call("check", "case.toml"), 2,
                    r"case.toml:\d+: walls.shell.thickness is -0.2 at .*with "
                    r"'t\[1,1\]' at the end of its bounds, 2")

    def test_a_study_shapes_the_tension(self):
        """At the same volume a field alone makes the strut stiffer."""
        sway = self.run_case("plain", solid("", ""))["responses"]["sway"]
        text = solid(vector([4, 1], 1, [0.4, 2.5]) + AXIS,
                     'tension = "around"')
        found = self.run_case("study", text + f"""
[study]
kind = "match"
targets = {{ sway = {0.98 * sway} }}
tolerance = 1e-3
""")
        self.assertAlmostEqual(found["responses"]["sway"] / (0.98 * sway), 1.0,
                               3)
        t = found["parameters"]["t"]
        self.assertEqual((len(t), len(t[0])), (4, 1))
        self.assertNotEqual(t, [[1], [1], [1], [1]])
        # And goes on from there, to the bit of the database.
        self.expect(self.call("run", "study.toml", "--out", "study",
                              "--no-pictures", "--no-report"), 0)
        again = self.result(self.folder / "study")
        self.assertEqual(again["responses"]["sway"],
                         found["responses"]["sway"])

    def test_a_field_of_one_value_is_that_number(self):
        """A partition of one: any shape with one coefficient for all."""
        plain = self.run_case("plain", solid("", "tension = 1.3"))
        shaped = self.run_case("shaped", solid(
            vector([3, 5], 1.3, [1, 2]) + AXIS, 'tension = "around"'))
        for name, value in plain["responses"].items():
            self.assertAlmostEqual(shaped["responses"][name] / value, 1.0, 6,
                                   name)

    def test_symmetry_and_pressure_do_not_know_where_the_case_lies(self):
        """Half a strut under a field of pressure, its plane at y = 0 and far
        from there."""
        text = solid(vector([4, 1], [[0.01], [0.02], [0.03], [0.01]],
                            [0.001, 0.1]) + AXIS, "", """
[symmetry]
planes = [{ at = [0, 0, 0], normal = [0, -1, 0] }]

[fields.gas]
kind = "pressure"
body = "part"
pressure = "around + 1e-4*(z - @z)"
""", "volume = 3.2e4")
        text = text.replace("force = [1000, 200, 0]", "force = [1000, 0, 0]")
        found = []
        for name, (dy, dz) in {"here": (0, 0), "far": (400, 300)}.items():
            moved = text.replace("@z", str(dz))
            for place in ("[0, 0, 0]\nnormal", "[4, 0, 50]\nnormal",
                          "from = [0, 0, 0]", "to = [4, 0, 50]",
                          "at = [0, 0, 0]"):
                self.assertIn(place, moved)
                x, y, z = eval(place[place.index("["):place.index("]") + 1])
                moved = moved.replace(
                    place, place.replace(f"[{x}, {y}, {z}]",
                                         f"[{x}, {y + dy}, {z + dz}]"))
            found.append(self.run_case(name, moved)["responses"])
        for name, value in found[0].items():
            self.assertAlmostEqual(found[1][name] / value, 1.0, 3, name)

    def test_a_power_of_nothing_has_its_derivative(self):
        """0^n on half of the film, n a design variable."""
        self.check_gradient(solid(
            "[design.n]\ninitial = 3.5\nbounds = [3.2, 4]\n",
            'tension = "1 + 4e-6*max(x, 0)^n"'))

    def test_a_datafile_has_names_but_no_shapes(self):
        self.run_case("named", solid(
            "[design.a]\ninitial = 1\nbounds = [0.5, 2]\n",
            'tension = "1 + 0.01*a*z"'))
        self.expect(self.call("export", "named", "--format", "fe"), 0)
        self.run_case("shaped", solid(vector([3, 2], 1, [0.5, 2]) + AXIS,
                                      'tension = "around"'))
        self.expect(self.call("export", "shaped", "--format", "fe"), 2,
                    "shapes")


if __name__ == "__main__":
    unittest.main()
