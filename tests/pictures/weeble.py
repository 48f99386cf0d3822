#!/usr/bin/env python3
"""The README's picture: a crinkle cut through the curved weeble, and a look into the layers at its lower sharp edge.

usage: weeble.py CURVED.vtu OUT.png      (pip install pyvista; draws off screen)
"""
import sys

import numpy as np
import pyvista as pv

FINE = 8  # straight pieces that a curved edge is drawn with
EDGES = ((0, 1), (1, 2), (2, 0), (0, 3), (1, 3), (2, 3))  # of a Lagrange tet, in VTK's order


def crinkle(mesh):
    """The tets that the plane y = 0 cuts."""
    y = mesh.points[:, 1]
    tets = np.flatnonzero(mesh.celltypes == pv.CellType.LAGRANGE_TETRAHEDRON)
    corners = np.array([mesh.get_cell(c).point_ids for c in tets])
    cut = (y[corners[:, :4]].min(1) <= 1e-9) & (y[corners[:, :4]].max(1) > 1e-9)
    return tets[cut], corners[cut]


def wall(mesh):
    """The body's curved faces behind the plane."""
    faces = np.flatnonzero(mesh.celltypes == pv.CellType.LAGRANGE_TRIANGLE)
    corners = [mesh.points[mesh.get_cell(c).point_ids[:3]] for c in faces]
    behind = [c for c, x in zip(faces, corners) if x[:, 1].mean() > 0 and np.linalg.norm(x, axis=1).max() < 3]
    return mesh.extract_cells(behind).extract_surface(nonlinear_subdivision=4, algorithm=None)


def curves(points, corners):
    """The curved edges of the tets as poly-lines, each evaluated from its nodes."""
    p = 1 + (corners.shape[1] > 4) + (corners.shape[1] > 10) + (corners.shape[1] > 20)
    at, nodes = np.linspace(0, 1, FINE + 1), np.arange(p + 1) / p
    basis = np.array([np.prod([(at - nodes[j]) / (nodes[i] - nodes[j]) for j in range(p + 1) if j != i], axis=0) for i in range(p + 1)])
    lines = []
    for e, (a, b) in enumerate(EDGES):
        inner = corners[:, 4 + e * (p - 1):4 + (e + 1) * (p - 1)]
        chain = np.concatenate([corners[:, [a]], inner, corners[:, [b]]], axis=1)
        lines.append(np.einsum("is,eic->esc", basis, points[chain]))
    lines = np.concatenate(lines)
    cells = np.hstack([np.full((len(lines), 1), FINE + 1), np.arange(lines.shape[0] * (FINE + 1)).reshape(len(lines), -1)])
    return pv.PolyData(lines.reshape(-1, 3), lines=cells.ravel())


def main():
    source, target = sys.argv[1:3]
    mesh = pv.read(source)
    cells, corners = crinkle(mesh)
    surface = mesh.extract_cells(cells).extract_surface(nonlinear_subdivision=3, algorithm=None)
    edges, body = curves(mesh.points, corners), wall(mesh)
    plot = pv.Plotter(off_screen=True, shape=(1, 2), window_size=(1800, 900), border=False)
    views = [((0.0, -9.0, 0.2), (0.0, 0.0, 0.15), 24), ((1.02, -3.0, -0.33), (1.02, 0.0, -0.33), 6.5)]
    for column, (eye, focus, angle) in enumerate(views):
        plot.subplot(0, column)
        plot.set_background("white")
        plot.add_mesh(surface, color="#dfe9f2", lighting=False)
        plot.add_mesh(body, color="#c98a4b", smooth_shading=True)
        plot.add_mesh(edges, color="#203040", line_width=1.2)
        plot.camera.position, plot.camera.focal_point, plot.camera.up = eye, focus, (0, 0, 1)
        plot.camera.view_angle = angle
    plot.screenshot(target)


if __name__ == "__main__":
    main()
