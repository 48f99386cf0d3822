"""Meshes as other libraries have them: each is asked where it has the points of a curved element of known shape."""

import meshio
import numpy as np
import pytest
import sagitta
from polynomial import INSIDE, ORDERS, element, image, lattice, rule
from vtk import reference

ELEMENTS = [(kind, p) for kind in INSIDE for p in ORDERS]

def curved(tests):
    return pytest.mark.parametrize("kind, p", tests)


@curved(ELEMENTS)
def test_meshio_has_the_elements_and_writes_them_again(kind, p, tmp_path):
    mesh = element(kind, p)
    if kind == "pyramid" and p > 2:
        with pytest.raises(sagitta.MeshError, match="pyramids"):
            mesh.to_meshio()
        return
    theirs = mesh.to_meshio()
    assert (theirs.points == mesh.points).all()
    meshio.write(tmp_path / "again.msh", theirs, file_format="gmsh22")
    assert (sagitta.read(tmp_path / "again.msh").cells[kind] == mesh.cells[kind]).all()


def test_meshio_has_the_patches(weeble_p2):
    theirs = weeble_p2.to_meshio()
    assert {"wall", "farfield"} <= set(theirs.cell_sets) and (theirs.points == weeble_p2.points).all()
    for name, patch in weeble_p2.patches.items():
        blocks = zip(theirs.cells, theirs.cell_sets[name])
        nodes = np.concatenate([block.data[own] for block, own in blocks if block.type == "triangle6"])
        assert {*map(tuple, nodes[:, :3])} == {*map(tuple, patch.faces["triangle"][:, :3])}


@curved(ELEMENTS)
def test_pyvista_has_the_elements_where_they_are(kind, p):
    grid = element(kind, p).to_pyvista()
    cell = grid.GetCell(0)
    at, _ = rule(kind, n=4)
    found, weights, part = np.zeros(3), [0.0] * cell.GetNumberOfPoints(), reference(0)
    # VTK has a curved pyramid as a degenerate hex: x = a (1 - c), y = b (1 - c), z = c
    collapsed = kind == "pyramid" and p > 1
    for point in at:
        own = point / [1 - point[2], 1 - point[2], 1] if collapsed else point
        if kind == "pyramid" and p == 1:
            continue  # VTK's linear pyramid is not the polynomial one; its corners tell
        cell.EvaluateLocation(part, list(own), found, weights)
        assert np.allclose(found, image(kind, p, point[None])[0], atol=1e-12)
    if kind == "pyramid" and p == 1:
        corners = np.array([grid.points[cell.GetPointId(n)] for n in range(5)])
        assert np.allclose(corners, image(kind, 1, lattice(kind, 1)[[0, 1, 3, 2, 4]]))
