"""Reads Nastran bulk data strictly by columns, and says its first subcases to
CalculiX: what the file means to a program that knows nothing of its writer."""
import collections
import math
import re

# Cards that the decks of this program may have, and no others.
KNOWN = {"PARAM", "GRDSET", "GRID", "CTETRA", "PSOLID", "MAT1", "SPC1", "SPC", "LOAD",
         "FORCE", "MOMENT", "PLOAD4", "GRAV", "RFORCE", "TEMP", "TEMPD",
         "SPOINT", "CELAS2", "MPC", "MAT9", "CORD2R", "CTRIA6", "PSHELL", "RBE2"}
# CalculiX's order of the 21 constants of an anisotropic material: pairs of
# stresses as Nastran counts them (11 22 33 12 23 31).
ANISO = [(0, 0), (0, 1), (1, 1), (0, 2), (1, 2), (2, 2), (0, 3), (1, 3), (2, 3),
         (3, 3), (0, 5), (1, 5), (2, 5), (3, 5), (5, 5), (0, 4), (1, 4), (2, 4),
         (3, 4), (4, 5), (4, 4)]
LINE = 72  # columns that count


def real(field):
    """1.5, 1.5E-9 and 1.5-9; a point must be there."""
    text = field.strip()
    if not re.fullmatch(r"[+-]?(\d+\.\d*|\.\d+)(E?[+-]\d+)?", text):
        raise ValueError(f"no real number: {field!r}")
    return float(re.sub(r"(?<=[\d.])E?([+-]\d+)$", r"e\1", text))


def cards(lines):
    """(name, fields) with fields as text, '' for empty."""
    found = []
    for line in lines:
        if len(line) > LINE:
            raise ValueError(f"{len(line)} columns: {line}")
        name = line[:8].strip()
        width = 16 if "*" in name else 8
        per_line = 64 // width
        fields = [line[8 + width * k:8 + width * (k + 1)].strip()
                  for k in range(per_line)]
        if name in ("*", "+", ""):
            found[-1][1].extend(fields)
        else:
            found.append((name.rstrip("*"), fields))
    return found


class Deck:
    def __init__(self):
        self.grids, self.elements, self.properties = {}, {}, {}
        self.materials, self.sets = {}, {}
        self.subcases = collections.defaultdict(dict)
        self.held = collections.defaultdict(list)
        self.loads = {}
        self.forces = collections.defaultdict(list)
        self.pressures = collections.defaultdict(list)
        self.gravity, self.spin = {}, {}
        self.axes, self.springs, self.equations = {}, [], []
        self.scalars, self.rigid = [], []
        self.shells, self.shell_properties, self.frames = {}, {}, {}
        self.heat = collections.defaultdict(dict)


def read_case_control(text, deck):
    text = re.sub(r",\s*\n\s*", ", ", text)
    subcase = 0
    for line in text.split("\n"):
        words = re.match(r"\s*(\S+?)(?: (\d+))?\s*(?:=\s*(.*))?$", line)
        if not words:
            continue
        key, index, value = words.groups()
        if key == "SET":
            deck.sets[int(index)] = value
        elif key == "SUBCASE":
            subcase = int(index)
        elif key in ("SPC", "LOAD", "TEMPERATURE(LOAD)"):
            deck.subcases[subcase][key] = int(value)


