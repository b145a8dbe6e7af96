#!/usr/bin/env python3
"""Random film problems (film_starts.py), each settled by the program and by Surface
Evolver from the same datafile: who settles what, at which energy, in which time.
Ends with 1 where Evolver holds a film for stable that the program refuses, unless
Evolver's own film is lost when it is refined and settled again.
Use: film_problems.py PROGRAM [--kinds tube,bad] [--count 20] [--first 0]
     [--facets 2000] [--limit 60] [--seed 1] [--keep FOLDER] [--limits], from
     anywhere; or
     film_problems.py PROGRAM --settles tube_2,strut_0: these, without Evolver.
--limits: what neither settles is asked for with other volumes or pressures, and
the eigenvalue that falls to 0 on the way tells how far beyond its limit it is."""
import argparse
import copy
import json
import math
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

# Energies, relative, times facets: the error of flat facets falls as one over
# their number, at another rate where vertices do not slide along the film.
ALIKE = 4.0
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
        '\neigenprobe 0\ndump "evolver.fe"\nq\nq\n')
FINER_YET = (1, 2)  # refinements that Evolver's film has to stand
# Beyond limits: the parts of the volume, or of 1 / length in pressure, by which
# the problem is changed at most and at once, and halvings of the last step.
FURTHEST, STEP, HALVINGS = 1.5, 0.03, 5
LEAST = 0.4         # of the volume
LINE_ENDS = 1.5     # edges: a line this near the rim lies at it


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


def by_program(program, folder, levels, start="start.fe"):
    return evolved(program, folder, start, "--refine", str(levels))


def evolved(program, folder, *what):
    """What the program makes of a datafile or case: as of by_evolver()."""
    shutil.rmtree(folder / "out", ignore_errors=True)
    output, seconds = seconds_of(
        [program, "evolve", *what, "--quiet", "--no-pictures", "--out", "out"],
        folder, OUR_LIMIT)
    result = {"settled": False, "energy": None, "seconds": seconds,
              "why": "time", "facets": 0}
    report = folder / "out" / "film.json"
    if output is None or not report.exists():
        result["why"] = output.strip() if output else "time"
        return result
    found = json.loads(report.read_text())
    result.update(energy=found["energy"], facets=found["facets"],
                  why=found["verdict"], settled=found["verdict"] == "stable",
                  eigenvalue=found.get("min_eigenvalue"))
    if found.get("nesting", {}).get("crossing_pairs", 0) > 0:
        result.update(why="crosses itself", settled=False)
    return result


def lost_when_finer(program, folder):
    """Why Evolver's film is none; None where it stands."""
    for levels in FINER_YET:
        finer = by_program(program, folder, levels, "evolver.fe")
        if not finer["settled"]:
            return f"refined {levels} times: {finer['why']}"
    return None


def changed(film, by):
    """The problem with all volumes times 1 + by, pressures raised by `by`."""
    result = copy.copy(film)
    result.bodies = []
    for sides, held in film.bodies:
        what, value = held.split()
        value = float(value) * (1 + by) if what == "volume" else float(value) + by
        result.bodies.append((sides, f"{what} {value:.17g}"))
    return result


def line_to_rim(path):
    """Of a film that the program wrote: the least distance between a line where
    three films meet and what is held, in mean edges; None without a line."""
    part, points, held, edges, rims, count = "", {}, set(), {}, {}, {}
    for row in path.read_text().splitlines():
        words = row.split("//")[0].split()
        if words[:1] == ["boundary"]:
            part = int(words[1])
            rims[part] = []
        elif words[:1] and words[0] in ("vertices", "edges", "faces", "bodies"):
            part = words[0]
        elif words and isinstance(part, int):
            rims[part].append(row.split(":")[1])
        elif words and part == "vertices":
            if "boundary" in words:
                p1 = {"p1": float(words[1]), "cos": math.cos, "sin": math.sin}
                place = [eval(f, p1) for f in rims[int(words[3])]]
            else:
                place = [float(x) for x in words[1:4]]
            points[words[0]] = place
            held.update(words[:1] if "fixed" in words else ())
        elif words and part == "edges":
            edges[words[0]] = words[1:3]
        elif words and part == "faces":
            for edge in words[1:4]:
                count[edge.strip("-")] = count.get(edge.strip("-"), 0) + 1
    line = {v for edge, n in count.items() if n > 2 for v in edges[edge]}
    mean = statistics.mean(math.dist(points[a], points[b])
                           for a, b in edges.values())
    return min((math.dist(points[a], points[b]) / mean
                for a in line for b in held), default=None)


def asked(text, bodies):
    """The text of a film's datafile with the volumes and pressures of others."""
    head, tail = text.split("\nbodies", 1)
    held = iter(held for _, held in bodies)
    return head + "\nbodies" + re.sub(r"(volume|pressure) \S+",
                                      lambda _: next(held), tail)


