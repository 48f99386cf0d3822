"""Strict parsers of mesh files, for comparison: written from the formats' descriptions, without a look at sagitta's readers.

`read(path)` gives a `Mesh` or raises `Refused`. Only the forms of the samples that `agree.py` takes are known.
"""

from . import gmf, mfem, msh, su2, ugrid, vtk, vtu
from .mesh import Mesh, Refused

READERS = {"msh": msh.read, "su2": su2.read, "mesh": gmf.read, "mfem": mfem.read, "ugrid": ugrid.read, "vtk": vtk.read, "vtu": vtu.read}


def read(path):
    with open(path, "rb") as file:
        mesh = READERS[path.rsplit(".", 1)[1]](file.read(), path)
    mesh.check()
    return mesh


__all__ = ["Mesh", "Refused", "read"]
