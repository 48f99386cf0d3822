"""Meshes: coordinates, cells and boundary patches, from files or arrays."""

from __future__ import annotations

import os
from collections.abc import Iterator, Mapping
from functools import cached_property
from pathlib import Path
from typing import TYPE_CHECKING, Any, TypeVar

from numpy.typing import ArrayLike

from . import _sagitta, convert
from .arrays import Cells, coordinates, elements
from .report import CurveReport

if TYPE_CHECKING:
    import numpy as np
    from numpy.typing import NDArray

    from .arrays import Float

__all__ = ["CurvedMesh", "Mesh", "Patch", "Patches", "read"]

Name = str | os.PathLike[str]
M = TypeVar("M", bound="Mesh")

#: What reading files may use, as the program's defaults are.
LIMITS: dict[str, Any] = {"cad_timeout": 300.0, "memory_limit": None}


class Patch:
    """The boundary elements of one name: faces of a volume mesh, lines of a plane one.

    Attributes:
        name: the physical name, or ``surface 3`` where the file gives none.
    """

    def __init__(self, name: str, native: _sagitta.Patch) -> None:
        self.name = name
        self._native = native

    @property
    def faces(self) -> Cells:
        """Nodes of the faces by kind, as :attr:`Mesh.cells`: ``faces["triangle"]``, ``faces["quad", "gmsh"]``."""
        return Cells(self._native.kinds(), self._native.nodes)

    @cached_property
    def cad_face(self) -> list[str | None]:
        """The CAD entity that each face lies on, ``face:2``, or None; one kind of faces after the other, as in :attr:`faces`.

        Only of curved meshes. The names are those that :meth:`sagitta.Cad.project` takes.
        """
        return self._native.cad_face()

    @cached_property
    def distance(self) -> Float:
        """The largest distance of each face from its CAD, (n,), in the mesh's unit; NaN where it is not associated with the CAD.

        Only of curved meshes; sampled at (3p)² points a face. The order is that of :attr:`cad_face`.
        """
        return self._native.distance()

    def __repr__(self) -> str:
        return f"Patch({self.name!r})"


class Patches(Mapping[str, Patch]):
    """Boundary patches by name, in the order of the file."""

    def __init__(self, native: _sagitta.Mesh) -> None:
        self._native = native
        self._names = native.patches()

    def __getitem__(self, name: str) -> Patch:
        return Patch(name, self._native.patch(name))

    def __iter__(self) -> Iterator[str]:
        return iter(self._names)

    def __len__(self) -> int:
        return len(self._names)

    def __repr__(self) -> str:
        return f"Patches({', '.join(map(repr, self._names))})"


