"""Random film problems, each a Surface Evolver datafile: rims, crude first facets,
volumes or pressures. The same kind and number give the same problem everywhere.
Lengths have no unit; tension is 1."""
import math
import random

SMOOTH = 64  # points a rim, for the volume of the loft itself


def add(a, b, factor=1.0):
    return tuple(x + factor * y for x, y in zip(a, b))


def cross(a, b):
    return (a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2],
            a[0] * b[1] - a[1] * b[0])


def dot(a, b):
    return sum(x * y for x, y in zip(a, b))


def unit(a):
    return tuple(x / math.sqrt(dot(a, a)) for x in a)


class Rim:
    """A circle or square about `normal`; size: radius, or half a side. Points run
    counterclockwise seen from the tip of the normal."""

    def __init__(self, shape, centre, normal, size, turn=0.0):
        self.shape, self.centre, self.size = shape, centre, size
        self.normal = unit(normal)
        least = min(range(3), key=lambda k: abs(self.normal[k]))
        axis = tuple(float(k == least) for k in range(3))
        u = unit(add(axis, self.normal, -dot(axis, self.normal)))
        v = cross(self.normal, u)
        c, s = math.cos(turn), math.sin(turn)
        self.u = tuple(c * a + s * b for a, b in zip(u, v))
        self.v = cross(self.normal, self.u)

    def at(self, t):
        """The point at the angle t."""
        x, y = math.cos(t), math.sin(t)
        if self.shape == "square":
            # evenly spaced along each side, corners at 45 degrees
            quarter = math.floor(2 * t / math.pi + 0.5)
            along = 2 * (2 * t / math.pi - quarter)
            c, s = math.cos(quarter * math.pi / 2), math.sin(
                quarter * math.pi / 2)
            x, y = c - s * along, s + c * along
        return add(add(self.centre, self.u, self.size * x), self.v,
                   self.size * y)

    def boundary(self, number):
        rows = [f"boundary {number} parameters 1"]
        for k in range(3):
            rows.append(
                f"x{k + 1}: {self.centre[k]:.17g} + ({self.size * self.u[k]:.17g})"
                f"*cos(p1) + ({self.size * self.v[k]:.17g})*sin(p1)")
        return "\n".join(rows) + "\n"


