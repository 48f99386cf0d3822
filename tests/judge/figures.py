#!/usr/bin/env python3
"""What other programs find in mesh files: nodes, cells, volume, and area of each patch, as JSON.

usage: figures.py FOLDER... > fixtures/samples/figures.json

Each file goes to Gmsh (MSH, CGNS, GMF of order 2), meshio (UGRID, SU2, GMF) and VTK (VTK, VTU, CGNS), in this order, until one reads it; the answer names the program. Patches are told
by physical name where the program gives names ("name"), else by number ("tag"). A file that none reads has their reasons.
"""
import json
import math
import os
import subprocess
import sys

import numpy as np

GMSH_SHAPES = {"Point": "point", "Line": "line", "Triangle": "triangle", "Quadrilateral": "quad", "Tetrahedron": "tet",
               "Pyramid": "pyramid", "Prism": "prism", "Hexahedron": "hex"}
PRISMS_WITHOUT_FUNCTIONS = (90, 91)  # Gmsh cannot evaluate prisms of order 3 and 4
# Faces of linear cells in VTK's and meshio's corner order.
FACES = {"tet": [[0, 2, 1], [0, 1, 3], [1, 2, 3], [2, 0, 3]],
         "pyramid": [[0, 3, 2, 1], [0, 1, 4], [1, 2, 4], [2, 3, 4], [3, 0, 4]],
         "prism": [[0, 2, 1], [0, 1, 4, 3], [1, 2, 5, 4], [2, 0, 3, 5], [3, 4, 5]],
         "hex": [[0, 3, 2, 1], [0, 1, 5, 4], [1, 2, 6, 5], [2, 3, 7, 6], [3, 0, 4, 7], [4, 5, 6, 7]]}
MESHIO_SHAPES = {"vertex": "point", "line": "line", "triangle": "triangle", "quad": "quad", "tetra": "tet", "pyramid": "pyramid",
                 "wedge": "prism", "hexahedron": "hex"}
VTK_SHAPES = {1: "point", 3: "line", 5: "triangle", 9: "quad", 10: "tet", 12: "hex", 13: "prism", 14: "pyramid", 21: "line",
              22: "triangle", 24: "tet", 28: "quad", 29: "hex", 32: "prism", 68: "line", 69: "triangle", 70: "quad", 71: "tet",
              72: "hex", 73: "prism"}


def with_gmsh(path):
    import gmsh

    # Of GMF it reads tets alone, and meshio the linear ones.
    quadratic = path.endswith(".mesh") and "TetrahedraP2" in open(path).read()
    if not path.endswith((".msh", ".cgns")) and not quadratic:
        raise ValueError("not asked")  # it has no reader of the others, or reads its own VTK files wrongly
    if not gmsh.isInitialized():
        gmsh.initialize()
    gmsh.option.setNumber("General.Terminal", 0)
    gmsh.option.setNumber("General.AbortOnError", 2)
    gmsh.clear()
    gmsh.open(path)
    mesh, cells, volume = gmsh.model.mesh, {}, 0.0
    top = max((gmsh.model.mesh.getElementProperties(int(t))[1] for t in mesh.getElementTypes() if t not in PRISMS_WITHOUT_FUNCTIONS), default=3)
    names = {}
    for d, t in gmsh.model.getPhysicalGroups(2):
        for entity in gmsh.model.getEntitiesForPhysicalGroup(d, t):
            names[int(entity)] = gmsh.model.getPhysicalName(d, t)
    areas = {}
    for d, entity in gmsh.model.getEntities():
        types, tags, _ = mesh.getElements(d, entity)
        for kind, elements in zip(map(int, types), tags):
            if kind in PRISMS_WITHOUT_FUNCTIONS:
                raise ValueError("Gmsh has no functions of prisms of order 3 and 4")
            name, dimension = mesh.getElementProperties(kind)[:2]
            shape = GMSH_SHAPES[name.split()[0]]
            cells[shape] = cells.get(shape, 0) + len(elements)
            if dimension < 2:
                continue
            points, weights = mesh.getIntegrationPoints(kind, "Gauss8")
            matrices, determinants, _ = mesh.getJacobians(kind, points, entity)
            sums = np.asarray(determinants).reshape(-1, len(weights)) @ np.asarray(weights)
            if top == 2:
                # Cells of a plane mesh may fold: their signed area, which |det| would not give.
                columns = np.asarray(matrices).reshape(-1, len(weights), 3, 3)
                normals = np.cross(columns[:, :, 0], columns[:, :, 1])
                sums = np.linalg.norm(np.einsum("egc,g->ec", normals, weights), axis=1)
            if dimension == 3:
                volume += float(np.abs(sums).sum())
            else:
                key = names.get(int(entity)) or str(entity)
                areas[key] = areas.get(key, 0.0) + float(np.abs(sums).sum())
    if not cells:
        raise ValueError("Gmsh finds no elements")
    if top == 2:
        areas = {"": sum(areas.values())}
    by = "name" if set(names.values()) >= set(areas) else "tag"
    return {"program": f"Gmsh {gmsh.__version__}", "nodes": len(mesh.getNodes()[0]), "cells": cells, "volume": volume, "by": by, "areas": areas}


def triangle(points, corners):
    a, b, c = (points[corners[:, n]] for n in range(3))
    return np.linalg.norm(np.cross(b - a, c - a), axis=1) / 2


def area(points, corners):
    if corners.shape[1] == 3:
        return triangle(points, corners)
    return triangle(points, corners[:, [0, 1, 2]]) + triangle(points, corners[:, [0, 2, 3]])