class Mesh:
    """A mesh of one polynomial order.

    Args:
        points: coordinates, (n, 3) or in the plane (n, 2), in the unit of the CAD.
        cells: by kind (``tet``, ``pyramid``, ``prism``, ``hex``; in the plane ``triangle``, ``quad``) the nodes of the cells, (m, k), numbers
            into ``points``. All are of one order, which k tells.
        patches: by name, and in it by kind, the nodes of the boundary elements.
        node_order: the order of the nodes in an element; see :class:`sagitta.arrays.Cells`. It does not matter in linear meshes but
            for ``basix`` and ``lexicographic``.
    """

    _native: _sagitta.Mesh

    def __init__(
        self,
        points: ArrayLike,
        cells: Mapping[str, ArrayLike],
        patches: Mapping[str, Mapping[str, ArrayLike]] | None = None,
        *,
        node_order: str = "cgns",
    ) -> None:
        named = [(name, elements(f"patches[{name!r}]", own)) for name, own in (patches or {}).items()]
        self._native = _sagitta.from_arrays(coordinates(points), elements("cells", cells), named, node_order)

    @classmethod
    def _of(cls: type[M], native: _sagitta.Mesh) -> M:
        mesh = cls.__new__(cls)
        mesh._native = native
        return mesh

    @property
    def order(self) -> int:
        """Polynomial order of all elements, 1 to 4."""
        return self._native.order

    @property
    def dimension(self) -> int:
        """Dimension of the cells, 2 or 3."""
        return self._native.dimension

    @property
    def points(self) -> Float:
        """Coordinates of the nodes, (n, 3), in the mesh's unit: a view on the mesh's own memory, read-only."""
        return self._native.points()

    @property
    def cells(self) -> Cells:
        """Nodes of the cells by kind: ``cells["hex"]``, ``cells["hex", "lexicographic"]``."""
        return Cells([kind for kind, _ in self._native.counts()], self._native.nodes)

    def numbers(self, kind: str) -> NDArray[np.uint64]:
        """The numbers that the cells of a kind have in files, (m,): messages and reports name elements by them."""
        return self._native.numbers(kind)

    @property
    def patches(self) -> Patches:
        """Boundary patches by name."""
        return Patches(self._native)

    @property
    def notes(self) -> list[str]:
        """What reading changed or left out."""
        return self._native.notes

    def write(
        self,
        path: Name,
        target: str | None = None,
        *,
        msh_version: str = "4.1",
        ascii: bool = False,
        volume_only: bool = False,
        physical_only: bool = False,
    ) -> list[str]:
        """Writes the mesh; the ending of the name is the format. The same bytes as the program ``sagitta`` writes.

        Args:
            path: the file; it appears under its name only when it is complete.
            target: the solver that it is for (``mfem``, ``pyfr``, ``dolfinx``, ``ngsolve``, ``nektar``, ``flexi``, ``su2``, ``gmsh``, ``paraview``).
            msh_version: of MSH files, ``4.1`` or ``2.2``.
            ascii: MSH as text.
            volume_only: VTU without the boundary elements.
            physical_only: without points, lines and faces that belong to no physical group.

        Returns:
            Notes of what was changed for the solver and of what the format does not hold.

        Raises:
            MeshError: the format or solver cannot take the mesh.
            FileError: the system refuses.
        """
        return self._native.write(os.fspath(path), target, msh_version, ascii, volume_only, physical_only)

    def to_meshio(self) -> Any:
        """The mesh as ``meshio.Mesh``, with the patches as cell sets; see :func:`sagitta.convert.meshio.of`."""
        return convert.load("meshio").of(self)

    def to_pyvista(self) -> Any:
        """The mesh as ``pyvista.UnstructuredGrid`` of Lagrange cells; see :func:`sagitta.convert.pyvista.of`."""
        return convert.load("pyvista").of(self)

    def to_mfem(self) -> Any:
        """The mesh as ``mfem.ser.Mesh`` (PyMFEM), with curved nodes; see :func:`sagitta.convert.mfem.of`."""
        return convert.load("mfem").of(self)

    def to_dolfinx(self, comm: Any) -> Any:
        """The mesh as DOLFINx has it; see :func:`sagitta.convert.dolfinx.of`."""
        return convert.load("dolfinx").of(self, comm)

    def to_ngsolve(self) -> Any:
        """The mesh as ``ngsolve.Mesh``, curved; see :func:`sagitta.convert.ngsolve.of`."""
        return convert.load("ngsolve").of(self)

    def __repr__(self) -> str:
        cells = ", ".join(f"{count} {kind}" for kind, count in self._native.counts())
        return f"<sagitta.{type(self).__name__} P{self.order}: {len(self.points)} points, {cells}>"


class CurvedMesh(Mesh):
    """A mesh that :func:`sagitta.curve` curved, with its report."""

    @cached_property
    def report(self) -> CurveReport:
        """What came out, and what is proven of it."""
        return CurveReport(self._native)

    @property
    def min_jacobians(self) -> Float:
        """A proven lower bound of J/Jc of each cell, (cells,): all kinds together, in the order of files."""
        return self._native.minima()


def read(path: Name, *, memory_limit: int | None = None) -> Mesh:
    """Reads a mesh file of order 1 to 4; its format is found by content and name.

    Args:
        path: MSH, CGNS, UGRID, SU2, VTU, MFEM, GMF, PLOT3D; ``docs/formats.md`` says of each what is read.
        memory_limit: bytes of memory that reading may take; by default half of the machine's.

    Raises:
        MeshError: the file is damaged, or in no known format.
        FileError: the system refuses.
    """
    return Mesh._of(_sagitta.read(os.fspath(path), LIMITS | {"memory_limit": memory_limit}))


def source(mesh: Name | Mesh) -> str | _sagitta.Mesh:
    """A mesh as the native functions take it: the name of a file, or what a mesh holds."""
    return mesh._native if isinstance(mesh, Mesh) else str(Path(mesh))
