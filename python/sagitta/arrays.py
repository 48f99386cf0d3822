"""What comes in as arrays, and cells by kind and node order."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from typing import TYPE_CHECKING, Any, Callable, TypeAlias

import numpy as np
from numpy.typing import ArrayLike, NDArray

if TYPE_CHECKING:
    Float: TypeAlias = NDArray[np.float64]
    Int: TypeAlias = NDArray[np.int64]

__all__ = ["Cells"]


class Cells(Mapping[Any, "Int"]):
    """Nodes of elements, by kind: ``cells["tet"]`` is an array of shape (elements, nodes of each), of numbers into ``points``.

    ``cells["tet", "gmsh"]`` has them in another node order: ``cgns`` (the default: corners, edges, faces, interior), ``lexicographic``
    (row by row), ``gmsh``, ``vtk``, ``basix``, ``mfem``; :func:`sagitta.node_orders` lists them. Corners come first in ``cgns``, ``gmsh``
    and ``vtk``. Each look-up makes a new array; it is yours.
    """

    def __init__(self, kinds: list[str], nodes: Callable[[str, str], Int]) -> None:
        self._kinds = kinds
        self._nodes = nodes

    def __getitem__(self, key: str | tuple[str, str]) -> Int:
        kind, order = (key, "cgns") if isinstance(key, str) else key
        if kind not in self._kinds:
            raise KeyError(f"no cells of kind {kind!r}; there are {', '.join(self._kinds) or 'none'}")
        return self._nodes(kind, order)

    def __iter__(self) -> Iterator[str]:
        return iter(self._kinds)

    def __len__(self) -> int:
        return len(self._kinds)

    def __repr__(self) -> str:
        return f"Cells({', '.join(self._kinds)})"


def coordinates(points: ArrayLike) -> Float:
    """Points as (n, 3) doubles: without a copy where they are that already; z is 0 where there are two columns."""
    array = np.ascontiguousarray(points, dtype=np.float64)
    if array.ndim != 2 or array.shape[1] not in (2, 3):
        raise ValueError(f"points has the shape {array.shape}, not (n, 3), or (n, 2) in the plane")
    if array.shape[1] == 2:
        array = np.column_stack([array, np.zeros(len(array))])
    return array


def elements(what: str, of_kind: Mapping[str, ArrayLike]) -> list[tuple[str, Int]]:
    """Nodes of elements by kind, as (n, k) integers."""
    found = []
    for kind, nodes in of_kind.items():
        array = np.asarray(nodes)
        if array.ndim != 2 or not np.issubdtype(array.dtype, np.integer):
            raise ValueError(f"{what}[{kind!r}] is not an array of integers of shape (elements, nodes of each)")
        found.append((kind, np.ascontiguousarray(array, dtype=np.int64)))
    return found
