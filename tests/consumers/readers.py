"""The readers: each returns what it found in a file, as far as it can tell: nodes, cells, volume, areas, faces by patch."""
import os
import re
import subprocess
import sys
import tempfile

import numpy as np

CELLS = ("tet", "pyramid", "prism", "hex")


def count(counts, key, n):
    counts[key] = counts.get(key, 0) + int(n)


def read_gmsh(path):
    import gmsh

    shapes = {"Triangle": "triangle", "Quadrilateral": "quad", "Tetrahedron": "tet", "Pyramid": "pyramid", "Prism": "prism", "Hexahedron": "hex"}
    gmsh.initialize()
    gmsh.option.setNumber("General.Terminal", 0)
    gmsh.option.setNumber("General.AbortOnError", 2)
    gmsh.open(path)
    mesh, found = gmsh.model.mesh, {"nodes": 0, "cells": {}, "volume": 0.0, "areas": {}, "faces": {}}
    found["nodes"] = len(mesh.getNodes()[0])
    names = {}
    for d, t in gmsh.model.getPhysicalGroups(2):
        names.update({int(e): gmsh.model.getPhysicalName(d, t) for e in gmsh.model.getEntitiesForPhysicalGroup(d, t)})
    for d, entity in [*gmsh.model.getEntities(2), *gmsh.model.getEntities(3)]:
        for kind, tags in zip(*mesh.getElements(d, entity)[:2]):
            if kind in (90, 91):
                found["cells"]["prism"] = found["cells"].get("prism", 0) + len(tags)
                found["volume"] = None  # it has no functions of prisms of order 3 and 4
                continue
            count(found["cells"], shapes[mesh.getElementProperties(kind)[0].split()[0]], len(tags))
            points, weights = mesh.getIntegrationPoints(kind, "Gauss14")
            _, determinants, _ = mesh.getJacobians(kind, points, entity)
            size = float((determinants.reshape(-1, len(weights)) @ weights).sum())
            if d == 3:
                found["volume"] = None if found["volume"] is None else found["volume"] + size
            else:
                name = names.get(int(entity), str(entity))
                found["areas"][name] = found["areas"].get(name, 0.0) + size
                count(found["faces"], name, len(tags))
    return found


def read_meshio(path):
    import meshio

    # meshio.read() ends the process where a file is not to its liking.
    mesh = meshio.vtu.read(path) if path.endswith(".vtu") else meshio.gmsh.read(path)
    stems = {"triangle": "triangle", "quad": "quad", "tetra": "tet", "pyramid": "pyramid", "wedge": "prism", "hexahedron": "hex"}
    stems.update({f"VTK_LAGRANGE_{name}": shape for name, shape in
                  (("TRIANGLE", "triangle"), ("QUADRILATERAL", "quad"), ("TETRAHEDRON", "tet"), ("WEDGE", "prism"), ("HEXAHEDRON", "hex"))})
    found = {"nodes": len(mesh.points), "cells": {}, "volume": None, "areas": {}, "faces": {}}
    for block in mesh.cells:
        shape = stems.get(block.type, stems.get(block.type.rstrip("0123456789")))
        if shape:
            count(found["cells"], shape, len(block.data))
    return found


def read_mfem(path):
    import mfem.ser as mfem

    mesh = mfem.Mesh(path, 1, 1, False)
    shapes = {2: "triangle", 3: "quad", 4: "tet", 5: "hex", 6: "prism", 7: "pyramid"}
    found = {"nodes": mesh.GetNodes().FESpace().GetNDofs() if mesh.GetNodes() else mesh.GetNV(), "cells": {}, "volume": 0.0, "areas": {}, "faces": {}}
    nodes = mesh.GetNodes()
    space, values = nodes.FESpace(), nodes.GetDataArray()
    rules = mfem.IntegrationRules(0, mfem.Quadrature1D.GaussLegendre)

    by_geometry = {}
    for n in range(mesh.GetNE()):
        by_geometry.setdefault(mesh.GetElementGeometry(n), []).append(n)
    for geometry, numbers in by_geometry.items():
        # MFEM's shape functions, tabled once a shape, and its numbering of nodes.
        rule, element = rules.Get(geometry, 14), space.GetFE(numbers[0])
        points = [rule.IntPoint(n) for n in range(rule.GetNPoints())]
        slopes = []
        for point in points:
            table = mfem.DenseMatrix(element.GetDof(), element.GetDim())
            element.CalcDShape(point, table)
            slopes.append(table.GetDataArray().copy())
        places = np.array([space.GetElementVDofs(n) for n in numbers]).reshape(len(numbers), 3, element.GetDof())
        count(found["cells"], shapes[geometry], len(numbers))
        found["volume"] += float(integral(values[places].transpose(0, 2, 1), np.array(slopes), [point.weight for point in points]).sum())
    # A file of cells alone has no patches: what MFEM finds on the outside has no name.
    for n in range(0 if path.endswith(".vtu") else mesh.GetNBE()):
        name, transformation = f"#{mesh.GetBdrAttribute(n)}", mesh.GetBdrElementTransformation(n)
        rule, area = rules.Get(mesh.GetBdrElementGeometry(n), 14), 0.0
        for k in range(rule.GetNPoints()):
            point = rule.IntPoint(k)
            transformation.SetIntPoint(point)
            area += point.weight * transformation.Weight()
        found["areas"][name] = found["areas"].get(name, 0.0) + area
        count(found["faces"], name, 1)
        count(found["cells"], shapes[mesh.GetBdrElementGeometry(n)], 1)
    return found


