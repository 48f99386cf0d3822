"""What sagitta does: curve, check, link, validate."""

from __future__ import annotations

import os
from collections.abc import Iterable, Mapping
from pathlib import Path
from typing import TYPE_CHECKING, Callable, Literal, TypeAlias

from numpy.typing import ArrayLike

from . import _sagitta, errors, progress as progress_display
from .cad_model import Cad
from .mesh import LIMITS, CurvedMesh, Mesh, Name, source
from .report import CheckReport, LinkReport, Validation

if TYPE_CHECKING:
    from ._sagitta import Progress

__all__ = ["check", "curve", "link", "validate"]

Kinds: TypeAlias = "Mapping[str, ArrayLike]"
Scale: TypeAlias = 'float | Literal["auto"]'

#: What meshes that come as arrays are called in messages, linkage files and reports.
IN_MEMORY = "mesh"


def curve(
    mesh: Name | Mesh | None = None,
    *,
    cad: Name | Cad,
    order: int,
    points: ArrayLike | None = None,
    cells: Kinds | None = None,
    patches: Mapping[str, Kinds] | None = None,
    linkage: Name | None = None,
    cad_scale: Scale = 1.0,
    name: str = IN_MEMORY,
    surface: bool = False,
    only: Iterable[str] | None = None,
    straight: Iterable[str] | None = None,
    by_tags: bool | None = None,
    tolerance: float | None = None,
    max_offset: float = 1e-3,
    freeze_linear: bool = False,
    freeze_walls: bool = False,
    direct: bool = False,
    curve_layers: int | None = None,
    floor: float = 0.1,
    threshold: float = 0.8,
    alpha: float | None = None,
    max_sweeps: int = 200,
    survey_factor: int = 4,
    time_limit: float | None = None,
    threads: int | None = None,
    target: tuple[Name, str] | None = None,
    keep_invalid: bool = False,
    progress: bool | Callable[[Progress], object] | None = None,
    cad_timeout: float = 300.0,
    memory_limit: int | None = None,
) -> CurvedMesh:
    """Curves a linear mesh onto its CAD, and proves every element valid.

    Args:
        mesh: the linear mesh: a file, or a :class:`Mesh`. Or give arrays:
        points: coordinates, (n, 3), in the plane also (n, 2).
        cells: nodes of the cells by kind, ``{"tet": (m, 4), "prism": (k, 6)}``.
        patches: nodes of the boundary elements by name and kind, ``{"wall": {"triangle": (f, 3)}}``.
        cad: the CAD that the mesh was made on: STEP, IGES or BREP; of a :class:`Cad` its file and scale.
        order: polynomial order of the curved mesh, 2 to 4.
        linkage: a MeshLink file that links the two. Without it the mesh's entity tags do, where they are the CAD's numbers, else geometry.
        cad_scale: what the CAD is multiplied by to be in the mesh's unit; ``"auto"`` finds the factor between units that fits.
        name: what a mesh in memory is called in messages, linkage file and report.
        surface: the mesh is one of triangles and quadrilaterals on CAD faces, without a volume.
        only, straight: patches to curve, or to leave straight.
        by_tags: whether entity tags may be the CAD's numbers; by default those of files, not those of meshes that come as arrays.
        tolerance: how far a node may be from its CAD entity where geometry decides, in the mesh's unit.
        max_offset: how far a linear node may be from its CAD entity, as a fraction of the bounding box's diagonal.
        freeze_linear, freeze_walls: keep linear nodes where they are; nodes on walls where projection put them.
        direct: begin at the order itself, not at P2.
        curve_layers: layers of elements off curved walls that may be curved; by default as far as the walls' displacement reaches.
        floor: least costs, 0 to 1, for which walls stay on the CAD.
        threshold, alpha, max_sweeps, survey_factor: of the smoother, as the program's options.
        time_limit: seconds after which smoothing ends; what there is by then is certified.
        threads: by default as many as there are cores. The result does not depend on them.
        target: a file and a solver (see :meth:`Mesh.write`): a mesh that this cannot take is refused before the work.
        keep_invalid: return the mesh also where it is not certified.
        progress: True shows a line on stderr, a function is called with a :class:`Progress`, and ends the smoothing early by returning
            False; by default there is a line in notebooks.
        cad_timeout: seconds after which reading the CAD is given up.
        memory_limit: bytes that reading a file may take.

    Returns:
        The curved mesh. Its linear nodes come first, its elements have the numbers of the linear mesh. Boundary faces that could not
        be put on the CAD are in ``report.off_cad`` and ``report.open_faces``.

    Raises:
        NotCertified: not every element is proven valid, or a wall folds.
        MeshError, CadError, LinkageError, AssociationError, FileError: by cause.
        KeyboardInterrupt: on Ctrl-C; nothing is left behind.
    """
    given = _given(mesh, points, cells, patches)
    if isinstance(cad, Cad):
        cad_scale, cad = cad.scale, cad.path
    wishes = {
        "order": order,
        "surface": surface,
        "only": None if only is None else list(only),
        "straight": None if straight is None else list(straight),
        "by_tags": mesh is not None if by_tags is None else by_tags,
        "tolerance": tolerance,
        "max_offset": max_offset,
        "freeze_linear": freeze_linear,
        "freeze_walls": freeze_walls,
        "direct": direct,
        "curve_layers": curve_layers,
        "floor": floor,
        "threshold": threshold,
        "alpha": alpha,
        "max_sweeps": max_sweeps,
        "survey_factor": survey_factor,
        "time_limit": time_limit,
        "threads": threads,
    }
    with progress_display.shown(progress) as call:
        native = _sagitta.curve(
            source(given),
            name,
            os.fspath(cad),
            _factor(cad_scale),
            None if linkage is None else os.fspath(linkage),
            wishes,
            LIMITS | {"cad_timeout": cad_timeout, "memory_limit": memory_limit},
            None if target is None else (os.fspath(target[0]), target[1]),
            call,
        )
    curved = CurvedMesh._of(native)
    if not native.certified and not keep_invalid:
        why = "not all elements are proven valid and all walls free of folds (keep_invalid=True returns the mesh)"
        raise errors.NotCertified(f"{_called(given, name)}: {why}", curved)
    return curved


