"""One curved element of every kind and order, whose map is a known polynomial of the mesh's order."""

import itertools

import numpy as np
import sagitta

#: What the lattice of order p of each kind of cell satisfies, beside 0 <= i, j, k <= p.
INSIDE = {
    "triangle": lambda p, i, j, k: k == 0 and i + j <= p,
    "quad": lambda p, i, j, k: k == 0,
    "tet": lambda p, i, j, k: i + j + k <= p,
    "pyramid": lambda p, i, j, k: i + k <= p and j + k <= p,
    "prism": lambda p, i, j, k: i + j <= p,
    "hex": lambda p, i, j, k: True,
}
FLAT = ("triangle", "quad")
ORDERS = (1, 2, 3, 4)


def lattice(kind, p):
    """Points of the unit cell, row by row, the first axis fastest: (n, 3)."""
    every = ((i, j, k) for k, j, i in itertools.product(range(p + 1), repeat=3))
    return np.array([at for at in every if INSIDE[kind](p, *at)]) / p


def image(kind, p, at):
    """Where the element has the points `at` of the unit cell: a polynomial of total degree p, whose Jacobian is positive."""
    x, y, z = at.T
    flat = kind in FLAT
    bent = np.array([y + z, z - x, x + y]) / 2.0
    moved = at + 0.2 * bent.T**p
    if flat:
        moved[:, 2] = 0.0
    return moved


def element(kind, p):
    """The element as a mesh, made of arrays in lexicographic order."""
    points = image(kind, p, lattice(kind, p))
    return sagitta.Mesh(points, {kind: np.arange(len(points))[None, :]}, node_order="lexicographic")


def rule(kind, n=8):
    """Gauss points and weights on the unit cell, exact for polynomials far beyond what is integrated here."""
    x, w = np.polynomial.legendre.leggauss(n)
    x, w = (x + 1) / 2, w / 2
    axes = 2 if kind in FLAT else 3
    at = np.array(list(itertools.product(x, repeat=axes)))
    weight = np.prod(np.array(list(itertools.product(w, repeat=axes))), axis=1)
    at = np.column_stack([at, np.zeros((len(at), 3 - axes))])
    if kind in ("triangle", "prism"):  # collapsed: x = a (1 - b)
        weight = weight * (1 - at[:, 1])
        at[:, 0] *= 1 - at[:, 1]
    if kind == "tet":
        weight = weight * (1 - at[:, 1]) * (1 - at[:, 2]) ** 2
        at[:, 0] *= (1 - at[:, 1]) * (1 - at[:, 2])
        at[:, 1] *= 1 - at[:, 2]
    if kind == "pyramid":
        weight = weight * (1 - at[:, 2]) ** 2
        at[:, :2] *= (1 - at[:, 2])[:, None]
    return at, weight


def integral(kind, p, function):
    """The integral of a function over the element, by the map itself."""
    at, weight = rule(kind)
    axes, h = (2 if kind in FLAT else 3), 1e-6
    columns = [(image(kind, p, at + h * e) - image(kind, p, at - h * e)) / (2 * h) for e in np.eye(3)[:axes]]
    jacobians = np.stack(columns, axis=-1)[:, :axes, :]
    return float(np.sum(weight * np.linalg.det(jacobians) * function(image(kind, p, at))))
