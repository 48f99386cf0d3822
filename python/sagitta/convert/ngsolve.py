"""To NGSolve, through a temporary MSH file that Netgen reads."""

from __future__ import annotations

import tempfile
from pathlib import Path
from typing import TYPE_CHECKING

import ngsolve
from netgen.read_gmsh import ReadGmsh

if TYPE_CHECKING:
    from ..mesh import Mesh


def of(mesh: Mesh) -> ngsolve.Mesh:
    """An ``ngsolve.Mesh`` with the patches as boundaries.

    Raises:
        MeshError: what Netgen's reader does not have: tets beyond P2, other cells beyond P1.
    """
    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder) / "mesh.msh"
        mesh.write(path, target="ngsolve")
        return ngsolve.Mesh(ReadGmsh(str(path)))
