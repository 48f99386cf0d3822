#include "airfoil.hxx"
#include "guard.hxx"

#include <BRepBuilderAPI_MakeEdge.hxx>
#include <BRepBuilderAPI_MakeVertex.hxx>
#include <BRepBuilderAPI_MakeWire.hxx>
#include <GeomAPI_Interpolate.hxx>
#include <Geom_BSplineCurve.hxx>
#include <IFSelect_ReturnStatus.hxx>
#include <Interface_Static.hxx>
#include <Message.hxx>
#include <Message_Messenger.hxx>
#include <STEPControl_Writer.hxx>
#include <TColgp_HArray1OfPnt.hxx>
#include <TopoDS_Edge.hxx>
#include <TopoDS_Vertex.hxx>
#include <TopoDS_Wire.hxx>
#include <gp_Pnt.hxx>

namespace occt {
namespace {

TopoDS_Edge edge(const Handle(Geom_Curve)& curve, const TopoDS_Vertex& from, const TopoDS_Vertex& to, double first, double last) {
  BRepBuilderAPI_MakeEdge make(curve, from, to, first, last);
  if (!make.IsDone()) throw std::runtime_error("no edge on the spline");
  return make.Edge();
}

} // namespace

void write_airfoil(rust::Str path, rust::Slice<const double> points, std::size_t nose) {
  guard("write_airfoil", [&] {
    Message::DefaultMessenger()->ChangePrinters().Clear();
    const int count = int(points.size() / 2);
    if (count < 4 || nose == 0 || int(nose) + 1 >= count) throw std::runtime_error("too few points");
    Handle(TColgp_HArray1OfPnt) places = new TColgp_HArray1OfPnt(1, count);
    for (int i = 0; i < count; i++) places->SetValue(i + 1, gp_Pnt(points[2 * i], points[2 * i + 1], 0.0));
    GeomAPI_Interpolate interpolate(places, false, 1e-12);
    interpolate.Perform();
    if (!interpolate.IsDone()) throw std::runtime_error("no spline through the points");
    const Handle(Geom_BSplineCurve) curve = interpolate.Curve();
    if (curve->NbKnots() != count) throw std::runtime_error("the spline's knots are not its points");
    const gp_Pnt start = places->First(), end = places->Last();
    const bool sharp = start.Distance(end) == 0.0;
    const TopoDS_Vertex first = BRepBuilderAPI_MakeVertex(start), middle = BRepBuilderAPI_MakeVertex(places->Value(int(nose) + 1));
    const TopoDS_Vertex last = sharp ? first : TopoDS_Vertex(BRepBuilderAPI_MakeVertex(end));
    const double at = curve->Knot(int(nose) + 1);
    BRepBuilderAPI_MakeWire wire(edge(curve, first, middle, curve->FirstParameter(), at), edge(curve, middle, last, at, curve->LastParameter()));
    if (!sharp) wire.Add(BRepBuilderAPI_MakeEdge(last, first).Edge());
    if (!wire.IsDone()) throw std::runtime_error("the curves make no loop");
    STEPControl_Writer writer;
    Interface_Static::SetCVal("write.step.unit", "MM");
    const std::string name(path.data(), path.size());
    if (writer.Transfer(wire.Wire(), STEPControl_AsIs) != IFSelect_RetDone) throw std::runtime_error("STEP does not take the curves");
    if (writer.Write(name.c_str()) != IFSelect_RetDone) throw std::runtime_error("the file could not be written");
  });
}

} // namespace occt
