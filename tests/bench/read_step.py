#!/usr/bin/env python3
"""FreeCAD's command line on the cases' STEP files: does it find one valid closed
solid of the volume that the film holds (of walls, of the facets' as near as these
are), with the mass centre of our own surface?
Not part of the tests: a large package. Use: read_step.py PROGRAM, from anywhere."""
import json
import os
import pathlib
import re
import struct
import subprocess
import sys
import tempfile

ROOT = pathlib.Path(__file__).resolve().parents[2]
READER = ROOT / "tests/peers/freecad_step.py"
CASES = ["two_arm/case", "two_arm_sized/case", "strut_family/case"]
WALLS = ["torque_tube/case", "bracket_vs_solid/skin", "bracket_vs_solid/case",
         "h_beam_casting/case", "minimal_cell/case", "minimal_cell/diamond"]
SETTINGS = ["--no-pictures", "--quiet"]
ANALYSE = ["--set", "study.kind=analyse"]
FACETS = 1e-2  # relative volume of a wall's facets, off its faces'
VOLUME = 1e-3  # relative
CENTRE = 1e-3  # of the surface's size


def call(*command, **options):
    done = subprocess.run([str(c) for c in command], capture_output=True,
                          text=True, check=False, **options)
    if done.returncode != 0:
        sys.exit(f"{command[0]} ended with {done.returncode}:\n{done.stdout}"
                 f"\n{done.stderr}")
    return done.stdout + done.stderr


def centre_of(stl):
    """Mass centre, diagonal and volume of what a binary STL encloses."""
    data = stl.read_bytes()
    whole, moment = 0.0, [0.0] * 3
    low, high = [1e300] * 3, [-1e300] * 3
    for k in range(struct.unpack_from("<I", data, 80)[0]):
        c = struct.unpack_from("<9f", data, 84 + 50 * k + 12)
        a, b, d = c[0:3], c[3:6], c[6:9]
        cone = (a[0] * (b[1] * d[2] - b[2] * d[1]) +
                a[1] * (b[2] * d[0] - b[0] * d[2]) +
                a[2] * (b[0] * d[1] - b[1] * d[0])) / 6
        whole += cone
        for i in range(3):
            moment[i] += cone * (a[i] + b[i] + d[i]) / 4
            low[i] = min(low[i], a[i], b[i], d[i])
            high[i] = max(high[i], a[i], b[i], d[i])
    size = sum((h - l) ** 2 for h, l in zip(high, low)) ** 0.5
    return [m / whole for m in moment], size, whole


def main():
    program = pathlib.Path(sys.argv[1]).resolve()
    bad = 0
    with tempfile.TemporaryDirectory() as name:
        folder = pathlib.Path(name)
        for case in CASES + WALLS:
            run = folder / case.replace("/", "_")
            path = ROOT / "cases" / f"{case}.toml"
            analyse = ANALYSE if "[study]" in path.read_text() else []
            call(program, "run", path, *SETTINGS, *analyse, "--out", run)
            step, stl = run.with_suffix(".step"), run.with_suffix(".stl")
            told = call(program, "export", run, "--format", "step", "--out",
                        step)
            call(program, "export", run, "--format", "stl", "--out", stl)
            centre, size, facets = centre_of(stl)
            held = facets if case in WALLS else sum(
                body["volume"] for body in json.loads(
                    (run / "result.json").read_text())
                ["film"]["bodies"].values())
            allowed = FACETS if case in WALLS else VOLUME
            said = call("freecadcmd", READER,
                        env={**os.environ,
                             "STEP_FILES": str(step)})
            found = json.loads(re.search(r"^\{.*\}$", said, re.M).group(0))
            off = found["volume"] / held - 1
            apart = sum((x - y) ** 2
                        for x, y in zip(found["centre"], centre)) ** 0.5
            good = (found["solids"] == 1 and found["valid"] and found["closed"]
                    and abs(off) < allowed and apart < CENTRE * size)
            bad += not good
            print(f"FreeCAD {found['version']}: {case}: {found['solids']} solid, "
                  f"{found['faces']} faces {found['kinds']}, valid "
                  f"{found['valid']}, closed {found['closed']}, volume "
                  f"{found['volume']:.9g} mm3, off by {off:.1e}; mass centre "
                  f"({', '.join(f'{x:.4g}' for x in found['centre'])}) mm, "
                  f"{apart:.2g} mm from our surface's; "
                  f"{step.stat().st_size / 1000:.0f} kB")
            for line in told.splitlines():
                if line.startswith(("gap", "tangent")):
                    print("   ", line)
            print(f"    size {size:.4g} mm across")
    if bad:
        sys.exit(f"FreeCAD finds {bad} other parts")


if __name__ == "__main__":
    main()
