"""Meshes as other libraries have them, one module a library: ``of(mesh)`` gives theirs."""

from __future__ import annotations

import importlib
from types import ModuleType

__all__ = ["load"]

#: What pip installs for each.
_INSTALL = {
    "meshio": "meshio",
    "pyvista": "pyvista",
    "mfem": "mfem",
    "dolfinx": "dolfinx-solver-real (or conda-forge's fenics-dolfinx)",
    "ngsolve": "ngsolve",
}


def load(library: str) -> ModuleType:
    """The converter of a library.

    Raises:
        ImportError: the library is not installed; the message says what to install.
    """
    try:
        return importlib.import_module(f"{__name__}.{library}")
    except ImportError as error:
        raise ImportError(f"{library} is needed for this: pip install {_INSTALL[library]} ({error})", name=library) from error
