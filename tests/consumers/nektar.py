"""Nektar++'s XML as Nektar++ makes geometry of it, after its user guide (section Geometry), its checks in SpatialDomains and Karniadakis and
Sherwin's basis: no code of sagitta. There is no package of Nektar++ or NekMesh to ask (apt, pip)."""
import xml.etree.ElementTree as xml

import numpy as np
from scipy.special import eval_jacobi

# Sides by Nektar++'s corners; which pairs of faces meet in its edges; the edges that meet in each corner.
FACES = {
    "A": ((0, 1, 2), (0, 1, 3), (1, 2, 3), (0, 2, 3)),
    "P": ((0, 1, 2, 3), (0, 1, 4), (1, 2, 4), (3, 2, 4), (0, 3, 4)),
    "R": ((0, 1, 2, 3), (0, 1, 4), (1, 2, 5, 4), (3, 2, 5), (0, 3, 5, 4)),
    "H": ((0, 1, 2, 3), (0, 1, 5, 4), (1, 2, 6, 5), (3, 2, 6, 7), (0, 3, 7, 4), (4, 5, 6, 7)),
}
BASE = ((0, 1), (0, 2), (0, 3), (0, 4))
EDGES = {
    "A": ((0, 1), (0, 2), (0, 3), (1, 3), (1, 2), (2, 3)),
    "P": (*BASE, (1, 4), (1, 2), (2, 3), (3, 4)),
    "R": (*BASE, (1, 4), (1, 2), (2, 3), (3, 4), (2, 4)),
    "H": (*BASE, (1, 4), (1, 2), (2, 3), (3, 4), (5, 1), (5, 2), (5, 3), (5, 4)),
}
CORNERS = {
    "A": ((0, 2), (0, 1), (1, 2), (3, 4)),
    "P": ((0, 3), (0, 1), (1, 2), (2, 3), (4, 5)),
    "R": ((0, 3), (0, 1), (1, 2), (2, 3), (4, 5), (6, 7)),
    "H": ((0, 3), (0, 1), (1, 2), (2, 3), (8, 11), (8, 9), (9, 10), (10, 11)),
}
PLACES = {
    "A": ((0, 0, 0), (1, 0, 0), (0, 1, 0), (0, 0, 1)),
    "P": ((0, 0, 0), (1, 0, 0), (1, 1, 0), (0, 1, 0), (0, 0, 1)),
    "R": ((0, 0, 0), (1, 0, 0), (1, 1, 0), (0, 1, 0), (0, 0, 1), (0, 1, 1)),
    "H": ((0, 0, 0), (1, 0, 0), (1, 1, 0), (0, 1, 0), (0, 0, 1), (1, 0, 1), (1, 1, 1), (0, 1, 1)),
    "T": ((0, 0, 0), (1, 0, 0), (0, 1, 0)),
    "Q": ((0, 0, 0), (1, 0, 0), (1, 1, 0), (0, 1, 0)),
}
NAMES = {"A": "tet", "P": "pyramid", "R": "prism", "H": "hex", "T": "tri", "Q": "quad"}
HOLDS = {
    "A": lambda i, j, k, p: i + j + k <= p,
    "P": lambda i, j, k, p: i + k <= p and j + k <= p,
    "R": lambda i, j, k, p: i + k <= p,
    "H": lambda i, j, k, p: True,
    "T": lambda i, j, k, p: k == 0 and i + j <= p,
    "Q": lambda i, j, k, p: k == 0,
}
SAME = 1e-12


def lattice(kind, p):
    axes = range(p + 1)
    return [(i, j, k) for k in axes for j in axes for i in axes if HOLDS[kind](i, j, k, p)]


def psi_a(p, z):
    if p < 2:
        return (1 - z) / 2 if p == 0 else (1 + z) / 2
    return (1 - z) / 2 * (1 + z) / 2 * eval_jacobi(p - 2, 1, 1, z)


def psi_b(p, q, z):
    if p == 0:
        return psi_a(q, z)
    if q == 0:
        return ((1 - z) / 2) ** p
    return ((1 - z) / 2) ** p * (1 + z) / 2 * eval_jacobi(q - 1, 2 * p - 1, 1, z)


def ratio(a, b):
    return 2 * np.divide(a, b, out=np.zeros_like(a), where=b > 1e-14) - 1


