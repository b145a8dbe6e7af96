#!/usr/bin/env python3
"""How thick are the walls of cases/h_beam_casting, front to back, further than
two thicknesses from the lines at which they meet, and anywhere? Asked: within
5 % there, and nowhere below 0.9 of what the case asks for. Not part
of the tests, which ask it of simpler walls. Needs python3-vtk9 and numpy.
Use: wall_thickness.py PROGRAM [--set NAME=VALUE ...], from anywhere."""
import math
import pathlib
import subprocess
import sys
import tempfile

import numpy as np
import vtk
from vtk.util.numpy_support import vtk_to_numpy

CASE = pathlib.Path(__file__).resolve().parents[2] / "cases/h_beam_casting"
WALLS = dict.fromkeys(["shell", "blend_1", "blend_2", "floor_1", "floor_2",
                       "web_1", "web_2"], 12.0)  # [mm]
PROMISED = 0.05
LEAST = 0.9


def read(path):
    reader = vtk.vtkXMLPolyDataReader()
    reader.SetFileName(str(path))
    reader.Update()
    mesh = reader.GetOutput()
    return (mesh, vtk_to_numpy(mesh.GetPoints().GetData()),
            vtk_to_numpy(mesh.GetPolys().GetConnectivityArray()).reshape(-1, 3))


def lines_of(points, facets):
    """Points of the edges at which three films meet."""
    edges = np.sort(np.concatenate([facets[:, [0, 1]], facets[:, [1, 2]],
                                    facets[:, [2, 0]]]), axis=1)
    edges, films = np.unique(edges, axis=0, return_counts=True)
    ends = points[edges[films == 3]]
    return np.concatenate([ends[:, 0], ends.mean(axis=1), ends[:, 1]])


def distances(points, lines):
    return np.array([np.linalg.norm(lines - p, axis=1).min() for p in points])


def probe_of(points, facets):
    cells = vtk.vtkCellArray()
    for facet in facets:
        cells.InsertNextCell(3)
        for corner in facet:
            cells.InsertCellPoint(int(corner))
    surface = vtk.vtkPolyData()
    surface.SetPoints(points)
    surface.SetPolys(cells)
    probe = vtk.vtkCellLocator()
    probe.SetDataSet(surface)
    probe.BuildLocator()
    return probe


def nearest(probe, point):
    place, cell, part, square = ([0, 0, 0], vtk.reference(0), vtk.reference(0),
                                 vtk.reference(0.0))
    probe.FindClosestPoint(point, place, cell, part, square)
    return math.sqrt(square)


def main():
    program, *settings = sys.argv[1:]
    with tempfile.TemporaryDirectory() as folder:
        subprocess.run([program, "evolve", CASE / "case.toml", *settings,
                        "--quiet", "--no-pictures", "--out", folder],
                       check=True)
        wall, points, facets = read(folder + "/wall_casting.vtp")
        lines = lines_of(*read(folder + "/film.vtp")[1:])
    names = wall.GetFieldData().GetAbstractArray("surface_names")
    names = [names.GetValue(i) for i in range(names.GetNumberOfValues())]
    label = vtk_to_numpy(wall.GetCellData().GetArray("surface"))
    worst = 0.0
    least = 1.0
    for film, asked in WALLS.items():
        probe = probe_of(wall.GetPoints(),
                         facets[label == names.index(film + "/back")])
        middles = points[facets[label == names.index(film)]].mean(axis=1)
        away = distances(middles, lines) > 2 * asked
        all_off = np.array([nearest(probe, p) for p in middles]) / asked - 1
        off = all_off[away]
        worst = max(worst, abs(off).max())
        least = min(least, 1 + all_off.min())
        print(f"{film:8} {len(off):6} places  {100 * off.min():+.2f} to "
              f"{100 * off.max():+.2f} %, least of all {all_off.min():+.2%}")
    if worst > PROMISED or least < LEAST:
        sys.exit(f"worse than {100 * PROMISED:g} %, or below {LEAST:g}")


if __name__ == "__main__":
    main()
