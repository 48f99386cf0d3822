#include "oracle.hxx"
#include "guard.hxx"
#include "opencascade-sys/src/lib.rs.h"

#include <BRepBuilderAPI_MakeVertex.hxx>
#include <BRepTools.hxx>
#include <BRep_Tool.hxx>
#include <TopoDS.hxx>
#include <TopoDS_Vertex.hxx>

namespace occt {

Oracle::Oracle(const TopoDS_Face& face) : face_(face), analysis_(new ShapeAnalysis_Surface(BRep_Tool::Surface(face))) {
  double u_min, u_max, v_min, v_max;
  BRepTools::UVBounds(face, u_min, u_max, v_min, v_max);
  search_.Init(BRep_Tool::Surface(face), u_min, u_max, v_min, v_max);
}

bool Oracle::project(double x, double y, double z, std::array<double, 3>& found) {
  return guard("GeomAPI_ProjectPointOnSurf", [&] {
    search_.Perform(gp_Pnt(x, y, z));
    if (!search_.IsDone() || search_.NbPoints() == 0) return false;
    search_.LowerDistanceParameters(found[0], found[1]);
    found[2] = search_.LowerDistance();
    return true;
  });
}

void Oracle::analyse(double x, double y, double z, std::array<double, 3>& found) {
  guard("ShapeAnalysis_Surface", [&] {
    const gp_Pnt point(x, y, z);
    const gp_Pnt2d uv = analysis_->ValueOfUV(point, 1e-9);
    found = {uv.X(), uv.Y(), analysis_->Value(uv).Distance(point)};
  });
}

double Oracle::extrema(double x, double y, double z, std::array<double, 3>& found) const {
  return guard("BRepExtrema_DistShapeShape", [&] {
    const TopoDS_Vertex vertex = BRepBuilderAPI_MakeVertex(gp_Pnt(x, y, z));
    BRepExtrema_DistShapeShape extrema(vertex, face_);
    if (!extrema.IsDone() || extrema.NbSolution() == 0) throw std::runtime_error("no solution");
    const gp_Pnt point = extrema.PointOnShape2(1);
    found = {point.X(), point.Y(), point.Z()};
    return extrema.Value();
  });
}

std::unique_ptr<Oracle> oracle(const Shape& shape, size_t face) {
  return guard("oracle", [&] {
    if (face >= shape.face_count()) throw std::runtime_error("no such face");
    return std::make_unique<Oracle>(TopoDS::Face(shape.faces()(int(face) + 1)));
  });
}

} // namespace occt
