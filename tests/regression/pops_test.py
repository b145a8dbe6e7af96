#!/usr/bin/env python3
"""Junctions that no film keeps, popped at the freeze where a case asks for it:
plates about an axis, drawn at random, as walls and between bodies; and designs
at which films join in another way."""
import json
import random
import re
import unittest

from program import ProgramTest, some, without_seconds
from results_test import documented

# Four plates from the corners of a box, about an axis.
PLATES = """title = "Four plates"
units = "mm-N-MPa"

[design.wide]
initial = {wide}
bounds = [{least}, {most}]

[design.lean]
initial = {lean}
bounds = [-10.0, 10.0]

[design.pull]
initial = 1.0
bounds = [0.8, 1.2]

[curves.plate]
repeat = 4
kind = "polygon"
points = [
  [0, 0, 0],
  [0, 0, {tall}],
  ["wide / 2 * if(i == 1, 1, if(i == 4, 1, -1)) + lean", "{high} / 2 * if(i < 3, 1, -1)", {tall}],
  ["wide / 2 * if(i == 1, 1, if(i == 4, 1, -1))", "{high} / 2 * if(i < 3, 1, -1)", 0],
]
free = [1]

[films.plate]
repeat = 4
kind = "disk"
curves = ["plate_{{i}}"]
tension = "pull"

[walls.plates]
films = [{{ name = "plate_{{i}}", repeat = 4 }}]
thickness = 1
fillet = 0.5
material = "steel"

[materials.steel]
youngs_modulus = 210000
poisson_ratio = 0.3
density = "7850 kg/m^3"

[load_cases.service]
supports = [{{ on = "plate_1/rim:plate_1", fix = "xyz" }}]
loads = [{{ on = "plate_3", pressure = 0.1 }}]

[responses.area]
kind = "film_area"

[responses.mass]
kind = "mass"

[responses.stiff]
kind = "compliance"
load_case = "service"

[analysis]
buckling = 0

[resolution]
fea = {edge}
{pop}
"""
# The same between four bodies of one material, a pressure in the first.
CELLS = """title = "Four cells"
units = "mm-N-MPa"

[design.wide]
initial = {wide}
bounds = [20.0, 40.0]

[design.pull]
initial = 1.0
bounds = [0.8, 1.2]

[design.blow]
initial = {blow}
bounds = [-0.01, 0.01]

[parameters]
tall = 30
high = {high}

[curves.plate]
repeat = 4
kind = "polygon"
points = [[0, 0, 0], [0, 0, "tall"], {top}, {low}]
free = [1]

[curves.low]
repeat = 4
kind = "polygon"
points = [[0, 0, 0], {low}, {next_low}]

[curves.top]
repeat = 4
kind = "polygon"
points = [[0, 0, "tall"], {top}, {next_top}]

[curves.side]
repeat = 4
kind = "polygon"
points = [{low}, {next_low}, {next_top}, {top}]

[films.plate]
repeat = 4
kind = "disk"
curves = ["plate_{{i}}"]
tension = "pull"

[solids.floor]
repeat = 4
kind = "cap"
curve = "low_{{i}}"

[solids.lid]
repeat = 4
kind = "cap"
curve = "top_{{i}}"

[solids.face]
repeat = 4
kind = "cap"
curve = "side_{{i}}"

[bodies.cell]
repeat = 4
enclosed_by = ["plate_{{i}}", "plate_{{i % 4 + 1}}", "floor_{{i}}", "lid_{{i}}", "face_{{i}}"]
pressure = "if(i == 1, blow, 0)"
material = "steel"

[materials.steel]
youngs_modulus = 210000
poisson_ratio = 0.3
density = "7850 kg/m^3"

[load_cases.service]
supports = [{{ on = "floor_1", fix = "xyz" }}, {{ on = "floor_3", fix = "xyz" }}]
loads = [{{ on = "lid_2", force = [100, 0, -50] }}]

[responses.mass]
kind = "mass"

[responses.area]
kind = "film_area"

[responses.stiff]
kind = "compliance"
load_case = "service"

[responses.sway]
kind = "mean_displacement"
on = "lid_3"
direction = [1, 0, 0]

[analysis]
buckling = 0

[resolution]
fea = 4
pop = true
"""
POP = "pop = true"
SWEEP = """
[study]
kind = "sweep"
method = "grid"
levels = { wide = 7 }
"""


