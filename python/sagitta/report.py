"""Reports: what came out, and what is proven of it."""

from __future__ import annotations

import json
from typing import TYPE_CHECKING, Any, NamedTuple

if TYPE_CHECKING:
    from . import _sagitta

__all__ = ["CheckReport", "CurveReport", "LinkReport", "Report", "Validation", "WeakCell"]


class WeakCell(NamedTuple):
    """A cell, and the proven lower bound of its J/Jc."""

    kind: str
    """``tet``, ``hex``, ..."""
    row: int
    """Its row in ``mesh.cells[kind]``."""
    number: int
    """Its number in files."""
    min_jacobian: float
    """A proven lower bound of J/Jc in it; below 0 or unknown (``-inf``) where it is not proven valid."""
    position: tuple[float, float, float]
    """The middle of its corners."""


class Report:
    """A report of the program, as JSON (:attr:`data`; fields: ``docs/schema``) and as text (``str(report)``)."""

    data: dict[str, Any]
    """The document, field by field as the program's ``--report`` writes it."""

    def __init__(self, document: str, text: str) -> None:
        self.data = json.loads(document)
        self._text = text

    def __str__(self) -> str:
        return self._text

    def __repr__(self) -> str:
        return f"<sagitta.{type(self).__name__}>\n{self._text}"

    @property
    def notes(self) -> list[str]:
        """What a user should know."""
        return list(self.data.get("notes", []))


class _Certificate(Report):
    """A report with a certificate in it."""

    @property
    def certified(self) -> bool:
        """Whether every element is proven valid, and (of curved meshes) every face on the CAD free of folds."""
        return bool(self.data["certified"])

    @property
    def min_jacobian(self) -> float:
        """A proven lower bound of J/Jc over the whole mesh: Jc is the element's Jacobian in the linear mesh. ``-inf`` where there is none."""
        lower = self.data["certificate"]["j_over_jc"]["lower"]
        return float("-inf") if lower is None else float(lower)

    @property
    def min_scaled_jacobian(self) -> float:
        """A proven lower bound of the scaled Jacobian: smallest over largest determinant of an element."""
        lower = self.data["certificate"]["scaled_jacobian"]["lower"]
        return float("-inf") if lower is None else float(lower)


class CurveReport(_Certificate):
    """The report of a curved mesh; made when it is first looked at."""

    def __init__(self, native: _sagitta.Mesh) -> None:
        super().__init__(*native.report())
        self._native = native

    @property
    def certified(self) -> bool:
        return self._native.certified

    @property
    def stopped(self) -> bool:
        """Whether the smoothing was ended early: by the time limit or the progress callback."""
        return self._native.stopped

    @property
    def off_cad(self) -> list[dict[str, Any]]:
        """Boundary faces that belong to the CAD and are not on it, so that the elements behind them are valid."""
        return list(self.data["off_cad"])

    @property
    def open_faces(self) -> list[dict[str, Any]]:
        """Boundary faces that stay straight, as it could not be decided where on the CAD they lie, with cause and remedy."""
        return list(self.data["open_faces"])

    def worst(self, count: int = 10) -> list[WeakCell]:
        """The cells with the smallest proven bounds of J/Jc, worst first."""
        found = self._native.worst(count)
        return [WeakCell(kind, row, number, bound, (at[0], at[1], at[2])) for kind, row, number, bound, at in found]


class CheckReport(_Certificate):
    """What is proven of a mesh that was only checked."""

    def worst(self, count: int = 10) -> list[dict[str, Any]]:
        """The elements that are not proven valid, and the valid ones with the smallest J/Jc, worst first: at most ten of these."""
        return list(self.data["certificate"]["worst"][:count])


class LinkReport(Report):
    """What of a mesh was linked to which CAD, and what not."""

    linkage: bytes
    """The MeshLink file."""

    def __init__(self, document: str, text: str, linkage: bytes) -> None:
        super().__init__(document, text)
        self.linkage = linkage


class Validation(Report):
    """Findings about a linkage file."""

    @property
    def findings(self) -> list[dict[str, Any]]:
        """Each with ``code``, ``severity`` (error, warning, note), ``line``, ``message`` and ``remedy``."""
        return list(self.data["findings"])

    def is_clean(self, strict: bool = False) -> bool:
        """Whether there is nothing to fix; with ``strict`` notes count too."""
        return self.data["errors"] + self.data["warnings"] == 0 and not (strict and self.data["notes"])

    @property
    def notes(self) -> list[str]:
        """Messages of the findings that are no defects."""
        return [own["message"] for own in self.findings if own["severity"] == "note"]
