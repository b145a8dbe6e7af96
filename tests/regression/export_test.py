#!/usr/bin/env python3
"""`meniscus export`: the programs that the files are for open them and find the
same part: Gmsh, admesh, Surface Evolver, CalculiX; 3MF and Nastran decks by
strict readers of their own."""
import collections
import ctypes
import ctypes.util
import json
import os
import re
import shutil
import struct
import subprocess
import tempfile
import unittest
import pathlib
import xml.etree.ElementTree
import zipfile

import bulk_data
import program
from program import COARSE, ProgramTest

FORMATS = ["stl", "3mf", "obj", "fe", "inp", "bdf", "msh", "vtu"]
SOLIDS = 1e-3  # of volume: what another program may find otherwise
# CalculiX prints seven digits.
AGREEMENT = 1e-6
# Evolver sums in doubles what is written to the last digit.
ENERGY = 1e-10


def run_program(*command, folder=None, timeout=120):
    """Output of a program that must end well; admesh writes the header of a
    binary file with what lies behind it."""
    done = subprocess.run([str(c) for c in command], capture_output=True,
                          text=True, errors="replace", timeout=timeout,
                          cwd=folder,
                          env={**os.environ, "LC_ALL": "C"})
    assert done.returncode == 0, f"{command}\n{done.stdout}\n{done.stderr}"
    return done.stdout + done.stderr


class Gmsh:
    """The model in a file, as Gmsh's own library has it."""

    def __init__(self, file):
        self.gmsh = ctypes.CDLL(ctypes.util.find_library("gmsh"))
        self.call("Initialize", 0, None, 0)
        self.call("OptionSetNumber", b"General.Verbosity", number(2))
        self.call("Open", str(file).encode())

    def call(self, name, *arguments):
        error = ctypes.c_int()
        getattr(self.gmsh, "gmsh" + name)(*arguments, ctypes.byref(error))
        assert error.value == 0, f"gmsh{name}: {error.value}"

    def close(self):
        self.call("Finalize")

    def determinants(self, element_type):
        """Weights of the integration points, and the Jacobian's determinants
        at those of all elements."""
        points, weights = Array(), Array()
        self.call("ModelMeshGetIntegrationPoints", element_type, b"Gauss4",
                  *points.out(), *weights.out())
        jacobians, found, places = Array(), Array(), Array()
        self.call("ModelMeshGetJacobians", element_type, points.data,
                  points.size, *jacobians.out(), *found.out(), *places.out(),
                  -1, size(0), size(1))
        return weights.values(), found.values()

    def volume(self, element_type=11):
        weights, found = self.determinants(element_type)
        return sum(weights[k % len(weights)] * d for k, d in enumerate(found))

    def names(self, dimension):
        tags = Array(ctypes.c_int)
        self.call("ModelGetPhysicalGroups", *tags.out(), dimension)
        names = []
        for tag in tags.values()[1::2]:
            name = ctypes.c_char_p()
            self.call("ModelGetPhysicalName", dimension, tag,
                      ctypes.byref(name))
            names.append(name.value.decode())
        return names


number = ctypes.c_double
size = ctypes.c_size_t


class Array:
    """One that a C function makes."""

    def __init__(self, kind=ctypes.c_double):
        self.data = ctypes.POINTER(kind)()
        self.size = size()

    def out(self):
        return ctypes.byref(self.data), ctypes.byref(self.size)

    def values(self):
        return self.data[:self.size.value]


def volume_of(points, facets):
    total = 0.0
    for a, b, c in ([points[k] for k in facet] for facet in facets):
        total += (a[0] * (b[1] * c[2] - b[2] * c[1]) +
                  a[1] * (b[2] * c[0] - b[0] * c[2]) +
                  a[2] * (b[0] * c[1] - b[1] * c[0])) / 6
    return total


def edges_are_paired(facets):
    """Every edge once in each direction."""
    edges = collections.Counter(
        (facet[k], facet[(k + 1) % 3]) for facet in facets for k in range(3))
    return all(n == 1 and edges[(b, a)] == 1 for (a, b), n in edges.items())


def nodal_field(msh, name):
    """The values of a $NodeData section, one list per node."""
    for section in msh.split("$NodeData\n")[1:]:
        lines = section.split("\n")
        if name in lines[1]:
            count = int(lines[7])
            return [[float(x) for x in line.split()[1:]]
                    for line in lines[8:8 + count]]
    raise AssertionError(f"no field {name}")


