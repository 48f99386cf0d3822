"""Meshes as arrays: what goes in comes out, in every node order."""

import numpy as np
import pytest
import sagitta
from polynomial import FLAT, INSIDE, ORDERS, element, lattice

ELEMENTS = [(kind, p) for kind in INSIDE for p in ORDERS]


@pytest.mark.parametrize("kind, p", ELEMENTS)
def test_arrays_come_out_as_they_went_in(kind, p):
    mesh = element(kind, p)
    assert (mesh.order, mesh.dimension, list(mesh.cells)) == (p, 2 if kind in FLAT else 3, [kind])
    assert (mesh.cells[kind, "lexicographic"] == np.arange(len(mesh.points))).all()
    for name, _ in sagitta.node_orders():
        try:
            slots = sagitta.node_order(kind, p, name)
        except KeyError:
            assert kind == "pyramid" and p > 1 and name in ("vtk", "mfem")
            continue
        own = mesh.cells[kind, name]
        assert own.dtype == np.int64 and (own == mesh.cells[kind][:, slots]).all()
        again = sagitta.Mesh(mesh.points, {kind: own}, node_order=name)
        assert (again.cells[kind] == mesh.cells[kind]).all()


def test_corners_come_first_where_it_is_said():
    corners = lattice("hex", 1)
    for name in ("cgns", "gmsh", "vtk", "mfem"):
        nodes = element("hex", 3).cells["hex", name][0, :8]
        ends = lattice("hex", 3)[nodes]
        assert np.isin(ends, (0, 1)).all() and len(np.unique(ends, axis=0)) == len(corners)


@pytest.mark.parametrize("kind, p", ELEMENTS)
def test_check_certifies_arrays(kind, p):
    mesh = element(kind, p)
    report = sagitta.check(mesh.points, {kind: mesh.cells[kind]})
    assert report.certified and 0 < report.min_jacobian < 1.1
    assert report.data["cells"][0]["cell"] == kind


def test_an_inverted_element_is_found():
    points, nodes = lattice("hex", 2), np.arange(27)[None, :]
    points[13] += 2.0  # the node in the middle, thrown out of the cube
    report = sagitta.check(points, {"hex": nodes}, node_order="lexicographic")
    assert not report.certified and report.worst()[0]["verdict"] == "invalid"


def test_points_are_seen_and_not_copied():
    mesh = element("tet", 3)
    points = mesh.points
    assert np.shares_memory(points, mesh.points) and not points.flags.writeable
    with pytest.raises(ValueError):
        points[0] = 0.0
    with pytest.raises(ValueError):
        points.flags.writeable = True
    kept = points.copy()
    del mesh
    assert (points == kept).all()  # the array keeps the mesh


def test_patches_have_their_names_and_faces():
    cube = lattice("hex", 1)
    faces = {"bottom": {"quad": [[0, 1, 3, 2]]}, "sides": {"quad": np.array([[0, 1, 5, 4], [2, 3, 7, 6]], dtype=np.int32)}}
    mesh = sagitta.Mesh(cube, {"hex": [[0, 1, 3, 2, 4, 5, 7, 6]]}, faces)
    assert list(mesh.patches) == ["bottom", "sides"] and "top" not in mesh.patches
    assert mesh.patches["sides"].faces["quad"].tolist() == faces["sides"]["quad"].tolist()
    with pytest.raises(KeyError, match="bottom, sides"):
        mesh.patches["top"]


@pytest.mark.parametrize(
    "points, cells, said",
    [
        (np.zeros((4, 4)), {"tet": [[0, 1, 2, 3]]}, "shape"),
        (np.zeros((4, 3)), {"tet": [[0, 1, 2, 4]]}, "element 0 has node 4"),
        (np.zeros((4, 3)), {"tet": [[0, 1, 2, -1]]}, "element 0 has node -1"),
        (np.zeros((4, 3)), {"tet": [[0, 1, 2]]}, "4, 10, 20, 35 nodes, not 3"),
        (np.zeros((4, 3)), {"tet": [[0.0, 1.0, 2.0, 3.0]]}, "integers"),
        (np.full((4, 3), np.nan), {"tet": [[0, 1, 2, 3]]}, "not finite"),
        (np.zeros((4, 3)), {}, "at least one kind"),
    ],
)
def test_arrays_that_make_no_mesh_are_refused(points, cells, said):
    with pytest.raises(ValueError, match=said):
        sagitta.Mesh(points, cells)


def test_unknown_words_are_told_with_the_known_ones():
    with pytest.raises(KeyError, match="tet, pyramid, prism, hex"):
        sagitta.Mesh(np.zeros((4, 3)), {"tetra": [[0, 1, 2, 3]]})
    mesh = element("hex", 2)
    with pytest.raises(KeyError, match="lexicographic, gmsh"):
        mesh.cells["hex", "exodus"]
    with pytest.raises(KeyError, match="there are hex"):
        mesh.cells["tet"]


def test_what_is_written_is_read_again(tmp_path):
    mesh = element("prism", 4)
    mesh.write(tmp_path / "prism.cgns")
    again = sagitta.read(tmp_path / "prism.cgns")
    assert (again.cells["prism"] == mesh.cells["prism"]).all() and (again.points == mesh.points).all()
    assert again.numbers("prism").tolist() == [1]
