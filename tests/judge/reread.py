#!/usr/bin/env python3
"""Reads mesh files with Gmsh, meshio and PyVista (VTK), where they can, and prints what each found, as JSON.

usage: reread.py FILE...
output: {FILE: {"gmsh": {...}, "meshio": {...}, "pyvista": {...}}}; a reader that failed gives {"error": text}.
"""
import contextlib
import json
import sys

import numpy as np

PRISMS_WITHOUT_FUNCTIONS = (90, 91)  # Gmsh cannot evaluate prisms of order 3 and 4


def with_gmsh(path):
    import gmsh

    if not path.endswith((".msh", ".mesh")):
        return {"error": "not a format of Gmsh's"}
    if not gmsh.isInitialized():
        gmsh.initialize()
    gmsh.option.setNumber("General.Terminal", 0)
    gmsh.option.setNumber("General.AbortOnError", 2)
    gmsh.clear()
    gmsh.open(path)
    mesh = gmsh.model.mesh
    counts, volume, smallest = {}, 0.0, np.inf
    for kind in map(int, mesh.getElementTypes()):
        tags, _ = mesh.getElementsByType(kind)
        counts[str(kind)] = len(tags)
        if kind in PRISMS_WITHOUT_FUNCTIONS:
            volume = None
            continue
        if mesh.getElementProperties(kind)[1] != 3:
            continue
        points, weights = mesh.getIntegrationPoints(kind, "Gauss8")
        _, determinants, _ = mesh.getJacobians(kind, points)
        smallest = min(smallest, float(np.min(determinants)))
        if volume is not None:
            volume += float(np.sum(determinants.reshape(-1, len(weights)) @ np.asarray(weights)))
    node_tags, points, _ = mesh.getNodes()
    groups = [
        [d, t, gmsh.model.getPhysicalName(d, t), [int(e) for e in gmsh.model.getEntitiesForPhysicalGroup(d, t)]]
        for d, t in gmsh.model.getPhysicalGroups()
    ]
    periodic = sum(len(mesh.getPeriodicNodes(d, t)[1]) for d, t in gmsh.model.getEntities() if mesh.getPeriodicNodes(d, t)[0] != t)
    return {
        "elements": counts,
        "nodes": len(node_tags),
        "largest_tag": int(max(node_tags)),
        "volume": volume,
        "smallest_determinant": None if smallest == np.inf else smallest,
        "groups": groups,
        "periodic_pairs": periodic,
        "box": [float(x) for x in np.concatenate([np.min(points.reshape(-1, 3), 0), np.max(points.reshape(-1, 3), 0)])],
    }


def with_meshio(path):
    import meshio

    mesh = meshio.read(path)
    counts = {}
    for block in mesh.cells:
        counts[block.type] = counts.get(block.type, 0) + len(block.data)
    return {"elements": counts, "nodes": len(mesh.points)}


def with_pyvista(path):
    import pyvista

    if not path.endswith(".vtu"):
        return {"error": "only VTU is read with VTK"}
    grid = pyvista.read(path)
    counts = {int(t): int(n) for t, n in zip(*np.unique(grid.celltypes, return_counts=True))}
    sizes = grid.compute_cell_sizes(length=False, area=False, volume=True)
    return {
        "elements": counts,
        "nodes": grid.n_points,
        "volume": float(np.sum(sizes["Volume"])),
        "arrays": {name: [float(np.nanmin(grid[name])), float(np.nanmax(grid[name]))] for name in grid.array_names},
    }


def main():
    found = {}
    for path in sys.argv[1:]:
        found[path] = {}
        for name, read in (("gmsh", with_gmsh), ("meshio", with_meshio), ("pyvista", with_pyvista)):
            try:
                with contextlib.redirect_stdout(sys.stderr):
                    found[path][name] = read(path)
            except (Exception, SystemExit) as error:  # noqa: BLE001 - what the reader says is the result
                found[path][name] = {"error": f"{type(error).__name__}: {error}"}
    json.dump(found, sys.stdout)


main()