class Film:
    """A datafile in the making. Caps are fixed facets without tension."""

    def __init__(self):
        self.head = []
        self.points, self.marks = [], []
        self.facets = []  # (three points, is a cap)
        self.bodies = []  # (facets with a sign, from 1, "volume 3")
        self.lines = {}   # of points (a, b) -> marks of the edge a-b
        self.held = []    # Rim

    def point(self, place, mark=""):
        self.points.append(tuple(place))
        self.marks.append(mark)
        return len(self.points) - 1

    def facet(self, a, b, c, cap=False):
        self.facets.append(((a, b, c), cap))
        return len(self.facets)

    def rim(self, rim, count):
        """Its points, held, and the edges between them."""
        self.held.append(rim)
        number = len(self.held)
        round_one = rim.shape == "circle"
        if round_one:
            self.head.append(rim.boundary(number))
        ring = []
        for k in range(count):
            t = 2 * math.pi * (k + 0.5) / count
            # squares have a point at each corner
            t = t if round_one else 2 * math.pi * k / count + math.pi / 4
            mark = f"boundary {number} fixed" if round_one else "fixed"
            ring.append(self.point(rim.at(t), mark))
            if round_one:
                self.marks[-1] = (t, mark)
        for a, b in zip(ring, ring[1:] + ring[:1]):
            self.lines[a, b] = f"boundary {number} fixed" if round_one \
                else "fixed"
        return ring

    def cap(self, ring, centre):
        """A fan with its normal as `ring` runs."""
        middle = self.point(centre, "fixed")
        for a in ring:
            self.lines[middle, a] = "fixed"
        return [self.facet(middle, a, b, True)
                for a, b in zip(ring, ring[1:] + ring[:1])]

    def band(self, low, high):
        result = []
        for k in range(len(low)):
            j = (k + 1) % len(low)
            result.append(self.facet(low[k], low[j], high[j]))
            result.append(self.facet(low[k], high[j], high[k]))
        return result

    def fan(self, ring, centre):
        middle = self.point(centre)
        return [self.facet(middle, a, b)
                for a, b in zip(ring, ring[1:] + ring[:1])]

    def volume(self, facets):
        total = 0.0
        for f in facets:
            a, b, c = (self.points[i] for i in self.facets[abs(f) - 1][0])
            total += dot(a, cross(b, c)) / 6 * (1 if f > 0 else -1)
        return total

    def films(self):
        return sum(1 for _, cap in self.facets if not cap)

    def moves(self):
        """Is any of the first points free?"""
        return any(mark in ("", "constraint 1") for mark in self.marks)

    def pressed(self):
        return any("pressure" in held for _, held in self.bodies)

    def text(self):
        edges, numbers = [], {}

        def edge(a, b):
            if (b, a) in numbers:
                return -numbers[b, a]
            if (a, b) not in numbers:
                edges.append((a, b))
                numbers[a, b] = len(edges)
            return numbers[a, b]
        for a, b in self.lines:
            edge(a, b)
        faces = [[edge(t[k], t[(k + 1) % 3]) for k in range(3)]
                 for t, _ in self.facets]
        rows = ["gravity_constant 0", ""] + self.head + ["vertices"]
        for i, (p, mark) in enumerate(zip(self.points, self.marks), 1):
            if isinstance(mark, tuple):
                rows.append(f"{i} {mark[0]:.17g} {mark[1]}")
            else:
                rows.append(f"{i} {p[0]:.17g} {p[1]:.17g} {p[2]:.17g} {mark}")
        rows += ["", "edges"]
        for i, (a, b) in enumerate(edges, 1):
            rows.append(f"{i} {a + 1} {b + 1} {self.lines.get((a, b), '')}")
        rows += ["", "faces"]
        for i, ((_, cap), face) in enumerate(zip(self.facets, faces), 1):
            rows.append(f"{i} {face[0]} {face[1]} {face[2]}"
                        + (" fixed tension 0" if cap else ""))
        if self.bodies:
            rows += ["", "bodies"]
        for i, (sides, held) in enumerate(self.bodies, 1):
            lines = [" ".join(map(str, sides[k:k + 16]))
                     for k in range(0, len(sides), 16)]
            rows.append(f"{i} " + " \\\n".join(lines) + f" {held}")
        return "\n".join(rows) + "\n\nread\n"


def rim_of(r, centre, normal, size):
    return Rim(r.choice(("circle", "square")), centre, normal, size,
               r.uniform(0, math.pi / 2))


def tilted(r, most):
    angle, way = math.radians(r.uniform(0, most)), r.uniform(0, 2 * math.pi)
    return (math.sin(angle) * math.cos(way), math.sin(angle) * math.sin(way),
            math.cos(angle))


def mixed(a, b, s):
    return add(tuple((1 - s) * x for x in a), b, s)


def loft(film, low, high, count, rows):
    """Rings from rim to rim: the first and last are held."""
    bottom, top = film.rim(low, count), film.rim(high, count)
    rings = [bottom]
    for k in range(1, rows):
        rings.append([film.point(mixed(film.points[a], film.points[b], k / rows))
                      for a, b in zip(bottom, top)])
    return rings + [top]


def loft_volume(low, high):
    film = Film()
    return film.volume(tube_body(film, loft(film, low, high, SMOOTH, 1), low,
                                 high))


def tube_body(film, rings, low, high):
    sides = []
    for a, b in zip(rings, rings[1:]):
        sides += film.band(a, b)
    sides += film.cap(rings[0][::-1], low.centre)
    return sides + film.cap(rings[-1], high.centre)


