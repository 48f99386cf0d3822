"""The least and largest value of every array of a VTU file over its cells of the highest dimension, as VTK reads them, as one JSON document.

    fields.py FILE.vtu
"""

import json
import sys

import numpy as np
import pyvista

grid = pyvista.read(sys.argv[1])
own = np.asarray(grid.cell_data["dimension"]) == np.max(grid.cell_data["dimension"])
cells = {name: np.asarray(values)[own] for name, values in grid.cell_data.items()}
found = {name: [float(values.min()), float(values.max())] for name, values in (cells | dict(grid.point_data)).items()}
print(json.dumps(found))
