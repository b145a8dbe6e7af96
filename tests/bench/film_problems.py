#!/usr/bin/env python3
"""Random film problems (film_starts.py), each settled by the program and by Surface
Evolver from the same datafile: who settles what, at which energy, in which time.
Ends with 1 where Evolver holds a film for stable that the program refuses.
Use: film_problems.py PROGRAM [--kinds tube,bad] [--count 20] [--first 0]
     [--facets 2000] [--limit 60] [--seed 1] [--keep FOLDER], from anywhere; or
     film_problems.py PROGRAM --settles tube_2,strut_0: these, without Evolver."""
import argparse
import json
import os
import pathlib
import re
import resource
import shutil
import statistics
import subprocess
import sys
import tempfile

sys.path.insert(0, str(pathlib.Path(__file__).parent))
import film_starts  # noqa: E402

ALIKE = 1e-4        # energies at equal facets, relative
CHANGE = 1e-9       # of Evolver's energy in its last step: settled
OUR_LIMIT = 120     # s
SLOW = 0.2          # of Evolver's time is allowed, above
LARGE = 10000       # facets
# The usual script; near rest its plain `hessian` may leave the film, so it seeks.
FIRST = "u; V; g 30; u; V; g 30; hessian_seek; hessian_seek;\n"
FINER = "r; u; V; g 20; u; V; g 10; hessian_seek; hessian_seek;\n"
LAST = ("hessian_seek; hessian; hessian; hessian; before := total_energy; "
        'hessian;\nprintf "\\ndone_clock %.6f\\n", clock;\n'
        'printf "done_energy %.12g\\n", total_energy + PRESSED;\n'
        'printf "done_change %.6g\\n", abs(total_energy - before) / total_energy;'
        "\neigenprobe 0\nq\nq\n")


def refinements(film, facets):
    result = 0
    while film.films() * 4 ** result < facets:
        result += 1
    return result


def seconds_of(command, folder, limit):
    """Its output and processor time; None where it takes too long."""
    before = resource.getrusage(resource.RUSAGE_CHILDREN)
    try:
        run = subprocess.run(command, cwd=folder, timeout=limit, text=True,
                             stdout=subprocess.PIPE, stderr=subprocess.STDOUT,
                             stdin=subprocess.DEVNULL, errors="replace",
                             env={**os.environ, "OMP_NUM_THREADS": "1"})
    except subprocess.TimeoutExpired:
        return None, limit
    after = resource.getrusage(resource.RUSAGE_CHILDREN)
    return run.stdout, (after.ru_utime + after.ru_stime - before.ru_utime
                        - before.ru_stime)


def by_evolver(film, folder, levels, limit):
    """dict: settled (at rest, no eigenvalue below 0), energy, seconds, why."""
    # of films alone, as the program counts it
    pressed = "sum(body, pressure * volume)" if film.pressed() else "0"
    (folder / "job.cmd").write_text(
        (FIRST if film.moves() else "u;\n") + levels * FINER
        + LAST.replace("PRESSED", pressed))
    output, seconds = seconds_of(
        ["evolver", "-x", "-f", "job.cmd", "start.fe"], folder, limit)
    result = {"settled": False, "energy": None, "seconds": seconds,
              "why": "time" if output is None else "no end"}
    if output is None:
        return result

    def number(key):
        found = re.search(rf"^done_{key} (\S+)", output, re.M)
        return float(found[1]) if found else None
    if number("energy") is None:
        result["why"] = "".join(output.strip().splitlines()[-1:])
        return result
    probe = re.search(r"(\d+) <[^,]*, *(\d+) ==", output)
    result["energy"] = number("energy")
    result["seconds"] = number("clock") or seconds
    below = int(probe[1]) if probe else -1
    rest = number("change")
    result["settled"] = rest is not None and rest < CHANGE and below == 0
    result["why"] = f"change {rest}, {below} eigenvalues below 0"
    return result


def by_program(program, folder, levels):
    shutil.rmtree(folder / "out", ignore_errors=True)
    output, seconds = seconds_of(
        [program, "evolve", "start.fe", "--refine", str(levels), "--quiet",
         "--no-pictures", "--out", "out"], folder, OUR_LIMIT)
    result = {"settled": False, "energy": None, "seconds": seconds,
              "why": "time", "facets": 0}
    report = folder / "out" / "film.json"
    if output is None or not report.exists():
        result["why"] = output.strip() if output else "time"
        return result
    found = json.loads(report.read_text())
    result.update(energy=found["energy"], facets=found["facets"],
                  why=found["verdict"], settled=found["verdict"] == "stable")
    return result


