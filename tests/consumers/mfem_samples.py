#!/usr/bin/env python3
"""Meshes as MFEM itself writes them, for fixtures/samples: curved boxes of each kind of cell, and what MFEM measures of them.

usage: mfem_samples.py FOLDER
"""
import json
import math
import os
import sys

import mfem.ser as mfem


class Bend(mfem.VectorPyCoefficient):
    def EvalValue(self, x):
        x, y, z = list(x) + [0.0] * (3 - len(x))
        return [x + 0.1 * math.sin(2 * y), y + 0.1 * x * z + 0.1 * x * x, z + 0.1 * math.cos(x + y)][: self.vdim]


def measure(mesh):
    volume, sides = 0.0, {}
    for n in range(mesh.GetNE()):
        volume += integral(mesh.GetElementTransformation(n))
    for n in range(mesh.GetNBE()):
        key = str(mesh.GetBdrAttribute(n))
        sides[key] = sides.get(key, 0.0) + integral(mesh.GetBdrElementTransformation(n))
    return {"volume": volume, "sides": sides, "cells": mesh.GetNE()}


def integral(transformation):
    rule, total = mfem.IntRules.Get(transformation.GetGeometryType(), 24), 0.0
    for k in range(rule.GetNPoints()):
        point = rule.IntPoint(k)
        transformation.SetIntPoint(point)
        total += point.weight * transformation.Weight()
    return total


def main(folder):
    kinds = mfem.Element
    meshes = {
        "mfem_prisms_p3": (mfem.Mesh.MakeCartesian3D(1, 1, 2, kinds.WEDGE), 3, False),
        "mfem_tets_p4": (mfem.Mesh.MakeCartesian3D(1, 1, 1, kinds.TETRAHEDRON), 4, False),
        "mfem_hexes_p3_l2": (mfem.Mesh.MakeCartesian3D(2, 1, 1, kinds.HEXAHEDRON), 3, True),
        "mfem_hexes_p1": (mfem.Mesh.MakeCartesian3D(2, 1, 1, kinds.HEXAHEDRON), 1, False),
        "mfem_plane_p4": (mfem.Mesh.MakeCartesian2D(2, 2, kinds.TRIANGLE), 4, False),
    }
    figures = {}
    for name, (mesh, order, apart) in meshes.items():
        if order > 1:
            mesh.SetCurvature(order, apart)
            mesh.Transform(Bend(mesh.SpaceDimension()))
        if name == "mfem_plane_p4":
            mesh.bdr_attribute_sets.SetAttributeSet("upper and lower", mfem.intArray([1, 3]))
            mesh.bdr_attribute_sets.SetAttributeSet("inflow", mfem.intArray([4]))
        path = os.path.join(folder, f"{name}.mfem")
        mesh.Save(path, 16)
        figures[f"{name}.mfem"] = measure(mfem.Mesh(path, 1, 1))
    with open(os.path.join(folder, "mfem_figures.json"), "w") as file:
        json.dump(figures, file, indent=1, sort_keys=True)


main(sys.argv[1])