def displacements(dat, count):
    """Of the first step in CalculiX's .dat file."""
    lines = dat.split("displacements")[1].split("\n")[2:2 + count]
    return [[float(x) for x in line.split()[1:]] for line in lines]


def difference(a, b):
    """Largest over the largest."""
    largest = max(abs(x) for row in b for x in row)
    return max(abs(x - y) for p, q in zip(a, b)
               for x, y in zip(p, q)) / largest


class Export(ProgramTest):
    """One coarse run of a case; each test opens one file of it."""

    case = program.CASE
    chambers = 1
    title = b"Two-arm bracket"
    edges = COARSE

    @classmethod
    def setUpClass(cls):
        cls.home = pathlib.Path(tempfile.mkdtemp(prefix="meniscus export "))
        cls.out = cls.home / "run"
        run_program(program.PROGRAM, "run", cls.case, *cls.edges,
                    "--set", "study.kind=analyse", "--no-pictures", "--out",
                    cls.out)
        cls.found = json.loads((cls.out / "result.json").read_text())
        for name in FORMATS:
            run_program(program.PROGRAM, "export", cls.out, "--format", name,
                        "--out", cls.home / f"part.{name}")
        cls.volume = abs(volume_of(*cls.stl()))
        text = cls.case.read_text()
        cls.bodies = re.findall(r"^\[bodies\.(\w+)\]", text, re.M)
        cls.surfaces = set(re.findall(r"^\[(?:films|solids)\.(\w+)\]", text,
                                      re.M))

    @classmethod
    def tearDownClass(cls):
        shutil.rmtree(cls.home)

    @classmethod
    def stl(cls):
        data = (cls.home / "part.stl").read_bytes()
        count = struct.unpack_from("<I", data, 80)[0]
        number_of, facets = {}, []
        for k in range(count):
            c = struct.unpack_from("<9f", data, 84 + 50 * k + 12)
            facets.append([number_of.setdefault(c[3 * i:3 * i + 3],
                                                len(number_of))
                           for i in range(3)])
        return list(number_of), facets

    def file(self, name):
        return self.home / f"part.{name}"

    def text(self, name):
        return self.file(name).read_text()

    def test_each_file_says_where_it_is_from(self):
        for name in FORMATS:
            data = self.file(name).read_bytes()
            if name == "3mf":
                data = zipfile.ZipFile(self.file(name)).read(
                    "3D/3dmodel.model")
            if name == "vtu":  # its texts are compressed
                told = all(b'Name="%s"' % key in data
                           for key in (b"program", b"case_and_design"))
            else:
                told = (re.search(rb"Meniscus \d+\.\d+", data) and
                        self.title in data)
            self.assertTrue(told, name)

    def test_the_runs_own_surface_comes_again(self):
        runs = next(self.out.glob("part_*.stl"))
        self.assertEqual(runs.read_bytes()[84:],
                         self.file("stl").read_bytes()[84:])

    def test_stl_is_closed(self):
        said = run_program("admesh", self.file("stl"))
        self.assertRegex(said, r"Total disconnected facets +: +0 +0")
        self.assertRegex(said, r"Number of parts +: +1 ")
        found = float(re.search(r"Volume +: +([\d.]+)", said).group(1))
        self.assertAlmostEqual(found / self.volume, 1, 4)

    def test_gmsh_fills_the_stl(self):
        script = self.home / "fill.geo"
        script.write_text('Merge "part.stl";\nSurface Loop(1) = Surface{:};\n'
                          "Volume(1) = {1};\n")
        said = run_program("gmsh", "-3", script, "-o", self.home / "filled.msh",
                           "-v", "5", folder=self.home)
        self.assertNotRegex(said, "(?i)error|overlap|intersect")
        gmsh = Gmsh(self.home / "filled.msh")
        try:
            self.assertAlmostEqual(gmsh.volume(4) / self.volume, 1,
                                   delta=SOLIDS)
        finally:
            gmsh.close()

    def test_vtk_reads_the_vtu(self):
        said = run_program(program.PROGRAM.parent / "read_vtu",
                           self.file("vtu")).splitlines()
        rows = [line.split("|") for line in said]
        tet = self.found["tet"]
        self.assertIn(["points", str(tet["nodes"])], rows)
        self.assertIn(["cells", str(tet["elements"])], rows)
        self.assertEqual([row[1] for row in rows if row[0] == "type"],
                         ["24"])  # VTK_QUADRATIC_TETRA
        (field,) = [row for row in rows if row[0] == "point" and
                    row[1].startswith("displacement") and row[3] == "3"][:1]
        ours = nodal_field(self.text("msh"), "displacement")
        self.assertEqual(int(field[2]), len(ours))
        largest = max(sum(x * x for x in row) for row in ours) ** 0.5
        self.assertAlmostEqual(float(field[5]) / largest, 1, delta=1e-6)

    def mesh_volume(self):
        """Of the ten-node elements, by the program."""
        there = self.home / "sides"
        run_program(program.PROGRAM, "compare", self.out, self.out, "--out",
                    there)
        parts = json.loads((there / "compare.json").read_text())["parts"]
        return parts[0]["volume"]

    def test_gmsh_finds_valid_elements_of_that_volume(self):
        gmsh = Gmsh(self.file("msh"))
        try:
            self.assertGreater(min(gmsh.determinants(11)[1]), 0)
            self.assertAlmostEqual(gmsh.volume() / self.mesh_volume(), 1,
                                   delta=SOLIDS)
            self.assertEqual(gmsh.names(3), self.bodies)
            self.assertEqual(set(gmsh.names(2)), self.surfaces)
        finally:
            gmsh.close()

    def test_3mf_is_closed_and_in_the_cases_unit(self):
        root = xml.etree.ElementTree.fromstring(
            zipfile.ZipFile(self.file("3mf")).read("3D/3dmodel.model"))
        space = "{http://schemas.microsoft.com/3dmanufacturing/core/2015/02}"
        self.assertEqual(root.get("unit"), "millimeter")
        parts = [part for part in root.iter(space + "object")
                 if part.find(space + "mesh") is not None]
        self.assertEqual([part.get("name") for part in parts], self.bodies)
        self.assertEqual(len(list(root.iter(space + "item"))), 1)
        total = 0.0
        for part in parts:
            points = [[float(v.get(k)) for k in "xyz"]
                      for v in part.iter(space + "vertex")]
            facets = [[int(t.get(k)) for k in ("v1", "v2", "v3")]
                      for t in part.iter(space + "triangle")]
            self.assertTrue(edges_are_paired(facets))
            total += volume_of(points, facets)
        self.assertAlmostEqual(total / self.volume, 1, 5)

    def test_obj_is_closed_and_keeps_the_names(self):
        lines = [line.split() for line in self.text("obj").split("\n") if line]
        points = [[float(x) for x in line[1:]] for line in lines
                  if line[0] == "v"]
        objects = []
        for line in lines:
            if line[0] == "o":
                objects.append((line[1], []))
            elif line[0] == "f":
                objects[-1][1].append([int(x) - 1 for x in line[1:]])
        self.assertEqual([name for name, _ in objects], self.bodies)
        for _, facets in objects:
            self.assertTrue(edges_are_paired(facets))
        total = sum(volume_of(points, facets) for _, facets in objects)
        self.assertAlmostEqual(total / self.volume, 1, 5)
        self.assertEqual({line[1] for line in lines if line[0] == "g"},
                         self.surfaces)

    def test_evolver_finds_the_same_energy_at_rest(self):
        script = self.home / "measure.cmd"
        script.write_text('printf "LOADED %.17g %.17g\\n",total_energy,'
                          "sum(body,volume)\nm 0\ng\nhessian\n"
                          'printf "RESTED %.17g\\n",total_energy\nq\nq\n')
        said = run_program("evolver", "-x", "-f", script, self.file("fe"))
        loaded = re.search(r"LOADED (\d\S+) (\S+)", said)
        film = self.found["film"]
        self.assertAlmostEqual(float(loaded.group(1)) / film["energy"], 1,
                               delta=ENERGY)
        held = sum(body["volume"] for body in film["bodies"].values())
        self.assertAlmostEqual(float(loaded.group(2)) / held, 1,
                               delta=ENERGY)
        # Its Newton step may slide vertices along the film too: little to gain.
        rested = float(re.search(r"RESTED (\d\S+)", said).group(1))
        self.assertAlmostEqual(rested / film["energy"], 1, delta=1e-7)

    def test_compare_takes_the_datafile_by_its_faces(self):
        there = self.home / "from_datafile"
        alone = ["compare", self.out, self.file("fe"), "--out", there]
        said = self.refused(alone)
        self.assertIn("there are\n  film_1: ", said)
        self.assertIn("--face", said)
        # Solids in the order of the case.
        caps = re.findall(r"(?m)^\[solids\.(\w+)\]", self.case.read_text())
        names = [f"--face={cap}=solid_{k + 1}" for k, cap in enumerate(caps)]
        run_program(program.PROGRAM, *alone, *names)
        own, read = json.loads((there / "compare.json").read_text())["parts"]
        self.assertEqual(read["parts"], own["parts"])
        self.assertAlmostEqual(read["weld_length"], own["weld_length"],
                               delta=0.01 * own["weld_length"])
        self.assertAlmostEqual(read["mass"] / own["mass"], 1, delta=0.01)
        stiffness = [part["load_cases"]["service"]["stiffness"]
                     for part in (own, read)]
        self.assertAlmostEqual(stiffness[1] / stiffness[0], 1, delta=0.02)
        self.assertIn("--face here=nowhere", self.refused(
            [*alone, "--face=here=nowhere"]))
        self.assertIn("NAME=FACE", self.refused([*alone, "--face=nothing"]))

    def refused(self, arguments, code=2):
        done = subprocess.run([str(program.PROGRAM), *map(str, arguments)],
                              capture_output=True, text=True)
        self.assertEqual(done.returncode, code, done.stdout + done.stderr)
        return done.stderr

    def solved(self, deck, name):
        """Displacements by CalculiX."""
        (self.home / f"{name}.inp").write_text(deck)
        run_program("ccx", "-i", name, folder=self.home)
        count = len(nodal_field(self.text("msh"), "displacement"))
        return displacements((self.home / f"{name}.dat").read_text(), count)

    def test_calculix_solves_the_deck_with_the_same_answer(self):
        ours = nodal_field(self.text("msh"), "displacement")
        self.assertLess(difference(ours, self.solved(self.text("inp"), "own")),
                        AGREEMENT)

    def test_the_nastran_deck_says_the_same(self):
        """Read by the book, said again to CalculiX."""
        deck = bulk_data.read(self.text("bdf"))
        ours = nodal_field(self.text("msh"), "displacement")
        theirs = self.solved(bulk_data.calculix_deck(deck, 1), "bulk")
        self.assertLess(difference(ours, theirs), AGREEMENT)
        self.assertEqual(len(deck.sets), len(self.surfaces))


