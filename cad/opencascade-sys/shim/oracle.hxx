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

private:
  TopoDS_Face face_;
  GeomAPI_ProjectPointOnSurf search_;
  Handle(ShapeAnalysis_Surface) analysis_;
};

std::unique_ptr<Oracle> oracle(const Shape& shape, size_t face);

} // namespace occt
