#!/usr/bin/env python3
"""Makes the shapes of cad/tests with OCCT's Python binding (pip install cadquery-ocp-novtk, version 8.0): make_shapes.py [FOLDER]"""
import math, os, sys
from OCP.BRep import BRep_Builder, BRep_Tool
from OCP.BRepAlgoAPI import BRepAlgoAPI_Cut
from OCP.BRepBuilderAPI import (BRepBuilderAPI_MakeEdge, BRepBuilderAPI_MakeFace, BRepBuilderAPI_MakeWire,
                                BRepBuilderAPI_NurbsConvert)
from OCP.BRepLib import BRepLib
from OCP.BRepPrimAPI import BRepPrimAPI_MakeBox, BRepPrimAPI_MakeCylinder, BRepPrimAPI_MakeRevol, BRepPrimAPI_MakeSphere
from OCP.BRepTools import BRepTools
from OCP.GC import GC_MakeArcOfCircle
from OCP.Geom import (Geom_BSplineCurve, Geom_BSplineSurface, Geom_BezierSurface, Geom_ConicalSurface,
                      Geom_CylindricalSurface, Geom_OffsetSurface, Geom_SphericalSurface, Geom_SurfaceOfLinearExtrusion,
                      Geom_SurfaceOfRevolution, Geom_ToroidalSurface)
from OCP.Geom2d import Geom2d_Circle, Geom2d_Line, Geom2d_TrimmedCurve
from OCP.IFSelect import IFSelect_RetDone
from OCP.Interface import Interface_Static
from OCP.STEPControl import STEPControl_AsIs, STEPControl_GeometricCurveSet, STEPControl_Writer
from OCP.IGESControl import IGESControl_Writer
from OCP.collections import Array1_double, Array1_gp_Pnt, Array1_int, Array2_double, Array2_gp_Pnt
from OCP.TopExp import TopExp_Explorer
from OCP.TopAbs import TopAbs_FACE, TopAbs_FORWARD, TopAbs_REVERSED
from OCP.TopLoc import TopLoc_Location
from OCP.TopoDS import TopoDS, TopoDS_Compound, TopoDS_Edge, TopoDS_Face, TopoDS_Vertex, TopoDS_Wire
from OCP.gp import gp_Ax1, gp_Ax2, gp_Ax2d, gp_Ax3, gp_Circ, gp_Dir, gp_Dir2d, gp_Pnt, gp_Pnt2d, gp_Trsf, gp_Vec

folder = sys.argv[1] if len(sys.argv) > 1 else os.path.dirname(os.path.abspath(__file__))


def place(x):
    """A tilted frame, so that nothing is aligned with the axes."""
    return gp_Ax3(gp_Pnt(x, 0.3 * x, 1.0), gp_Dir(0.2, -0.3, 1.0), gp_Dir(1.0, 0.1, 0.0))


def reals(values):
    array = Array1_double(1, len(values))
    for i, value in enumerate(values):
        array.SetValue(i + 1, value)
    return array


def integers(values):
    array = Array1_int(1, len(values))
    for i, value in enumerate(values):
        array.SetValue(i + 1, value)
    return array


def curve(points, degree=3):
    poles = Array1_gp_Pnt(1, len(points))
    for i, p in enumerate(points):
        poles.SetValue(i + 1, gp_Pnt(*p))
    spans = len(points) - degree
    ends = [degree + 1] + [1] * (spans - 1) + [degree + 1]
    return Geom_BSplineCurve(poles, reals(range(spans + 1)), integers(ends), degree)


def grid(n, m, at):
    poles = Array2_gp_Pnt(1, n, 1, m)
    for i in range(n):
        for j in range(m):
            poles.SetValue(i + 1, j + 1, gp_Pnt(*at(i, j)))
    return poles


def spline(n, m, at, degree=3):
    def side(k):
        spans = k - degree
        return reals(range(spans + 1)), integers([degree + 1] + [1] * (spans - 1) + [degree + 1])
    (ku, mu), (kv, mv) = side(n), side(m)
    return Geom_BSplineSurface(grid(n, m, at), ku, kv, mu, mv, degree, degree)


def roof():
    """A ridge: degree 2 with a knot of multiplicity 2."""
    at = lambda i, j: (i, j, 1.5 - abs(i - 2) + 0.1 * (i == 1))
    return Geom_BSplineSurface(grid(5, 3, at), reals([0, 1, 2]), reals([0, 1]), integers([3, 2, 3]), integers([3, 3]), 2, 2)


