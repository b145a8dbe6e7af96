#!/usr/bin/env python3
"""Shells in files for other programs: CalculiX solves their decks beside us,
Nastran's are read by the book, Gmsh opens them, their bodies are closed."""
import math
import re
import struct
import xml.etree.ElementTree
import zipfile

import bulk_data
import program
import shells_test
from export_test import (AGREEMENT, Gmsh, difference, displacements,
                         edges_are_paired, nodal_field, run_program, volume_of)
from program import ProgramTest, some

# CalculiX makes six-node shells wedges of fifteen nodes: another element, with
# the same answer where both are fine enough.
EDGES = ("10", "5")
# Its difference to ours, from one edge to the half; the slowest drawn has
# 0.098, 0.051, 0.010 at edges of 10, 5, 2.5.
SHRINKS = 0.6
THICK = 0.025  # down to what walls of t / R = 0.05 leave,
FINE = 0.1  # from where there is not much


def cross(a, b):
    return [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2],
            a[0] * b[1] - a[1] * b[0]]


def less(a, b):
    return [x - y for x, y in zip(a, b)]


def unit(a):
    size = math.sqrt(sum(x * x for x in a))
    return [x / size for x in a]


def root_mean(ours, theirs):
    """Of the difference, over that of `ours`."""
    apart = sum((x - y) ** 2 for p, q in zip(ours, theirs)
                for x, y in zip(p, q))
    return math.sqrt(apart / sum(x * x for p in ours for x in p))


def steps(dat, count):
    """Displacements of all steps of CalculiX's .dat file."""
    return [displacements("displacements" + part, count)
            for part in dat.split("displacements")[1:]]


def deck_rows(deck, card):
    """Rows of numbers under a card that begins so."""
    rows = []
    for part in re.split(r"\n(?=\*)", deck):
        if part.startswith(card):
            rows += [[float(x) for x in line.split(",")]
                     for line in part.split("\n")[1:] if line.strip()]
    return rows


def to_middle(deck):
    """From each node to the middle of the wall, by the deck."""
    nodes = {int(n): x for n, *x in deck_rows(deck, "*NODE, NSET")}
    offset, even = re.search(
        r"OFFSET=(\S+?)(?:, NODAL THICKNESS)?\n(\S+)", deck).groups()
    thickness = {int(n): t for n, t in deck_rows(deck, "*NODAL THICKNESS")}
    normals = {n: [0.0, 0.0, 0.0] for n in nodes}
    for _, *facet in deck_rows(deck, "*ELEMENT"):
        a, b, c = (nodes[int(n)] for n in facet[:3])
        normal = unit(cross(less(b, a), less(c, a)))
        for n in facet:
            normals[int(n)] = [x + y for x, y in zip(normals[int(n)], normal)]
    return [[-float(offset) * thickness.get(n, float(even)) * x
             for x in unit(normals[n])] for n in sorted(nodes)]