class ExportOfThreeBodies(Export):
    """Bodies that share facets, two load cases."""

    case = program.ROOT / "cases" / "two_arm_sized" / "case.toml"
    chambers = 3
    title = b"Two-arm bracket, sized"
    edges = ["--set", "resolution.fea=22", "--set", "resolution.film=11"]


FUNNEL = """title = "Liquid in a funnel"
units = "mm-N-MPa"

[curves.brim]
kind = "circle"
center = [0, 0, -2]
normal = [0, 0, 1]
radius = 32

[films.dome]
kind = "disk"
curves = ["brim"]
tension = 3.0

[solids.funnel]
kind = "wetted"
curve = "brim"
wall = "cone"
at = [0, 0, -40]
axis = [0, 0, 1]
half_angle = "40 deg"
contact_angle = "100 deg"

[bodies.part]
enclosed_by = ["dome", "funnel"]
volume = 9e4
material = "aluminium"

[materials.aluminium]
youngs_modulus = 71700.0
poisson_ratio = 0.33
density = 2.8e-9

[load_cases.service]
supports = [{ on = "funnel", fix = "xyz" }]
loads = [{ on = "dome", pressure = 10.0 }]

[responses.mass]
kind = "mass"

[resolution]
fea = 10.0
"""


class OfLiquidInAFunnel(ProgramTest):
    """A face that a film wets on a cone."""

    chords = 5e-3  # of volume: facets lie inside the cone

    @classmethod
    def setUpClass(cls):
        cls.home = pathlib.Path(tempfile.mkdtemp(prefix="meniscus funnel "))
        cls.out = cls.home / "run"
        (cls.home / "funnel.toml").write_text(FUNNEL)
        run_program(program.PROGRAM, "run", cls.home / "funnel.toml", "--out",
                    cls.out, "--no-pictures")

    @classmethod
    def tearDownClass(cls):
        shutil.rmtree(cls.home)

    def export(self, name, code=0):
        file = self.folder / f"part.{name.split('-')[0]}"
        done = self.call("export", self.out, "--format", name, "--out", file)
        self.expect(done, code)
        return file, done.stderr

    def test_every_program_finds_the_liquid(self):
        said = run_program("admesh", self.export("stl")[0])
        self.assertRegex(said, r"Total disconnected facets +: +0 +0")
        found = float(re.search(r"Volume +: +([\d.]+)", said).group(1))
        self.assertAlmostEqual(found / 9e4, 1, delta=self.chords)
        script = self.folder / "measure.geo"
        script.write_text(f"""SetFactory("OpenCASCADE");
v() = ShapeFromFile("{self.export("step-faceted")[0]}");
m() = Mass Volume{{v(0)}};
Printf("found %g of %.15g", #v(), m(0));
""")
        said = run_program("gmsh", script, "-", "-parse_and_exit")
        solids, volume = re.search(r"found (\d+) of (\S+)", said).groups()
        self.assertEqual(solids, "1")
        self.assertAlmostEqual(float(volume) / found, 1, delta=1e-4)
        script = self.folder / "measure.cmd"
        script.write_text('printf "LOADED %.17g %.17g\\n",total_energy,'
                          "sum(body,volume)\nq\nq\n")
        said = run_program("evolver", "-x", "-f", script, self.export("fe")[0])
        energy, volume = re.search(r"LOADED (\d\S+) (\S+)", said).groups()
        film = json.loads((self.out / "result.json").read_text())["film"]
        self.assertAlmostEqual(float(energy) / film["energy"], 1,
                               delta=self.chords)
        self.assertAlmostEqual(float(volume) / 9e4, 1, delta=self.chords)

    def test_smooth_step_is_refused_by_its_name(self):
        file, said = self.export("step", 2)
        self.assertIn("the face that 'funnel' wets is not plane", said)
        self.assertIn("step-faceted", said)
        self.assertFalse(file.exists())


