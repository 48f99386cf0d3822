#include "shape.hxx"
#include "guard.hxx"
#include "opencascade-sys/src/lib.rs.h"

#include <BRepTools.hxx>
#include <BRepTools_WireExplorer.hxx>
#include <BRep_TEdge.hxx>
#include <BRep_TFace.hxx>
#include <BRep_TVertex.hxx>
#include <BRep_Tool.hxx>
#include <BinTools.hxx>
#include <TopExp.hxx>
#include <TopExp_Explorer.hxx>
#include <TopoDS.hxx>
#include <TopoDS_Iterator.hxx>
#include <sstream>

namespace occt {
namespace {

// 1-based map index to 0-based number; -1 where the shape is not in the map.
int number(const TopTools_IndexedMapOfShape& map, const TopoDS_Shape& shape) { return map.FindIndex(shape) - 1; }

const TopoDS_Shape& at(const TopTools_IndexedMapOfShape& map, size_t i) {
  if (i >= size_t(map.Extent())) throw std::runtime_error("no such entity");
  return map(int(i) + 1);
}

// The tolerance as stored: BRep_Tool::Tolerance gives no less than 1e-7, whatever the scale of the model.
template <class Stored> double tolerance_of(const TopoDS_Shape& shape) {
  return Handle(Stored)::DownCast(shape.TShape())->Tolerance();
}

} // namespace

Loops::Loops(const TopoDS_Face& face, const TopTools_IndexedMapOfShape& edges)
    : face_(TopoDS::Face(face.Oriented(TopAbs_FORWARD))) {
  int wire = 0;
  for (TopoDS_Iterator it(face_); it.More(); it.Next()) {
    if (it.Value().ShapeType() == TopAbs_WIRE) add_wire(it.Value(), edges, wire++);
  }
}

void Loops::add_wire(const TopoDS_Shape& wire, const TopTools_IndexedMapOfShape& edges, int number_of_wire) {
  std::vector<TopoDS_Shape> plain, ordered;
  for (TopoDS_Iterator it(wire); it.More(); it.Next()) {
    const TopAbs_Orientation side = it.Value().Orientation();
    if (it.Value().ShapeType() != TopAbs_EDGE || (side != TopAbs_FORWARD && side != TopAbs_REVERSED)) continue;
    plain.push_back(it.Value());
  }
  for (BRepTools_WireExplorer it(TopoDS::Wire(wire), face_); it.More() && ordered.size() <= plain.size(); it.Next())
    ordered.push_back(it.Current());
  for (const TopoDS_Shape& edge : ordered.size() == plain.size() ? ordered : plain)
    edges_.push_back({edge, number(edges, edge), number_of_wire});
}

Coedge Loops::coedge(size_t i) const {
  return guard("coedge", [&] {
    const Item& item = edges_.at(i);
    Coedge coedge{};
    coedge.edge = item.index;
    coedge.wire = item.wire;
    coedge.reversed = item.edge.Orientation() == TopAbs_REVERSED;
    coedge.seam = BRep_Tool::IsClosed(TopoDS::Edge(item.edge), face_);
    BRep_Tool::Range(TopoDS::Edge(item.edge), face_, coedge.first, coedge.last);
    return coedge;
  });
}

std::unique_ptr<Pcurve> Loops::pcurve(size_t i) const {
  return guard("pcurve", [&] {
    double first = 0, last = 0;
    Handle(Geom2d_Curve) curve = BRep_Tool::CurveOnSurface(TopoDS::Edge(edges_.at(i).edge), face_, first, last);
    if (curve.IsNull()) throw std::runtime_error("edge has no pcurve on its face");
    return std::make_unique<Pcurve>(curve, first, last);
  });
}

Shape::Shape(const TopoDS_Shape& shape) : shape_(shape) {
  TopExp::MapShapes(shape, TopAbs_FACE, faces_);
  TopExp::MapShapes(shape, TopAbs_EDGE, edges_);
  // points that bound no edge (construction points of STEP files) are none of the model's vertices
  TopTools_IndexedMapOfShape all, used;
  TopExp::MapShapes(shape, TopAbs_VERTEX, all);
  for (int i = 1; i <= edges_.Extent(); i++) TopExp::MapShapes(edges_(i), TopAbs_VERTEX, used);
  for (int i = 1; i <= all.Extent(); i++)
    if (used.Contains(all(i))) vertices_.Add(all(i));
}

FaceData Shape::face(size_t i) const {
  return guard("face", [&] {
    const TopoDS_Face face = TopoDS::Face(at(faces_, i));
    FaceData data{};
    data.reversed = face.Orientation() == TopAbs_REVERSED;
    data.tolerance = tolerance_of<BRep_TFace>(face);
    BRepTools::UVBounds(face, data.u_min, data.u_max, data.v_min, data.v_max);
    data.natural = BRep_Tool::NaturalRestriction(face);
    return data;
  });
}

EdgeData Shape::edge(size_t i) const {
  return guard("edge", [&] {
    const TopoDS_Edge edge = TopoDS::Edge(at(edges_, i).Oriented(TopAbs_FORWARD));
    EdgeData data{};
    data.tolerance = tolerance_of<BRep_TEdge>(edge);
    data.degenerate = BRep_Tool::Degenerated(edge);
    BRep_Tool::Range(edge, data.first, data.last);
    TopoDS_Vertex start, end;
    TopExp::Vertices(edge, start, end);
    data.start = start.IsNull() ? -1 : number(vertices_, start);
    data.end = end.IsNull() ? -1 : number(vertices_, end);
    return data;
  });
}

VertexData Shape::vertex(size_t i) const {
  return guard("vertex", [&] {
    const TopoDS_Vertex vertex = TopoDS::Vertex(at(vertices_, i));
    const gp_Pnt p = BRep_Tool::Pnt(vertex);
    VertexData data{};
    data.x = p.X();
    data.y = p.Y();
    data.z = p.Z();
    data.tolerance = tolerance_of<BRep_TVertex>(vertex);
    return data;
  });
}

std::unique_ptr<Loops> Shape::loops(size_t i) const {
  return guard("face boundary", [&] { return std::make_unique<Loops>(TopoDS::Face(at(faces_, i)), edges_); });
}

std::unique_ptr<Surface> Shape::surface(size_t i) const {
  return guard("face surface", [&] {
    Handle(Geom_Surface) surface = BRep_Tool::Surface(TopoDS::Face(at(faces_, i)));
    if (surface.IsNull()) throw std::runtime_error("face has no surface");
    return std::make_unique<Surface>(surface);
  });
}

std::unique_ptr<Curve> Shape::curve(size_t i) const {
  return guard("edge curve", [&] {
    double first = 0, last = 0;
    Handle(Geom_Curve) curve = BRep_Tool::Curve(TopoDS::Edge(at(edges_, i)), first, last);
    if (curve.IsNull()) throw std::runtime_error("edge has no curve in space");
    return std::make_unique<Curve>(curve);
  });
}

rust::Vec<uint8_t> Shape::bytes() const {
  return guard("shape to bytes", [&] {
    std::ostringstream stream(std::ios::binary);
    BinTools::Write(shape_, stream);
    const std::string text = stream.str();
    rust::Vec<uint8_t> bytes;
    bytes.reserve(text.size());
    for (char c : text) bytes.push_back(uint8_t(c));
    return bytes;
  });
}

std::unique_ptr<Shape> shape_from_bytes(rust::Slice<const uint8_t> bytes) {
  return guard("shape from bytes", [&] {
    std::istringstream stream(std::string(reinterpret_cast<const char*>(bytes.data()), bytes.size()), std::ios::binary);
    TopoDS_Shape shape;
    BinTools::Read(shape, stream);
    if (shape.IsNull()) throw std::runtime_error("no shape in the bytes");
    return std::make_unique<Shape>(shape);
  });
}

} // namespace occt