def two_rims(r, longest=3.5):
    size = r.uniform(0.7, 1.1)
    low = rim_of(r, (0.0, 0.0, 0.0), tilted(r, 10), size)
    away, way = r.uniform(0, 0.6), r.uniform(0, 2 * math.pi)
    high = rim_of(r, (away * math.cos(way), away * math.sin(way),
                      size * r.uniform(0.8, longest)), tilted(r, 25),
                  r.uniform(0.5, 1.1))
    return low, high


def tube(r, least=0.85, most=1.35, pressure=None, longest=3.5):
    """Between two rims: tilted, turned, offset."""
    film = Film()
    low, high = two_rims(r, longest)
    rings = loft(film, low, high, r.choice((8, 12, 16)), r.randint(1, 4))
    sides = tube_body(film, rings, low, high)
    held = f"volume {r.uniform(least, most) * loft_volume(low, high):.17g}" \
        if pressure is None else f"pressure {pressure:.17g}"
    film.bodies.append((sides, held))
    return film, rings


def strut(r, volume=14.0):
    """A square foot, a round end that stands off it, no good facet."""
    film = Film()
    low = Rim("square", (0.0, 0.0, 0.0), (0, 0, 1), 1.0)
    high = Rim("circle", (0.8, 0.0, 4.0), (0, 0, 1), 0.6, -math.pi / 4)
    rings = loft(film, low, high, r.choice((12, 16, 20)), r.choice((3, 5, 6)))
    film.bodies.append((tube_body(film, rings, low, high), f"volume {volume}"))
    return film


def hull(points):
    """Triangles of the convex hull, outward (incremental, for a hundred points in
    general position)."""
    def normal(t):
        a, b, c = (points[i] for i in t)
        return cross(add(b, a, -1), add(c, a, -1))
    middle = tuple(sum(points[i][k] for i in range(4)) / 4 for k in range(3))
    faces = []
    for t in ((0, 1, 2), (0, 1, 3), (0, 2, 3), (1, 2, 3)):
        out = dot(normal(t), add(points[t[0]], middle, -1)) > 0
        faces.append(t if out else (t[0], t[2], t[1]))
    for i in range(4, len(points)):
        seen = [t for t in faces
                if dot(normal(t), add(points[i], points[t[0]], -1)) > 0]
        if not seen:
            continue
        sides = {(t[k], t[(k + 1) % 3]) for t in seen for k in range(3)}
        gone = set(seen)
        faces = [t for t in faces if t not in gone]
        faces += [(a, b, i) for a, b in sides if (b, a) not in sides]
    return faces


def branch(r):
    """Three to five rims around a middle, joined by their convex hull."""
    while True:
        normals = []
        count = r.randint(3, 5)
        while len(normals) < count:
            n = unit(tuple(r.gauss(0, 1) for _ in range(3)))
            if all(dot(n, m) < 0.35 for m in normals):
                normals.append(n)
        film = Film()
        rims, rings = [], []
        for n in normals:
            size = r.uniform(0.45, 0.7)
            if r.random() < 0.5:
                rims.append(Rim("circle", tuple(1.3 * x for x in n), n, size,
                                r.uniform(0, 6)))
            else:
                rims.append(Rim("square", tuple(1.3 * x for x in n), n,
                                0.8 * size, r.uniform(0, 6)))
            rings.append(film.rim(rims[-1], 8))
        points = list(film.points)
        # a tip above each rim, so that the hull holds it as a fan
        for rim in rims:
            points.append(add(rim.centre, rim.normal, 0.02))
        tips = len(film.points)
        order = list(range(len(points)))
        r.shuffle(order)
        faces = [tuple(order[i] for i in t)
                 for t in hull([points[i] for i in order])]
        fans = [[t for t in faces if tips + k in t] for k in range(count)]
        if not all(len(fan) == len(ring) for fan, ring in zip(fans, rings)) \
                or len({i for t in faces for i in t}) < len(points):
            continue
        sides = [film.facet(*t) for t in faces if max(t) < tips]
        for rim, ring in zip(rims, rings):
            sides += film.cap(ring, rim.centre)
        whole = film.volume(sides)
        film.bodies.append(
            (sides, f"volume {r.uniform(0.5, 1.0) * whole:.17g}"))
        return film


