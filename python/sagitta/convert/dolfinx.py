"""To DOLFINx, in memory: its elements are those of Basix."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, NamedTuple

import basix.ufl
import numpy as np
from dolfinx import graph, io
from dolfinx import mesh as dolfinx_mesh

if TYPE_CHECKING:
    from ..mesh import Mesh

#: Basix's words for kinds of cells.
_CELLS = {"tet": "tetrahedron", "hex": "hexahedron", "triangle": "triangle", "quad": "quadrilateral", "prism": "prism", "pyramid": "pyramid"}


class DolfinxMesh(NamedTuple):
    """A mesh as DOLFINx has it, and its boundary."""

    mesh: dolfinx_mesh.Mesh
    """With curved cells of the mesh's order."""
    facet_tags: dolfinx_mesh.MeshTags | None
    """The patch of each boundary facet, by number; None for prisms and pyramids, of which DOLFINx has no facet tags."""
    patches: dict[str, int]
    """The numbers of the patches, from 1."""


def of(mesh: Mesh, comm: Any) -> DolfinxMesh:
    """A DOLFINx mesh on ``comm``, distributed from its first process; the others may give any mesh of the same cells and order.

    Raises:
        MeshError: cells of several kinds, of which DOLFINx takes one; prisms and pyramids beyond P2, which it lacks.
    """
    from ..errors import MeshError

    kinds = list(mesh.cells)
    if len(kinds) != 1 or kinds[0] not in _CELLS:
        raise MeshError(f"DOLFINx takes cells of one kind; the mesh has {', '.join(kinds)}")
    kind, axes = kinds[0], mesh.dimension
    if kind in ("prism", "pyramid") and mesh.order > 2:
        raise MeshError(f"DOLFINx has no {kind}s of P{mesh.order}; P2 is its highest order")
    element = basix.ufl.element("Lagrange", _CELLS[kind], mesh.order, lagrange_variant=basix.LagrangeVariant.equispaced, shape=(axes,))
    first = comm.rank == 0
    cells = mesh.cells[kind, "basix"] if first else np.empty((0, mesh.cells[kind].shape[1]), dtype=np.int64)
    points = mesh.points[:, :axes] if first else np.empty((0, axes))
    own = dolfinx_mesh.create_mesh(comm, cells, element, points)
    numbers = {name: number for number, name in enumerate(mesh.patches, start=1)}
    tags = None if kind in ("prism", "pyramid") else _facet_tags(mesh, own, numbers, first)
    return DolfinxMesh(own, tags, numbers)


def _facet_tags(mesh: Mesh, own: dolfinx_mesh.Mesh, numbers: dict[str, int], first: bool) -> dolfinx_mesh.MeshTags:
    """The patches on the facets, which DOLFINx finds by the nodes at their corners."""
    dimension = mesh.dimension - 1
    facet = {2: 3 if "tet" in mesh.cells else 4, 1: 2}[dimension]
    nodes, values = [np.empty((0, facet), dtype=np.int64)], [np.empty(0, dtype=np.int32)]
    for name, number in numbers.items() if first else ():
        for of_kind in mesh.patches[name].faces.values():
            nodes.append(of_kind[:, :facet])
            values.append(np.full(len(of_kind), number, dtype=np.int32))
    entities, found = io.distribute_entity_data(own, dimension, np.concatenate(nodes), np.concatenate(values))
    own.topology.create_connectivity(dimension, 0)
    adjacency = graph.adjacencylist(entities)
    own.topology.create_connectivity(dimension, mesh.dimension)
    return dolfinx_mesh.meshtags_from_entities(own, dimension, adjacency, found.astype(np.int32, copy=False))