LOADS = """
[load_cases.service]
supports = [{ on = "foot_pad", fix = "xyz" }]
loads = [
  { on = "top", pressure = 3 }, { gravity = [0, 5000, -9810] },
  { spin = 40, axis = [1, 0, 2], at = [30, 5, 0] }]

[load_cases.heat]
supports = [{ on = "foot_pad", fix = "xyz" }]
loads = [{ temperature = "20 + x", reference = 20 }]
"""
ON_SPRINGS = """
[load_cases.service]
supports = [{ on = "foot_pad", fix = "xz" },
            { on = "skin", stiffness = [0, 3, 2] }]
loads = [{ on = "top", force = [500, 300, -100] }]

[load_cases.heat]
supports = [{ on = "foot_pad", fix = "xyz" }]
loads = [{ temperature = "20 + x", reference = 20 }]
"""
ISOTROPIC = """youngs_modulus = 71700.0
poisson_ratio = 0.33
density = 2.8e-9
thermal_expansion = 2e-5
"""
LAMINATE = """youngs_moduli = [120e3, 9e3, 7e3]
poisson_ratios = [0.3, 0.32, 0.4]
shear_moduli = [4500, 4000, 3000]
axes = [[1, 2, 2], [0, 1, 0]]
density = 2.8e-9
thermal_expansions = [1e-6, 2e-5, 3e-5]
"""