def read(text):
    lines = [line for line in text.split("\n") if line[:1] != "$" and line]
    if lines[:2] != ["SOL 101", "CEND"] or lines[-1] != "ENDDATA":
        raise ValueError("no static job")
    bulk = lines.index("BEGIN BULK")
    deck = Deck()
    read_case_control("\n".join(lines[2:bulk]), deck)
    for name, f in cards(lines[bulk + 1:-1]):
        if name not in KNOWN:
            raise ValueError(f"card {name}")
        if name == "GRID":
            deck.grids[int(f[0])] = [real(x) for x in f[2:5]]
            if f[5]:
                deck.frames[int(f[0])] = int(f[5])
        elif name == "CTRIA6":
            f = [*f, *[""] * 5]
            t = [real(x) for x in f[10:13] if x]
            if f[8]:
                raise ValueError("a material angle")
            deck.shells[int(f[0])] = (int(f[1]), [int(n) for n in f[2:8]],
                                      real(f[9]) if f[9] else 0.0, t)
        elif name == "PSHELL":
            if f[1] != f[3] or f[1] != f[5]:
                raise ValueError("a shell without bending or shear")
            deck.shell_properties[int(f[0])] = (
                int(f[1]), real(f[2]) if f[2] else None)
        elif name == "CTETRA":
            deck.elements[int(f[0])] = (int(f[1]), [int(n) for n in f[2:12]])
        elif name == "PSOLID":
            deck.properties[int(f[0])] = int(f[1])
            if f[2] and int(f[2]) != int(f[1]):
                raise ValueError("axes of another material")
        elif name == "MAT9":
            deck.materials[int(f[0])] = [real(x) if x else 0.0
                                         for x in [*f[1:], *[""] * 8]]
        elif name == "CORD2R":
            deck.axes[int(f[0])] = [real(x) for x in f[2:11]]
        elif name == "RBE2":
            if f[2] != "123456":
                raise ValueError("a part of a rigid body")
            deck.rigid.append((int(f[1]), [int(n) for n in f[3:] if n]))
        elif name == "SPOINT":
            points = [int(n) for n in f if n]
            deck.scalars += points
            deck.grids.update({n: [0.0, 0.0, 0.0] for n in points})
        elif name == "CELAS2":
            deck.springs.append((int(f[0]), real(f[1]), int(f[2])))
        elif name == "MPC":
            terms = [g[k:k + 3] for g in (f[i:i + 8]
                                          for i in range(0, len(f), 8))
                     for k in (1, 4)]
            deck.equations.append([(int(n), max(int(c), 1), real(a))
                                   for n, c, a in terms if n])
        elif name == "MAT1":
            deck.materials[int(f[0])] = (real(f[1]), real(f[3]),
                                          *(real(x) if x else 0.0
                                            for x in [*f[4:6], ""][:2]))
        elif name == "SPC1":
            deck.held[int(f[0])].append((f[1], [int(n) for n in f[2:] if n],
                                         0.0))
        elif name == "SPC":
            deck.held[int(f[0])].append((f[2], [int(f[1])], real(f[3])))
        elif name == "LOAD":
            if any(real(x) != 1.0 for x in [f[1], *f[2::2]] if x):
                raise ValueError("a factor")
            deck.loads[int(f[0])] = [int(x) for x in f[3::2] if x]
        elif name in ("FORCE", "MOMENT"):
            scale = real(f[3])
            deck.forces[int(f[0])].append(
                (int(f[1]), 1 if name == "FORCE" else 4,
                 [scale * real(x) for x in f[4:7]]))
        elif name == "PLOAD4":
            on, off = (*f, "", "", "", "")[6:8]  # of shells there are none
            deck.pressures[int(f[0])].append(
                (int(f[1]), real(f[2]), int(on or 0), int(off or 0)))
        elif name == "GRAV":
            deck.gravity[int(f[0])] = (real(f[2]), [real(x) for x in f[3:6]])
        elif name == "RFORCE":
            deck.spin[int(f[0])] = (int(f[1]), real(f[3]),
                                    [real(x) for x in f[4:7]])
        elif name == "TEMPD":
            if real(f[1]) != 0.0:
                raise ValueError("a default temperature")
        elif name == "TEMP":
            deck.heat[int(f[0])][int(f[1])] = real(f[2])
    return deck


def calculix_deck(deck, subcase):
    """A static step of CalculiX that prints all displacements."""
    out = ["*NODE, NSET=NALL"]
    for n, x in sorted(deck.grids.items()):
        out.append(f"{n}, {x[0]:.12e}, {x[1]:.12e}, {x[2]:.12e}")
    for pid, mid in deck.properties.items():
        out.append(f"*ELEMENT, TYPE=C3D10, ELSET=P{pid}")
        # Both have mid-sides 12 23 31 14 24 34.
        out += [f"{e}, " + ", ".join(map(str, nodes))
                for e, (p, nodes) in deck.elements.items() if p == pid]
        out += material_lines(deck, pid, mid)
    out += shell_lines(deck)
    for e, stiffness, node in deck.springs:
        out += [f"*ELEMENT, TYPE=SPRING1, ELSET=S{e}", f"{e}, {node}",
                f"*SPRING, ELSET=S{e}", "1", f"{stiffness:.12e}"]
    for terms in deck.equations:
        texts = [f"{n}, {c}, {a:.12e}" for n, c, a in terms]
        out += ["*EQUATION", str(len(terms)), *texts]
    case = deck.subcases[subcase]
    heat = deck.heat[case.get("TEMPERATURE(LOAD)")]
    if heat:
        out += ["*INITIAL CONDITIONS, TYPE=TEMPERATURE", "NALL, 0."]
    out += ["*STEP", "*STATIC", "*BOUNDARY"]
    out += [f"{n}, 2, 3" for n in deck.scalars]
    for components, nodes, value in deck.held[case["SPC"]]:
        out += [f"{n}, {c}, {c}, {value:.12e}" for n in nodes
                for c in components.replace("0", "1")]
    for part in deck.loads.get(case.get("LOAD"), []):
        out += load_lines(deck, part)
    if heat:
        out += ["*TEMPERATURE", *(f"{n}, {t:.12e}" for n, t in heat.items())]
    out += ["*NODE PRINT, NSET=NALL", "U", "*END STEP", ""]
    return "\n".join(out)


