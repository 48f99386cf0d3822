"""To PyVista, through a temporary VTU file, which has pyramids as VTK can show them and the fields of the report."""

from __future__ import annotations

import tempfile
from pathlib import Path
from typing import TYPE_CHECKING

import pyvista

if TYPE_CHECKING:
    from ..mesh import Mesh


def of(mesh: Mesh) -> pyvista.UnstructuredGrid:
    """A ``pyvista.UnstructuredGrid`` of the cells, as Lagrange cells of the mesh's order, without the boundary elements.

    A curved mesh has the cell data ``straight``, ``certified_min_J_over_Jc`` and ``C_WCN``. ``grid.plot(nonlinear_subdivision=4)`` shows curved cells as curved.
    """
    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder) / "mesh.vtu"
        mesh.write(path, volume_only=True)
        return pyvista.UnstructuredGrid(pyvista.read(path))
