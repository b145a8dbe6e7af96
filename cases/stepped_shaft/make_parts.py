#!/usr/bin/python3
"""Writes the conventional stepped shafts that case.toml stands against:
sharp.obj, sharp_fine.obj (the corner cut twice as finely), fillet_4.obj and
fillet_10.obj, solids of revolution about z with a group for each face. Lengths
in mm. Nothing of it is random: the files are the same on every machine.
usage: make_parts.py [FOLDER]"""
import math
import pathlib
import sys

FOLDER = pathlib.Path(sys.argv[1] if len(sys.argv) > 1 else ".").resolve()
BIG, SMALL = 30.0, 20.0        # radii
LOW, HIGH = -50.0, 70.0        # ends; the shoulder is at z = 0
COARSE = 5.0                   # edges far from the shoulder
GROWTH = 1.3                   # of edges, from one ring to the next
AROUND = 96                    # edges around at the shoulder


def steps(length, first, last=COARSE):
    """Places along `length` from 0, edges growing from `first`."""
    at, edge, places = 0.0, first, [0.0]
    while at + 1.5 * edge < length:
        at += edge
        places.append(at)
        edge = min(GROWTH * edge, last)
    return places + [length]


def around(edge):
    """Edges around a ring beside edges of this length."""
    n = AROUND
    while n > 24 and 2 * math.pi * SMALL / n < 0.6 * edge:
        n //= 2
    return n


class Mesh:
    def __init__(self):
        self.points = []
        self.groups = []       # (name, facets)

    def ring(self, radius, z, n):
        """Circumscribed in the mean: the polygon has the circle's area."""
        w = math.pi / n
        r = radius * math.sqrt(2 * w / math.sin(2 * w))
        first = len(self.points)
        for k in range(n):
            a = 2 * math.pi * k / n
            self.points.append((r * math.cos(a), r * math.sin(a), z))
        return list(range(first, first + n))

    def strip(self, low, high):
        """Facets between two rings, outward where `high` follows `low` along
        the profile from the big end to the small one."""
        facets = []
        i = j = 0
        n, m = len(low), len(high)
        while i < n or j < m:
            # The diagonal that keeps the two angles together.
            if j == m or (i < n and (i + 0.5) / n <= (j + 0.5) / m):
                facets.append((low[i % n], low[(i + 1) % n], high[j % m]))
                i += 1
            else:
                facets.append((low[i % n], high[(j + 1) % m], high[j % m]))
                j += 1
        return facets

    def disk(self, rim, radius, z, down):
        """Rings towards the middle, ever fewer points around."""
        facets, ring, n = [], rim, len(rim)
        r = radius
        while n > 6:
            edge = 2 * math.pi * r / n
            r -= edge
            if r < 1.2 * edge:
                break
            if 2 * math.pi * r / n < 0.6 * COARSE and n % 2 == 0:
                n //= 2
            inner = self.ring(r, z, n)
            facets += self.strip(ring, inner)
            ring = inner
        middle = len(self.points)
        self.points.append((0.0, 0.0, z))
        facets += [(ring[k], ring[(k + 1) % len(ring)], middle)
                   for k in range(len(ring))]
        return [(a, c, b) for a, b, c in facets] if down else facets

    def write(self, name):
        with open(FOLDER / name, "w", encoding="ascii") as file:
            file.write("# mm; made by make_parts.py\n")
            for x, y, z in self.points:
                file.write(f"v {x:.5f} {y:.5f} {z:.5f}\n")
            for group, facets in self.groups:
                file.write(f"g {group}\n")
                for a, b, c in facets:
                    file.write(f"f {a + 1} {b + 1} {c + 1}\n")


def shaft(name, fine, fillet):
    """`fine`: edges at the shoulder; `fillet`: its radius, 0: none."""
    mesh = Mesh()
    profile = []               # (radius, z, group of the strip that ends here)
    big = steps(-LOW, fine)
    profile += [(BIG, -z, "big") for z in reversed(big)]
    foot = SMALL + fillet
    down = steps(BIG - foot, fine) if BIG - foot > 1e-9 else [0.0]
    down = [BIG - foot - s for s in reversed(down)]
    profile += [(BIG - s, 0.0, "shoulder") for s in down[1:]]
    parts = max(1, round(0.5 * math.pi * fillet / fine)) if fillet else 0
    for k in range(1, parts + 1):
        a = 0.5 * math.pi * k / parts
        profile.append((foot - fillet * math.sin(a),
                        fillet * (1 - math.cos(a)), "fillet"))
    start = profile[-1][1]
    profile += [(SMALL, start + z, "small")
                for z in steps(HIGH - start, fine)[1:]]
    rings = []
    for k, (radius, z, _) in enumerate(profile):
        near = [math.dist(profile[k][:2], profile[i][:2])
                for i in (k - 1, k + 1) if 0 <= i < len(profile)]
        rings.append(mesh.ring(radius, z, around(max(near))))
    groups = {"big_end": mesh.disk(rings[0], BIG, LOW, True)}
    for k in range(1, len(profile)):
        groups.setdefault(profile[k][2], []).extend(
            mesh.strip(rings[k - 1], rings[k]))
    groups["small_end"] = mesh.disk(rings[-1], SMALL, HIGH, False)
    mesh.groups = list(groups.items())
    mesh.write(name)
    return mesh


def check(mesh):
    """Closed, and its volume above 0."""
    edges, volume = {}, 0.0
    for _, facets in mesh.groups:
        for facet in facets:
            p, q, r = (mesh.points[v] for v in facet)
            volume += (p[0] * (q[1] * r[2] - q[2] * r[1])
                       - p[1] * (q[0] * r[2] - q[2] * r[0])
                       + p[2] * (q[0] * r[1] - q[1] * r[0])) / 6
            for k in range(3):
                edge = facet[k], facet[(k + 1) % 3]
                assert edge not in edges, edge
                edges[edge] = True
    assert all((b, a) in edges for a, b in edges), "open"
    return volume


if __name__ == "__main__":
    FOLDER.mkdir(parents=True, exist_ok=True)
    for name, fine, fillet in (("sharp.obj", 0.8, 0.0),
                               ("sharp_fine.obj", 0.4, 0.0),
                               ("fillet_4.obj", 0.5, 4.0),
                               ("fillet_10.obj", 0.9, 10.0)):
        mesh = shaft(name, fine, fillet)
        volume = check(mesh)
        size = (FOLDER / name).stat().st_size
        print(f"{name}: {sum(len(f) for _, f in mesh.groups)} facets, "
              f"{volume:.1f} mm3, {size} bytes")
