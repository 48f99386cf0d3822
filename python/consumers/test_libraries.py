"""Meshes as libraries of solvers have them: each integrates polynomials over curved elements of known shape. `make python-consumers` runs this."""

import numpy as np
import pytest
import sagitta
from polynomial import INSIDE, ORDERS, element, integral, rule

ELEMENTS = [(kind, p) for kind in INSIDE for p in ORDERS]

#: Polynomials whose integrals every library is asked for.
FUNCTIONS = {"1": lambda x: np.ones(len(x)), "x": lambda x: x[:, 0], "y²": lambda x: x[:, 1] ** 2, "xy": lambda x: x[:, 0] * x[:, 1]}


def curved(tests):
    return pytest.mark.parametrize("kind, p", tests)


@curved(ELEMENTS)
def test_mfem_integrates_over_the_elements(kind, p):
    mfem = pytest.importorskip("mfem.ser")
    mesh = element(kind, p).to_mfem()
    transformation = mesh.GetElementTransformation(0)
    at, weight = rule(kind)
    point = mfem.IntegrationPoint()
    sums = dict.fromkeys(FUNCTIONS, 0.0)
    for x, w in zip(at, weight):
        point.Set3(*x)
        transformation.SetIntPoint(point)
        found = transformation.Transform(point)
        place = np.zeros((1, 3))
        place[0, : len(found)] = found
        for name, function in FUNCTIONS.items():
            sums[name] += w * transformation.Weight() * function(place)[0]
    for name, function in FUNCTIONS.items():
        assert sums[name] == pytest.approx(integral(kind, p, function), rel=1e-7), name


@curved(ELEMENTS)
def test_dolfinx_integrates_over_the_elements(kind, p):
    pytest.importorskip("dolfinx")
    import ufl
    from dolfinx import fem
    from mpi4py import MPI

    if kind in ("prism", "pyramid") and p > 2:
        with pytest.raises(sagitta.MeshError, match="P2 is its highest order"):
            element(kind, p).to_dolfinx(MPI.COMM_SELF)
        return
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

    with pytest.raises(sagitta.MeshError, match="hex"):
        element("hex", 2).to_ngsolve()
