#!/usr/bin/env python3
"""Writes CGNS files of structured zones: a half ring of two zones whose indices run differently, and a plane ring that closes on itself.

usage: structured_zones.py RING.cgns PLANE.cgns (needs h5py)
"""
import sys

import h5py
import numpy as np

from cgns_nodes import node, text

RADII = np.geomspace(0.5, 5, 5)


def whole(parent, name, label, rows):
    """Rows of numbers, the first index fastest in memory, as Fortran has them."""
    return node(parent, name, label, "I4", np.array(rows, "i4"))


def begin(path, dimension):
    file = h5py.File(path, "w")
    for key, content, size in (("name", "HDF5 MotherNode", 33), ("label", "Root Node of HDF5 File", 33), ("type", "MT", 3)):
        file.attrs.create(key, np.bytes_(content), dtype=f"S{size}")
    file.create_dataset(" format", data=np.frombuffer(b"IEEE_LITTLE_32\0", "i1"))
    file.create_dataset(" hdf5version", data=np.frombuffer(b"HDF5 Version 1.10.8".ljust(33, b"\0"), "i1"))
    node(file, "CGNSLibraryVersion", "CGNSLibraryVersion_t", "R4", np.array([3.4], "f4"))
    return file, node(file, "Base", "CGNSBase_t", "I4", np.array([dimension, dimension], "i4"))


def zone(base, name, points):
    """A zone of points by their indices, the last axis that of coordinates."""
    *size, axes = points.shape
    own = whole(base, name, "Zone_t", [size, [n - 1 for n in size], [0] * len(size)])
    text(own, "ZoneType", "ZoneType_t", "Structured")
    grid = node(own, "GridCoordinates", "GridCoordinates_t")
    for axis in range(axes):
        # HDF5 has the last index fastest, CGNS the first.
        node(grid, f"Coordinate{'XYZ'[axis]}", "DataArray_t", "R8", np.ascontiguousarray(points[..., axis].T))
    return own, node(own, "ZoneBC", "ZoneBC_t"), node(own, "ZoneGridConnectivity", "ZoneGridConnectivity_t")


def condition(parent, name, kind, first, last, location=None):
    own = text(parent, name, "BC_t", kind)
    whole(own, "PointRange", "IndexRange_t", [first, last])
    if location:
        text(own, "GridLocation", "GridLocation_t", location)


def connection(parent, name, donor, own, other, transform):
    node_ = text(parent, name, "GridConnectivity1to1_t", donor)
    whole(node_, "PointRange", "IndexRange_t", own)
    whole(node_, "PointRangeDonor", "IndexRange_t", other)
    whole(node_, "Transform", "int[IndexDimension]", transform)
    return node_


def ring(path):
    file, base = begin(path, 3)
    points = np.zeros((2, 9, 5, 3, 3))
    for quarter in range(2):
        angle = (8 * quarter + np.arange(9)) / 16 * np.pi
        points[quarter, ..., 0] = np.multiply.outer(np.cos(angle), RADII)[:, :, None]
        points[quarter, ..., 1] = np.multiply.outer(np.sin(angle), RADII)[:, :, None]
        points[quarter, ..., 2] = 1 - np.arange(3) / 2  # so that the axes are right-handed
    # The second zone counts along z and round the ring, both backwards, then outward; its joint is off by rounding.
    second = points[1].transpose(2, 0, 1, 3)[::-1, ::-1] * (1 + 1e-15)
    _, conditions, joints = zone(base, "first", points[0])
    condition(conditions, "wall", "BCWallViscous", [1, 1, 1], [9, 1, 3])
    condition(conditions, "farfield", "BCFarfield", [1, 5, 1], [8, 5, 2], "JFaceCenter")
    condition(conditions, "symmetry", "BCSymmetryPlane", [1, 1, 1], [1, 5, 3])
    connection(joints, "joint", "second", [[9, 1, 1], [9, 5, 3]], [[3, 9, 1], [1, 9, 5]], [-2, 3, -1])
    low = connection(joints, "low", "first", [[1, 1, 1], [9, 5, 1]], [[1, 1, 3], [9, 5, 3]], [1, 2, 3])
    high = connection(joints, "high", "first", [[1, 1, 3], [9, 5, 3]], [[1, 1, 1], [9, 5, 1]], [1, 2, 3])
    for own, shift in ((low, -1.0), (high, 1.0)):
        periodic = node(node(own, "GridConnectivityProperty", "GridConnectivityProperty_t"), "Periodic", "Periodic_t")
        for name, values in (("RotationCenter", [0, 0, 0]), ("RotationAngle", [0, 0, 0]), ("Translation", [0, 0, shift])):
            node(periodic, name, "DataArray_t", "R4", np.array(values, "f4"))
    _, conditions, joints = zone(base, "second", second)
    condition(conditions, "wall", "BCWallViscous", [1, 1, 1], [3, 9, 1])
    condition(conditions, "farfield", "BCFarfield", [3, 9, 5], [1, 1, 5])
    condition(conditions, "symmetry", "BCSymmetryPlane", [1, 1, 1], [3, 1, 5])
    condition(conditions, "ends", "BCSymmetryPlane", [1, 1, 1], [1, 9, 5])
    condition(conditions, "ends_too", "BCSymmetryPlane", [3, 1, 1], [3, 9, 5])
    connection(joints, "joint", "first", [[1, 9, 1], [3, 9, 5]], [[9, 1, 3], [9, 5, 1]], [-3, -1, 2])
    file.close()


def plane(path):
    file, base = begin(path, 2)
    angle = np.arange(17) / 16 * 2 * np.pi
    points = np.zeros((17, 5, 2))
    points[..., 0] = np.multiply.outer(np.cos(angle), RADII)
    points[..., 1] = np.multiply.outer(np.sin(angle), RADII)
    _, conditions, joints = zone(base, "ring", points)
    condition(conditions, "wall", "BCWallViscous", [1, 1], [17, 1])
    condition(conditions, "farfield", "BCFarfield", [1, 5], [17, 5])
    connection(joints, "cut", "ring", [[1, 1], [1, 5]], [[17, 1], [17, 5]], [1, 2])
    connection(joints, "cut_too", "ring", [[17, 1], [17, 5]], [[1, 1], [1, 5]], [1, 2])
    file.close()


ring(sys.argv[1])
plane(sys.argv[2])