def read_vtk(path):
    import vtk
    from vtk.util.numpy_support import vtk_to_numpy

    if path.endswith(".cgns"):
        reader = vtk.vtkCGNSReader()
        reader.SetFileName(path)
        reader.UpdateInformation()
        reader.EnableAllBases()
        reader.Update()
        grids = []
        walk = reader.GetOutput().NewIterator()
        while not walk.IsDoneWithTraversal():
            grids.append(walk.GetCurrentDataObject())
            walk.GoToNextItem()
        grid = max(grids, key=lambda g: g.GetNumberOfCells())
    else:
        reader = vtk.vtkXMLUnstructuredGridReader()
        reader.SetFileName(path)
        reader.Update()
        grid = reader.GetOutput()
    shapes = {5: "triangle", 9: "quad", 10: "tet", 12: "hex", 13: "prism", 14: "pyramid", 22: "triangle", 24: "tet", 28: "quad", 29: "hex",
              32: "prism", 69: "triangle", 70: "quad", 71: "tet", 72: "hex", 73: "prism"}
    patches = grid.GetCellData().GetArray("patch")
    patches = None if patches is None else vtk_to_numpy(patches)
    points = vtk_to_numpy(grid.GetPoints().GetData())
    kinds = vtk_to_numpy(grid.GetCellTypesArray())
    offsets = vtk_to_numpy(grid.GetCells().GetOffsetsArray())
    starts, counts = offsets[:-1], np.diff(offsets)
    connectivity = vtk_to_numpy(grid.GetCells().GetConnectivityArray())
    found = {"nodes": None, "cells": {}, "volume": 0.0, "areas": {}, "faces": {}}
    for kind, length in {(int(k), int(n)) for k, n in zip(kinds, counts)}:
        if kind not in shapes:
            if kind in (1, 3, 21, 68):
                continue
            raise ValueError(f"cells of type {kind}")
        which = np.flatnonzero((kinds == kind) & (counts == length))
        cell, shape = grid.GetCell(int(which[0])), shapes[kind]
        count(found["cells"], shape, len(which))
        slopes, weights = [], []
        for at, weight in gauss(shape):
            derivatives = [0.0] * (cell.GetCellDimension() * length)
            cell.InterpolateDerivs(at, derivatives)
            # Lagrange quadrilaterals and hexes give the derivatives of a point together, the others those by a coordinate.
            together = kind in (70, 72)
            table = np.array(derivatives).reshape((-1, cell.GetCellDimension()) if together else (cell.GetCellDimension(), -1))
            slopes.append(table if together else table.T)
            weights.append(weight)
        sizes = integral(points[connectivity[starts[which][:, None] + np.arange(length)]], np.array(slopes), weights)
        if cell.GetCellDimension() == 3:
            found["volume"] += float(np.abs(sizes).sum())
        elif patches is not None:
            for patch in np.unique(patches[which]):
                own, name = patches[which] == patch, f"#{int(patch)}"
                found["areas"][name] = found["areas"].get(name, 0.0) + float(sizes[own].sum())
                count(found["faces"], name, own.sum())
    return found


