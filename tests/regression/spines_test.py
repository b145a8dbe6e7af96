#!/usr/bin/env python3
"""Liquid held along spines, as users write it: arms of any length and networks
of them, exact gradients by points and radii, mistakes told by line."""
import json
import math
import pathlib
import random
import re
import tomllib
import unittest

from program import ProgramTest, some


def circle(name, center, normal, radius):
    return f"""
[curves.{name}]
kind = "circle"
center = {list(center)}
normal = {list(normal)}
radius = {radius}

[solids.{name}_pad]
kind = "cap"
curve = "{name}"
"""


def spine(name, points, radius, more=""):
    return f"""
[spines.{name}]
points = {[list(p) for p in points]}
radius = {radius}
{more}
"""


def part(title, rims, spines, top="", loads="", resolution=6.0):
    """`rims`: text of circle(), by name of the curve."""
    names = list(rims)
    quoted = ", ".join(f'"{name}"' for name in names)
    pads = ", ".join(f'"{name}_pad"' for name in names)
    return f"""title = "{title}"
units = "mm-N-MPa"
{top}
{"".join(rims.values())}
[films.skin]
kind = "spines"
curves = [{quoted}]
{"".join(spines)}
[bodies.part]
enclosed_by = ["skin", {pads}]
material = "steel"

[materials.steel]
youngs_modulus = 2e5
poisson_ratio = 0.3
density = 7.85e-9

[load_cases.service]
supports = [{{ on = "{names[0]}_pad", fix = "xyz" }}]
loads = [{loads or f'{{ on = "{names[-1]}_pad", force = [0, 100, -300] }}'}]

[responses.mass]
kind = "mass"

[responses.sway]
kind = "mean_displacement"
on = "{names[-1]}_pad"
direction = [0, 0, 1]

[analysis]
buckling = 0

[resolution]
fea = {resolution}
"""


# A stem and two arms; reach, radii and the joint's place may follow the design.
TREE = part(
    "A tree of three spines",
    {"foot": circle("foot", [0, 0, 0], [0, 0, -1], 12),
     "left": circle("left", ["-reach", 0, 100], [-1, 0, 0], 9),
     "right": circle("right", [80, 0, 100], [1, 0, 0], 9)},
    [spine("stem", [[0, 0, 0], [0, 0, "joint"]], ["12", "thick"]),
     spine("left_arm", [[0, 0, "joint"], ["-0.5 * reach", 0, 97],
                        ["-reach", 0, 100]], ["thick", 9, 9]),
     spine("right_arm", [[0, 0, "joint"], [40, 0, 97], [80, 0, 100]],
           ["thick", 9, 9])],
    top="""
[design.reach]
initial = 80
bounds = [60, 100]

[design.joint]
initial = 70
bounds = [55, 80]

[design.thick]
initial = 11
bounds = [9, 14]
""", resolution=7.0)