def modes(kind, p, at):
    """The modified basis at points of the unit cell, and which functions are those of the inside."""
    x, y, z = np.array(at, float).T
    own, inner = [], []

    def take(values, inside):
        own.append(values)
        inner.append(inside)

    n = range(p + 1)
    if kind in "QH":
        for i in n:
            for j in n:
                for k in n if kind == "H" else (0,):
                    last = psi_a(k, 2 * z - 1) if kind == "H" else 1
                    take(psi_a(i, 2 * x - 1) * psi_a(j, 2 * y - 1) * last, min(i, j, k if kind == "H" else 2) > 1)
        return np.array(own).T, np.array(inner)
    triangle = []  # (function of the first axis, degree above which the second falls, function of the second)
    for i in range(2, p + 1):
        triangle += [(i, i, q, q > 0) for q in range(p - i + 1)]
    sides = [(i, q) for i in (0, 1) for q in range(2, p + 1)]
    if kind in "TR":
        s, t, line = (x, y, None) if kind == "T" else (x, z, y)
        a, b = ratio(s, 1 - t), 2 * t - 1
        flat = [(psi_a(i, a) * (1 - b) / 2, False) for i in (0, 1)] + [((1 + b) / 2, False)]
        flat += [(psi_a(i, a) * psi_a(q, b), False) for i, q in sides]
        flat += [(psi_a(i, a) * psi_b(m, q, b), inside) for i, m, q, inside in triangle]
        for values, inside in flat:
            for k in n if kind == "R" else (0,):
                take(values * (psi_a(k, 2 * line - 1) if kind == "R" else 1), inside and (kind == "T" or k > 1))
        return np.array(own).T, np.array(inner)
    if kind == "P":
        a, b, c = ratio(x, 1 - z), ratio(y, 1 - z), 2 * z - 1
        take((1 + c) / 2, False)
        for i in n:
            for j in n:
                if max(i, j) < 2:
                    take(psi_a(i, a) * psi_a(j, b) * (1 - c) / 2, False)
                    for k in range(2, p + 1):
                        take(psi_a(i, a) * psi_a(j, b) * psi_a(k, c), False)
                elif min(i, j) < 2:
                    m = max(i, j)
                    for k in range(p - m + 1):
                        take(psi_a(i, a) * psi_a(j, b) * psi_b(m, k, c), False)
                else:
                    take(psi_a(i, a) * psi_a(j, b) * ((1 - c) / 2) ** (i + j - 2), False)
        return np.array(own).T, np.array(inner)
    a, b, c = ratio(x, 1 - y - z), ratio(y, 1 - z), 2 * z - 1
    corners = [psi_a(0, a) * (1 - b) / 2, psi_a(1, a) * (1 - b) / 2, (1 + b) / 2]
    for function in corners:
        take(function * (1 - c) / 2, False)
        for k in range(2, p + 1):
            take(function * psi_a(k, c), False)
    take((1 + c) / 2, False)
    for i, q in sides:
        for k in range(p - q + 1):
            take(psi_a(i, a) * psi_a(q, b) * psi_b(q, k, c), False)
    for i, m, q, inside in triangle:
        for k in range(p - m - q + 1):
            take(psi_a(i, a) * psi_b(m, q, b) * psi_b(m + q, k, c), inside and k > 0)
    return np.array(own).T, np.array(inner)


def completion(kind, p):
    """Which lattice points are inside, and what they are of the others when the functions of the inside are left out."""
    points = lattice(kind, p)
    flat = kind in "TQ"
    sides = FACES.get(kind) or tuple(zip(range(len(PLACES[kind])), (*range(1, len(PLACES[kind])), 0)))
    onto = []
    for side in sides:
        corners = np.array([PLACES[kind][c] for c in side], float)
        plane = corners[1:] - corners[0]
        onto.append((corners[0], plane))
    at = np.array(points, float) / p
    inside = np.array([all(np.linalg.matrix_rank(np.vstack([plane, x - origin]), 1e-9) > np.linalg.matrix_rank(plane, 1e-9) for origin, plane in onto) for x in at])
    values, inner = modes(kind, p, at)
    assert values.shape[1] == len(points) and inner.sum() == inside.sum(), (kind, p, values.shape, inner.sum(), inside.sum(), flat)
    return inside, values[inside][:, ~inner] @ np.linalg.inv(values[~inside][:, ~inner])