class ShellFiles(ProgramTest):
    def run_case(self, text, edge, *formats, name="run"):
        case = self.folder / "case.toml"
        case.write_text(text)
        out = self.folder / f"{name}_{edge}"
        self.expect(self.call("run", case, "--no-pictures", "--out", out,
                              "--set", f"resolution.fea={edge}"), 0)
        files = {}
        for form in formats:
            files[form] = self.folder / f"{name}_{edge}.{form}"
            self.expect(self.call("export", out, "--format", form, "--out",
                                  files[form]), 0)
        return files

    def by_calculix(self, deck, name, count):
        (self.folder / f"{name}.inp").write_text(deck)
        run_program("ccx", "-i", name, folder=self.folder)
        return steps((self.folder / f"{name}.dat").read_text(), count)

    def differences(self, text, edge):
        """Root mean squares of each load case's, in the middle of the wall."""
        files = self.run_case(text, edge, "inp", "msh")
        deck, msh = (files[name].read_text() for name in ("inp", "msh"))
        names = re.findall(r'"displacement, (\S+) \[', msh)
        middle = to_middle(deck)
        found = []
        theirs = self.by_calculix(deck, "deck", len(middle))
        self.assertEqual(len(theirs), len(names))
        for name, other in zip(names, theirs):
            u = nodal_field(msh, f"displacement, {name} ")
            turned = nodal_field(msh, f"rotation, {name} ")
            own = [[x + y for x, y in zip(u[n], cross(turned[n], middle[n]))]
                   for n in range(len(u))]
            found.append(root_mean(own, other))
        return found

    def expect_the_same_limit(self, text):
        coarse, fine = (self.differences(text, edge) for edge in EDGES)
        for far, near in zip(coarse, fine):
            self.assertLess(near, max(SHRINKS * far, THICK),
                            (coarse, fine))
            self.assertLess(near, FINE, (coarse, fine))

    def test_calculix_finds_the_tubes_displacements(self):
        coarse = self.differences(shells_test.TUBE, "16")
        fine = self.differences(shells_test.TUBE, "8")
        self.assertLess(max(fine), 0.01, (coarse, fine))
        self.assertLess(sum(fine), 0.5 * sum(coarse), (coarse, fine))

    def test_calculix_bends_the_strip_as_far(self):
        self.assertLess(self.differences(shells_test.STRIP, "7")[0], 2e-3)

    # What acts along rims is all that acts, in both decks.
    def test_decks_have_what_pulls_rims(self):
        text = shells_test.STRIP.replace("force = [0, 0, 0.1]",
                                         "rim_tension = 5")
        self.assertLess(self.differences(text, "7")[0], 2e-3)
        file = self.run_case(text, "7", "bdf")["bdf"]
        bulk = bulk_data.read(file.read_text())
        ends = [x[0] for x in bulk.grids.values()]
        theirs = self.by_calculix(bulk_data.calculix_deck(bulk, 1), "bulk",
                                  len(ends))[0]
        far = [u[0] for x, u in zip(ends, theirs) if abs(x - 100) < 1e-9]
        for u in far:
            self.assertLess(abs(u / (5 * 100 / 1000) - 1), 2e-3)

    # As a rim's moment about itself: at its nodes.
    def test_decks_have_the_moments_of_rims(self):
        text = shells_test.STRIP.replace("force = [0, 0, 0.1]",
                                         "moment = [0, -2, 0]")
        self.assertLess(self.differences(text, "7")[0], 2e-3)
        file = self.run_case(text, "7", "bdf")["bdf"]
        bulk = bulk_data.read(file.read_text())
        ends = [x[0] for x in bulk.grids.values()]
        theirs = self.by_calculix(bulk_data.calculix_deck(bulk, 1), "bulk",
                                  len(ends))[0]
        for u in [u[2] for x, u in zip(ends, theirs) if abs(x - 100) < 1e-9]:
            self.assertLess(abs(u / (2 * 100 ** 2 / 2 / (1000 * 20 / 12))
                                - 1), 5e-3)

    def test_calculix_finds_what_is_moved_and_heated(self):
        for text in (
                shells_test.STRIP.replace(
                    'fix_rotation = "xyz" }]',
                    'fix_rotation = "xyz" }, { on = "plate/rim:end", fix = '
                    '"xz", displacement = [0.1, 0, 2] }]').replace(
                    "force = [0, 0, 0.1]", "force = [0, 0.1, 0]"),
                shells_test.STRIP.replace(
                    "poisson_ratio = 0",
                    "poisson_ratio = 0\nthermal_expansion = 2e-5").replace(
                    '{ on = "plate/rim:end", force = [0, 0, 0.1] }',
                    "{ temperature = 70, reference = 20 }")):
            self.assertLess(self.differences(text, "7")[0], 2e-3)
            file = self.run_case(text, "7", "bdf", "msh", name="bulk")
            bulk = bulk_data.read(file["bdf"].read_text())
            theirs = self.by_calculix(bulk_data.calculix_deck(bulk, 1), "bulk",
                                      len(bulk.grids))[0]
            ours = nodal_field(file["msh"].read_text(), "displacement, tip ")
            self.assertLess(root_mean(ours, theirs), 2e-3)

    # A step that holds the same again is not to lose it.
    def test_calculix_holds_two_steps_alike(self):
        strip = shells_test.STRIP
        case = strip[strip.index("[load_cases.tip]"):
                     strip.index("[responses.dip]")]
        text = strip.replace(case, case + case.replace("tip", "again").replace(
            "0.1", "0.3"))
        deck = self.run_case(text, "7", "inp")["inp"].read_text()
        first, second = self.by_calculix(deck, "twice", len(to_middle(deck)))
        self.assertLess(root_mean([[3 * x for x in u] for u in first], second),
                        1e-4)

    # CalculiX presses the face that normals point away from, and holds the
    # middle of the wall: drawn so that both mean the same.
    def test_calculix_finds_those_of_films_drawn_at_random(self):
        for seed in some(range(20, 24), 2):
            with self.subTest(seed=seed):
                text = shells_test.drawn(seed)
                # One node held, and rims pulled there, are other things to it.
                text = re.sub(r'\[load_cases\.afloat\].*?\n(?=\[)', "", text,
                              flags=re.S)
                text = re.sub(r'\[responses\.grown\].*?\n(?=\[)', "", text,
                              flags=re.S)
                text = re.sub(r'.*rim_tension.*\n', "", text)
                self.assertNotIn("afloat", text)
                text = re.sub(r'"skin/(inside|outside)", pressure',
                              '"skin/inside", pressure', text)
                if 'side = "both"' not in text:
                    text = re.sub(r'fix_rotation = "\w+"',
                                  'fix_rotation = "xyz"', text)
                self.expect_the_same_limit(text)

    # A strip turned in its plane and out of it, its root held along its own
    # axes: the same as where these are x, y, z.
    def test_axes_of_a_support_mean_the_same_to_calculix(self):
        plain = shells_test.STRIP.replace("poisson_ratio = 0", "poisson_ratio = 0.3")
        plain = plain.replace('fix = "xyz", fix_rotation = "xyz"',
                              'fix = "xz", fix_rotation = "y"')
        plain = plain.replace('{ on = "plate/rim:root", fix = "xz"', """
  { on = "plate/rim:side", fix = "y" },
  { on = "plate/rim:root", fix = "xz\"""").replace("[curves.end]", """
[curves.side]
kind = "polygon"
points = [[0, 20, 0], [100, 20, 0], [100, 20, 9], [0, 20, 9]]

[curves.end]""")
        first, second = [3, 4, 0], [-4, 3, 0]

        def turned(match):
            p = [float(x) for x in match.group(1).split(",")]
            return str([(p[0] * first[k] + p[1] * second[k]) / 5 +
                        (p[2] if k == 2 else 0) for k in range(3)])

        head, tail = plain.split("[films.plate]")
        head = re.sub(r"\[(-?\d+, -?\d+, -?\d+)\]", turned, head)
        aslant = (head + "[films.plate]" + tail).replace(
            'fix = "', f'axes = [{first}, {second}], fix = "')
        for text in (plain, aslant):
            found = self.differences(text, "5")
            self.assertLess(found[0], 0.01, found)

    def test_the_nastran_deck_says_the_same(self):
        text = shells_test.TUBE.replace('thickness = "wall"',
                                        'thickness = "wall * (1 + z / 200)"')
        # CalculiX ends, "zero coefficient", at moments of some rims' nodes;
        # the strip has them in both decks.
        text = re.sub(r'.*rim:low"\], moment.*\n', "", text)
        self.assertNotIn("moment", text)
        files = self.run_case(text, "16", "inp", "bdf")
        bulk = bulk_data.read(files["bdf"].read_text())
        self.assertEqual(len(bulk.sets), 3)  # the film and two rims
        # A step that is the first to hold rotations is another to CalculiX
        # where it is the first of all: each by itself.
        head, *load_cases = files["inp"].read_text().split("** load case")
        nodes = len(bulk.grids) - 1  # one is of the spin
        for subcase, load_case in enumerate(load_cases):
            own = self.by_calculix(f"{head}** load case{load_case}", "own",
                                   nodes)[0]
            theirs = self.by_calculix(
                bulk_data.calculix_deck(bulk, subcase + 1), "bulk", nodes)[0]
            self.assertLess(difference(own, theirs), 10 * AGREEMENT)

    def test_the_nastran_deck_says_where_the_wall_is(self):
        text = shells_test.STRIP.replace('material = "model"\n', """material = "model"
side = "inside"
""", 1).replace('fix = "xyz", fix_rotation = "xyz"',
                'fix = "xz", fix_rotation = "x", '
                'axes = [[0, 1, 0], [1, 0, 0]]')
        text = text.replace("loads = [{", """loads = [{ on = "plate/outside", pressure = 2 }, {""")
        text = text.replace('supports = [{', """supports = [
  { on = "plate/rim:end", fix = "xyz" }, {""")
        bulk = bulk_data.read(self.run_case(text, "7", "bdf")["bdf"].read_text())
        self.assertEqual({row[2] for row in bulk.shells.values()}, {-0.5})
        self.assertEqual({row[3] != [] for row in bulk.shells.values()},
                         {False})
        self.assertEqual(bulk.shell_properties, {1: (1, 1.0)})
        root = [n for n, x in bulk.grids.items() if abs(x[0]) < 1e-9]
        self.assertEqual(sorted(bulk.frames), sorted(root))
        z, x = bulk.axes[1][3:6], bulk.axes[1][6:9]
        self.assertEqual((z, x), ([0, 0, -1], [0, 1, 0]))
        held = {components: sorted(nodes)
                for components, nodes, value in bulk.held[1]
                if value == 0.0}
        self.assertEqual(held["134"], sorted(root))
        pressures = [row for rows in bulk.pressures.values() for row in rows]
        self.assertEqual({row[1] for row in pressures}, {-2.0})
        self.assertEqual(len(pressures), len(bulk.shells))

    def test_gmsh_finds_the_surface(self):
        file = self.run_case(shells_test.TUBE, "8", "msh")["msh"]
        gmsh = Gmsh(file)
        try:
            self.assertEqual(gmsh.names(2), ["skin"])
            self.assertEqual(gmsh.names(3), [])
            area = gmsh.volume(9)  # six-node triangles
        finally:
            gmsh.close()
        self.assertLess(abs(area / (2 * math.pi * 50 * 100) - 1), 1e-3)

    # Half of the wall on either side: Pappus' volume.
    def test_bodies_of_their_thickness_are_closed(self):
        text = shells_test.TUBE.replace('thickness = "wall"\n', """thickness = "wall * (3 + z / 50)"
side = "outside"
""")
        # Outside by half of it; what facets of arcs leave.
        exact = sum(2 * math.pi * (50 + t / 2) * t * 0.1
                    for t in (3 + (k + 0.5) / 500 - 1 for k in range(1000)))
        files = self.run_case(text, "8", "stl", "obj", "3mf")
        points, facets = [], []
        groups = set()
        for line in files["obj"].read_text().split("\n"):
            words = line.split()
            if words[:1] == ["v"]:
                points.append([float(x) for x in words[1:4]])
            elif words[:1] == ["f"]:
                facets.append([int(x.split("/")[0]) - 1 for x in words[1:]])
            elif words[:1] == ["g"]:
                groups.add(words[1])
        self.assertEqual(groups, {"skin", "skin/back", "skin/rim:low",
                                  "skin/rim:high"})
        self.assertTrue(edges_are_paired(facets))
        self.assertLess(abs(volume_of(points, facets) / exact - 1), 3e-3)
        data = files["stl"].read_bytes()
        self.assertEqual(struct.unpack_from("<I", data, 80)[0], len(facets))
        model = xml.etree.ElementTree.fromstring(
            zipfile.ZipFile(files["3mf"]).read("3D/3dmodel.model"))
        triangles = model.findall(".//{*}triangle")
        self.assertTrue(edges_are_paired(
            [[t.get(k) for k in ("v1", "v2", "v3")] for t in triangles]))
        self.assertEqual(len(triangles), len(facets))

    def test_what_no_file_can_say_is_told(self):
        self.run_case(shells_test.STRIP, "7")
        for form in ("step", "step-faceted"):
            done = self.expect(self.call("export", self.folder / "run_7",
                                         "--format", form), 2)
            self.assertIn("take [walls] in place of [shells]", done.stderr)


if __name__ == "__main__":
    program.unittest.main()
