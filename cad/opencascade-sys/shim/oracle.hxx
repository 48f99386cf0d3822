// OCCT's own closest-point searches on one face, as a reference for tests and benchmarks. Not for threads.
#pragma once
#include "shape.hxx"
#include <BRepExtrema_DistShapeShape.hxx>
#include <GeomAPI_ProjectPointOnSurf.hxx>
#include <ShapeAnalysis_Surface.hxx>

namespace occt {

class Oracle {
public:
  explicit Oracle(const TopoDS_Face& face);
  // GeomAPI_ProjectPointOnSurf, initialised once: nearest orthogonal point over the face's range of parameters, trims
  // ignored; writes u, v, distance. False where it finds none.
  bool project(double x, double y, double z, std::array<double, 3>& found);
  // ShapeAnalysis_Surface: u, v, distance on the whole surface, trims ignored.
  void analyse(double x, double y, double z, std::array<double, 3>& found);
  // BRepExtrema_DistShapeShape to the trimmed face: the distance; writes the point.
  double extrema(double x, double y, double z, std::array<double, 3>& found) const;
  // How far a point is off the trimmed face. BRepExtrema alone is not enough: OCCT 7.6 hands the face's tolerance (1e-7 mm) to its
  // classifier as a tolerance of u and v, and so takes points for inside that are 3e-5 mm outside where a parameter is long.
  // Here the classifier has no tolerance, and a point outside is as far off as its nearest edge. `slack` is how far the parameters
  // that ShapeAnalysis finds for the point may miss it.
  double off(double x, double y, double z, double slack) const;

private:
  bool is_outside(const gp_Pnt2d& uv) const;
  TopoDS_Face face_;
  GeomAPI_ProjectPointOnSurf search_;
  Handle(ShapeAnalysis_Surface) analysis_;
};

std::unique_ptr<Oracle> oracle(const Shape& shape, size_t face);

} // namespace occt
