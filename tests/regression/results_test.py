#!/usr/bin/env python3
"""result.json and docs/results.md have the same keys; exclusion zones and
adaptive refinement from a case file to the files of a run."""
import json
import re
import unittest

import program
from program import ProgramTest, strut

CASE = """title = "A strut"
units = "mm-N-MPa"

[parameters]
load = 1000.0

[design.foot]
initial = 25.0
bounds = [20.0, 32.0]
""" + strut('"foot"', 60, "sole") + """
[resolution]
fea = 12.0

[materials.aluminium]
youngs_modulus = 71700.0
poisson_ratio = 0.33
density = 2.8e-9
yield_strength = 400

[load_cases.push]
supports = [{ on = "sole", fix = "xyz" }]
loads = [{ on = "top", force = ["load", 0, 0] }]

[responses.sway]
kind = "mean_displacement"
on = "top"
direction = [1, 0, 0]

[responses.summit]
kind = "max_von_mises"
"""

ANALYSIS = """
[analysis]
adapt = true
exclude = [{ near = "sole", distance = 10 }]
"""

STUDY = """
[study]
kind = "match"
targets = { sway = 5.8e-3 }
tolerance = 0.005
"""

# What multipliers_test.py, refreeze_test.py, pops_test.py and shells_test.py
# look at.
ELSEWHERE = {"envelopes", "norm_peaks", "refrozen", "popped", "topology",
             "multipliers", "shell"}
# Kinds of study with a part of result.json of their own.
OTHER_STUDIES = {
    "sweep": 'kind = "sweep"\ncount = 2\n',
    "tolerance": 'kind = "tolerance"\ndeviations = { foot = 0.1 }\n'
                 'count = 2\n',
    "coarse": 'kind = "match"\ntargets = { sway = 0.0058 }\n'
              'coarse_first = 2\n',
    "finer_film": 'kind = "analyse"\n',
    "front": 'kind = "pareto"\nobjectives = ["sway", "weight"]\ncount = 3\n',
}
WEIGHT = ('\n[responses.weight]\nkind = "mass"\n'
          '[responses.skin_area]\nkind = "film_area"\n\n[study]\n')

# What the case calls things: no keys of the schema.
NAMES = {"foot", "load", "sway", "summit", "push", "part", "sway = 0.0058",
         "weight", "skin_area"}


# Of the solver petsc alone.
PETSC = {"process_memory"}


def no_number(text):
    raise ValueError(f"{text} is no JSON")


def nested_keys(value):
    if isinstance(value, list):
        return set().union(*map(nested_keys, value))
    if not isinstance(value, dict):
        return set()
    return set(value).union(*map(nested_keys, value.values())) - NAMES


def documented():
    """Top-level keys with the nested ones that their row names."""
    text = (program.ROOT / "docs" / "results.md").read_text()
    table = text.split("\n## result.json\n")[1].split("\n## ")[0]
    rows = {}
    for line in table.splitlines():
        if line.startswith("| `"):
            keys, meaning = re.split(r"(?<!\\)\|", line)[1:3]
            for key in re.findall(r"`(\w+)`", keys):
                rows[key] = set(re.findall(r"`(\w+)`", meaning))
    return rows


