"""How far a curving is, shown: a line that overwrites itself."""

from __future__ import annotations

import sys
from collections.abc import Iterator
from contextlib import contextmanager
from typing import TYPE_CHECKING, Callable

if TYPE_CHECKING:
    from ._sagitta import Progress

__all__ = ["shown"]


@contextmanager
def shown(wish: bool | Callable[[Progress], object] | None) -> Iterator[Callable[[Progress], object] | None]:
    """What is called with the progress: a function as given, one that shows a line, or nothing."""
    if callable(wish):
        yield wish
    elif wish or (wish is None and _is_notebook()):
        line = _Line()
        try:
            yield line
        finally:
            line.clear()
    else:
        yield None


def _is_notebook() -> bool:
    """Whether this runs in a Jupyter kernel, whose cells show stderr while they run."""
    return "ipykernel" in sys.modules


class _Line:
    """A line on stderr; it may not be there any more, which is no fault of the work."""

    def __init__(self) -> None:
        self._length = 0

    def __call__(self, at: Progress) -> None:
        order = "" if at.order is None else f", P{at.order}"
        text = f"[{at.seconds:6.1f} s] {at.step}{order}"
        if at.step in ("smooth", "recover") and at.worst_cost is not None:
            text += f": sweep {at.sweep} of at most {at.max_sweeps}, worst cost {at.worst_cost:.3f}, {at.inverted} inverted"
        self._write(text)

    def clear(self) -> None:
        self._write("")

    def _write(self, text: str) -> None:
        try:
            sys.stderr.write(f"\r{text.ljust(self._length)}" + ("" if text else "\r"))
            sys.stderr.flush()
        except (OSError, ValueError, AttributeError):
            pass
        self._length = len(text)