class NastranLoads(ProgramTest):
    def expect_same(self, loads, material):
        text = re.sub(r"(?s)youngs_modulus.*?(?=\n\[)", material,
                      program.SIZED_STRUT)
        text = re.sub(r"(?s)\[load_cases.service\].*?(?=\[responses)",
                      loads.lstrip() + "\n", text)
        text = re.sub(r"(?s)(\[responses.sway\].*?)\n\n",
                      r'\1\nload_case = "service"\n\n', text)
        text = re.sub(r"(?s)\[study\].*", '[study]\nkind = "analyse"\n', text)
        case = self.folder / "case.toml"
        case.write_text(text)
        out = self.folder / "out"
        self.expect(self.call("run", case, "--set", "resolution.fea=14",
                              "--no-pictures", "--out", out), 0)
        for name in ("bdf", "msh"):
            self.expect(self.call("export", out, "--format", name), 0)
        deck = bulk_data.read((out / "part_14.bdf").read_text())
        msh = (out / "part_14.msh").read_text()
        for subcase, name in ((1, "service"), (2, "heat")):
            ours = nodal_field(msh, f"displacement, {name}")
            (out / "bulk.inp").write_text(
                bulk_data.calculix_deck(deck, subcase))
            run_program("ccx", "-i", "bulk", folder=out)
            theirs = displacements((out / "bulk.dat").read_text(), len(ours))
            self.assertLess(difference(ours, theirs), AGREEMENT, name)
        return deck

    def test_loads_mean_the_same_to_calculix(self):
        deck = self.expect_same(LOADS, ISOTROPIC)
        self.assertTrue(deck.pressures and deck.gravity and deck.spin)

    def test_springs_and_a_laminate_mean_the_same_to_calculix(self):
        deck = self.expect_same(ON_SPRINGS, LAMINATE)
        self.assertTrue(deck.springs and deck.axes)


