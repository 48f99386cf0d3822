"""CAD: entities, and closest points on them."""

from __future__ import annotations

import os
from collections.abc import Iterable
from typing import TYPE_CHECKING, NamedTuple

from numpy.typing import ArrayLike

from . import _sagitta
from .arrays import coordinates
from .mesh import LIMITS, Name

if TYPE_CHECKING:
    import numpy as np
    from numpy.typing import NDArray

    from .arrays import Float

__all__ = ["Cad", "Entity", "Feet"]


class Entity(NamedTuple):
    """A face or edge of a CAD file."""

    id: str
    """Its number as a reference: ``face:2``."""
    kind: str
    """``plane``, ``cylinder``, ``nurbs``, ..."""
    reference: str
    """What the file calls it: ``step:#123``."""
    name: str
    """Its name in the file, or nothing."""


class Feet(NamedTuple):
    """The closest points of CAD entities to some points, in the order of these."""

    points: Float
    """The feet, (n, 3)."""
    distance: Float
    """How far the points are from them, (n,)."""
    entity: list[str]
    """The entity that each lies on: ``face:2``."""
    parameters: Float
    """(u, v) on the face, (t, 0) on an edge, (n, 2); NaN where there are none."""
    proven: NDArray[np.bool_]
    """Whether each is proven to be the closest point, (n,)."""
    end: list[str]
    """Where the search ended: ``interior``, ``trim``, ``crease``, ``end``, ``stalled``."""


class Cad:
    """A STEP, IGES or BREP file, read by OpenCASCADE in a process of its own, which a malformed file may crash.

    Args:
        path: the file.
        scale: what its coordinates are multiplied by.
        timeout: seconds after which reading is given up.
        memory_limit: bytes that reading may take; by default 4 GB, at most half of the machine's.

    Raises:
        CadError: not CAD, malformed, or empty.
        FileError: the system refuses.
    """

    def __init__(
        self, path: Name, *, scale: float = 1.0, timeout: float = 300.0, memory_limit: int | None = None
    ) -> None:
        limits = LIMITS | {"cad_timeout": timeout, "memory_limit": memory_limit}
        self._native = _sagitta.Cad(os.fspath(path), scale, limits)

    @property
    def path(self) -> str:
        """The file."""
        return os.fspath(self._native.path)

    @property
    def scale(self) -> float:
        """What the coordinates were multiplied by."""
        return self._native.scale

    @property
    def unit(self) -> str:
        """The file's unit."""
        return self._native.unit

    @property
    def bounds(self) -> tuple[list[float], list[float]]:
        """Lower and upper corner of its box, scaled."""
        lower, upper = self._native.bounds
        return lower, upper

    @property
    def faces(self) -> list[Entity]:
        """Its faces."""
        return [Entity(*own) for own in self._native.faces]

    @property
    def edges(self) -> list[Entity]:
        """Its edges."""
        return [Entity(*own) for own in self._native.edges]

    @property
    def groups(self) -> dict[str, list[str]]:
        """Named groups, and the ids of their members."""
        return dict(self._native.groups)

    def project(self, points: ArrayLike, group: Iterable[str] | None = None) -> Feet:
        """The closest points to some points.

        Args:
            points: (n, 3), in the CAD's unit times ``scale``.
            group: references of the entities to project onto, as ``face:2``, ``name:"wing"``, ``group:"walls"``; by default all faces and
                free edges.

        Raises:
            KeyError: a reference to nothing.
        """
        references = [group] if isinstance(group, str) else list(group or [])
        feet = self._native.project(coordinates(points), references)
        return Feet(feet.points, feet.distance, feet.entity, feet.parameters, feet.proven, feet.end)

    def __repr__(self) -> str:
        return f"<sagitta.Cad {self.path}: {len(self._native.faces)} faces, unit {self.unit}>"