def volume_of(points, shape, corners):
    """Divergence theorem; a quadrilateral is the mean of its two triangulations."""
    total = np.zeros(len(corners))
    for face in FACES[shape]:
        cuts = [(face, 1.0)] if len(face) == 3 else [([face[0], face[1], face[2]], 0.5), ([face[0], face[2], face[3]], 0.5),
                                                     ([face[0], face[1], face[3]], 0.5), ([face[1], face[2], face[3]], 0.5)]
        for cut, weight in cuts:
            a, b, c = (points[corners[:, n]] for n in cut)
            total += weight * np.einsum("ij,ij->i", a, np.cross(b, c)) / 6
    return float(np.abs(total).sum())


def with_meshio(path):
    import meshio

    references = {"ugrid": "ugrid:ref", "su2": "su2:tag", "mesh": "medit:ref", "meshb": "medit:ref"}
    ending = path.rsplit(".", 1)[-1]
    if ending not in references:
        raise ValueError("not asked")
    mesh = meshio.read(path)
    points = np.pad(mesh.points, ((0, 0), (0, 3 - mesh.points.shape[1])))
    refs = mesh.cell_data[references[ending]]
    cells, volume, areas = {}, 0.0, {}
    for n, block in enumerate(mesh.cells):
        shape = MESHIO_SHAPES[block.type]
        cells[shape] = cells.get(shape, 0) + len(block.data)
        if shape in FACES:
            volume += volume_of(points, shape, block.data)
        elif shape in ("triangle", "quad"):
            for surface, size in zip(refs[n], area(points, block.data)):
                areas[str(int(surface))] = areas.get(str(int(surface)), 0.0) + float(size)
    if volume == 0:
        areas = {"": sum(areas.values())}
    return {"program": f"meshio {meshio.__version__}", "nodes": len(mesh.points), "cells": cells, "volume": volume, "by": "tag", "areas": areas}


def with_vtk(path):
    import pyvista
    import vtk

    if not path.endswith((".vtu", ".vtk", ".cgns")):
        raise ValueError("not asked")
    grid = pyvista.read(path)
    if isinstance(grid, pyvista.MultiBlock):
        grid = grid.combine(merge_points=False)
    cells = {}
    for kind, count in zip(*np.unique(grid.celltypes, return_counts=True)):
        if int(kind) not in VTK_SHAPES:
            raise ValueError(f"VTK has cells of type {kind}")
        cells[VTK_SHAPES[int(kind)]] = cells.get(VTK_SHAPES[int(kind)], 0) + int(count)
    sizes = grid.compute_cell_sizes(length=False, area=True, volume=True)
    ids = grid.cell_data["CellEntityIds"] if "CellEntityIds" in grid.cell_data else np.ones(grid.n_cells, int)
    volume = float(np.abs(sizes.cell_data["Volume"]).sum())
    areas = {}
    for entity, size in zip(ids, sizes.cell_data["Area"]):
        if size > 0:
            areas[str(int(entity))] = areas.get(str(int(entity)), 0.0) + float(size)
    if volume == 0:
        areas = {"": sum(areas.values())}
    found = {"program": f"VTK {vtk.vtkVersion().GetVTKVersion()}", "nodes": grid.n_points, "cells": cells, "volume": volume, "by": "tag", "areas": areas}
    if grid.celltypes.max() > 14:
        found["tolerance"] = 2e-3  # VTK measures curved cells by cutting them into flat ones,
        if volume == 0:
            del found["areas"]  # and gets folded ones wrong
    if path.endswith(".cgns"):
        found.pop("areas", None)
        del found["nodes"]  # VTK's reader repeats points, and gives the cells alone
        found["cells"] = {shape: count for shape, count in cells.items() if shape in FACES}
    if not found["cells"]:
        raise ValueError("VTK finds no cells")
    return found


READERS = {"Gmsh": with_gmsh, "meshio": with_meshio, "VTK": with_vtk}


def one(reader, path):
    """In a process of its own: readers print, and crash."""
    stdout = os.dup(1)
    os.dup2(2, 1)
    try:
        found = READERS[reader](path)
        if not all(map(math.isfinite, [found["volume"], *found.get("areas", {}).values()])):
            raise ValueError("its figures are not finite")
    except (Exception, SystemExit) as error:  # noqa: BLE001 - what the reader says is the result
        found = {"error": f"{type(error).__name__}: {error}".strip()[:160]}
    with os.fdopen(stdout, "w") as out:
        json.dump(found, out)
        out.flush()
        os._exit(0)  # some readers crash at the end only


def figures(path):
    reasons = []
    for reader in READERS:
        child = subprocess.run([sys.executable, __file__, "--one", reader, path], capture_output=True, text=True, timeout=120)
        found = json.loads(child.stdout) if child.stdout else {"error": f"crashed ({child.returncode})"}
        if "error" not in found:
            # A program that finds no faces says nothing of patches: those given by vertices are not for all.
            return {key: value for key, value in found.items() if key != "areas" or value}
        reasons.append(f"{reader}: {found['error']}".replace(os.path.dirname(path) + "/", ""))
    return {"unread": reasons}


def main():
    if sys.argv[1] == "--one":
        one(*sys.argv[2:])
    found = {}
    for folder in sys.argv[1:]:
        for name in sorted(os.listdir(folder)):
            path = os.path.join(folder, name)
            if name.rsplit(".", 1)[-1] in ("msh", "cgns", "su2", "vtk", "vtu", "ugrid", "unv", "mesh", "meshb"):
                found[name] = figures(path)
    json.dump(found, sys.stdout, indent=1, sort_keys=True)
    print()


main()
