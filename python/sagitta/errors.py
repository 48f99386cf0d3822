"""Exceptions, by cause. All are :class:`Error`; ``except sagitta.Error`` catches everything that sagitta says of its own.

Arguments that make no sense raise ``ValueError``, ``TypeError`` or ``KeyError`` as usual; Ctrl-C raises ``KeyboardInterrupt``.
"""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from .mesh import CurvedMesh

__all__ = [
    "AssociationError",
    "CadError",
    "Error",
    "FileError",
    "LinkageError",
    "MeshError",
    "NotCertified",
]


class Error(Exception):
    """Why something was not done; the message names file, place, thing and remedy.

    Attributes:
        file: the file that it is about, where it is about one.
        place: where in the file: ``line 12``, ``byte 4096``, ``element 7``, ``3:14`` (line and column of a linkage file).
    """

    file: Path | None
    place: str | None

    def __init__(
        self, message: str, file: str | Path | None = None, place: str | None = None, errno: int | None = None
    ) -> None:
        super().__init__(message)
        self.file = None if file is None else Path(file)
        self.place = place


class FileError(Error, OSError):
    """The system refused to read or write a file; ``errno`` is its number, as of any ``OSError``."""

    def __init__(
        self, message: str, file: str | Path | None = None, place: str | None = None, errno: int | None = None
    ) -> None:
        Error.__init__(self, message, file, place)
        self.errno = errno


class MeshError(Error):
    """A mesh that cannot be read, written in this form, or curved: damaged, not linear, inverted."""


class CadError(Error):
    """CAD that cannot be read, or has nothing to curve onto."""


class LinkageError(Error):
    """A linkage file that cannot be read, or does not belong to its mesh or CAD."""


class AssociationError(Error):
    """Mesh and CAD do not belong together: another unit, another position, another case."""


class NotCertified(Error):
    """Not all elements of the curved mesh are proven valid and all its walls free of folds.

    ``keep_invalid=True`` returns such a mesh instead. With an exception it is in :attr:`mesh`, to look at what failed:
    ``error.mesh.report.worst(10)``.
    """

    mesh: CurvedMesh

    def __init__(self, message: str, mesh: CurvedMesh) -> None:
        super().__init__(message)
        self.mesh = mesh
