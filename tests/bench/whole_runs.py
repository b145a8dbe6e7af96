#!/usr/bin/env python3
"""Whole runs of the program, as docs/performance.md tells them: the match of
cases/two_arm at 113,000 elements, with pictures and without, and cases/fuselage up
to two million facets. Ends with 1 where a target is missed.
Use: whole_runs.py PROGRAM [match] [fuselage], from anywhere."""
import json
import math
import os
import pathlib
import statistics
import subprocess
import sys
import tempfile
import time

ROOT = pathlib.Path(__file__).resolve().parents[2]
MATCH_SECONDS = 60     # asked of the whole match on two threads
PICTURES = 1.15        # with pictures over without, medians
PAIRS = 5
GROWTH = 1.2           # seconds ~ facets^p, at the largest size
FACET_BYTES = 900      # beyond what `check` takes of the same case


def measured(*command):
    """Wall clock and processor seconds and peak memory [byte] of a run."""
    before = time.monotonic()
    child = subprocess.Popen([str(c) for c in command], cwd=ROOT,
                             stdout=subprocess.DEVNULL)
    _, status, used = os.wait4(child.pid, 0)
    if status != 0:
        sys.exit(f"{' '.join(map(str, command))} ended with {status}")
    return (time.monotonic() - before, used.ru_utime + used.ru_stime,
            1024 * used.ru_maxrss)


def match(program, folder):
    def run(*more):
        return measured(program, "run", "cases/two_arm/case.toml", "--set",
                        "resolution.fea=4.95", "--set", "resolution.film=2.475",
                        "--quiet", "--threads", 2, *more, "--out",
                        folder / f"match_{time.monotonic_ns()}")
    bare, whole = [], []
    for _ in range(PAIRS):
        bare.append(run("--no-pictures", "--no-frames", "--no-report"))
        whole.append(run())
    print("| the whole match, two threads | wall clock [s] | processor [s] |\n"
          "|---|---|---|")
    wall = {}
    for name, runs in (("without pictures", bare), ("with them", whole)):
        wall[name] = statistics.median(r[0] for r in runs)
        print(f"| {name} | {wall[name]:.1f} | "
              f"{statistics.median(r[1] for r in runs):.1f} |", flush=True)
    missed = []
    if wall["without pictures"] > MATCH_SECONDS:
        missed.append(f"the match takes {wall['without pictures']:.1f} s of "
                      f"{MATCH_SECONDS}")
    gain = wall["with them"] / wall["without pictures"]
    if gain > PICTURES:
        missed.append(f"pictures make it {gain:.2f} times as long, "
                      f"{PICTURES} are allowed")
    return missed


def fuselage(program, folder):
    print("| `film` [mm] | facets | film [s] | all, CPU [s] | power of the "
          "growth | memory [MB] | bytes per facet |\n" + "|---" * 7 + "|")
    missed, last = [], None
    *_, read = measured(program, "check", "cases/fuselage/case.toml")
    for edge in (86, 43, 21.5):
        out = folder / f"scale_{edge:g}"
        _, cpu, peak = measured(
            program, "evolve", "cases/fuselage/case.toml", "--no-pictures",
            "--quiet", "--out", out, "--set", "resolution.fea=86", "--set",
            f"resolution.film={edge:g}")
        film = json.loads((out / "film.json").read_text())
        facets = film["facets"]
        power = math.log(cpu / last[0]) / math.log(facets / last[1]) \
            if last else None
        print(f"| {edge:g} | {facets:,} | {film['seconds']:.1f} | {cpu:.1f} | "
              f"{'' if power is None else f'{power:.2f}'} | {peak / 1e6:.0f} | "
              f"{(peak - read) / facets:.0f} |", flush=True)
        last = (cpu, facets)
        if (peak - read) / facets > FACET_BYTES:
            missed.append(f"{(peak - read) / facets:.0f} bytes per facet at "
                          f"{edge:g} mm, {FACET_BYTES} are allowed")
    print(f"`check` takes {read / 1e6:.0f} MB, which bytes per facet leave out.")
    if power > GROWTH:
        missed.append(f"seconds grow as facets^{power:.2f}, {GROWTH} is allowed")
    return missed


def main():
    program = pathlib.Path(sys.argv[1]).resolve()
    missed = []
    with tempfile.TemporaryDirectory(prefix="meniscus bench ") as name:
        for part in (match, fuselage):
            if len(sys.argv) == 2 or part.__name__ in sys.argv[2:]:
                missed += part(program, pathlib.Path(name))
    for line in missed:
        print("MISSED:", line)
    return 1 if missed else 0


if __name__ == "__main__":
    sys.exit(main())
