#!/usr/bin/env python3
"""Films that end on others along lines that nobody drew, from outside: plates across
a tube, fins about it and shelves in it, drawn at random, made solid by walls."""
import csv
import math
import random
import re
import unittest

from program import ProgramTest, some

HEAD = """title = "A tube with {what}"
units = "mm-N-MPa"

[design.foot]
initial = {foot}
bounds = [20.0, 40.0]

[design.aside]
initial = {aside}
bounds = [-10.0, 10.0]

[design.pull]
initial = {pull}
bounds = [0.1, 1.0]

[design.wall]
initial = {wall}
bounds = [1.0, 6.0]

[parameters]
top = {top}
high = {high}

[curves.base]
kind = "circle"
center = [0, 0, 0]
normal = [0, 0, -1]
radius = "foot"

[curves.head]
kind = "circle"
center = ["aside", 0, "high"]
normal = [0, 0, 1]
radius = "top"

[films.skin]
kind = "loft"
curves = ["base", "head"]
{films}
[walls.tube]
films = ["skin"{names}]
thickness = "wall"
fillet = {fillet}
material = "steel"

[materials.steel]
youngs_modulus = 210000
poisson_ratio = 0.3
density = "7850 kg/m^3"

[load_cases.service]
supports = [{{ on = "skin/rim:base", fix = "xyz" }}]
loads = [{{ on = "skin/rim:head", force = [500, 200, -1000] }}]

[responses.mass]
kind = "mass"

[responses.sway]
kind = "mean_displacement"
on = "skin/rim:head"
direction = [1, 0, 0]

[responses.energy]
kind = "film_energy"

[analysis]
buckling = 0

[resolution]
fea = {edge}
"""
RIB = """
[curves.{name}]
kind = "polygon"
points = [{points}]
free = {free}

[films.{name}]
kind = "disk"
curves = ["{name}"]
joins = ["skin"]
tension = "pull"
"""
SHELF = """
[curves.shelf]
kind = "circle"
center = [{x}, {y}, "{share} * high"]
normal = [{tilt}, 0, 1]
radius = {radius}
free = true

[films.shelf]
kind = "disk"
curves = ["shelf"]
joins = ["skin"]
tension = "pull"
"""


def low(angle, more=0.0):
    return (f'["(foot + {more}) * cos({angle})", "(foot + {more}) * sin({angle})", 0]')


def up(angle, more=0.0):
    return (f'["aside + (top + {more}) * cos({angle})", '
            f'"(top + {more}) * sin({angle})", "high"]')


def ribbed(seed, **changed):
    """A tube with one to three plates that do not cross, fins, or a shelf."""
    draw = random.Random(seed)
    kind = ("plates", "fins", "a shelf")[seed % 3]
    films, names = "", []
    if kind == "plates":
        turn = draw.uniform(0, 2 * math.pi)
        for k, middle in enumerate(draw.choice([[0.0], [-0.25, 0.25]])):
            half = math.acos(middle + draw.uniform(-0.1, 0.1))
            one, other = turn - half, turn + half
            films += RIB.format(name=f"rib_{k}", free=[2, 4], points=", ".join(
                [low(one), low(other), up(other), up(one)]))
            names.append(f"rib_{k}")
    elif kind == "fins":
        count = draw.randint(1, 4)
        first = draw.uniform(0, 2 * math.pi)
        for k in range(count):
            angle = first + 2 * math.pi * (k + draw.uniform(-0.2, 0.2)) / count
            films += RIB.format(name=f"rib_{k}", free=[4], points=", ".join(
                [low(angle), low(angle, draw.uniform(8, 20)),
                 up(angle, draw.uniform(8, 20)), up(angle)]))
            names.append(f"rib_{k}")
    else:
        films += SHELF.format(x=draw.uniform(-3, 3), y=draw.uniform(-3, 3),
                              share=draw.uniform(0.35, 0.65),
                              tilt=draw.uniform(-0.2, 0.2),
                              radius=draw.uniform(22, 30))
        names.append("shelf")
    wall = draw.uniform(2, 4)
    numbers = {"what": kind, "foot": draw.uniform(27, 32),
               "aside": draw.uniform(-3, 3), "pull": draw.uniform(0.15, 0.35),
               "wall": wall, "top": draw.uniform(26, 31),
               "high": draw.uniform(18, 28), "fillet": draw.uniform(0.5, 1) * wall,
               "edge": draw.uniform(5, 8), "films": films,
               "names": "".join(f', "{name}"' for name in names)}
    return HEAD.format(**{**numbers, **changed})