def chambers(r):
    """A tube with a film across it: two volumes and a line where three meet."""
    film = Film()
    low, high = two_rims(r, 3.0)
    rings = loft(film, low, high, r.choice((8, 12)), 4)
    lower = film.band(rings[0], rings[1]) + film.band(rings[1], rings[2])
    upper = film.band(rings[2], rings[3]) + film.band(rings[3], rings[4])
    across = film.fan(rings[2], mixed(low.centre, high.centre, 0.5))
    lower += across + film.cap(rings[0][::-1], low.centre)
    upper += [-f for f in across] + film.cap(rings[4], high.centre)
    for sides in (lower, upper):
        film.bodies.append(
            (sides, f"volume {r.uniform(1.0, 1.4) * film.volume(sides):.17g}"))
    return film


def sliding(r):
    """A bridge from a held rim down to a plane that it wets at some angle."""
    film = Film()
    size = r.uniform(0.7, 1.1)
    high = rim_of(r, (0.0, 0.0, size * r.uniform(0.6, 1.8)), tilted(r, 15), size)
    count, rows = r.choice((8, 12, 16)), r.randint(1, 3)
    top = film.rim(high, count)
    angle = math.radians(r.uniform(50, 130))
    film.head.append(
        "constraint 1\nformula: z = 0\nenergy:\ne1: 0\n"
        f"e2: {-math.cos(angle):.17g}*x\ne3: 0\n")
    foot = [(film.points[v][0], film.points[v][1], 0.0) for v in top]
    bottom = [film.point(p, "constraint 1") for p in foot]
    for a, b in zip(bottom, bottom[1:] + bottom[:1]):
        film.lines[a, b] = "constraint 1"
    rings = [bottom]
    for k in range(1, rows):
        rings.append([film.point(mixed(p, film.points[v], k / rows))
                      for p, v in zip(foot, top)])
    rings.append(top)
    sides = []
    for a, b in zip(rings, rings[1:]):
        sides += film.band(a, b)
    sides += film.cap(top, high.centre)
    film.bodies.append(
        (sides, f"volume {r.uniform(0.8, 1.4) * film.volume(sides):.17g}"))
    return film


def pressed(r):
    return tube(r, pressure=r.uniform(-0.3, 0.6), longest=1.4)[0]


def bad(r):
    """A tube whose first facets are needles, folds, or far from the volume."""
    film, rings = tube(r, 0.95, 1.3, longest=2.5)
    inner = [v for ring in rings[1:-1] for v in ring]
    way = r.choice(("needles", "folds", "far"))
    centre = tuple(sum(film.points[v][k] for v in rings[0] + rings[-1])
                   / (2 * len(rings[0])) for k in range(3))
    s = r.choice((0.4, 2.5))
    for v in inner:
        p = film.points[v]
        if way == "needles":
            film.points[v] = mixed(p, film.points[r.choice(inner)],
                                   0.02 * r.random())
            film.points[v] = (film.points[v][0], film.points[v][1],
                              0.05 * p[2])
        elif way == "folds":
            film.points[v] = tuple(x + r.uniform(-0.35, 0.35) for x in p)
        else:
            film.points[v] = (centre[0] + s * (p[0] - centre[0]),
                              centre[1] + s * (p[1] - centre[1]), p[2])
    return film


KINDS = {"tube": lambda r: tube(r)[0], "branch": branch, "chambers": chambers,
         "sliding": sliding, "pressed": pressed, "bad": bad, "strut": strut}


def problem(kind, number, seed=1):
    """Problem `number` of a kind: a Film."""
    return KINDS[kind](random.Random(f"{kind} {number} {seed}"))
