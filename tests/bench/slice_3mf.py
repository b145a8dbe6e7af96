#!/usr/bin/env python3
"""PrusaSlicer's command line on the 3MF of two brackets: does it find each body
manifold, in one piece, all together of the films' volume, and does it slice? Not
part of the tests: a large package. Use: slice_3mf.py PROGRAM, from anywhere."""
import json
import pathlib
import re
import subprocess
import sys
import tempfile

CASES = pathlib.Path(__file__).resolve().parents[2] / "cases"
PARTS = ["two_arm", "ge_bracket"]
LAYER = 0.3  # mm
VOLUME = 1e-3  # relative


def call(*command):
    done = subprocess.run([str(c) for c in command], capture_output=True,
                          text=True, check=False)
    if done.returncode != 0:
        sys.exit(f"{command[0]} ended with {done.returncode}:\n{done.stdout}"
                 f"\n{done.stderr}")
    return done.stdout


def check(program, case):
    with tempfile.TemporaryDirectory() as name:
        folder = pathlib.Path(name)
        call(program, "run", CASES / case / "case.toml", "--set", "study.kind=analyse",
             "--no-pictures", "--out", folder / "run")
        part = folder / "part.3mf"
        call(program, "export", folder / "run", "--format", "3mf", "--out",
             part)
        info = call("prusa-slicer", "--info", part)
        bodies = {key: re.findall(rf"^{key} = +(\S+)$", info, re.M)
                  for key in ("manifold", "number_of_parts", "volume",
                              "number_of_facets", "min_z", "max_z")}
        # Its command line puts each body on the plate by itself.
        height = max(float(high) - float(low) for low, high in
                     zip(bodies["min_z"], bodies["max_z"], strict=True))
        film = json.loads((folder / "run" / "result.json").read_text())["film"]
        held = sum(body["volume"] for body in film["bodies"].values())
        off = sum(map(float, bodies["volume"])) / held - 1
        call("prusa-slicer", "--export-gcode", "--layer-height", LAYER,
             "--bed-shape", "0x0,400x0,400x400,0x400", "--max-print-height",
             "400", "--support-material", "--output", folder / "part.gcode",
             part)
        gcode = (folder / "part.gcode").read_text()
        tops = {float(z) for z in re.findall(r"^;Z:([\d.]+)$", gcode, re.M)}
        print(f"{case}: PrusaSlicer: {len(bodies['volume'])} bodies of "
              f"{len(film['bodies'])}, facets "
              f"{' '.join(bodies['number_of_facets'])}, "
              f"the tallest {height:.6g} mm, "
              f"volume off by {off:.1e}; sliced at {LAYER} mm, top layer at "
              f"{max(tops):g} mm")
        if (set(bodies["manifold"]) != {"yes"} or
                set(bodies["number_of_parts"]) != {"1"} or
                len(bodies["volume"]) != len(film["bodies"]) or
                abs(off) > VOLUME or abs(max(tops) - height) > 2 * LAYER):
            sys.exit("PrusaSlicer finds another part")


def main():
    program = pathlib.Path(sys.argv[1]).resolve()
    for case in PARTS:
        check(program, case)


if __name__ == "__main__":
    main()
