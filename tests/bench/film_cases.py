#!/usr/bin/env python3
"""The random film problems of film_starts.py as case files: rims as curves, the first
facets as a film of facets, the body between them with its volume or pressure; each
also settled by Surface Evolver from its datafile. Ends with 1 where Evolver holds a
film for stable that the program refuses, or finds with another energy.
Use: film_cases.py PROGRAM [--kinds tube,bad] [--count 20] [--first 0]
     [--facets 2000] [--limit 60] [--seed 1] [--keep FOLDER], from anywhere; or
     film_cases.py PROGRAM --settles tube_0,bad_3: these, without Evolver."""
import math
import pathlib
import sys
import tempfile

sys.path.insert(0, str(pathlib.Path(__file__).parent))
import film_problems  # noqa: E402
import film_starts  # noqa: E402
from film_starts import add, cross, dot  # noqa: E402

KINDS = ("tube", "branch", "strut", "pressed", "bad")  # one body, held rims
COARSE = 4000  # facets
ALIKE = 5e-3  # of the energies: meshes differ, films do not
REST = """
[materials.any]
youngs_modulus = 1
poisson_ratio = 0.3
density = 1

[load_cases.pull]
supports = [{ on = "cap_1", fix = "xyz" }]
loads = [{ on = "cap_2", force = [0, 0, 1] }]

[responses.mass]
kind = "mass"
"""


def numbers(values):
    return "[" + ", ".join(f"{x:.17g}" for x in values) + "]"


def curve(name, rim):
    if rim.shape == "circle":
        return (f'[curves.{name}]\nkind = "circle"\n'
                f"center = {numbers(rim.centre)}\nnormal = {numbers(rim.normal)}\n"
                f"radius = {rim.size:.17g}\n")
    corners = [rim.at(math.pi / 4 + k * math.pi / 2) for k in range(4)]
    return (f'[curves.{name}]\nkind = "polygon"\npoints = ['
            + ", ".join(numbers(p) for p in corners) + "]\n")


def area(film):
    total = 0.0
    for (a, b, c), cap in film.facets:
        if not cap:
            u, v, w = (film.points[i] for i in (a, b, c))
            n = cross(add(v, u, -1), add(w, u, -1))
            total += math.sqrt(dot(n, n)) / 2
    return total


def outward(film):
    """The films' facets as the body sees them."""
    sides, _ = film.bodies[0]
    rows = []
    for f in sides:
        corners, cap = film.facets[abs(f) - 1]
        if not cap:
            rows.append(corners if f > 0 else corners[::-1])
    return rows


def case_text(film, facets):
    edge = math.sqrt(4 / math.sqrt(3) * area(film) / facets)
    facets_of = outward(film)
    used = sorted({v for t in facets_of for v in t})
    place = {v: k for k, v in enumerate(used)}
    names = [f"rim_{k + 1}" for k in range(len(film.held))]
    caps = [f"cap_{k + 1}" for k in range(len(film.held))]
    quoted = [f'"{n}"' for n in names]
    text = 'title = "A random film"\nunits = "mm-N-MPa"\n\n'
    text += "\n".join(curve(n, rim) for n, rim in zip(names, film.held))
    text += ('\n[films.skin]\nkind = "facets"\ncurves = ['
             + ", ".join(quoted) + "]\nvertices = [\n"
             + ",\n".join(numbers(film.points[v]) for v in used)
             + "]\nfacets = [\n"
             + ",\n".join(str([place[v] for v in t]) for t in facets_of) + "]\n")
    for cap, name in zip(caps, names):
        text += f'\n[solids.{cap}]\nkind = "cap"\ncurve = "{name}"\n'
    held = film.bodies[0][1].split()
    text += ("\n[bodies.liquid]\nenclosed_by = ["
             + ", ".join(f'"{n}"' for n in ["skin"] + caps)
             + f']\nmaterial = "any"\n{held[0]} = {held[1]}\n' + REST)
    # As parts do: a mesh for analysis, the film nested in it.
    halvings = 0
    while facets > COARSE * 4 ** halvings:
        halvings += 1
    return text + (f"\n[resolution]\nfea = {edge * 2 ** halvings:.6g}\n"
                   f"film = {edge:.6g}\n")


def compare(options, name, folder):
    kind, number = name.split("_")
    film = film_starts.problem(kind, int(number), options.seed)
    (folder / "case.toml").write_text(case_text(film, options.facets))
    own = film_problems.evolved(options.program, folder, "case.toml")
    row = {"name": name, "own": own, "peer": None, "apart": None}
    said = (f"{name:12} {own['facets']:6} facets  "
            f"{'settled' if own['settled'] else 'refused':8}"
            f" {own['seconds']:6.2f} s")
    if not options.settles:
        (folder / "start.fe").write_text(film.text())
        row["peer"] = peer = film_problems.by_evolver(
            film, folder, film_problems.refinements(film, options.facets),
            options.limit)
        said += (f"  Evolver {'settled' if peer['settled'] else 'refused':8}"
                 f" {peer['seconds']:6.2f} s")
        if own["settled"] and peer["settled"]:
            row["apart"] = own["energy"] / peer["energy"] - 1
            said += f"  energy {row['apart']:+.1e}"
    print(said + ("" if own["settled"] else f" | {own['why'][:200]}"),
          flush=True)
    if options.keep:
        keep = pathlib.Path(options.keep)
        keep.mkdir(parents=True, exist_ok=True)
        (keep / f"{name}.toml").write_text((folder / "case.toml").read_text())
    return row


def main():
    options = film_problems.options_of(__doc__, KINDS).parse_args()
    names = options.settles.split(",") if options.settles else [
        f"{kind}_{number}" for kind in options.kinds.split(",")
        for number in range(options.first, options.first + options.count)]
    rows = []
    for name in names:
        with tempfile.TemporaryDirectory(prefix="meniscus film ") as folder:
            rows.append(compare(options, name, pathlib.Path(folder)))
    if options.settles:
        missed = [f"{r['name']}: refused: {r['own']['why']}" for r in rows
                  if not r["own"]["settled"]]
    else:
        count = {(a, b): sum(1 for r in rows if (r["own"]["settled"],
                                                 r["peer"]["settled"]) == (a, b))
                 for a in (True, False) for b in (True, False)}
        print(f"{len(rows)} cases: both settle {count[True, True]}, the program "
              f"only {count[True, False]}, Evolver only {count[False, True]}, "
              f"none {count[False, False]}")
        missed = [f"{r['name']}: refused, Evolver settles it: {r['own']['why']}"
                  for r in rows
                  if r["peer"]["settled"] and not r["own"]["settled"]]
        missed += [f"{r['name']}: energy {r['apart']:+.2e} off Evolver's"
                   for r in rows
                   if r["apart"] is not None and abs(r["apart"]) > ALIKE]
    for line in missed:
        print("MISSED:", line)
    return 1 if missed else 0


if __name__ == "__main__":
    sys.exit(main())