def face(surface, *bounds):
    return BRepBuilderAPI_MakeFace(surface, *bounds, 1e-7).Face() if bounds else BRepBuilderAPI_MakeFace(surface, 1e-7).Face()


def loop(surface, curve2d):
    edge = BRepBuilderAPI_MakeEdge(curve2d, surface).Edge()
    BRepLib.BuildCurve3d_s(edge)
    return BRepBuilderAPI_MakeWire(edge).Wire()


def holed(base, u, v, radius):
    """A face with a hole whose pcurve is a circle around u, v, wherever that is."""
    surface = BRep_Tool.Surface_s(base)
    circle = Geom2d_Circle(gp_Ax2d(gp_Pnt2d(u, v), gp_Dir2d(1, 0)), radius)
    maker = BRepBuilderAPI_MakeFace(base)
    maker.Add(TopoDS.Wire(loop(surface, circle).Reversed()))
    return maker.Face()


def box_with_hole():
    box = BRepPrimAPI_MakeBox(gp_Pnt(0, 0, 0), 4, 3, 2).Shape()
    drill = BRepPrimAPI_MakeCylinder(gp_Ax2(gp_Pnt(2, 1.5, -1), gp_Dir(0, 0.1, 1)), 0.7, 5).Shape()
    return BRepAlgoAPI_Cut(box, drill).Shape()


def compound(shapes):
    builder, whole = BRep_Builder(), TopoDS_Compound()
    builder.MakeCompound(whole)
    for shape in shapes:
        builder.Add(whole, shape)
    return whole


def kinds():
    wave = lambda i, j: (0.8 * i, 0.7 * j, math.sin(0.9 * i) * math.cos(0.8 * j))
    profile = [(0, 0, 0), (1, 1.2, 0), (2, -0.7, 0.2), (3, 0.4, 0), (4, 0, 0.5), (5, 1, 0)]
    meridian = [(1, 0, 0), (2.2, 0, 1), (0.6, 0, 2), (1.5, 0, 3), (0.7, 0, 4)]
    axis = gp_Ax1(gp_Pnt(0, 0, 0), gp_Dir(0, 0, 1))
    cylinder = Geom_CylindricalSurface(place(0), 1.3)
    sphere = Geom_SphericalSurface(place(2), 1.7)
    nurbs = BRepBuilderAPI_NurbsConvert(BRepPrimAPI_MakeSphere(gp_Ax2(gp_Pnt(1, 2, 3), gp_Dir(1, 1, 1)), 1.1).Shape()).Shape()
    rational = TopExp_Explorer(nurbs, TopAbs_FACE).Current()
    return [
        face(sphere),                                                              # 1 whole sphere
        face(sphere, 0.3, 2.5, -0.4, 1.1),                                         # 2 its patch
        face(cylinder, 0, 2 * math.pi, -2, 3),                                     # 3 whole cylinder
        face(Geom_ConicalSurface(place(-3), 0.4, 0.5), 0, 2 * math.pi, -0.5 / math.sin(0.4), 2),  # 4 cone with its apex
        face(Geom_ToroidalSurface(place(5), 3, 0.8), 0, 2 * math.pi, 0, 2 * math.pi),             # 5 whole torus
        face(Geom_SurfaceOfLinearExtrusion(curve(profile), gp_Dir(0.1, 0.2, 1)), 0, 3, -1, 2),    # 6 extrusion
        face(Geom_SurfaceOfRevolution(curve(meridian), axis), 0, 4.5, 0, 2),       # 7 revolution
        face(Geom_OffsetSurface(spline(7, 6, wave), 0.2), 0, 4, 0, 3),             # 8 offset
        face(roof(), 0, 2, 0, 1),                                                  # 9 C0 kink
        face(Geom_BezierSurface(grid(6, 5, wave)), 0, 1, 0, 1),                    # 10 Bezier, degrees 5 and 4
        rational,                                                                  # 11 rational, with poles
        holed(face(spline(7, 6, wave), 0, 4, 0, 3), 2, 1.5, 0.8),                  # 12 B-spline with a hole
        holed(face(cylinder, 0, 2 * math.pi, -2, 3), 1.5 + 2 * math.pi, 0.5, 0.9), # 13 a hole a period away
        face(Geom_OffsetSurface(cylinder, 0.4), 0, 2 * math.pi, -1, 1),            # 14 offset of a cylinder
        face(spline(26, 24, lambda i, j: (0.2 * i, 0.2 * j, 0.1 * math.sin(i * j)), 7), 0, 19, 0, 17),  # 15 degree 7, rough
    ]


