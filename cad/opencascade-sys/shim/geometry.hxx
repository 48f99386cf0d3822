// Immutable geometry: surfaces, curves and pcurves behind OCCT handles, evaluated by D0..D2 only.
#pragma once
#include "rust/cxx.h"
#include <Geom2d_Curve.hxx>
#include <Geom_Curve.hxx>
#include <Geom_Surface.hxx>
#include <array>
#include <memory>

namespace occt {

struct Form;
struct Spans;

class Surface {
public:
  explicit Surface(Handle(Geom_Surface) surface);
  void d2(double u, double v, std::array<double, 18>& jet) const;
  Form form() const;
  Spans spans() const;
  std::unique_ptr<Surface> basis_surface() const;
  std::unique_ptr<class Curve> basis_curve() const;

private:
  Handle(Geom_Surface) surface_;
};

class Curve {
public:
  explicit Curve(Handle(Geom_Curve) curve);
  void d2(double t, std::array<double, 9>& jet) const;
  Form form() const;
  Spans spans(double first, double last) const;
  std::unique_ptr<Curve> basis_curve() const;

private:
  Handle(Geom_Curve) curve_;
};

class Pcurve {
public:
  Pcurve(Handle(Geom2d_Curve) curve, double first, double last);
  void d1(double t, std::array<double, 4>& jet) const;
  Spans spans() const;

private:
  Handle(Geom2d_Curve) curve_;
  double first_, last_;
};

} // namespace occt