class Results(ProgramTest):
    def run_case(self, text, name="out"):
        path = self.folder / "case.toml"
        path.write_text(text)
        out = self.folder / name
        self.expect(self.call("run", path, "--out", out, "--no-pictures"), 0)
        return out, json.loads((out / "result.json").read_text(),
                               parse_constant=no_number)

    def test_petsc_in_two_processes_comes_to_the_same(self):
        _, ours = self.run_case(CASE + STUDY)
        solver = '[analysis]\nsolver = "petsc"\nprocesses = 2\n'
        _, theirs = self.run_case(CASE + solver + STUDY, "petsc")
        self.assertEqual(theirs["fea"]["solver"], "petsc")
        self.assertEqual(len(theirs["fea"]["process_memory"]), 2)
        self.assertEqual(theirs["gradient_evaluations"], 0)
        for response, value in ours["start"]["responses"].items():
            self.assertAlmostEqual(
                theirs["start"]["responses"][response] / value, 1, 7)
        self.assertTrue(any("buckling" in text
                            for text in theirs["warnings"]))

    def test_every_key_is_documented_and_every_documented_key_occurs(self):
        free = 'frequencies = 1\nsupports_of = "free"\n'
        _, result = self.run_case(CASE + ANALYSIS + free + STUDY)
        # A factor far above 1 has an error where it was asked for.
        _, asked = self.run_case(CASE + "[analysis]\nbuckling = 1\n" + STUDY)
        result["buckling"]["push"].update(asked["buckling"]["push"])
        # The clamp, where it is not left out.
        result["stress"]["push"]["no_limit"] = (
            asked["stress"]["push"]["no_limit"])
        # A load from any direction.
        anywhere = CASE.replace('force = ["load", 0, 0]', 'size = "load"')
        _, worst = self.run_case(anywhere.split("[responses.summit]")[0] +
                                 '[study]\nkind = "analyse"\n', "anywhere")
        result["worst_directions"] = worst["worst_directions"]
        for load_case, key in (("push", "direction"),
                               ("push_x", "unit_load")):
            result["stress"]["push"][key] = worst["stress"][load_case][key]
        # A half, pulled: what lies in the plane is held by it.
        half = (CASE.split("[responses.sway]")[0]
                .replace('{ on = "sole", fix = "xyz" }',
                         '{ on = "top", fix = "xy" }')
                .replace('["load", 0, 0]', '[0, 0, "load"]') +
                '[responses]\nmass = { kind = "mass" }\n[symmetry]\n'
                'planes = [{ at = [0, 0, 0], normal = [0, 0, -1] }]\n' +
                '[study]\nkind = "analyse"\n')
        _, halved = self.run_case(half, "half")
        result["symmetry"] = halved["symmetry"]
        rows = documented()
        self.assertEqual(set(result) - ELSEWHERE,
                         set(rows) - set(OTHER_STUDIES) - ELSEWHERE)
        for key, study in OTHER_STUDIES.items():
            _, other = self.run_case(CASE + WEIGHT + study, key)
            result[key] = other[key]
        for key, value in result.items():
            self.assertEqual(nested_keys(value), rows[key] - PETSC, key)
        # Of a peak, what its largest reading says above it.
        self.assertGreaterEqual(
            result["element_errors"]["responses"]["summit"], 0)
        after = result["adaptation"]["after"]
        self.assertGreaterEqual(after["response_errors"]["summit"], 0)
        self.assertLess(after["energy_error"],
                        result["adaptation"]["before"]["energy_error"])
        self.assertEqual(after["elements"], result["tet"]["elements"])
        # At the design that the answer's model is frozen at.
        frozen = result["start"]["responses"]["sway"]
        for model in result.get("refrozen", []):
            frozen = model["responses"]["sway"] + model["shift"]["sway"]
        self.assertAlmostEqual(after["responses"]["sway"], frozen, 9)

    def test_the_fields_of_the_part_are_documented(self):
        out, _ = self.run_case(CASE + ANALYSIS.replace("true", "false"))
        text = (program.ROOT / "docs" / "results.md").read_text()
        row = re.search(r"^\| `part.vtu` \|(.*)$", text, re.MULTILINE).group(1)
        data = (out / "part.vtu").read_bytes()
        head = data.split(b"<AppendedData")[0]
        names = []
        for kind in (b"PointData", b"CellData"):
            part = head.split(b"<" + kind)[1].split(b"</" + kind)[0]
            names += re.findall(rb'<DataArray[^>]* Name="(\w+)"', part)
        self.assertEqual({name.decode() for name in names},
                         set(re.findall(r"`(\w+)`", row)))

    def test_an_exclusion_takes_the_clamp_out_of_the_peak(self):
        _, whole = self.run_case(CASE, "whole")
        _, counted = self.run_case(CASE + ANALYSIS.replace("true", "false"))
        stress = counted["stress"]["push"]
        self.assertEqual(set(counted) - set(whole), {"exclusion"})
        share = counted["exclusion"]["volume_share"]
        self.assertGreater(share, 0.1)
        self.assertLess(share, 0.4)
        self.assertEqual(stress["excluded"]["max_von_mises"],
                         whole["stress"]["push"]["max_von_mises"])
        self.assertEqual(stress["max_von_mises"],
                         counted["responses"]["summit"])
        self.assertLess(stress["max_von_mises"],
                        whole["responses"]["summit"])

    def test_a_zone_without_elements_is_refused_by_line(self):
        path = self.folder / "case.toml"
        path.write_text(CASE + ANALYSIS.replace("10", "0.001"))
        line = self.line_of(path, "exclude")
        self.expect(self.call("run", path, "--out", self.folder / "out"), 2,
                    rf"case.toml:{line}: analysis.exclude\[0\]: no element")


if __name__ == "__main__":
    unittest.main(verbosity=2)