def shell_lines(deck):
    """S6 elements; a section's thickness, or the nodes'."""
    out, nodal = [], {}
    for pid, (mid, even) in deck.shell_properties.items():
        out.append(f"*ELEMENT, TYPE=S6, ELSET=P{pid}")
        for e, (p, nodes, offset, t) in deck.shells.items():
            if p != pid:
                continue
            if offset or bool(t) == bool(even):
                raise ValueError(f"CTRIA6 {e}: no thickness, two, or beside")
            out.append(f"{e}, " + ", ".join(map(str, nodes)))
            t = t or [even] * 3
            t = [*t, *((t[k] + t[(k + 1) % 3]) / 2 for k in range(3))]
            nodal.update(zip(nodes, t))
        young, poisson, density, expansion = deck.materials[mid]
        out += [f"*MATERIAL, NAME=M{mid}", "*ELASTIC",
                f"{young:.12e}, {poisson:.12e}", "*DENSITY", f"{density:.12e}",
                "*EXPANSION", f"{expansion:.12e}",
                f"*SHELL SECTION, ELSET=P{pid}, MATERIAL=M{mid}, "
                "NODAL THICKNESS", "1."]
    if nodal:
        out += ["*NODAL THICKNESS",
                *(f"{n}, {t:.12e}" for n, t in nodal.items())]
    return out


def material_lines(deck, pid, mid):
    numbers = deck.materials[mid]
    section = f"*SOLID SECTION, ELSET=P{pid}, MATERIAL=M{mid}"
    out = [f"*MATERIAL, NAME=M{mid}"]
    if mid not in deck.axes:
        young, poisson, density, expansion = numbers
        return out + ["*ELASTIC", f"{young:.12e}, {poisson:.12e}", "*DENSITY",
                      f"{density:.12e}", "*EXPANSION", f"{expansion:.12e}",
                      section]
    upper = [(i, j) for i in range(6) for j in range(i, 6)]
    constants = [f"{numbers[upper.index(pair)]:.9e}" for pair in ANISO]
    out += ["*ELASTIC, TYPE=ANISO", ", ".join(constants[:8]),
            ", ".join(constants[8:16]), ", ".join(constants[16:]),
            "*DENSITY", f"{numbers[21]:.12e}", "*EXPANSION, TYPE=ORTHO",
            ", ".join(f"{x:.12e}" for x in numbers[22:25])]
    origin, z, x = (deck.axes[mid][k:k + 3] for k in (0, 3, 6))
    if any(origin):
        raise ValueError("an origin")
    y = [z[1] * x[2] - z[2] * x[1], z[2] * x[0] - z[0] * x[2],
         z[0] * x[1] - z[1] * x[0]]
    return out + [f"*ORIENTATION, NAME=O{mid}, SYSTEM=RECTANGULAR",
                  ", ".join(f"{v:.12e}" for v in [*x, *y]),
                  section + f", ORIENTATION=O{mid}"]


def load_lines(deck, part):
    out = []
    if part in deck.forces:
        out.append("*CLOAD")
        out += [f"{n}, {first + k}, {force[k]:.12e}"
                for n, first, force in deck.forces[part] for k in range(3)
                if force[k] != 0.0]
    if part in deck.pressures:
        out.append("*DLOAD")
        for e, pressure, on, off in deck.pressures[part]:
            if e in deck.shells:  # along the normal of G1 G2 G3
                out.append(f"{e}, P, {pressure:.12e}")
                continue
            corner = deck.elements[e][1].index(off)
            if on not in deck.elements[e][1][:4] or on == off:
                raise ValueError(f"PLOAD4 of element {e}")
            out.append(f"{e}, P{(3, 4, 2, 1)[corner]}, {pressure:.12e}")
    if part in deck.gravity:
        size, axis = deck.gravity[part]
        out.append("*DLOAD")
        out += [f"P{pid}, GRAV, {size:.12e}, " +
                ", ".join(f"{x:.12e}" for x in axis)
                for pid in [*deck.properties, *deck.shell_properties]]
    if part in deck.spin:
        point, turns, axis = deck.spin[part]
        rate = 2 * math.pi * turns
        numbers = [rate * rate, *deck.grids[point], *axis]
        out.append("*DLOAD")
        out += [f"P{pid}, CENTRIF, " + ", ".join(f"{x:.12e}" for x in numbers)
                for pid in [*deck.properties, *deck.shell_properties]]
    return out
