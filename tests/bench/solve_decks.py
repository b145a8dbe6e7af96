#!/usr/bin/env python3
"""`meniscus solve` beside CalculiX on decks that Gmsh makes of a STEP plate with
two holes: three static steps, whole programs on one thread from the deck to their
files (ours .vtu, .frd and .json, theirs .dat and .frd). Use: solve_decks.py
PROGRAM, from anywhere."""
import json
import os
import pathlib
import re
import resource
import subprocess
import sys
import tempfile

EDGES = [2.0, 1.3, 0.9]  # mm
MOST_RATIO = 0.5         # of processor time
SAME = 1e-6              # largest displacement of each step, relative
PLATE = """SetFactory("OpenCASCADE");
Box(1) = {0, 0, 0, 60, 20, 6};
Cylinder(2) = {15, 10, -1, 0, 0, 8, 5};
Cylinder(3) = {50, 10, -1, 0, 0, 8, 3};
BooleanDifference(4) = { Volume{1}; Delete; }{ Volume{2, 3}; Delete; };
"""
MESH = """SetFactory("OpenCASCADE");
Merge "plate.step";
Physical Volume("body") = Volume{:};
Physical Surface("foot") = Surface In BoundingBox {-1, -1, -1, 1, 21, 7};
Physical Surface("tip") = Surface In BoundingBox {59, -1, -1, 61, 21, 7};
"""
STEPS = """*MATERIAL, NAME=alloy
*ELASTIC
71700., 0.33
*DENSITY
2.8e-9
*SOLID SECTION, ELSET=body, MATERIAL=alloy
*BOUNDARY
foot, 1, 3
""" + "".join(f"""*STEP
*STATIC
*CLOAD, OP=NEW
{load}
*NODE PRINT, NSET=body
U
*NODE FILE
U
*EL FILE
S
*END STEP
""" for load in ("tip, 3, -1.", "tip, 1, 2.", "tip, 2, 3."))


def call(*command, folder):
    """Processor time [s] of a program that must end well."""
    before = resource.getrusage(resource.RUSAGE_CHILDREN)
    done = subprocess.run([str(c) for c in command], cwd=folder, text=True,
                          capture_output=True, check=False,
                          env={**os.environ, "OMP_NUM_THREADS": "1"})
    after = resource.getrusage(resource.RUSAGE_CHILDREN)
    if done.returncode != 0:
        sys.exit(f"{command[0]} ended with {done.returncode}:\n{done.stdout}"
                 f"\n{done.stderr}")
    return (after.ru_utime + after.ru_stime - before.ru_utime -
            before.ru_stime)


def without_surfaces(mesh):
    """CalculiX would take the surfaces' elements for plane stress."""
    kept, lines = True, []
    for line in mesh.splitlines():
        if line.startswith("*"):
            kept = "CPS" not in line
        if kept:
            lines.append(line)
    return "\n".join(lines) + "\n"


def largest(dat):
    """Largest displacement of each step of CalculiX's .dat."""
    result = []
    for part in dat.split("displacements")[1:]:
        rows = re.findall(r"^ +\d+ +(\S+) +(\S+) +(\S+)$", part, re.M)
        result.append(max(sum(float(x) ** 2 for x in row) for row in rows)
                      ** 0.5)
    return result


def main():
    program = pathlib.Path(sys.argv[1]).resolve()
    missed = False
    with tempfile.TemporaryDirectory() as name:
        folder = pathlib.Path(name)
        (folder / "plate.geo").write_text(PLATE)
        (folder / "mesh.geo").write_text(MESH)
        call("gmsh", "plate.geo", "-0", "-format", "step", "-o", "plate.step",
             folder=folder)
        print("nodes    ours [s]  CalculiX [s]  ratio  displacements differ by")
        for edge in EDGES:
            call("gmsh", "mesh.geo", "-3", "-order", "2", "-clmax", edge,
                 "-setnumber", "Mesh.SaveGroupsOfNodes", "1", "-format", "inp",
                 "-o", "mesh.inp", folder=folder)
            mesh = (folder / "mesh.inp").read_text()
            (folder / "ours.inp").write_text(mesh + STEPS)
            (folder / "theirs.inp").write_text(without_surfaces(mesh) + STEPS)
            out = f"out_{edge}"
            ours = call(program, "solve", "ours.inp", "--out", out,
                        folder=folder)
            theirs = call("ccx", "-i", "theirs", folder=folder)
            result = json.loads((folder / out / "result.json").read_text())
            off = max(abs(step["largest_displacement"]["value"] / exact - 1)
                      for step, exact in zip(
                          result["steps"],
                          largest((folder / "theirs.dat").read_text()),
                          strict=True))
            print(f"{result['tet']['nodes']:<8} {ours:8.2f} {theirs:13.2f} "
                  f"{ours / theirs:6.2f}  {off:.1e}")
            missed = missed or ours / theirs > MOST_RATIO or off > SAME
    if missed:
        sys.exit(f"missed: a ratio of {MOST_RATIO} at most, displacements the "
                 f"same to {SAME:g}")


if __name__ == "__main__":
    main()