def limit_of(program, film, folder, levels):
    """Where the problem, eased until its raw start settles, loses its film on
    the way back, each film from the one before: a sentence. At a fold the square
    of the lowest eigenvalue is linear in what is asked."""
    steps = [sign * STEP * k for k in range(1, round(FURTHEST / STEP) + 1)
             for sign in (1, -1) if sign * STEP * k > LEAST - 1]
    for by in steps:
        (folder / "start.fe").write_text(changed(film, by).text())
        own = by_program(program, folder, levels)
        if own["settled"]:
            break
    else:
        return f"no film within {FURTHEST:g} of it"
    written = folder / "out" / "film.fe"
    met = [(by, own["eigenvalue"])]
    text, step = written.read_text(), math.copysign(STEP, by)
    ends = line_to_rim(written)
    while abs(step) > STEP * 0.5 ** HALVINGS and abs(met[-1][0]) > 1e-9:
        by = met[-1][0] - step
        by = by if by * step > 0 else 0.0
        (folder / "next.fe").write_text(asked(text, changed(film, by).bodies))
        own = by_program(program, folder, 0, "next.fe")
        if own["settled"]:
            met.append((by, own["eigenvalue"]))
            text, ends = written.read_text(), line_to_rim(written)
        else:
            step *= 0.5
    if len(met) == 1:  # a second one, further out
        by = met[0][0] + 0.25 * math.copysign(STEP, met[0][0])
        (folder / "next.fe").write_text(asked(text, changed(film, by).bodies))
        own = by_program(program, folder, 0, "next.fe")
        met[:0] = [(by, own["eigenvalue"])] if own["settled"] else []
    last, near = met[-1]
    if abs(last) <= 1e-9:
        return "NOT SHOWN: it stands, and neither settles its raw start"
    said = f"stands from {met[0][0]:+.2f} to {last:+.4f}, "
    if len(met) > 1 and met[-2][1] > near:
        before, far = met[-2]
        fold = last - near ** 2 * (before - last) / (far ** 2 - near ** 2)
        if fold * last > 0 and abs(fold - last) < STEP:
            return (f"{said}lowest eigenvalue {far:.3g}, {near:.3g}, "
                    f"0 at {fold:+.4f}: beyond the fold")
    if ends is not None and ends < LINE_ENDS:
        return (f"{said}its line is {ends:.2g} edges off the rim there: beyond "
                "where the line meets it")
    return f"{said}lowest eigenvalue {near:.3g}: NOT SHOWN"


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
           "facets": film.films() * 4 ** levels, "lost": None}
    if peer["settled"] and not own["settled"]:
        row["lost"] = lost_when_finer(options.program, folder)
    print(f"{row['name']:14} {row['facets']:7} facets  "
          f"{'settled' if own['settled'] else 'refused':8} {own['seconds']:6.2f} s"
          f"  Evolver {'settled' if peer['settled'] else 'refused':8}"
          f" {peer['seconds']:6.2f} s  "
          + (f"energy {apart:+.1e}" if apart is not None else "")
          + ("" if own["settled"] else f" | {own['why'][:150]}")
          + ("" if peer["settled"] else f" | Evolver: {peer['why']}")
          + (f" | Evolver's film is lost {row['lost']}" if row["lost"] else ""),
          flush=True)
    if options.limits and not own["settled"] and not peer["settled"]:
        print(f"    {limit_of(options.program, film, folder, levels)}",
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
    lost = [r["name"] for r in rows if r["lost"]]
    if lost:
        print(f"of Evolver's, lost when refined: {len(lost)} {' '.join(lost)}")
    both = [r for r in rows if r["apart"] is not None]
    missed = [f"{r['name']}: refused, Evolver settles it: {r['own']['why']}"
              for r in rows if r["peer"]["settled"] and not r["own"]["settled"]
              and not r["lost"]]
    missed += [f"{r['name']}: energy {r['apart']:+.2e} above Evolver's"
               for r in both if r["apart"] > ALIKE / r["facets"]]
    missed += [f"{r['name']}: {r['own']['seconds']:.2f} s, Evolver "
               f"{r['peer']['seconds']:.2f} s" for r in both
               if r["facets"] > LARGE
               and r["own"]["seconds"] > SLOW * r["peer"]["seconds"]]
    lower = [r["name"] for r in both if r["apart"] < -ALIKE / r["facets"]]
    if both:
        ratios = sorted(r["peer"]["seconds"] / max(1e-3, r["own"]["seconds"])
                        for r in both)
        print(f"Evolver's time over the program's: {ratios[0]:.1f} to "
              f"{ratios[-1]:.1f}, median {statistics.median(ratios):.1f}")
        print(f"lower than Evolver's energy by more than {ALIKE:g} / facets: "
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


def options_of(description, kinds):
    parser = argparse.ArgumentParser(description=description)
    parser.add_argument("program", type=lambda p: str(pathlib.Path(p).resolve()))
    parser.add_argument("--kinds", default=",".join(kinds))
    parser.add_argument("--count", type=int, default=20)
    parser.add_argument("--first", type=int, default=0)
    parser.add_argument("--facets", type=int, default=2000)
    parser.add_argument("--limit", type=float, default=60)
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--keep", help="leave the problems here")
    parser.add_argument("--settles", help="names as tube_2, by the program alone")
    return parser


def main():
    parser = options_of(__doc__, film_starts.KINDS)
    parser.add_argument("--limits", action="store_true",
                        help="of what neither settles")
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
