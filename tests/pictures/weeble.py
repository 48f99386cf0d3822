#!/usr/bin/env python3
"""The README's picture: the curved weeble at P3 in a cut through its mesh, its lower sharp edge, and the layers there.

usage: weeble.py CURVED_P3.vtu OUT.png      (pip install pyvista matplotlib; draws off screen)

The cut is a plane through the axis and the curved elements as they are: faces and elements are evaluated from their nodes in small
pieces, and the pieces cut. The wall is drawn whole in front of the cut.
"""
import sys

import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as plt
import numpy as np
import pyvista as pv
from matplotlib.collections import LineCollection, PolyCollection
from matplotlib.patches import ConnectionPatch, Rectangle
from PIL import Image

P = 3
FINE = 10  # divisions of an edge by which faces and elements are cut
WALL, FLUID, LINES = "#c98a4b", "GnBu_r", "#1d2b3a"
RANGE = (0.55, 1.06)  # of J / J_c, in colours
TURN = np.radians(11)  # the cut goes through the axis, and along no face of the mesh
PANELS = [(0.0, 0.14, 1.78), (1.02, -0.335, 0.22), (1.0, -0.3, 0.0065)]  # middle and half width


def lattice(dimension, n):
    """Barycentric coordinates of the points that divide the edges of a simplex in n, times n."""
    grid = np.stack(np.meshgrid(*[np.arange(n + 1)] * dimension, indexing="ij"), -1).reshape(-1, dimension)
    grid = grid[grid.sum(1) <= n]
    return np.column_stack([n - grid.sum(1), grid])


