"""To PyMFEM, through a temporary MFEM mesh: its spaces number nodes over the whole mesh, which the file's writer knows."""

from __future__ import annotations

import tempfile
from pathlib import Path
from typing import TYPE_CHECKING

import mfem.ser

if TYPE_CHECKING:
    from ..mesh import Mesh


def of(mesh: Mesh) -> mfem.ser.Mesh:
    """An ``mfem.ser.Mesh`` with curved nodes; patches are boundary attributes, and named attribute sets."""
    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder) / "mesh.mesh"
        mesh.write(path, target="mfem")
        return mfem.ser.Mesh(str(path), 1, 0)  # edges are made; nothing is refined or turned
