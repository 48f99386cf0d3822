"""What VTK and Gmsh read of files with fields, as one JSON document: the least and largest value of every array, whether all are finite, and of
a cut through the middle those of every point array.

    fields.py FILE...      .vtu, .vtm, .vtkhdf or .msh
"""

import json
import sys

import numpy as np
import pyvista


def spread(values):
    """Least and largest of the finite values, and whether all are."""
    values = np.asarray(values)
    finite = values[np.isfinite(values)]
    return [float(np.min(finite)), float(np.max(finite)), finite.size == values.size] if finite.size else None


def grid(own):
    top = np.asarray(own.cell_data["dimension"]) == np.max(own.cell_data["dimension"])
    cut = own.extract_cells(np.flatnonzero(top)).slice(normal="x")
    return {
        "cells": {name: spread(np.asarray(values)[top]) for name, values in own.cell_data.items()},
        "points": {name: spread(values) for name, values in own.point_data.items()},
        "cut": {name: spread(values) for name, values in cut.point_data.items()} if cut.n_points else {},
        "names": {name: np.asarray(values).tolist() for name, values in own.field_data.items()},
        "count": int(np.sum(top)),
        "sizes": [float(size) for size in own.extract_cells(np.flatnonzero(top)).bounds],
    }


def views(path):
    import gmsh

    gmsh.initialize()
    gmsh.option.setNumber("General.Terminal", 0)
    gmsh.open(path)
    found = {}
    for tag in gmsh.view.getTags():
        kind, tags, data, _, _ = gmsh.view.getModelData(tag, 0)
        name = gmsh.view.option.getString(tag, "Name")
        found[name] = {"kind": kind, "count": len(tags), "spread": spread(np.concatenate(data))}
    gmsh.finalize()
    return found


def of(path):
    if path.endswith(".msh"):
        return views(path)
    own = pyvista.read(path)
    if isinstance(own, pyvista.MultiBlock):
        return {own.get_block_name(n): grid(own[n]) for n in range(own.n_blocks)}
    return grid(own)


print(json.dumps({path.rsplit("/", 1)[-1]: of(path) for path in sys.argv[1:]}))
