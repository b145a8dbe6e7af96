"""Read by FreeCAD's command line: the solid of each STEP file in STEP_FILES.

    STEP_FILES="a.step b.step" freecadcmd tests/peers/freecad_step.py

Prints a line per file; the last says how many are not one valid closed solid.
"""
import os

import Part  # FreeCAD's own

BAD = 0
for path in os.environ["STEP_FILES"].split():
    shape = Part.Shape()
    shape.read(path)
    solids = shape.Solids
    good = len(solids) == 1 and shape.isValid() and solids[0].isClosed()
    BAD += not good
    center = solids[0].CenterOfMass if solids else (0, 0, 0)
    print(f"{path}: {len(solids)} solids, {len(shape.Faces)} faces, valid "
          f"{shape.isValid()}, volume {shape.Volume:.9g} mm3, mass centre "
          f"({center[0]:.6g}, {center[1]:.6g}, {center[2]:.6g})")
print(f"{BAD} files are not one valid closed solid")
