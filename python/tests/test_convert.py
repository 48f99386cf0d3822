"""Meshes as other libraries have them: each is asked where it has the points of a curved element of known shape, or for integrals."""

import numpy as np
import pytest
from polynomial import FLAT, INSIDE, ORDERS, element, image, integral, lattice, rule

ELEMENTS = [(kind, p) for kind in INSIDE for p in ORDERS]

#: Polynomials whose integrals every library is asked for.
FUNCTIONS = {"1": lambda x: np.ones(len(x)), "x": lambda x: x[:, 0], "y²": lambda x: x[:, 1] ** 2, "xy": lambda x: x[:, 0] * x[:, 1]}


def curved(tests):
    return pytest.mark.parametrize("kind, p", tests)


@curved(ELEMENTS)
def test_meshio_has_the_elements_and_writes_them_again(kind, p, tmp_path):
    meshio, sagitta = pytest.importorskip("meshio"), pytest.importorskip("sagitta")
    mesh = element(kind, p)
    if kind == "pyramid" and p > 2:
        with pytest.raises(sagitta.MeshError, match="pyramids"):
            mesh.to_meshio()
        return
    theirs = mesh.to_meshio()
    assert (theirs.points == mesh.points).all()
    meshio.write(tmp_path / "again.msh", theirs, file_format="gmsh")
    assert (sagitta.read(tmp_path / "again.msh").cells[kind] == mesh.cells[kind]).all()


@curved(ELEMENTS)
def test_pyvista_has_the_elements_where_they_are(kind, p):
    pytest.importorskip("pyvista")
    grid = element(kind, p).to_pyvista()
    cell = grid.GetCell(0)
    at, _ = rule(kind, n=4)
    found, weights, part = np.zeros(3), [0.0] * cell.GetNumberOfPoints(), __import__("vtk").reference(0)
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


@curved(ELEMENTS)
def test_mfem_integrates_over_the_elements(kind, p):
    mfem = pytest.importorskip("mfem.ser")
    mesh = element(kind, p).to_mfem()
    transformation = mesh.GetElementTransformation(0)
    at, weight = rule(kind)
    point, found = mfem.IntegrationPoint(), mfem.Vector(2 if kind in FLAT else 3)
    sums = dict.fromkeys(FUNCTIONS, 0.0)
    for x, w in zip(at, weight):
        point.Set3(*x)
        transformation.SetIntPoint(point)
        transformation.Transform(point, found)
        place = np.zeros((1, 3))
        place[0, : found.Size()] = [found[n] for n in range(found.Size())]
        for name, function in FUNCTIONS.items():
            sums[name] += w * transformation.Weight() * function(place)[0]
    for name, function in FUNCTIONS.items():
        assert sums[name] == pytest.approx(integral(kind, p, function), rel=1e-7), name


@curved([(kind, p) for kind, p in ELEMENTS if kind != "pyramid"])
def test_dolfinx_integrates_over_the_elements(kind, p):
    pytest.importorskip("dolfinx")
    import ufl
    from dolfinx import fem
    from mpi4py import MPI

    mesh = element(kind, p).to_dolfinx(MPI.COMM_SELF).mesh
    x, dx = ufl.SpatialCoordinate(mesh), ufl.Measure("dx", mesh, metadata={"quadrature_degree": 14})
    one = fem.Constant(mesh, 1.0)
    forms = {"1": one, "x": x[0], "y²": x[1] ** 2, "xy": x[0] * x[1]}
    for name, function in FUNCTIONS.items():
        found = fem.assemble_scalar(fem.form(forms[name] * dx))
        assert found == pytest.approx(integral(kind, p, function), rel=1e-7), name


def test_dolfinx_has_the_patches(weeble_p2):
    pytest.importorskip("dolfinx")
    import ufl
    from dolfinx import fem
    from mpi4py import MPI

    own = weeble_p2.to_dolfinx(MPI.COMM_SELF)
    for name, number in own.patches.items():
        assert len(own.facet_tags.find(number)) == len(weeble_p2.patches[name].faces["triangle"])
    ds = ufl.Measure("ds", own.mesh, subdomain_data=own.facet_tags)
    area = fem.assemble_scalar(fem.form(fem.Constant(own.mesh, 1.0) * ds(own.patches["wall"])))
    assert area > 0


@curved([("tet", 1), ("tet", 2), ("hex", 1), ("prism", 1), ("pyramid", 1)])
def test_ngsolve_integrates_over_the_elements(kind, p):
    ngsolve = pytest.importorskip("ngsolve")
    mesh = element(kind, p).to_ngsolve()
    x, y = ngsolve.x, ngsolve.y
    forms = {"1": ngsolve.CF(1), "x": x, "y²": y**2, "xy": x * y}
    for name, function in FUNCTIONS.items():
        assert ngsolve.Integrate(forms[name], mesh, order=10) == pytest.approx(integral(kind, p, function), rel=1e-7), name


def test_ngsolve_refuses_what_its_reader_lacks():
    pytest.importorskip("ngsolve")
    import sagitta

    with pytest.raises(sagitta.MeshError, match="hex"):
        element("hex", 2).to_ngsolve()