class JoinedFilms(ProgramTest):
    def run_files(self, path, name, *options):
        out = self.folder / name
        self.expect(self.call("run", path, "--out", out, "--no-pictures",
                              "--no-report", *options), 0)
        return out, self.result(out)

    def test_gradients_are_exact(self):
        for seed in some(range(6), 3):
            with self.subTest(seed=seed):
                self.expect(self.call("check-gradient", self.case(ribbed(seed))), 0,
                            "all 12 derivatives agree")

    def test_lines_move_with_the_design_by_millimetres(self):
        """As a model that is frozen there has it."""
        for seed in some(range(6), 3):
            with self.subTest(seed=seed):
                path = self.case(ribbed(seed))
                sweep = self.case(ribbed(seed) + (
                    '\n[study]\nkind = "sweep"\nmethod = "grid"\n'
                    'levels = { aside = 3 }\n'), "sweep.toml")
                first = float(re.search(r"aside]\ninitial = (.*)", ribbed(seed))[1])
                last = round(first + 1.5, 3)
                out = self.folder / f"sweep_{seed}"
                self.expect(self.call("run", sweep, "--out", out, "--no-pictures",
                                      "--no-report", "--set",
                                      f"design.aside.bounds=[{first - 1},{last}]"), 0)
                with open(out / "history.csv", encoding="utf-8") as rows:
                    moved = [row for row in csv.DictReader(rows)
                             if float(row["aside"]) == last]
                anew = self.run_files(path, f"anew_{seed}", "--set", f"aside={last}")[1]
                self.assertAlmostEqual(
                    float(moved[0]["energy"]) / anew["responses"]["energy"], 1.0,
                    delta=2e-3)

    def test_step_is_one_valid_solid(self):
        for seed in some((2, 0, 1)):
            with self.subTest(seed=seed):
                out, result = self.run_files(self.case(ribbed(seed)), f"step_{seed}")
                self.assertEqual(result["film"]["index"], 0)
                done = self.call("export", out, "--format", "step")
                self.expect(done, 0, "valid closed solid")
                gap = float(re.search(r"gap at edges ([^ ]*) mm",
                                      done.stdout + done.stderr)[1])
                self.assertLess(gap, 0.01)

    def test_walls_of_their_own_thickness_are_one_body(self):
        for seed, side in some(((1, "inside"), (0, "both"), (2, "outside"))):
            with self.subTest(seed=seed):
                text = ribbed(seed)
                names = re.search(r'films = \["skin", (.*)\]', text)[1]
                fillet = re.search(r"^fillet = .*$", text, re.M)[0]
                text = text.replace(f', {names}', "").replace(
                    "[materials.steel]", f"""[walls.ribs]
films = [{names}]
thickness = "0.6 * wall"
{fillet}
material = "steel"

[materials.steel]""").replace(fillet, f'{fillet}\nside = "{side}"', 1)
                path = self.case(text)
                out, _ = self.run_files(path, f"own_{seed}")
                self.expect(self.call("export", out, "--format", "step"), 0,
                            "valid closed solid")
                self.expect(self.call("check-gradient", path), 0,
                            "all 12 derivatives agree")

    def test_where_a_shelf_was_drawn_has_no_say(self):
        masses = []
        for share in some((0.35, 0.65, 0.5), 2):
            text = re.sub(r'"0\.\d+ \* high"', f'"{share} * high"', ribbed(2))
            masses.append(self.run_files(self.case(text), f"from_{share}")[1]
                          ["responses"]["mass"])
        for mass in masses:
            self.assertAlmostEqual(mass / masses[0], 1.0, delta=2e-3)

    def test_says_what_is_wrong_with_it(self):
        text = ribbed(1)
        for old, new, said in (
                ('joins = ["skin"]', 'joins = ["skim"]', r"no film 'skim'; did you mean 'skin'"),
                ('joins = ["skin"]', 'joins = ["rib_0"]', "joins itself"),
                ("free = [4]", "", r"all of its curves hold it"),
                ('joins = ["skin"]\n', "", r"is free, and 1 film ends there"),
                ('curves = ["base", "head"]\n',
                 'curves = ["base", "head"]\njoins = ["rib_0"]\n', "in a circle"),
                ("[walls.tube]",
                 '[films.twin]\nkind = "disk"\ncurves = ["rib_0"]\n'
                 'joins = ["skin"]\n\n[walls.tube]',
                 "a side that joins a film is of one film alone"),
                ('points = [["(foot + 0.0)', 'points = [["(foot - 2.0)',
                 r"'rib_0' joins skin along a line that ends at .* from the "
                 r"nearest")):
            with self.subTest(said=said):
                self.assertIn(old, text)
                self.expect(self.call("check",
                                      self.case(text.replace(old, new, 1))), 2, said)


if __name__ == "__main__":
    unittest.main()
