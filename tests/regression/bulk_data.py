"""Reads Nastran bulk data strictly by columns, and says its first subcases to
CalculiX: what the file means to a program that knows nothing of its writer."""
import collections
import math
import re

# Cards that the decks of this program may have, and no others.
KNOWN = {"PARAM", "GRDSET", "GRID", "CTETRA", "PSOLID", "MAT1", "SPC1", "LOAD",
         "FORCE", "PLOAD4", "GRAV", "RFORCE", "TEMP", "TEMPD"}
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
        elif name == "CTETRA":
            deck.elements[int(f[0])] = (int(f[1]), [int(n) for n in f[2:12]])
        elif name == "PSOLID":
            deck.properties[int(f[0])] = int(f[1])
        elif name == "MAT1":
            deck.materials[int(f[0])] = (real(f[1]), real(f[3]),
                                          *(real(x) if x else 0.0
                                            for x in [*f[4:6], ""][:2]))
        elif name == "SPC1":
            deck.held[int(f[0])].append((f[1], [int(n) for n in f[2:] if n]))
        elif name == "LOAD":
            if any(real(x) != 1.0 for x in [f[1], *f[2::2]] if x):
                raise ValueError("a factor")
            deck.loads[int(f[0])] = [int(x) for x in f[3::2] if x]
        elif name == "FORCE":
            scale = real(f[3])
            deck.forces[int(f[0])].append(
                (int(f[1]), [scale * real(x) for x in f[4:7]]))
        elif name == "PLOAD4":
            deck.pressures[int(f[0])].append(
                (int(f[1]), real(f[2]), int(f[6]), int(f[7])))
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
        young, poisson, density, expansion = deck.materials[mid]
        out += [f"*MATERIAL, NAME=M{mid}", "*ELASTIC",
                f"{young:.12e}, {poisson:.12e}", "*DENSITY", f"{density:.12e}",
                "*EXPANSION", f"{expansion:.12e}",
                f"*SOLID SECTION, ELSET=P{pid}, MATERIAL=M{mid}"]
    case = deck.subcases[subcase]
    heat = deck.heat[case.get("TEMPERATURE(LOAD)")]
    if heat:
        out += ["*INITIAL CONDITIONS, TYPE=TEMPERATURE", "NALL, 0."]
    out += ["*STEP", "*STATIC", "*BOUNDARY"]
    for components, nodes in deck.held[case["SPC"]]:
        out += [f"{n}, {c}, {c}" for n in nodes for c in components]
    for part in deck.loads.get(case.get("LOAD"), []):
        out += load_lines(deck, part)
    if heat:
        out += ["*TEMPERATURE", *(f"{n}, {t:.12e}" for n, t in heat.items())]
    out += ["*NODE PRINT, NSET=NALL", "U", "*END STEP", ""]
    return "\n".join(out)


def load_lines(deck, part):
    out = []
    if part in deck.forces:
        out.append("*CLOAD")
        out += [f"{n}, {k + 1}, {force[k]:.12e}"
                for n, force in deck.forces[part] for k in range(3)
                if force[k] != 0.0]
    if part in deck.pressures:
        out.append("*DLOAD")
        for e, pressure, on, off in deck.pressures[part]:
            corner = deck.elements[e][1].index(off)
            if on not in deck.elements[e][1][:4] or on == off:
                raise ValueError(f"PLOAD4 of element {e}")
            out.append(f"{e}, P{(3, 4, 2, 1)[corner]}, {pressure:.12e}")
    if part in deck.gravity:
        size, axis = deck.gravity[part]
        out.append("*DLOAD")
        out += [f"P{pid}, GRAV, {size:.12e}, " +
                ", ".join(f"{x:.12e}" for x in axis)
                for pid in deck.properties]
    if part in deck.spin:
        point, turns, axis = deck.spin[part]
        rate = 2 * math.pi * turns
        numbers = [rate * rate, *deck.grids[point], *axis]
        out.append("*DLOAD")
        out += [f"P{pid}, CENTRIF, " + ", ".join(f"{x:.12e}" for x in numbers)
                for pid in deck.properties]
    return out