def beyond(surface, u, v, tolerance=1e-7):
    """A face over ranges that may reach beyond the knots, as trims of other systems do: OCCT's polynomials go on there. Its makers refuse such
    ranges, its builder does not. Boundary curves are the surface's own lines of constant parameter."""
    builder, made, wire = BRep_Builder(), TopoDS_Face(), TopoDS_Wire()
    builder.MakeFace(made, surface, tolerance)
    builder.MakeWire(wire)
    corners = {}
    for a in (0, 1):
        for b in (0, 1):
            corners[a, b] = TopoDS_Vertex()
            builder.MakeVertex(corners[a, b], surface.Value(u[a], v[b]), tolerance)
    sides = [(surface.VIso(v[0]), gp_Pnt2d(0, v[0]), gp_Dir2d(1, 0), u, (0, 0), (1, 0), TopAbs_FORWARD),
             (surface.UIso(u[1]), gp_Pnt2d(u[1], 0), gp_Dir2d(0, 1), v, (1, 0), (1, 1), TopAbs_FORWARD),
             (surface.VIso(v[1]), gp_Pnt2d(0, v[1]), gp_Dir2d(1, 0), u, (0, 1), (1, 1), TopAbs_REVERSED),
             (surface.UIso(u[0]), gp_Pnt2d(u[0], 0), gp_Dir2d(0, 1), v, (0, 0), (0, 1), TopAbs_REVERSED)]
    for line, start, along, ends, first, last, side in sides:
        edge = TopoDS_Edge()
        builder.MakeEdge(edge, line, tolerance)
        builder.Add(edge, corners[first].Oriented(TopAbs_FORWARD))
        builder.Add(edge, corners[last].Oriented(TopAbs_REVERSED))
        builder.UpdateEdge(edge, Geom2d_Line(start, along), made, tolerance)
        builder.Range(edge, *ends)
        builder.Add(wire, edge.Oriented(side))
    builder.Add(made, wire)
    return made


def rims():
    """Faces whose boundary is hard on a search: beyond the knots of surfaces and curves of each kind, and straight but unevenly parametrised."""
    at = lambda x: lambda i, j: (x + 0.8 * i, 0.7 * j, math.sin(0.9 * i) * math.cos(0.8 * j))
    profile = [(0, 5, 0), (1, 6.2, 0), (2, 4.3, 0.2), (3, 5.4, 0), (4, 5, 0.5), (5, 6, 0)]
    meridian = [(1, 0, 4), (2.2, 0, 5), (0.6, 0, 6), (1.5, 0, 7), (0.7, 0, 8)]
    weights = Array2_double(1, 4, 1, 3)
    for i in range(4):
        for j in range(3):
            weights.SetValue(i + 1, j + 1, [1.0, 0.6, 1.3][(i + j) % 3])
    rational = Geom_BezierSurface(grid(4, 3, lambda i, j: (i, 10 + j, 0.5 * math.sin(2 * i + j))), weights)
    # along lines, but not at even steps: second derivatives run along the tangents
    uneven = [0.0, 0.1, 0.7, 0.9, 2.3]
    ruled = Geom_BSplineSurface(grid(5, 2, lambda i, j: (7 + 2.9 * uneven[i], 5 + 1.3 * uneven[i] + 2 * j, 0.31 * uneven[i] * (1 + j))),
                                reals([0, 1, 2]), reals([0, 1]), integers([4, 1, 4]), integers([2, 2]), 3, 1)
    revolved = Geom_SurfaceOfRevolution(curve(meridian), gp_Ax1(gp_Pnt(0, 0, 0), gp_Dir(0, 0, 1)))
    return [
        beyond(spline(7, 6, at(0)), (-0.06, 4.05), (-0.04, 3.07)),                       # 1 B-spline, beyond on all sides
        beyond(spline(7, 6, at(6)), (1.3, 4.2), (0.5, 2.5)),                             # 2 B-spline, beyond on one
        beyond(rational, (-0.03, 1.05), (-0.02, 1.04)),                                  # 3 rational Bezier
        beyond(Geom_SurfaceOfLinearExtrusion(curve(profile), gp_Dir(0.1, 0.2, 1)), (-0.05, 3.04), (-1, 2)),  # 4 extrusion
        beyond(revolved, (0.3, 2.5), (-0.03, 2.05)),                                     # 5 revolution
        beyond(Geom_OffsetSurface(spline(7, 6, at(12)), 0.2), (-0.05, 4.04), (-0.03, 3.02), 1e-5),  # 6 offset of a B-spline
        beyond(ruled, (0, 2), (0, 1)),                                                   # 7 straight sides, uneven parameters
    ]


