"""Read by FreeCAD's command line: the solid of each STEP file in STEP_FILES.

    STEP_FILES="a.step b.step" freecadcmd tests/peers/freecad_step.py

Prints what it finds as JSON, a line per file.
"""
import collections
import json
import os

import FreeCAD
import Part  # FreeCAD's own

for path in os.environ["STEP_FILES"].split():
    shape = Part.Shape()
    shape.read(path)
    solids = shape.Solids
    kinds = collections.Counter(type(face.Surface).__name__
                                for face in shape.Faces)
    print()
    print(json.dumps({
        "file": path,
        "solids": len(solids),
        "faces": len(shape.Faces),
        "kinds": dict(kinds),
        "valid": shape.isValid(),
        "closed": bool(solids) and solids[0].isClosed(),
        "volume": shape.Volume,
        "centre": list(solids[0].CenterOfMass) if solids else [0, 0, 0],
        "version": ".".join(FreeCAD.Version()[:3]),
    }))
