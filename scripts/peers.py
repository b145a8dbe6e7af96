"""A finished run said again to other programs: its deck is exported and solved by
CalculiX, its datafile loaded by Surface Evolver; what they find stands beside what
the run found. cases.py uses it for runs whose expected.json has `calculix` or
`evolver`."""
import json
import math
import pathlib
import re
import subprocess

EDGES = [(0, 1), (1, 2), (0, 2), (0, 3), (1, 3), (2, 3)]  # of the mid-sides
# Points of the stiffness rule, CalculiX's too, in its order.
NEAR, FAR = 0.138196601125011, 0.585410196624968
POINTS = [[NEAR, NEAR, NEAR], [FAR, NEAR, NEAR], [NEAR, FAR, NEAR],
          [NEAR, NEAR, FAR]]


class NoPeer(Exception):
    """The other program is not there, or ended badly."""


def call(*command, folder=None):
    try:
        done = subprocess.run([str(c) for c in command], capture_output=True,
                              text=True, errors="replace", timeout=900,
                              cwd=folder, check=False)
    except FileNotFoundError as error:
        raise NoPeer(f"{command[0]} is not installed") from error
    if done.returncode != 0:
        raise NoPeer(f"{command[0]} ended with {done.returncode}:\n"
                     f"{done.stdout[-2000:]}{done.stderr[-2000:]}")
    return done.stdout


def sections(msh, name):
    """All $NodeData sections of that name: (title, values by node)."""
    found = []
    for section in msh.split("$NodeData\n")[1:]:
        lines = section.split("\n")
        if name in lines[1]:
            count = int(lines[7])
            found.append((lines[1].strip('"'), [
                [float(x) for x in line.split()[1:]]
                for line in lines[8:8 + count]]))
    return found


def printed(dat, word, width):
    """CalculiX's tables of that heading, one a step: rows of numbers."""
    tables = []
    for part in dat.split(word)[1:]:
        rows = []
        for line in part.split("\n")[2:]:
            numbers = line.split()
            if len(numbers) < width:
                break
            rows.append([float(x) for x in numbers])
        tables.append(rows)
    return tables


def mesh_of(deck):
    """Nodes and ten-node elements of the deck."""
    nodes, elements, reading = {}, {}, None
    for line in deck.split("\n"):
        if line.startswith("*"):
            word = line.upper().split(",")[0]
            reading = {"*NODE": nodes, "*ELEMENT": elements}.get(word)
            if word == "*ELEMENT" and "C3D10" not in line.upper():
                reading = None
            held = ""
            continue
        if reading is None or not line.strip():
            continue
        held += line
        if line.rstrip().endswith(","):
            continue
        numbers = held.split(",")
        held = ""
        key = int(numbers[0])
        reading[key] = ([float(x) for x in numbers[1:4]] if reading is nodes
                        else [int(x) for x in numbers[1:]])
    return nodes, elements


def jacobian(x, at):
    """Volume per unit of the reference element at a point of it."""
    r, s, t = at
    b = [1 - r - s - t, r, s, t]
    slopes = [[-1, -1, -1], [1, 0, 0], [0, 1, 0], [0, 0, 1]]
    j = [[0.0] * 3 for _ in range(3)]

    def add(node, by):
        for i in range(3):
            for k in range(3):
                j[i][k] += x[node][i] * by[k]
    for c in range(4):
        add(c, [(4 * b[c] - 1) * slopes[c][k] for k in range(3)])
    for m, (c, d) in enumerate(EDGES):
        add(4 + m, [4 * (b[c] * slopes[d][k] + b[d] * slopes[c][k])
                    for k in range(3)])
    return abs(j[0][0] * (j[1][1] * j[2][2] - j[1][2] * j[2][1]) -
               j[0][1] * (j[1][0] * j[2][2] - j[1][2] * j[2][0]) +
               j[0][2] * (j[1][0] * j[2][1] - j[1][1] * j[2][0]))


def von_mises(s):
    xx, yy, zz, xy, xz, yz = s
    return math.sqrt(0.5 * ((xx - yy) ** 2 + (yy - zz) ** 2 + (zz - xx) ** 2) +
                     3 * (xy * xy + xz * xz + yz * yz))


def difference(a, b):
    """Largest over the largest."""
    largest = max(abs(x) for row in b for x in row)
    return max(abs(x - y) for p, q in zip(a, b, strict=True)
               for x, y in zip(p, q, strict=True)) / largest


class Peer:
    """Figures of one load case."""

    def __init__(self, name, apart, mean, peak):
        self.name = name
        self.apart = apart  # displacements, largest over the largest
        self.mean = mean    # von Mises stress by volume
        self.peak = peak    # the same at integration points, the largest


def evolver_energy(program, run, place):
    """Of the run's film as Surface Evolver loads it: (energy of films and
    fields, without the work of given pressures that its own total has, volumes'
    sum)."""
    place = pathlib.Path(place)
    place.mkdir(parents=True, exist_ok=True)
    call(program, "export", run, "--format", "fe", "--out", place / "peer.fe")
    script = place / "measure.cmd"
    script.write_text('printf "LOADED %.17g %.17g\\n",'
                      "total_energy+sum(body where not fixed,"
                      "pressure*volume),sum(body,volume)\nq\nq\n")
    said = call("evolver", "-x", "-f", script, place / "peer.fe")
    loaded = re.search(r"LOADED (-?\d\S*) (-?\d\S*)", said)
    if not loaded:
        raise NoPeer(f"evolver does not load the film:\n{said[-2000:]}")
    return float(loaded.group(1)), float(loaded.group(2))


def solve(program, run, place):
    """CalculiX on the run's final design: a Peer for each load case."""
    place = pathlib.Path(place)
    place.mkdir(parents=True, exist_ok=True)
    for form in ("inp", "msh"):
        call(program, "export", run, "--format", form, "--out",
             place / f"peer.{form}")
    call("ccx", "-i", "peer", folder=place)
    dat = (place / "peer.dat").read_text()
    deck = (place / "peer.inp").read_text()
    nodes, elements = mesh_of(deck)
    weights = {e: [jacobian([nodes[n] for n in ids], p) for p in POINTS]
               for e, ids in elements.items()}
    ours = sections((place / "peer.msh").read_text(), "displacement")
    names = list(json.loads((pathlib.Path(run) / "result.json").read_text())
                 ["stress"])
    theirs = printed(dat, "displacements", 4)
    stresses = printed(dat, "stresses", 8)
    peers = []
    for k, name in enumerate(names):
        moved = [row[1:4] for row in sorted(theirs[k])]
        whole = sum_ = peak = 0.0
        for row in stresses[k]:
            weight = weights[int(row[0])][int(row[1]) - 1]
            stress = von_mises(row[2:8])
            whole += weight
            sum_ += weight * stress
            peak = max(peak, stress)
        peers.append(Peer(name, difference(ours[k][1], moved), sum_ / whole,
                          peak))
    return peers