def check(
    mesh: Name | Mesh | ArrayLike,
    cells: Kinds | None = None,
    *,
    linear: Name | Mesh | None = None,
    node_order: str = "cgns",
    name: str = IN_MEMORY,
    memory_limit: int | None = None,
) -> CheckReport:
    """Certifies a mesh of order 1 to 4: is every element's Jacobian positive everywhere?

    Args:
        mesh: a file, a :class:`Mesh`, or the points of one, (n, 3).
        cells: with points, the nodes of the cells by kind: ``{"hex": (m, 27)}``.
        linear: the linear mesh that it was made from, the reference of its Jacobians; by default each element's own corners.
        node_order: of ``cells``; see :class:`sagitta.arrays.Cells`.
        name: what a mesh in memory is called in messages and in the report.
        memory_limit: bytes that reading a file may take.

    Raises:
        MeshError, FileError: the mesh cannot be read, or has no cells.
    """
    given: Name | Mesh
    if cells is not None:
        given = Mesh(mesh, cells, node_order=node_order)  # type: ignore[arg-type]
    elif isinstance(mesh, (Mesh, str, os.PathLike)):
        given = mesh
    else:
        raise TypeError("check takes a file, a sagitta.Mesh, or points and cells")
    limits = LIMITS | {"memory_limit": memory_limit}
    return CheckReport(*_sagitta.check(source(given), name, None if linear is None else source(linear), limits))


def link(
    mesh: Name | Mesh,
    cad: Name | Cad,
    output: Name | None = None,
    *,
    cad_scale: Scale = 1.0,
    tolerance: float | None = None,
    by_tags: bool = True,
    name: str = IN_MEMORY,
    cad_timeout: float = 300.0,
    memory_limit: int | None = None,
) -> LinkReport:
    """Says which faces, edges and points of a linear mesh lie on which CAD entities, as a MeshLink file.

    Args:
        mesh: a file or a :class:`Mesh`.
        cad: a file or a :class:`Cad`.
        output: the MeshLink file to write; its text is in ``linkage`` of what is returned, too.
        cad_scale, tolerance, by_tags, name, cad_timeout, memory_limit: as those of :func:`curve`.

    Raises:
        AssociationError: no face of the mesh lies on the CAD.
        MeshError, CadError, FileError: by cause.
    """
    if isinstance(cad, Cad):
        cad_scale, cad = cad.scale, cad.path
    limits = LIMITS | {"cad_timeout": cad_timeout, "memory_limit": memory_limit}
    linked = _sagitta.link(source(mesh), name, os.fspath(cad), _factor(cad_scale), tolerance, by_tags, limits)
    report = LinkReport(linked[0], linked[1], bytes(linked[2]))
    if output is not None:
        Path(output).write_bytes(report.linkage)
    return report


def validate(
    linkage: Name,
    *,
    mesh: Name | None = None,
    cad: Name | Cad | None = None,
    cad_scale: Scale = 1.0,
    tolerance: float | None = None,
    cad_timeout: float = 300.0,
    memory_limit: int | None = None,
) -> Validation:
    """Checks a MeshLink file: alone, against its mesh, against its CAD. A broken file is a finding.

    Args:
        linkage: the MeshLink file.
        mesh, cad: the files that it was written for.
        cad_scale, tolerance, cad_timeout, memory_limit: as those of :func:`curve`.

    Raises:
        LinkageError, MeshError, CadError, FileError: a file cannot be read at all.
    """
    if isinstance(cad, Cad):
        cad_scale, cad = cad.scale, cad.path
    files = [None if file is None else os.fspath(file) for file in (mesh, cad)]
    limits = LIMITS | {"cad_timeout": cad_timeout, "memory_limit": memory_limit}
    return Validation(*_sagitta.validate(os.fspath(linkage), files[0], files[1], _factor(cad_scale), tolerance, limits))


def _given(
    mesh: Name | Mesh | None, points: ArrayLike | None, cells: Kinds | None, patches: Mapping[str, Kinds] | None
) -> Name | Mesh:
    if mesh is not None:
        if points is not None or cells is not None or patches is not None:
            raise TypeError("give a mesh, or points and cells and patches, not both")
        return mesh
    if points is None or cells is None:
        raise TypeError("give a mesh, or points and cells and patches")
    return Mesh(points, cells, patches)


def _factor(scale: Scale) -> float | None:
    return None if scale == "auto" else float(scale)


def _called(mesh: Name | Mesh, name: str) -> str:
    return name if isinstance(mesh, Mesh) else os.fspath(mesh)
