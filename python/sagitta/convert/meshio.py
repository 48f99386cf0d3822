"""To meshio, through a temporary MSH file: the nodes of its elements are in an order of its own, which its reader knows."""

from __future__ import annotations

import tempfile
from pathlib import Path
from typing import TYPE_CHECKING

import meshio
import numpy as np

if TYPE_CHECKING:
    from ..mesh import Mesh


def of(mesh: Mesh) -> meshio.Mesh:
    """A ``meshio.Mesh`` with the points of ``mesh``, its cells and boundary elements, and its named groups as ``cell_sets``.

    Raises:
        MeshError: pyramids of P3 and P4, which meshio does not have.
    """
    from ..errors import MeshError

    if mesh.order > 2 and "pyramid" in mesh.cells:
        raise MeshError(f"meshio has no pyramids of P{mesh.order}: write a VTU or MSH file")
    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder) / "mesh.msh"
        mesh.write(path, msh_version="2.2")  # of 4.1 meshio refuses files in which some elements have a group and others none
        theirs = meshio.read(path)
    groups = theirs.cell_data.get("gmsh:physical")
    for name, (number, dimension) in theirs.field_data.items() if groups else ():
        own = zip(theirs.cells, groups)
        theirs.cell_sets[name] = [np.flatnonzero((tags == number) & (block.dim == dimension)) for block, tags in own]
    return theirs
