#!/usr/bin/env python3
"""The ledger's floating-point work, by formula, against a count of the very
instructions that were executed: callgrind says how often each ran, objdump what
it does. Additions, multiplications, divisions and roots count one for each lane,
fused ones two.

    stage_operations.py BUILD/bin/stage_operations [--functions]
"""
import collections
import os
import pathlib
import re
import subprocess
import sys
import tempfile

CASE = pathlib.Path(__file__).resolve().parents[2] / "cases/two_arm/case.toml"
SETTINGS = ["resolution.fea=24", "resolution.film=12"]
# Of the counted work: what the formulas may leave out or say too much.
MOST_ERROR = {"start": 0.05, "film": 0.05, "motion": 0.05, "elasticity": 0.05}

PLAIN = re.compile(
    r"^v?(add|sub|mul|div|sqrt|addsub|hadd|hsub)(sd|ss|pd|ps)$")
FUSED = re.compile(r"^vfn?m(add|sub|addsub|subadd)(132|213|231)(sd|ss|pd|ps)$")


def work_of(mnemonic, operands):
    """Operations of one instruction."""
    plain, fused = PLAIN.match(mnemonic), FUSED.match(mnemonic)
    if not plain and not fused:
        return 0
    kind = plain.group(2) if plain else fused.group(3)
    lanes = 1
    if kind[0] == "p":
        lanes = 4 if "ymm" in operands else 2
        lanes *= 2 if kind == "ps" else 1
    return lanes * (2 if fused else 1)


def instructions_of(path):
    """Operations by address of the object's floating-point instructions."""
    if not os.path.exists(path):
        return {}
    text = subprocess.run(["objdump", "-d", "--no-show-raw-insn", path],
                          capture_output=True, text=True, check=False).stdout
    found = {}
    for line in text.splitlines():
        part = re.match(r"\s*([0-9a-f]+):\s+(\S+)\s*(.*)", line)
        if part:
            work = work_of(part.group(2), part.group(3))
            if work:
                found[int(part.group(1), 16)] = work
    return found


def executed(path):
    """(object, function, address) -> times, of one of callgrind's dumps."""
    counts = collections.Counter()
    obj = function = ""
    skip = False
    for line in path.read_text().splitlines():
        if line.startswith("ob="):
            obj = line[3:]
        elif line.startswith("fn="):
            function = line[3:]
        elif line.startswith("calls="):
            skip = True  # the next line is the callee's inclusive cost
        elif line.startswith("0x"):
            if not skip:
                address, *_, times = line.split()
                counts[obj, function, int(address, 16)] += int(times)
            skip = False
    return counts


def main():
    program = sys.argv[1]
    with tempfile.TemporaryDirectory() as folder:
        out = pathlib.Path(folder) / "count"
        done = subprocess.run(
            ["valgrind", "--tool=callgrind", "--dump-instr=yes",
             "--compress-strings=no", "--compress-pos=no", "--collect-atstart=no",
             "--toggle-collect=stage_*", "--dump-after=stage_*",
             f"--callgrind-out-file={out}", program, CASE, *SETTINGS],
            capture_output=True, text=True, check=False,
            env={**os.environ, "OMP_NUM_THREADS": "1"})
        if done.returncode != 0:
            sys.exit(done.stderr)
        formula = {name: float(value) for name, value in
                   (line.split() for line in done.stdout.splitlines())}
        known = {}
        bad = 0
        print(f"{'stage':<11} {'by formula':>11} {'counted':>11} {'ratio':>7}")
        for number, stage in enumerate(formula, 1):
            counted = collections.Counter()
            for (obj, function, address), times in executed(
                    pathlib.Path(f"{out}.{number}")).items():
                if obj not in known:
                    known[obj] = instructions_of(obj)
                counted[function] += times * known[obj].get(address, 0)
            whole = sum(counted.values())
            ratio = formula[stage] / whole if whole else float("inf")
            wrong = abs(ratio - 1) > MOST_ERROR[stage]
            bad += wrong
            print(f"{stage:<11} {formula[stage]:11.4g} {whole:11.4g} "
                  f"{ratio:7.3f}{'  WRONG' if wrong else ''}")
            if "--functions" in sys.argv:
                for function, work in counted.most_common(25):
                    print(f"    {work / whole:6.1%}  {function[:100]}")
    sys.exit(1 if bad else 0)


if __name__ == "__main__":
    main()