def integral(corners, slopes, weights):
    """Volume or area of each cell: `corners` cell x node x 3, `slopes` point x node x parameter."""
    sizes = []
    for part in np.array_split(corners, 1 + corners.size * len(weights) // 4_000_000):
        jacobians = np.einsum("enc,pnd->epcd", part, slopes, optimize=True)
        solid = slopes.shape[2] == 3
        each = np.linalg.det(jacobians) if solid else np.linalg.norm(np.cross(jacobians[..., 0], jacobians[..., 1]), axis=-1)
        sizes.append(each @ np.array(weights))
    return np.concatenate(sizes)


_rules = {}


def gauss(shape):
    """Points in VTK's parametric coordinates, and weights."""
    if shape not in _rules:
        from reference import rule

        points, weights = rule({"triangle": "tri"}.get(shape, shape), 7)
        _rules[shape] = list(zip(points.tolist(), weights.tolist()))
    return _rules[shape]


def program(arguments, folder=None):
    """Runs a program of the environment; its whole output, and the last telling line where it fails."""
    done = subprocess.run(arguments, capture_output=True, text=True, timeout=900, cwd=folder)
    text = done.stdout + done.stderr
    if done.returncode:
        plain = [re.sub(r"\x1b\[[0-9;]*m", "", line).strip() for line in text.splitlines()]
        lines = [line for line in plain if line and "!---" not in line and "!===" not in line]
        told = [line for line in lines if "!!" in line or "Error" in line or "Exception" in line]
        lines = told or lines
        raise ValueError(lines[-1] if lines else f"exit code {done.returncode}")
    return text


def beside(name):
    return os.path.join(os.path.dirname(sys.executable), name)


def read_pyfr(path):
    import h5py

    with tempfile.TemporaryDirectory() as folder:
        out = os.path.join(folder, "mesh.pyfrm")
        program([beside("pyfr"), "import", path, out])
        found = {"nodes": None, "cells": {}, "volume": None, "areas": {}, "faces": {}}
        with h5py.File(out) as file:
            shapes = {"tet": "tet", "pyr": "pyramid", "pri": "prism", "hex": "hex"}
            names = file["codec"][()] if "codec" in file else []
            for key, group in file["eles"].items():
                count(found["cells"], shapes[key], len(group))
                for face, offset in [] if "faces" not in (group.dtype.names or ()) else [(f, None) for f in range(group.dtype["faces"].shape[0])]:
                    for cidx in group["faces"]["cidx"][:, face]:
                        code = names[cidx].decode()
                        if code.startswith("bc/"):
                            count(found["faces"], code[3:], 1)
        return found


def read_pyhope(path):
    import h5py

    with tempfile.TemporaryDirectory() as folder:
        order, names = int(os.environ["SAGITTA_ORDER"]), os.environ["SAGITTA_NAMES"].split(",")
        lines = ["ProjectName = mesh", "Mode = 3", f"Filename = {path}", f"NGeo = {order}", f"BoundaryOrder = {order + 1}", "OutputFormat = HDF5",
                 "MeshIsAlreadyCurved = T"]
        for name in names:
            lines += [f"BoundaryName = {name}", "BoundaryType = (/ 4,0,0,0 /)"]
        with open(os.path.join(folder, "parameter.ini"), "w") as file:
            file.write("\n".join(lines) + "\n")
        program([beside("pyhope"), "parameter.ini"], folder)
        mesh = [f for f in os.listdir(folder) if f.endswith(".h5")]
        found = {"nodes": None, "cells": {}, "volume": None, "areas": {}, "faces": {}}
        shapes = {4: "tet", 5: "pyramid", 6: "prism", 8: "hex"}
        with h5py.File(os.path.join(folder, mesh[0])) as file:
            for kind in file["ElemInfo"][:, 0]:
                count(found["cells"], shapes[int(kind) % 10], 1)
            listed = [name.decode().strip() for name in file["BCNames"][()]]
            for side in file["SideInfo"][:, 4]:
                if side > 0:
                    count(found["faces"], listed[int(side) - 1], 1)
        return found


def read_cgnscheck(path):
    text = program(["cgnscheck", "-w1", path])
    bad = [line for line in text.splitlines() if "ERROR" in line or "WARNING" in line]
    if bad:
        raise ValueError("; ".join(bad))
    return {"nodes": None, "cells": {}, "volume": None, "areas": {}, "faces": {}}


# Which files each reader is given.
READERS = {
    "Gmsh": (read_gmsh, ("msh41b", "msh41a", "msh22b", "msh22a", "cgns")),
    "meshio": (read_meshio, ("msh41b", "msh41a", "msh22b", "msh22a", "vtu")),
    "MFEM": (read_mfem, ("msh41b", "msh41a", "msh22b", "msh22a", "vtu_volume")),
    "PyFR": (read_pyfr, ("msh41a", "msh22a")),
    "PyHOPE": (read_pyhope, ("msh41b", "msh22a", "cgns")),
    "VTK": (read_vtk, ("vtu", "cgns")),
    "cgnscheck": (read_cgnscheck, ("cgns",)),
}