def slopes(kind, p, at):
    """Derivatives of the functions of the lattice, by the complex step."""
    powers = lattice(kind, p)

    def functions(x):
        x, y, z = x
        if kind != "P":
            return np.array([x**i * y**j * z**k for i, j, k in powers])
        w = 1 - z
        return np.array([(x / w) ** i * (y / w) ** j * w ** max(i, j) * z**k for i, j, k in powers])

    nodes = np.array(powers, float) / p
    vandermonde = []
    for x in nodes:
        apex = kind == "P" and x[2] == 1
        vandermonde.append([float(i == 0 and j == 0) for i, j, _ in powers] if apex else functions(x))
    inverse = np.linalg.inv(np.array(vandermonde))
    step = 1e-30
    return np.array([[functions(x + 1j * step * np.eye(3)[axis]).imag / step @ inverse for axis in range(3)] for x in at]).transpose(0, 2, 1)


def seats(kind, p, corners, side):
    """For each lattice point of a face of these corners (a loop), its place in the cell whose corners are numbered so."""
    at = {corner: np.array(place) for corner, place in zip(corners, PLACES[kind])}
    origin, first, last = at[side[0]], at[side[1]], at[side[-1]]
    face = "T" if len(side) == 3 else "Q"
    return [tuple((p * origin + i * (first - origin) + j * (last - origin)).tolist()) for i, j, _ in lattice(face, p)]


def loop(edges, ends):
    own = [ends[e] for e in edges]
    corners = []
    for n, edge in enumerate(own):
        following = own[(n + 1) % len(own)]
        shared = set(edge) & set(following)
        if len(shared) != 1:
            raise ValueError("edges of a face do not follow one another")
        corners += [v for v in edge if v not in shared]
    return corners


def numbers(text):
    values = []
    for part in text.split("[")[1].split("]")[0].split(","):
        first, _, last = part.partition("-")
        values += range(int(first), int(last or first) + 1)
    return values