def nodes(corners, faces):
    """Barycentric coordinates, times P, of a Lagrange simplex's nodes in VTK's order."""
    unit = P * np.eye(corners, dtype=int)
    edges = [(0, 1), (1, 2), (2, 0), (0, 3), (1, 3), (2, 3)][: 3 if corners == 3 else 6]
    inner = [((P - k) * unit[a] + k * unit[b]) // P for a, b in edges for k in range(1, P)]
    middles = [unit[list(face)].sum(0) // 3 for face in faces]
    return np.array([*unit, *inner, *middles])


TRIANGLE = nodes(3, [(0, 1, 2)])
TET = nodes(4, [(0, 1, 3), (1, 2, 3), (2, 0, 3), (0, 2, 1)])


def basis(own, at):
    """Values of the Lagrange functions of a simplex at barycentric points."""
    def value(node):
        factors = [(P * at[:, a] - m) / (k - m) for a, k in enumerate(node) for m in range(k)]
        return np.prod(factors, axis=0)
    return np.stack([value(node) for node in own], axis=1)


def read(path):
    mesh = pv.read(path)
    cells = {}
    for kind, count in (("tet", len(TET)), ("triangle", len(TRIANGLE))):
        of = pv.CellType.LAGRANGE_TETRAHEDRON if kind == "tet" else pv.CellType.LAGRANGE_TRIANGLE
        own = np.flatnonzero(mesh.celltypes == of)
        starts = mesh.cell_offsets[own]
        cells[kind] = (own, mesh.cell_connectivity[starts[:, None] + np.arange(count)])
    return mesh, cells


def pieces(points, elements, own, n):
    """The elements' points on a lattice of n divisions, by element, and the lattice's small simplices."""
    dimension = own.shape[1] - 1
    at = lattice(dimension, n)
    return np.einsum("sn,enx->esx", basis(own, at / n), points[elements]), small(dimension, n, at)


def small(dimension, n, at):
    find = {tuple(x[1:]): k for k, x in enumerate(at)}
    cuts = {2: [[(0, 0), (1, 0), (0, 1)], [(1, 0), (1, 1), (0, 1)]],
            3: [[(0, 0, 0), (1, 0, 0), (0, 1, 0), (0, 0, 1)], [(1, 1, 0), (1, 0, 1), (0, 1, 1), (1, 1, 1)],
                *[[(1, 0, 0), (0, 1, 1), a, b] for a, b in (((0, 1, 0), (1, 1, 0)), ((1, 1, 0), (1, 0, 1)),
                                                            ((1, 0, 1), (0, 0, 1)), ((0, 0, 1), (0, 1, 0)))]]}[dimension]
    found = []
    for x in at:
        for cut in cuts:
            corners = [find.get(tuple(x[1:] + np.array(c))) for c in cut]
            if None not in corners:
                found.append(corners)
    return np.array(found)


def cut_lines(triangles):
    """Where triangles meet y = 0, as segments in (x, z)."""
    y = triangles[..., 1]
    segments = []
    crossed = (y.min(1) < 0) & (y.max(1) >= 0)
    for corners, y in zip(triangles[crossed], y[crossed]):
        ends = [corners[i] + (corners[j] - corners[i]) * y[i] / (y[i] - y[j])
                for i, j in ((0, 1), (1, 2), (2, 0)) if (y[i] < 0) != (y[j] < 0)]
        segments.append([end[[0, 2]] for end in ends])
    return np.array(segments)


def section(points, elements):
    """Cut lines of the elements' faces: each face once."""
    sides = [(0, 1, 2), (0, 1, 3), (0, 2, 3), (1, 2, 3)]
    near = crossing(points, elements)
    seen, faces = set(), []
    place = {tuple(node): k for k, node in enumerate(TET)}
    for element in elements[near]:
        for side in sides:
            key = tuple(sorted(element[list(side)]))
            if key in seen:
                continue
            seen.add(key)
            embed = np.zeros((len(TRIANGLE), 4), int)
            embed[:, list(side)] = TRIANGLE
            faces.append(element[[place[tuple(node)] for node in embed]])
    faces = np.array(faces)
    faces = faces[crossing(points, faces)]
    where, small_ones = pieces(points, faces, TRIANGLE, FINE)
    return cut_lines(where[:, small_ones].reshape(-1, 3, 3))


def crossing(points, elements):
    """Elements that may meet y = 0: control points are near the nodes."""
    y = points[elements][..., 1]
    margin = 0.3 * (y.max(1) - y.min(1))
    return (y.min(1) - margin < 0) & (y.max(1) + margin > 0)


def filled(points, elements, values):
    """Cut polygons of the elements, and a value each."""
    near = crossing(points, elements)
    where, small_ones = pieces(points, elements[near], TET, FINE)
    count = len(small_ones)
    cells = (np.arange(len(where))[:, None, None] * where.shape[1] + small_ones).reshape(-1, 4)
    grid = pv.UnstructuredGrid({pv.CellType.TETRA: cells}, where.reshape(-1, 3))
    grid["value"] = np.repeat(values[near], count)
    cut = grid.slice(normal="y", origin=(0, 0, 0)).triangulate()
    corners = cut.points[cut.faces.reshape(-1, 4)[:, 1:]][..., [0, 2]]
    return corners, cut["value"]


def render(points, faces, half, middle):
    """The whole wall with its element edges, seen along y without perspective, as an image with a clear background."""
    where, small_ones = pieces(points, faces, TRIANGLE, 12)
    cells = (np.arange(len(where))[:, None, None] * where.shape[1] + small_ones).reshape(-1, 3)
    body = pv.PolyData.from_regular_faces(where.reshape(-1, 3), cells).clean(tolerance=1e-9)
    body = body.compute_normals(feature_angle=35, split_vertices=True, auto_orient_normals=True)
    at = np.linspace(0, 1, 17)
    lines = []
    for a, b in ((0, 1), (1, 2), (2, 0)):
        ends = np.zeros((len(at), 3))
        ends[:, a], ends[:, b] = 1 - at, at
        lines.append(np.einsum("sn,enx->esx", basis(TRIANGLE, ends), points[faces]))
    lines = np.concatenate(lines)
    runs = np.hstack([np.full((len(lines), 1), len(at)), np.arange(lines.shape[0] * len(at)).reshape(len(lines), -1)])
    edges = pv.PolyData(lines.reshape(-1, 3), lines=runs.ravel())
    plot = pv.Plotter(off_screen=True, window_size=(2000, 2000), lighting="none")
    for position, strength in (((-5, -8, 7), 0.62), ((6, -6, -1), 0.22), ((0, -8, 0), 0.2)):
        plot.add_light(pv.Light(position=position, focal_point=(0, 0, 0), intensity=strength, light_type="scene light"))
    plot.add_mesh(body, color=WALL, smooth_shading=True, specular=0.12, specular_power=15, ambient=0.18)
    plot.add_mesh(edges, color="#3b2410", line_width=2.2, lighting=False)
    plot.enable_parallel_projection()
    plot.camera.position, plot.camera.focal_point, plot.camera.up = (middle[0], -9, middle[1]), (middle[0], 0, middle[1]), (0, 0, 1)
    plot.camera.parallel_scale = half
    plot.enable_anti_aliasing("ssaa")
    return plot.screenshot(transparent_background=True, return_img=True)


def chained(segments):
    """Segments end to end as closed loops."""
    ends = {}
    key = lambda x: tuple(np.round(x, 9))
    for segment in segments:
        a, b = map(key, segment)
        if a != b:
            ends.setdefault(a, set()).add(b)
            ends.setdefault(b, set()).add(a)
    loops = []
    while ends:
        at = next(iter(ends))
        loop = [at]
        while ends.get(at):
            after = ends[at].pop()
            ends[after].discard(at)
            if not ends[at]:
                del ends[at]
            at = after
            loop.append(at)
        ends.pop(at, None)
        loops.append(np.array(loop))
    return loops


def main():
    source, target = sys.argv[1:3]
    mesh, cells = read(source)
    points = np.asarray(mesh.points, dtype=float) @ np.array([[np.cos(TURN), np.sin(TURN), 0], [-np.sin(TURN), np.cos(TURN), 0], [0, 0, 1]])
    own, tets = cells["tet"]
    quality = np.asarray(mesh.cell_data["certified_min_J_over_Jc"])[own]
    _, triangles = cells["triangle"]
    body = triangles[np.linalg.norm(points[triangles[:, :3]], axis=2).max(1) < 3]
    lines = section(points, tets)
    polygons, values = filled(points, tets, quality)
    near = body[crossing(points, body)]
    where, small_ones = pieces(points, near, TRIANGLE, FINE)
    wall = cut_lines(where[:, small_ones].reshape(-1, 3, 3))
    chords = cut_lines(points[near[:, :3]])

    figure = plt.figure(figsize=(15, 7.6), facecolor="white")
    axes = [figure.add_axes(box) for box in ((0.005, 0.015, 0.49, 0.97), (0.505, 0.015, 0.28, 0.97), (0.795, 0.27, 0.20, 0.715))]
    width = (0.7, 0.7, 0.9)
    for axis, (x, z, half), thick in zip(axes, PANELS, width):
        axis.add_collection(PolyCollection(polygons, array=values, cmap=FLUID, clim=RANGE, edgecolors="face", linewidths=0.3,
                                           antialiased=False, rasterized=True))
        axis.add_collection(LineCollection(lines, colors=LINES, linewidths=thick))
        for loop in chained(wall):
            axis.fill(*loop.T, color=WALL, lw=0)
        axis.add_collection(LineCollection(wall, colors="#5b3210", linewidths=2.2))
        box = axis.get_position()
        tall = half * box.height * figure.get_figheight() / (box.width * figure.get_figwidth())
        axis.set(xlim=(x - half, x + half), ylim=(z - tall, z + tall), xticks=[], yticks=[])
        axis.spines[:].set(color="#5b6b7a", linewidth=1.2)
    x, z, half = PANELS[0]
    image = render(points, body, half, (x, z))
    axes[0].imshow(image, extent=(x - half, x + half, z - half, z + half), zorder=5, interpolation="antialiased", aspect="auto")
    for axis in axes[1:]:
        axis.add_collection(LineCollection(chords, colors="#b3261e", linewidths=1.3, linestyles=(0, (4, 3))))
    for outer, inner, panel in ((axes[0], axes[1], PANELS[1]), (axes[1], axes[2], PANELS[2])):
        x, z, half = panel
        bottom, top = inner.get_ylim()
        outer.add_patch(Rectangle((x - half, bottom), 2 * half, top - bottom, fill=False, ec="#b3261e", lw=1.5, zorder=9))
        for corner, side in ((top, 1), (bottom, 0)):
            figure.add_artist(ConnectionPatch((x + half, corner), (0, side), "data", "axes fraction", axesA=outer, axesB=inner,
                                              color="#b3261e", lw=0.9))
    bar = figure.colorbar(axes[0].collections[0], cax=figure.add_axes((0.80, 0.17, 0.19, 0.025)), orientation="horizontal")
    bar.ax.set_xlim(values.min(), 1)
    bar.set_label("proven minimum of $J/J_c$ in the element")
    figure.text(0.80, 0.045, "dashed: wall of the linear mesh", fontsize=10)
    figure.savefig(target, dpi=120)
    Image.open(target).convert("RGB").quantize(256, dither=Image.Dither.NONE).save(target, optimize=True)


if __name__ == "__main__":
    main()