def compare(options, kind, number, folder):
    film = film_starts.problem(kind, number, options.seed)
    (folder / "start.fe").write_text(film.text())
    levels = refinements(film, options.facets)
    own = by_program(options.program, folder, levels)
    peer = by_evolver(film, folder, levels, options.limit)
    apart = None
    if own["settled"] and peer["settled"]:
        apart = own["energy"] / peer["energy"] - 1
    row = {"name": f"{kind} {number}", "own": own, "peer": peer, "apart": apart,
           "facets": film.films() * 4 ** levels}
    print(f"{row['name']:14} {row['facets']:7} facets  "
          f"{'settled' if own['settled'] else 'refused':8} {own['seconds']:6.2f} s"
          f"  Evolver {'settled' if peer['settled'] else 'refused':8}"
          f" {peer['seconds']:6.2f} s  "
          + (f"energy {apart:+.1e}" if apart is not None else "")
          + ("" if own["settled"] else f" | {own['why'][:150]}")
          + ("" if peer["settled"] else f" | Evolver: {peer['why']}"),
          flush=True)
    return row


def summary(rows):
    """Printed; what is missed comes back."""
    count = {(a, b): sum(1 for r in rows if (r["own"]["settled"],
                                             r["peer"]["settled"]) == (a, b))
             for a in (True, False) for b in (True, False)}
    print(f"{len(rows)} problems: both settle {count[True, True]}, the program "
          f"only {count[True, False]}, Evolver only {count[False, True]}, none "
          f"{count[False, False]}")
    both = [r for r in rows if r["apart"] is not None]
    missed = [f"{r['name']}: refused, Evolver settles it: {r['own']['why']}"
              for r in rows if r["peer"]["settled"] and not r["own"]["settled"]]
    missed += [f"{r['name']}: energy {r['apart']:+.2e} above Evolver's"
               for r in both if r["apart"] > ALIKE]
    missed += [f"{r['name']}: {r['own']['seconds']:.2f} s, Evolver "
               f"{r['peer']['seconds']:.2f} s" for r in both
               if r["facets"] > LARGE
               and r["own"]["seconds"] > SLOW * r["peer"]["seconds"]]
    lower = [r["name"] for r in both if r["apart"] < -ALIKE]
    if both:
        ratios = sorted(r["peer"]["seconds"] / max(1e-3, r["own"]["seconds"])
                        for r in both)
        print(f"Evolver's time over the program's: {ratios[0]:.1f} to "
              f"{ratios[-1]:.1f}, median {statistics.median(ratios):.1f}")
        print(f"lower than Evolver's energy by more than {ALIKE:g}: "
              f"{len(lower)} {' '.join(lower[:8])}")
    return missed


def settles(options, folder):
    """Those of options.settles that the program refuses, with its reason."""
    missed = []
    for name in options.settles.split(","):
        kind, number = name.split("_")
        film = film_starts.problem(kind, int(number), options.seed)
        (folder / "start.fe").write_text(film.text())
        own = by_program(options.program, folder,
                         refinements(film, options.facets))
        print(f"{name}: {own['facets']} facets, energy {own['energy']}, "
              f"{own['why']}")
        if not own["settled"]:
            missed.append(f"{name}: refused: {own['why']}")
    return missed


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("program", type=lambda p: str(pathlib.Path(p).resolve()))
    parser.add_argument("--kinds", default=",".join(film_starts.KINDS))
    parser.add_argument("--count", type=int, default=20)
    parser.add_argument("--first", type=int, default=0)
    parser.add_argument("--facets", type=int, default=2000)
    parser.add_argument("--limit", type=float, default=60)
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--keep", help="leave the datafiles here")
    parser.add_argument("--settles", help="names as tube_2, by the program alone")
    options = parser.parse_args()
    if options.settles:
        with tempfile.TemporaryDirectory(prefix="meniscus film ") as name:
            missed = settles(options, pathlib.Path(name))
        for line in missed:
            print("MISSED:", line)
        return 1 if missed else 0
    rows = []
    for kind in options.kinds.split(","):
        for number in range(options.first, options.first + options.count):
            with tempfile.TemporaryDirectory(prefix="meniscus film ") as name:
                folder = pathlib.Path(name)
                rows.append(compare(options, kind, number, folder))
                if options.keep:
                    keep = pathlib.Path(options.keep)
                    keep.mkdir(parents=True, exist_ok=True)
                    (keep / f"{kind}_{number}.fe").write_text(
                        (folder / "start.fe").read_text())
    missed = summary(rows)
    for line in missed:
        print("MISSED:", line)
    return 1 if missed else 0


if __name__ == "__main__":
    sys.exit(main())