def plates(seed, **changed):
    draw = random.Random(seed)
    numbers = {"wide": draw.uniform(24, 30), "high": draw.uniform(14, 18),
               "lean": draw.uniform(-2, 2), "tall": 30, "edge": 4, "pop": POP,
               "least": 5, "most": 60}
    return PLATES.format(**{**numbers, **changed})


def cells(seed):
    draw = random.Random(seed)
    corner = ["wide / 2 * if(i == 1, 1, if(i == 4, 1, -1))",
              "high / 2 * if(i < 3, 1, -1)"]
    following = ["wide / 2 * if(i == 4, 1, if(i == 3, 1, -1))",
                 "high / 2 * if(i == 4, 1, if(i == 1, 1, -1))"]
    return CELLS.format(wide=draw.uniform(24, 30), high=draw.uniform(14, 18),
                        blow=draw.uniform(-0.006, 0.006),
                        low=json.dumps([*corner, 0]),
                        top=json.dumps([*corner, "tall"]),
                        next_low=json.dumps([*following, 0]),
                        next_top=json.dumps([*following, "tall"]))


class Pops(ProgramTest):
    def test_only_where_asked(self):
        as_drawn = self.case(plates(1, pop=""))
        self.expect(self.call("run", as_drawn, "--out", self.folder / "drawn"),
                    3, "more than three films meet along the line.*"
                    "resolution.pop = true the film stands")
        result = self.run_at(plates(1), "popped")
        film = result["film"]
        self.assertEqual((film["verdict"], film["index"]), ("stable", 0))
        popped, = result["popped"]
        self.assertEqual(set(popped), documented()["popped"])
        self.assertEqual(popped["name"], "popped1")
        self.assertIn(popped["pulled_from"], [f"plate_{k}" for k in range(1, 5)])
        self.assertGreater(popped["area"], 30)
        self.assertAlmostEqual(popped["place"][2], 15, delta=1.5)
        # Its wall is that of the plates.
        self.assertAlmostEqual(result["responses"]["mass"] /
                               (7.85e-9 * result["responses"]["area"]), 1,
                               delta=0.1)

    # Lines keep their ends: on a plane of symmetry the film would open there.
    def test_not_at_planes_that_lines_end_at(self):
        half = plates(1).replace(" + lean", "") + """
[symmetry]
planes = [{ at = [0, 0, 15], normal = [0, 0, 1] }]
"""
        self.expect(self.call("evolve", self.case(half), "--out",
                              self.folder / "half"), 3,
                    "the line where more than three films meet ends at a wall, "
                    r"at \(.*, 15\).*draw the film that comes between")

    def test_gradients_are_exact(self):
        for seed in some((2, 3)):
            self.expect(self.call("check-gradient", self.case(plates(seed))), 0,
                        "all 9 derivatives agree")

    def sweep_at(self, name, more="", **options):
        text = plates(5, tall=60, high=16, wide=20, lean=0, least=5,
                      most=23) + SWEEP + more
        return self.run_at(text, name, **options)

    # Where the two lines run into each other a study says so, and where.
    def test_a_sweep_tells_where_films_join_in_another_way(self):
        result = self.sweep_at("told", "refreeze = false\n")
        event, = result["topology"]
        self.assertEqual(set(event), documented()["topology"])
        self.assertEqual(event["kind"], "film_rejoins")
        self.assertEqual(event["designs"],
                         result["sweep"]["failures"]["film_rejoins"])
        self.assertEqual(event["parameters"]["wide"], 8)  # of 5 and 8
        self.assertIn("two lines of film 'popped1' run together at",
                      event["message"])
        self.assertNotIn("refrozen", result)

    # ... and goes on with the films that are there.
    def test_a_sweep_freezes_anew_where_films_join_in_another_way(self):
        result = self.sweep_at("anew")
        self.assertEqual(result["topology"][0]["designs"], 2)
        self.assertNotIn("film_rejoins", result["sweep"].get("failures", {}))
        anew, = result["refrozen"]
        self.assertEqual(anew["reason"], "films join in another way there")
        self.assertEqual(anew["parameters"]["wide"], 5)
        # What a case that is drawn there has.
        alone = self.run_at(plates(5, tall=60, high=16, wide=5, lean=0),
                            "alone")
        least = result["sweep"]["responses"]["area"]
        self.assertEqual(least["least_at"]["wide"], 5)
        self.assertAlmostEqual(least["least"] / alone["responses"]["area"], 1,
                               delta=2e-3)
        # The same from its database, and by two jobs.
        for name, more in (("anew", ["--resume"]), ("jobs", ["--jobs", 2])):
            out = self.folder / name
            self.expect(self.call("run", self.folder / "anew.toml", "--out",
                                  out, "--no-pictures", "--no-report", *more),
                        0)
            again = self.result(out)
            for key in ("topology", "refrozen", "sweep", "responses",
                        "evaluations"):
                self.assertEqual(again[key], result[key], (name, key))

    # The best design is put on a model of its own, of the films that it has.
    def test_the_best_of_a_sweep_may_have_other_films(self):
        result = self.sweep_at("best", 'objective = "area"\n')
        self.assertEqual(result["parameters"]["wide"], 5)
        self.assertEqual(len(result["popped"]), 1)
        self.assertIn(len(result["refrozen"]), (1, 2))

    # The least area is beyond the end of the bridge, where films join as on the
    # other side of it.
    def test_a_minimum_goes_on_with_the_films_beyond(self):
        study = """
[study]
kind = "minimize"
objective = "area"
tolerance = 1e-3
"""
        fixed = plates(6, tall=60, high=16, wide=20, lean=0, least=5, most=23)
        fixed = fixed.replace("[-10.0, 10.0]", "[0, 0]").replace(
            "[0.8, 1.2]", "[1, 1]")
        result = self.run_at(fixed + study, "beyond")
        self.assertAlmostEqual(result["parameters"]["wide"], 5, delta=1e-3)
        self.assertIn("films join in another way there, beside the best design",
                      [r["reason"] for r in result["refrozen"]])
        self.call("run", self.case(fixed + study + "refreeze = false\n"),
                  "--out", self.folder / "stays", "--no-pictures",
                  "--no-report")
        stays = self.result(self.folder / "stays")
        self.assertGreater(stays["parameters"]["wide"], 9)
        self.expect(self.call("run", self.folder / "beyond.toml", "--out",
                              self.folder / "beyond", "--resume",
                              "--no-pictures", "--no-report"), 0)
        again = self.result(self.folder / "beyond")
        for key in ("parameters", "responses", "refrozen", "topology",
                    "evaluations"):
            self.assertEqual(again[key], result[key], key)

    def test_a_match_finds_its_target_beyond(self):
        text = plates(6, tall=60, high=16, wide=20, lean=0, least=5, most=23)
        text = text.replace("[-10.0, 10.0]", "[0, 0]").replace(
            "[0.8, 1.2]", "[1, 1]")
        result = self.run_at(text + """
[study]
kind = "match"
targets = { area = 1700 }
""", "match")
        self.assertEqual(result["status"], "converged")
        self.assertLess(result["parameters"]["wide"], 9)
        self.assertAlmostEqual(result["responses"]["area"], 1700, delta=2)

    def test_between_bodies(self):
        for seed in some((7, 8)):
            text = cells(seed)
            result = self.run_at(text, f"cells_{seed}")
            self.assertEqual(len(result["popped"]), 1)
            wide = result["parameters"]["wide"]
            high = float(re.search(r"^high = (\S+)", text, re.M).group(1))
            # Together they fill their box.
            self.assertAlmostEqual(
                result["responses"]["mass"] / (7.85e-9 * wide * high * 30), 1,
                delta=1e-9)
            self.expect(self.call("check-gradient",
                                  self.folder / f"cells_{seed}.toml"), 0,
                        "all 12 derivatives agree")

    def test_same_bits_for_any_thread_count(self):
        found = []
        for threads in ("1", "2"):
            result = self.run_at(plates(4), f"threads_{threads}",
                                 env={"OMP_NUM_THREADS": threads})
            for key in ("ledger", "case", "case_hash", "process_memory"):
                result.pop(key, None)
            text = json.dumps(without_seconds(result))
            found.append(text.replace(f"threads_{threads}", "threads"))
        self.assertEqual(found[0], found[1])


if __name__ == "__main__":
    unittest.main()
