#!/usr/bin/env python3
"""What stands behind the +- of films: tripods drawn at random, near a collapse
and far from one, on a mesh as users take it, against facets four times finer
on another mesh. MENISCUS_FILM_ERRORS=N for N tripods; three otherwise."""
import os
import random
import statistics
import unittest

from program import ProgramTest

COUNT = int(os.environ.get("MENISCUS_FILM_ERRORS", "3"))
NAMES = ("margin", "area", "inside")

CASE = """title = "A random tripod"
units = "mm-N-MPa"
parameters = {{ ring = {ring}, height = {height}, foot = {foot}, head = {head} }}
films.skin = {{ kind = "branch", curves = ["foot_1", "foot_2", "foot_3", "head"] }}
solids.pad = {{ kind = "cap", curve = "foot_{{i}}", repeat = 3 }}
solids.seat = {{ kind = "cap", curve = "head" }}
study = {{ kind = "analyse" }}
resolution = {{ fea = {edge} }}

[curves.foot]
kind = "circle"
center = ["ring * cos({turn} + 2 * pi * i / 3)", "ring * sin({turn} + 2 * pi * i / 3)", 0]
normal = [0, 0, -1]
radius = "foot"
repeat = 3

[curves.head]
kind = "circle"
center = ["{aside} * ring", 0, "height"]
normal = [0, 0, 1]
radius = "head"

[bodies.tripod]
enclosed_by = ["skin", "pad_1", "pad_2", "pad_3", "seat"]
volume = "1.3 * {fill} * 3 * pi * foot^2 * sqrt(ring^2 + height^2)"
material = "aluminium"

[materials.aluminium]
youngs_modulus = "71.7 GPa"
poisson_ratio = 0.33
density = "2800 kg/m3"

[load_cases.service]
supports = [{{ on = "pad_{{i}}", fix = "xyz", repeat = 3 }}]
loads = [{{ on = "seat", force = [1000, 0, -3000] }}]

[responses]
margin = {{ kind = "collapse_margin" }}
area = {{ kind = "film_area" }}
inside = {{ kind = "pressure", body = "tripod" }}
"""


def draw(seed):
    r = random.Random(f"film errors {seed}")
    ring = r.uniform(25, 80)
    return ring, CASE.format(
        ring=ring, edge=ring / 6, height=ring * r.uniform(0.8, 2.0),
        foot=ring * r.uniform(0.22, 0.42), head=ring * r.uniform(0.22, 0.5),
        fill=r.uniform(0.55, 1.3), turn=r.uniform(0, 2),
        aside=r.uniform(-0.2, 0.2))


class FilmErrors(ProgramTest):
    def figures(self, seed, text, edge, film):
        """{name: (value, bar)} of a mesh; None: there is no film."""
        result = self.analyse_at(f"tripod_{seed}", text, edge, film)
        if result is None:
            return None
        return {name: (result["responses"][name],
                       result["response_errors"][name]) for name in NAMES}

    def test_bars_are_as_wide_as_the_error(self):
        rows = []
        tripods = 0
        for seed in range(20 * COUNT):
            ring, text = draw(seed)
            here = self.figures(seed, text, ring / 6, ring / 12)
            there = here and self.figures(seed, text, ring / 12, ring / 48)
            if not there:
                continue  # a film that does not stand has no error
            tripods += 1
            for name, (value, bar) in here.items():
                known = there[name][1]
                error = abs(value - there[name][0])
                rows.append(((bar + known) / error, bar / (error + known), name,
                             seed, value, bar, there[name][0], known))
            if tripods == COUNT:
                break
        self.assertEqual(tripods, COUNT)
        for row in sorted(rows):
            print("%.2f to %.2f  %s of tripod %d: %.5g +- %.2g, finer %.5g "
                  "+- %.2g" % (row[1], *(row[0], *row[2:])))
        for name in NAMES:
            own = [row for row in rows if row[2] == name]
            self.assertGreaterEqual(sum(row[0] >= 1.0 for row in own),
                                    0.95 * len(own), name)
            # A bar that covers all because it is huge says nothing.
            self.assertLess(statistics.median(row[1] for row in own), 3.0, name)


if __name__ == "__main__":
    unittest.main(verbosity=2)