def read_nektar(path):
    from reference import rule

    geometry = xml.parse(path).getroot().find("GEOMETRY")
    row = lambda item: [int(word) for word in item.text.split()]  # noqa: E731
    vertices = {int(v.get("ID")): np.array(v.text.split(), float) for v in geometry.find("VERTEX")}
    ends = {int(e.get("ID")): row(e) for e in geometry.find("EDGE")}
    faces = {int(f.get("ID")): (f.tag, row(f)) for f in geometry.find("FACE")}
    curved = geometry.find("CURVED")
    curves = {"E": {}, "F": {}}
    for c in curved if curved is not None else ():
        points = np.array(c.text.split(), float).reshape(-1, 3)
        if len(points) != int(c.get("NUMPOINTS")):
            raise ValueError("points of a curve are not as many as announced")
        curves[c.tag][int(c.get("EDGEID") or c.get("FACEID"))] = points
    p = max([len(x) - 1 for x in curves["E"].values()], default=1)
    size = max(abs(x).max() for x in vertices.values())
    same = lambda a, b: abs(a - b).max() <= SAME * size  # noqa: E731

    def edge(n):
        a, b = (vertices[v] for v in ends[n])
        line = curves["E"].get(n)
        if line is None:
            return np.array([a + (b - a) * i / p for i in range(p + 1)])
        if not (same(line[0], a) and same(line[-1], b)):
            raise ValueError(f"the curve of edge {n} does not end at its vertices")
        return line

    loops, surfaces, fills = {}, {}, {kind: completion(kind, p) for kind in "TQ"}
    for n, (kind, own) in faces.items():
        corners = loop(own, ends)
        points = {}
        for m, e in enumerate(own):
            line = edge(e) if ends[e][0] == corners[m] else edge(e)[::-1]
            for step, place in enumerate(np.linspace(PLACES[kind][m], PLACES[kind][(m + 1) % len(own)], p + 1) * p):
                points[tuple(np.rint(place).astype(int).tolist())] = line[step]
        order = lattice(kind, p)
        if n in curves["F"]:
            given = curves["F"][n]
            if kind == "T":  # corners, edges, rows
                on = [tuple(np.rint(np.array(PLACES["T"][m]) * p).astype(int).tolist()) for m in range(3)]
                for m in range(3):
                    a, b = np.array(on[m]), np.array(on[(m + 1) % 3])
                    on += [tuple((a + (b - a) * i // p).tolist()) for i in range(1, p)]
                listed = on + [at for at in order if at not in on]
            else:
                listed = order
            if len(listed) != len(given):
                raise ValueError(f"the curve of face {n} has {len(given)} points")
            for at, x in zip(listed, given):
                if at in points and not same(points[at], x):
                    raise ValueError(f"the curve of face {n} leaves its edges")
                points.setdefault(at, x)
            if any(e not in curves["E"] for e in own):
                raise ValueError(f"face {n} is curved, and an edge of it is not")
        values = np.array([points.get(at, np.zeros(3)) for at in order])
        inside, weights = fills[kind]
        if n not in curves["F"]:
            values[inside] = weights @ values[~inside]
        loops[n], surfaces[n] = corners, values

    found = {"cells": {}, "volume": 0.0, "areas": {}, "faces": {}, "solved": "read by a script"}
    kinds = {}
    for element in geometry.find("ELEMENT"):
        kinds.setdefault(element.tag, []).append((int(element.get("ID")), row(element)))
    listed = {}
    for kind, elements in kinds.items():
        places = {at: n for n, at in enumerate(lattice(kind, p))}
        nodes = np.zeros((len(elements), len(places), 3))
        for m, (n, own) in enumerate(elements):
            shared = [set(faces[own[a]][1]) & set(faces[own[b]][1]) for a, b in EDGES[kind]]
            if any(len(s) != 1 for s in shared):
                raise ValueError(f"faces of element {n} do not share an edge each")
            edges = [set(ends[s.pop()]) for s in shared]
            corners = [edges[a] & edges[b] for a, b in CORNERS[kind]]
            if any(len(c) != 1 for c in corners):
                raise ValueError(f"edges of element {n} do not meet in a vertex each")
            corners = [c.pop() for c in corners]
            for face, side in zip(own, FACES[kind]):
                if {corners[c] for c in side} != set(loops[face]):
                    raise ValueError(f"element {n} lists its faces in another order")
                if len(side) == 3 and loops[face][2] != corners[side[2]]:
                    raise ValueError(f"element {n} collapses face {face} at another corner than the face")
                for at, x in zip(seats(kind, p, corners, loops[face]), surfaces[face]):
                    nodes[m, places[at]] = x
            listed[n] = kind
        inside, weights = completion(kind, p)
        if inside.any():
            nodes[:, inside] = np.einsum("ib,ebc->eic", weights, nodes[:, ~inside])
        x, w = rule({"R": "prism", "A": "tet", "P": "pyramid", "H": "hex"}[kind])
        if kind == "R":  # it is collapsed along the last axis
            x = x[:, [0, 2, 1]]
        jacobians = np.linalg.det(np.einsum("enc,pnd->epcd", nodes, slopes(kind, p, x), optimize=True))
        if jacobians.min() <= 0:
            raise ValueError(f"{(jacobians.min(1) <= 0).sum()} elements {kind} have a Jacobian that is not positive")
        found["cells"][NAMES[kind]] = len(elements)
        found["volume"] += float((jacobians @ w).sum())
    domain = {c for d in geometry.find("DOMAIN") for c in numbers(d.text)}
    cells = []
    for c in geometry.find("COMPOSITE"):
        letter, own = c.text.strip()[0], numbers(c.text)
        if letter == "F":
            area = 0.0
            for kind in "TQ":
                some = np.array([surfaces[n] for n in own if faces[n][0] == kind])
                if len(some):
                    x, w = rule(NAMES[kind])
                    tangents = np.einsum("enc,pnd->epcd", some, slopes(kind, p, x), optimize=True)
                    area += float((np.linalg.norm(np.cross(tangents[..., 0], tangents[..., 1]), axis=-1) @ w).sum())
            found["areas"][c.get("NAME")], found["faces"][c.get("NAME")] = area, len(own)
        elif int(c.get("ID")) in domain:
            if any(listed[n] != letter for n in own):
                raise ValueError("a composite calls elements by another letter than they have")
            cells += own
    if sorted(cells) != sorted(listed):
        raise ValueError("the domain is not all elements, each once")
    return found


if __name__ == "__main__":
    import os
    import sys

    sys.path.insert(0, os.path.dirname(os.path.abspath(__file__)))
    print(read_nektar(sys.argv[1]))
