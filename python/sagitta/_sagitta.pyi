"""The native part; its users are the modules beside it."""

from os import PathLike
from typing import Any, Callable, final

import numpy as np
from numpy.typing import NDArray

_Source = str | Mesh
_Elements = tuple[str, NDArray[np.int64]]
_Entity = tuple[str, str, str, str]

@final
class Progress:
    """Where a curving stands."""

    @property
    def step(self) -> str:
        """``read``, ``associate``, ``elevate``, ``project``, ``perturb``, ``smooth``, ``certify``, ``recover``."""
    @property
    def order(self) -> int | None:
        """The order in work; orders are curved one after the other, from P2 on."""
    @property
    def seconds(self) -> float:
        """Since the beginning."""
    @property
    def sweep(self) -> int:
        """Sweeps of the smoother so far."""
    @property
    def max_sweeps(self) -> int:
        """Most sweeps there can be."""
    @property
    def active_nodes(self) -> int:
        """Nodes that move."""
    @property
    def worst_cost(self) -> float | None:
        """Smallest cost at the last survey, 1 at best, 0 or less where an element is inverted; None before the first."""
    @property
    def inverted(self) -> int:
        """Elements with a cost of 0 or less at the last survey."""

@final
class Mesh:
    order: int
    dimension: int
    notes: list[str]
    is_curved: bool
    certified: bool
    stopped: bool
    def points(self) -> NDArray[np.float64]: ...
    def counts(self) -> list[tuple[str, int]]: ...
    def nodes(self, kind: str, order: str) -> NDArray[np.int64]: ...
    def numbers(self, kind: str) -> NDArray[np.uint64]: ...
    def patches(self) -> list[str]: ...
    def patch(self, name: str) -> Patch: ...
    def minima(self) -> NDArray[np.float64]: ...
    def worst(self, count: int) -> list[tuple[str, int, int, float, list[float]]]: ...
    def report(self) -> tuple[str, str]: ...
    def write(
        self, path: str, target: str | None, msh_version: str, ascii: bool, volume_only: bool, physical_only: bool
    ) -> list[str]: ...

@final
class Patch:
    def kinds(self) -> list[str]: ...
    def nodes(self, kind: str, order: str) -> NDArray[np.int64]: ...
    def cad_face(self) -> list[str | None]: ...
    def distance(self) -> NDArray[np.float64]: ...

@final
class Feet:
    points: NDArray[np.float64]
    distance: NDArray[np.float64]
    parameters: NDArray[np.float64]
    proven: NDArray[np.bool_]
    entity: list[str]
    end: list[str]

@final
class Cad:
    def __new__(cls, path: str, scale: float, limits: dict[str, Any]) -> Cad: ...
    path: PathLike[str]
    scale: float
    unit: str
    bounds: tuple[list[float], list[float]]
    faces: list[_Entity]
    edges: list[_Entity]
    groups: list[tuple[str, list[str]]]
    def project(self, points: NDArray[np.float64], references: list[str]) -> Feet: ...

def read(path: str, limits: dict[str, Any]) -> Mesh: ...
def from_arrays(
    points: NDArray[np.float64], cells: list[_Elements], patches: list[tuple[str, list[_Elements]]], node_order: str
) -> Mesh: ...
def curve(
    mesh: _Source,
    name: str,
    cad: str,
    cad_scale: float | None,
    linkage: str | None,
    wishes: dict[str, Any],
    limits: dict[str, Any],
    target: tuple[str, str] | None,
    progress: Callable[[Progress], object] | None,
) -> Mesh: ...
def check(mesh: _Source, name: str, linear: _Source | None, limits: dict[str, Any]) -> tuple[str, str]: ...
def link(
    mesh: _Source,
    name: str,
    cad: str,
    cad_scale: float | None,
    tolerance: float | None,
    by_tags: bool,
    limits: dict[str, Any],
) -> tuple[str, str, bytes]: ...
def validate(
    linkage: str,
    mesh: str | None,
    cad: str | None,
    cad_scale: float | None,
    tolerance: float | None,
    limits: dict[str, Any],
) -> tuple[str, str]: ...
def node_orders() -> list[tuple[str, str]]:
    """The names of the node orders and what they are, ``cgns`` (the default) first."""

def node_order(kind: str, order: int, name: str) -> list[int]:
    """For each slot of an element of a kind and polynomial order in a node order, the node of the ``cgns`` order that it holds.

    ``mesh.cells[kind][:, sagitta.node_order(kind, p, name)]`` is ``mesh.cells[kind, name]``.
    """