def step(name, shape, mode=STEPControl_AsIs, assembly=0):
    writer = STEPControl_Writer()
    Interface_Static.SetIVal_s("write.step.assembly", assembly)
    writer.Transfer(shape, mode)
    assert writer.Write(os.path.join(folder, name)) == IFSelect_RetDone
    Interface_Static.SetIVal_s("write.step.assembly", 0)


def moved(shape, x, angle):
    trsf = gp_Trsf()
    trsf.SetRotation(gp_Ax1(gp_Pnt(0, 0, 0), gp_Dir(0, 0, 1)), angle)
    trsf.SetTranslationPart(gp_Vec(x, 0, 0))
    return shape.Located(TopLoc_Location(trsf))


def iges(name, shape):
    """Surface mode: every face with edges of its own, free curves as entities 110, 100 and 126."""
    writer = IGESControl_Writer("MM", 0)
    writer.AddShape(shape)
    writer.ComputeModel()
    assert writer.Write(os.path.join(folder, name))


def pieces():
    """Three faces of a cylinder: one below, along its whole rim, two above, side by side."""
    cylinder = Geom_CylindricalSurface(place(0), 2.0)
    return compound([face(cylinder, 0, 2, 0, 1), face(cylinder, 0, 0.8, 1, 3), face(cylinder, 0.8, 2, 1, 3)])


def doubtful():
    """A ridge inside a face, and two boxes that touch."""
    boxes = [BRepPrimAPI_MakeBox(gp_Pnt(x, 0, 0), 1, 2, 3).Shape() for x in (10, 11)]
    return compound([face(roof())] + boxes)


def lemon():
    """A solid whose one face is bounded by a vertex alone: an arc turned about its chord."""
    arc = GC_MakeArcOfCircle(gp_Pnt(-2, 0, 0), gp_Pnt(0, 0.7, 0), gp_Pnt(2, 0, 0)).Value()
    chord = BRepBuilderAPI_MakeEdge(gp_Pnt(2, 0, 0), gp_Pnt(-2, 0, 0)).Edge()
    half = BRepBuilderAPI_MakeFace(BRepBuilderAPI_MakeWire(BRepBuilderAPI_MakeEdge(arc).Edge(), chord).Wire()).Face()
    return BRepPrimAPI_MakeRevol(half, gp_Ax1(gp_Pnt(0, 0, 0), gp_Dir(1, 0, 0))).Shape()


def main():
    BRepTools.Write_s(doubtful(), os.path.join(folder, "doubtful.brep"))
    step("lemon.step", lemon())
    BRepTools.Write_s(compound(kinds()), os.path.join(folder, "kinds.brep"))
    BRepTools.Write_s(box_with_hole(), os.path.join(folder, "plate.brep"))
    BRepTools.Write_s(compound(rims()), os.path.join(folder, "rims.brep"))
    bracket = box_with_hole()
    pair = compound([moved(bracket, 0, 0), moved(bracket, 6, 0.5)])
    step("assembly.step", compound([pair, moved(pair, 20, 1.0)]), assembly=1)
    circle = BRepBuilderAPI_MakeEdge(gp_Circ(gp_Ax2(gp_Pnt(0, 0, 1), gp_Dir(0, 1, 1)), 2.0), 0.2, 4.0).Edge()
    free = BRepBuilderAPI_MakeEdge(curve([(0, 0, 0), (1, 2, 0), (3, -1, 1), (4, 0, 2), (6, 1, 0)])).Edge()
    line = BRepBuilderAPI_MakeEdge(gp_Pnt(0, 0, 0), gp_Pnt(1, 2, 3)).Edge()
    step("curves.step", compound([circle, free, line]), STEPControl_GeometricCurveSet)
    iges("curves.igs", compound([circle, free, line]))
    iges("unsewn.igs", box_with_hole())
    iges("pieces.igs", pieces())


main()