class Trouble(ProgramTest):
    def run_strut(self, out="run"):
        path = self.folder / "case.toml"
        path.write_text(program.SIZED_STRUT)
        self.expect(self.call("run", path, "--set", "study.kind=analyse",
                              "--set", "resolution.fea=14", "--no-pictures",
                              "--out", self.folder / out), 0)
        return self.folder / out

    def test_another_edge_and_the_files_names(self):
        run = self.run_strut()
        for name, edge in (("3mf", "9"), ("msh", "18")):
            done = self.call("export", run, "--format", name, "--edge", edge)
            self.expect(done, 0)
            self.assertEqual(done.stdout, f"{run}/part_{edge}.{name}\n")
            self.assertTrue((run / f"part_{edge}.{name}").exists())

    def test_what_is_no_run_is_told(self):
        run = self.run_strut()
        self.expect(self.call("export", run, "--format", "stp"), 2,
                    "'stp' is no format; there are stl, 3mf, obj, step, .*vtu")
        self.expect(self.call("export", self.folder, "--format", "stl"), 2,
                    "no study in")
        self.expect(self.call("export", self.folder / "none", "--format",
                              "stl"), 2, "no study in")
        self.expect(self.call("export", run, "--format", "stl", "--out",
                              self.folder / "none" / "a.stl"), 2, "a.stl")
        self.expect(self.call("export", run, "--format", "3mf", "--out", run),
                    2, "cannot write")
        before = sorted(run.iterdir())
        database = run / "study.sqlite"
        whole = database.read_bytes()
        for bytes_left in (whole[:1000], b"not a database " * 99,
                           whole[:5000] + b"\0" * (len(whole) - 5000), b""):
            database.write_bytes(bytes_left)
            self.expect(self.call("export", run, "--format", "obj"), 2,
                        "study.sqlite|study")
            self.assertEqual(sorted(run.iterdir()), before)

    def test_a_read_only_folder_is_told(self):
        run = self.run_strut()
        # Root writes everywhere: somebody else then, who may not reach the
        # build's folder.
        other = {"user": 65534} if os.geteuid() == 0 else {}
        program_here = shutil.copy(program.PROGRAM, self.folder)
        self.folder.chmod(0o777)
        run.chmod(0o555)
        self.addCleanup(run.chmod, 0o700)
        command = [program_here, "export", run, "--format", "obj"]
        for more, code, told in (([], 2, "cannot write"),
                                 (["--out", self.folder / "a.obj"], 0, "a.obj")):
            done = subprocess.run(command + more, capture_output=True,
                                  text=True, timeout=120, cwd=self.folder,
                                  **other)
            self.expect(done, code, told)

    def test_a_familys_members_are_all_written(self):
        case = self.folder / "case.toml"
        text = program.SIZED_STRUT.replace("[parameters]", "")
        text = re.sub(r"(?s)\[study\].*", "", text) + (
            '[study]\nkind = "family"\neach = "analyse"\n'
            "[study.members.a]\nresolution.fea = 14\n"
            "[study.members.b]\nresolution.fea = 15\n")
        case.write_text(text)
        out = self.folder / "out"
        self.expect(self.call("run", case, "--no-pictures", "--out", out), 0)
        done = self.call("export", out, "--format", "3mf", "--edge", "9")
        self.expect(done, 0)
        for name in "ab":
            self.assertTrue(
                (out / "members" / name / "part_9.3mf").exists(), done.stdout)
        self.expect(self.call("export", out, "--format", "3mf", "--out",
                              self.folder / "a.3mf"), 2, "family.*members/a")
        (out / "members" / "a" / "study.sqlite").write_bytes(b"broken" * 99)
        self.expect(self.call("export", out, "--format", "obj", "--edge", "9"),
                    2, "members/a")
        self.assertTrue((out / "members" / "b" / "part_9.obj").exists())


if __name__ == "__main__":
    unittest.main(verbosity=2)
