#include "oracle.hxx"
#include "guard.hxx"
#include "opencascade-sys/src/lib.rs.h"

#include <BRepBuilderAPI_MakeVertex.hxx>
#include <BRepClass_FaceClassifier.hxx>
#include <BRepTools.hxx>
#include <BRep_Tool.hxx>
#include <TopExp_Explorer.hxx>
#include <TopoDS.hxx>
#include <TopoDS_Vertex.hxx>
#include <algorithm>
#include <vector>

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

bool Oracle::is_outside(const gp_Pnt2d& uv) const {
  const Handle(Geom_Surface) surface = BRep_Tool::Surface(face_);
  const auto shifts = [](bool periodic, double period) { return periodic ? std::vector<double>{0, period, -period} : std::vector<double>{0}; };
  for (const double du : shifts(surface->IsUPeriodic(), surface->IsUPeriodic() ? surface->UPeriod() : 0))
    for (const double dv : shifts(surface->IsVPeriodic(), surface->IsVPeriodic() ? surface->VPeriod() : 0))
      if (BRepClass_FaceClassifier(face_, gp_Pnt2d(uv.X() + du, uv.Y() + dv), 0).State() != TopAbs_OUT) return false;
  return true;
}

double Oracle::off(double x, double y, double z, double slack) const {
  std::array<double, 3> nearest;
  const double distance = extrema(x, y, z, nearest);
  return guard("BRepClass_FaceClassifier", [&] {
    const gp_Pnt point(x, y, z);
    const gp_Pnt2d uv = analysis_->ValueOfUV(point, 1e-12);
    if (analysis_->Value(uv).Distance(point) > slack || !is_outside(uv)) return distance;
    const TopoDS_Vertex vertex = BRepBuilderAPI_MakeVertex(point);
    double rim = RealLast();
    for (TopExp_Explorer edges(face_, TopAbs_EDGE); edges.More(); edges.Next()) {
      if (BRep_Tool::Degenerated(TopoDS::Edge(edges.Current()))) continue;
      BRepExtrema_DistShapeShape extrema(vertex, edges.Current());
      if (extrema.IsDone() && extrema.NbSolution() > 0) rim = std::min(rim, extrema.Value());
    }
    return rim == RealLast() ? distance : std::max(distance, rim);
  });
}

std::unique_ptr<Oracle> oracle(const Shape& shape, size_t face) {
  return guard("oracle", [&] {
    if (face >= shape.face_count()) throw std::runtime_error("no such face");
    return std::make_unique<Oracle>(TopoDS::Face(shape.faces()(int(face) + 1)));
  });
}

} // namespace occt
