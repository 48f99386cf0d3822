#!/usr/bin/env python3
"""Writes a CGNS file of two unit cubes side by side, each a zone, without boundary elements: conditions by vertices.

usage: two_zones.py OUT.cgns (needs h5py)
"""
import sys

import h5py
import numpy as np

from cgns_nodes import node, text


def main():
    corners = np.array([[0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 1, 0], [0, 0, 1], [1, 0, 1], [1, 1, 1], [0, 1, 1]], float)
    file = h5py.File(sys.argv[1], "w")
    for key, content, size in (("name", "HDF5 MotherNode", 33), ("label", "Root Node of HDF5 File", 33), ("type", "MT", 3)):
        file.attrs.create(key, np.bytes_(content), dtype=f"S{size}")
    file.create_dataset(" format", data=np.frombuffer(b"IEEE_LITTLE_32\0", "i1"))
    file.create_dataset(" hdf5version", data=np.frombuffer(b"HDF5 Version 1.10.8".ljust(33, b"\0"), "i1"))
    node(file, "CGNSLibraryVersion", "CGNSLibraryVersion_t", "R4", np.array([3.4], "f4"))
    base = node(file, "Base", "CGNSBase_t", "I4", np.array([3, 3], "i4"))
    for n, (name, other) in enumerate((("left", "right"), ("right", "left"))):
        zone = node(base, name, "Zone_t", "I4", np.array([[8], [1], [0]], "i4"))
        text(zone, "ZoneType", "ZoneType_t", "Unstructured")
        grid = node(zone, "GridCoordinates", "GridCoordinates_t")
        for axis, letter in enumerate("XYZ"):
            # The right cube is off by a rounding error, so that only the list can join them.
            shift = n * (1 + 1e-12) if axis == 0 else 0
            node(grid, f"Coordinate{letter}", "DataArray_t", "R8", corners[:, axis] + shift)
        section = node(zone, "Hex", "Elements_t", "I4", np.array([17, 0], "i4"))
        node(section, "ElementRange", "IndexRange_t", "I4", np.array([1, 1], "i4"))
        node(section, "ElementConnectivity", "DataArray_t", "I4", np.arange(1, 9, dtype="i4"))
        sides = {"low": [1, 4, 8, 5], "high": [2, 3, 7, 6]}
        conditions = node(zone, "ZoneBC", "ZoneBC_t")
        condition = text(conditions, ("inlet", "outlet")[n], "BC_t", ("BCInflow", "BCOutflow")[n])
        node(condition, "PointList", "IndexArray_t", "I4", np.array(sides[("low", "high")[n]], "i4").reshape(-1, 1))
        connection = text(node(zone, "ZoneGridConnectivity", "ZoneGridConnectivity_t"), "joint", "GridConnectivity_t", other)
        text(connection, "GridConnectivityType", "GridConnectivityType_t", "Abutting1to1")
        own, donor = (sides["high"], sides["low"]) if n == 0 else (sides["low"], sides["high"])
        node(connection, "PointList", "IndexArray_t", "I4", np.array(own, "i4").reshape(-1, 1))
        node(connection, "PointListDonor", "IndexArray_t", "I4", np.array(donor, "i4").reshape(-1, 1))
    file.close()


main()