class Spines(ProgramTest):
    def run_case(self, text, *more, name="case", expect=0):
        (self.folder / f"{name}.toml").write_text(text)
        done = self.call("run", f"{name}.toml", "--out", name, "--no-pictures",
                         *more)
        self.assertEqual(done.returncode, expect, done.stdout + done.stderr)
        return json.loads((self.folder / name / "result.json").read_text())

    def test_a_slender_arm_is_the_tube_that_it_says(self):
        # L / R = 24, where volume alone stands to 6.28: mass of the cylinder.
        length, radius = 240.0, 10.0
        text = part("A rod", {
            "low": circle("low", [0, 0, 0], [0, 0, -1], radius),
            "high": circle("high", [0, 0, length], [0, 0, 1], radius)},
            [spine("rod", [[0, 0, 0], [0, 0, length]], radius)],
            loads='{ on = "high_pad", force = [300, 0, 0] }', resolution=5.0)
        found = self.run_case(text)
        self.assertEqual(found["film"]["index"], 0)
        self.assertAlmostEqual(
            found["responses"]["mass"]["value"] if isinstance(
                found["responses"]["mass"], dict) else
            found["responses"]["mass"],
            math.pi * radius ** 2 * length * 7.85e-9,
            delta=0.01 * math.pi * radius ** 2 * length * 7.85e-9)

    def test_a_datafile_of_spines_is_refused(self):
        rims = {"low": circle("low", [0, 0, 0], [0, 0, -1], 10),
                "high": circle("high", [0, 0, 50], [0, 0, 1], 10)}
        self.run_case(part("A rod", rims,
                           [spine("rod", [[0, 0, 0], [0, 0, 50]], 10)],
                           resolution=8))
        done = self.call("export", "case", "--format", "fe")
        self.assertEqual(done.returncode, 2, done.stdout + done.stderr)
        self.assertIn("held by spines", done.stdout + done.stderr)

    def test_gradients_are_exact(self):
        (self.folder / "tree.toml").write_text(TREE)
        done = self.call("check-gradient", "tree.toml", timeout=300)
        self.assertEqual(done.returncode, 0, done.stdout + done.stderr)

    def test_random_networks_stand(self):
        # Trees of three to six arms from one joint, in directions of any kind
        # that are not too near each other.
        draw = random.Random(26)
        for trial in some(range(4), 2):
            radius = 8.0
            directions = []
            while len(directions) < 3 + trial % 4:
                d = [draw.gauss(0, 1) for _ in range(3)]
                size = math.sqrt(sum(x * x for x in d))
                d = [x / size for x in d]
                if all(sum(a * b for a, b in zip(d, e)) < 0.3
                       for e in directions):
                    directions.append(d)
            lengths = [draw.uniform(40, 110) for _ in directions]
            rims, spines = {}, []
            for k, (d, length) in enumerate(zip(directions, lengths)):
                end = [round(length * x, 6) for x in d]
                rims[f"end_{k}"] = circle(f"end_{k}", end, d,
                                          radius * draw.uniform(0.9, 1.4))
                spines.append(spine(f"arm_{k}", [[0, 0, 0], end],
                                    [radius, radius]))
            found = self.run_case(part(f"Network {trial}", rims, spines,
                                       resolution=5.0), name=f"net_{trial}")
            self.assertEqual(found["film"]["index"], 0, trial)

    def test_suction_keeps_arms_side_by_side_from_one_web(self):
        # Two rods four radii apart that a third one joins in the middle.
        radius, length, apart = 10.0, 160.0, 40.0
        rims = {}
        for name, side in (("one", -0.5), ("two", 0.5)):
            for end, x, out in (("low", 0, -1), ("high", length, 1)):
                rims[f"{name}_{end}"] = circle(
                    f"{name}_{end}", [x, side * apart, 0], [out, 0, 0], radius)
        ends = {"one": [[0, -20, 0], [length, -20, 0]],
                "two": [[0, 20, 0], [length, 20, 0]],
                "bridge": [[80, -20, 0], [80, 20, 0]]}
        rods = math.pi * radius ** 2 * 2 * length * 7.85e-9
        masses = {}
        for suction in (0.0, 0.2):
            text = part("Two rods", rims, [
                spine(name, points, radius, f"tension = {1 + radius * suction}")
                for name, points in ends.items()], resolution=5.0)
            text = text.replace('material = "steel"\n',
                                f'material = "steel"\npressure = {-suction}\n',
                                1)
            masses[suction] = self.run_case(
                text, "--no-report")["responses"]["mass"] / rods
        self.assertGreater(masses[0.0], 1.8)
        self.assertLess(masses[0.2], 1.2)

    def test_a_frame_of_arms_stands_wherever_it_is_drawn(self):
        # Eight arms between two eyes and four washers, close beside each other:
        # half of such starts used to end far from rest, or on folded facets.
        frame = pathlib.Path(__file__).parent / "frame.toml"
        knees = tomllib.loads(frame.read_text())["design"]["knee"]["initial"]
        chance = random.Random(11)
        moved = [word for i, arm in enumerate(knees, 1)
                 for k, point in enumerate(arm, 1)
                 for c, at in enumerate(point, 1)
                 for word in ("--set", f"knee[{i},{k},{c}]="
                              f"{at + chance.uniform(-1, 1):.6g}")]
        for number, places in enumerate(some((moved, []))):
            done = self.call("evolve", frame, "--out", f"frame_{number}",
                             "--no-pictures", *places, timeout=300)
            self.expect(done, 0, "film: stable")

    def test_an_arm_may_pass_over_a_bore(self):
        # From the eye around it, up and across its axis at three radii.
        rims = {"top": circle("top", [0, 0, 8], [0, 0, 1], 8),
                "under": circle("under", [0, 0, 0], [0, 0, -1], 8),
                "end": circle("end", [-40, 0, 32], [-1, 0, 0], 5)}
        text = part("An arm over a bore", rims, [
            """
[spines.eye]
points = [{ at = ["13 * cos(i * pi / 4)", "13 * sin(i * pi / 4)", 4], repeat = 9 }]
radius = 6
""", spine("arm", [[13, 0, 4], [24, 0, 16], [14, 0, 30], [-40, 0, 32]], 5)],
                    resolution=3.0)
        bore = """
[solids.bore]
kind = "ring"
curve = "top"
inner = "under"
"""
        for pad in ("top", "under"):
            text = text.replace(f"""
[solids.{pad}_pad]
kind = "cap"
curve = "{pad}"
""", "")
        text = text.replace('"top_pad", "under_pad"', '"bore"').replace(
            '"top_pad"', '"bore"').replace("[films.skin]", bore + "[films.skin]")
        found = self.run_case(text, "--no-report")
        self.assertEqual(found["film"]["index"], 0)
        # An eye of 6 mm about 13 mm without its bore, and 90 mm of arm.
        self.assertLess(abs(found["responses"]["mass"] / 7.85e-9 / 15000 - 1),
                        0.4)

    def test_a_spine_is_proposed_for_an_arm_that_cannot_stand(self):
        def rod(length):
            rims = {"low": circle("low", [0, 0, 0], [0, 0, -1], 10),
                    "high": circle("high", [0, 0, length], [0, 0, 1], 10)}
            text = part("A rod", rims, [])
            return text.replace('"spines"', '"loft"').replace(
                "[bodies.part]\n",
                f"[bodies.part]\nvolume = {math.pi * 100 * length}\n")
        (self.folder / "rod.toml").write_text(rod(66))
        done = self.call("check", "rod.toml")
        told = done.stdout + done.stderr
        self.assertEqual(done.returncode, 0, told)
        found = re.search(r"rod\.toml:\d+: warning: film 'skin' is 6\.6 times as long.*"
                          r"(\[spines\.skin\]) with (points = .*\]), "
                          r"(radius = .*\])", told)
        self.assertTrue(found, told)
        # What it proposes stands.
        (self.folder / "held.toml").write_text(
            rod(66).replace("[bodies.part]", "\n".join(found.groups()) +
                            "\n\n[bodies.part]"))
        done = self.call("evolve", "held.toml", "--no-pictures")
        self.assertEqual(done.returncode, 0, done.stdout + done.stderr)
        (self.folder / "short.toml").write_text(rod(60))
        told = self.call("check", "short.toml")
        self.assertNotIn("spine", told.stdout + told.stderr)

    def test_mistakes_are_told_by_line(self):
        cases = [
            (TREE.replace("radius = ['12', 'thick']", "radius = [12, 11, 10]"),
             r"spines\.stem\.radius has 3 for 2 points"),
            (TREE.replace("radius = ['12', 'thick']", "radius = -2"),
             r"spines\.stem\.radius.*above 0"),
            (TREE.replace("[spines.stem]", '[spines.stem]\nbody = "prt"'),
             r"body 'prt'.*part"),
            (TREE.replace("[spines.stem]", '[spines.stem]\nkind = "arc"'),
             r"spline"),
            (TREE.replace("[80, 0, 100]], ", "[80, 0, 80]], ", 1)
             .replace("[40, 0, 97], [80, 0, 100]]", "[40, 0, 97], [80, 0, 80]]"),
             r"no spine ends at its curve 'right'"),
        ]
        for number, (text, message) in enumerate(cases):
            self.assertNotEqual(text, TREE, number)
            (self.folder / "wrong.toml").write_text(text)
            done = self.call("check", "wrong.toml")
            told = done.stdout + done.stderr
            self.assertNotEqual(done.returncode, 0, told)
            self.assertRegex(told, message)
            self.assertRegex(told, r"wrong\.toml:\d+")


if __name__ == "__main__":
    unittest.main(verbosity=2)
