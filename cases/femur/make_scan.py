#!/usr/bin/python3
"""Writes scan.stl, what fit.toml is tried on: its own part at other numbers
(TRUE) and on a finer mesh, each point of its surface moved at random by a normal
NOISE in x, y and z. The same on every machine but for the last bits of the film.
usage: make_scan.py FOLDER PROGRAM"""
import pathlib
import random
import struct
import subprocess
import sys
import tempfile

FIT = pathlib.Path(__file__).resolve().parent / "fit.toml"
TRUE = {"head_radius": 24.0, "head_offset": 41.0, "neck_shaft_degrees": 130.0,
        "version_degrees": 13.0, "shaft_width": 15.2, "volume": 67000.0}
NOISE = 0.5  # mm, standard deviation of each coordinate
FINER = {"resolution.fea": 5, "resolution.film": 2.5}


def case_text():
    """The fit's case without its scan: to be looked at as it stands."""
    text = FIT.read_text(encoding="utf-8")
    return text[:text.index("[responses.off]")] + (
        '[responses.mass]\nkind = "mass"\n\n[study]\nkind = "analyse"\n')


def read_stl(path):
    """Corners of a binary STL's facets."""
    data = pathlib.Path(path).read_bytes()
    count = struct.unpack_from("<I", data, 80)[0]
    return [struct.unpack_from("<9f", data, 84 + 50 * k + 12)
            for k in range(count)]


def write_stl(path, facets):
    with open(path, "wb") as out:
        out.write(b"scan".ljust(80) + struct.pack("<I", len(facets)))
        for facet in facets:
            out.write(struct.pack("<12fH", 0, 0, 0, *facet, 0))


def noisy(facets, spread):
    """The same surface, each of its points moved at random."""
    chance = random.Random(5)
    moved = {}
    result = []
    for facet in facets:
        corners = []
        for k in range(0, 9, 3):
            corner = facet[k:k + 3]
            if corner not in moved:
                moved[corner] = [x + chance.gauss(0, spread) for x in corner]
            corners += moved[corner]
        result.append(corners)
    return result


def main(folder, program):
    with tempfile.TemporaryDirectory() as place:
        case = pathlib.Path(place) / "true.toml"
        case.write_text(case_text(), encoding="utf-8")
        sets = [word for name, value in {**TRUE, **FINER}.items()
                for word in ("--set", f"{name}={value}")]
        subprocess.run([program, "run", case, *sets, "--quiet",
                        "--no-pictures", "--no-report", "--no-frames",
                        "--out", pathlib.Path(place) / "true"], check=True)
        facets = read_stl(next(pathlib.Path(place).glob("true/part_*.stl")))
    write_stl(folder / "scan.stl", noisy(facets, NOISE))


if __name__ == "__main__":
    main(pathlib.Path(sys.argv[1]).resolve(), sys.argv[2])
