#include "geometry.hxx"
#include "guard.hxx"
#include "opencascade-sys/src/lib.rs.h"

#include <Geom2dConvert.hxx>
#include <Geom2dConvert_BSplineCurveToBezierCurve.hxx>
#include <Geom2d_BSplineCurve.hxx>
#include <Geom2d_BezierCurve.hxx>
#include <Geom2d_TrimmedCurve.hxx>
#include <GeomConvert.hxx>
#include <GeomConvert_BSplineCurveToBezierCurve.hxx>
#include <GeomConvert_BSplineSurfaceToBezierSurface.hxx>
#include <Geom_BSplineCurve.hxx>
#include <Geom_BSplineSurface.hxx>
#include <Geom_BezierCurve.hxx>
#include <Geom_BezierSurface.hxx>
#include <Geom_Circle.hxx>
#include <Geom_ConicalSurface.hxx>
#include <Geom_CylindricalSurface.hxx>
#include <Geom_Ellipse.hxx>
#include <Geom_Hyperbola.hxx>
#include <Geom_Line.hxx>
#include <Geom_OffsetCurve.hxx>
#include <Geom_OffsetSurface.hxx>
#include <Geom_Parabola.hxx>
#include <Geom_Plane.hxx>
#include <Geom_RectangularTrimmedSurface.hxx>
#include <Geom_SphericalSurface.hxx>
#include <Geom_SurfaceOfLinearExtrusion.hxx>
#include <Geom_SurfaceOfRevolution.hxx>
#include <Geom_ToroidalSurface.hxx>
#include <Geom_TrimmedCurve.hxx>
#include <TColStd_Array1OfReal.hxx>

namespace occt {
namespace {

void put(double* at, const gp_XYZ& p) {
  at[0] = p.X();
  at[1] = p.Y();
  at[2] = p.Z();
}

void push(rust::Vec<double>& list, const gp_XYZ& p) {
  list.push_back(p.X());
  list.push_back(p.Y());
  list.push_back(p.Z());
}

rust::Vec<double> frame(const gp_Pnt& o, const gp_Dir& x, const gp_Dir& y, const gp_Dir& z) {
  rust::Vec<double> list;
  for (const gp_XYZ& p : {o.XYZ(), x.XYZ(), y.XYZ(), z.XYZ()}) push(list, p);
  return list;
}

rust::Vec<double> frame(const gp_Ax3& a) { return frame(a.Location(), a.XDirection(), a.YDirection(), a.Direction()); }
rust::Vec<double> frame(const gp_Ax2& a) { return frame(a.Location(), a.XDirection(), a.YDirection(), a.Direction()); }

Form form_of(Kind kind, rust::Vec<double> axes, double a = 0, double b = 0) {
  Form form{};
  form.kind = kind;
  form.axes = std::move(axes);
  form.a = a;
  form.b = b;
  return form;
}

Handle(Geom_Surface) untrimmed(Handle(Geom_Surface) surface) {
  for (;;) {
    Handle(Geom_RectangularTrimmedSurface) trimmed = Handle(Geom_RectangularTrimmedSurface)::DownCast(surface);
    if (trimmed.IsNull()) return surface;
    surface = trimmed->BasisSurface();
  }
}

Handle(Geom_Curve) untrimmed(Handle(Geom_Curve) curve) {
  for (;;) {
    Handle(Geom_TrimmedCurve) trimmed = Handle(Geom_TrimmedCurve)::DownCast(curve);
    if (trimmed.IsNull()) return curve;
    curve = trimmed->BasisCurve();
  }
}

void push_knots(rust::Vec<double>& list, const TColStd_Array1OfReal& knots) {
  for (int i = knots.Lower(); i <= knots.Upper(); i++) list.push_back(knots(i));
}

void push_pole(rust::Vec<double>& list, const gp_XYZ& p, double w) {
  push(list, p);
  list.push_back(w);
}

void push_patch(Spans& spans, const Handle(Geom_BezierSurface)& patch) {
  for (int i = 1; i <= patch->NbUPoles(); i++)
    for (int j = 1; j <= patch->NbVPoles(); j++) push_pole(spans.poles, patch->Pole(i, j).XYZ(), patch->Weight(i, j));
}

Spans spans_of(const Handle(Geom_BSplineSurface)& given) {
  Handle(Geom_BSplineSurface) surface = Handle(Geom_BSplineSurface)::DownCast(given->Copy());
  Spans spans{};
  spans.period_u = given->IsUPeriodic() ? given->UPeriod() : 0;
  spans.period_v = given->IsVPeriodic() ? given->VPeriod() : 0;
  if (surface->IsUPeriodic()) surface->SetUNotPeriodic();
  if (surface->IsVPeriodic()) surface->SetVNotPeriodic();
  GeomConvert_BSplineSurfaceToBezierSurface convert(surface);
  TColStd_Array1OfReal u(1, convert.NbUPatches() + 1), v(1, convert.NbVPatches() + 1);
  convert.UKnots(u);
  convert.VKnots(v);
  push_knots(spans.knots_u, u);
  push_knots(spans.knots_v, v);
  spans.degree_u = surface->UDegree();
  spans.degree_v = surface->VDegree();
  for (int i = 1; i <= convert.NbUPatches(); i++)
    for (int j = 1; j <= convert.NbVPatches(); j++) push_patch(spans, convert.Patch(i, j));
  return spans;
}

Spans spans_of(Handle(Geom_BSplineCurve) curve) {
  Spans spans{};
  spans.period_u = curve->IsPeriodic() ? curve->Period() : 0;
  curve = Handle(Geom_BSplineCurve)::DownCast(curve->Copy());
  if (curve->IsPeriodic()) curve->SetNotPeriodic();
  GeomConvert_BSplineCurveToBezierCurve convert(curve);
  TColStd_Array1OfReal knots(1, convert.NbArcs() + 1);
  convert.Knots(knots);
  push_knots(spans.knots_u, knots);
  spans.degree_u = curve->Degree();
  for (int i = 1; i <= convert.NbArcs(); i++) {
    Handle(Geom_BezierCurve) arc = convert.Arc(i);
    for (int k = 1; k <= arc->NbPoles(); k++) push_pole(spans.poles, arc->Pole(k).XYZ(), arc->Weight(k));
  }
  return spans;
}

} // namespace

Surface::Surface(Handle(Geom_Surface) surface) : surface_(untrimmed(surface)) {}

void Surface::d2(double u, double v, std::array<double, 18>& jet) const {
  guard("surface evaluation", [&] {
    gp_Pnt p;
    gp_Vec du, dv, duu, dvv, duv;
    surface_->D2(u, v, p, du, dv, duu, dvv, duv);
    put(&jet[0], p.XYZ());
    put(&jet[3], du.XYZ());
    put(&jet[6], dv.XYZ());
    put(&jet[9], duu.XYZ());
    put(&jet[12], duv.XYZ());
    put(&jet[15], dvv.XYZ());
  });
}

Form Surface::form() const {
  return guard("surface form", [&]() -> Form {
    if (auto s = Handle(Geom_Plane)::DownCast(surface_)) return form_of(Kind::Plane, frame(s->Position()));
    if (auto s = Handle(Geom_CylindricalSurface)::DownCast(surface_))
      return form_of(Kind::Cylinder, frame(s->Position()), s->Radius());
    if (auto s = Handle(Geom_ConicalSurface)::DownCast(surface_))
      return form_of(Kind::Cone, frame(s->Position()), s->RefRadius(), s->SemiAngle());
    if (auto s = Handle(Geom_SphericalSurface)::DownCast(surface_))
      return form_of(Kind::Sphere, frame(s->Position()), s->Radius());
    if (auto s = Handle(Geom_ToroidalSurface)::DownCast(surface_))
      return form_of(Kind::Torus, frame(s->Position()), s->MajorRadius(), s->MinorRadius());
    if (auto s = Handle(Geom_SurfaceOfRevolution)::DownCast(surface_)) {
      const gp_Dir z = s->Axis().Direction();
      return form_of(Kind::Revolution, frame(gp_Ax2(s->Location(), z)));
    }
    if (auto s = Handle(Geom_SurfaceOfLinearExtrusion)::DownCast(surface_)) {
      const gp_Dir z = s->Direction();
      return form_of(Kind::Extrusion, frame(gp_Ax2(gp_Pnt(0, 0, 0), z)));
    }
    if (auto s = Handle(Geom_OffsetSurface)::DownCast(surface_)) return form_of(Kind::Offset, {}, s->Offset());
    if (surface_->IsKind(STANDARD_TYPE(Geom_BezierSurface))) return form_of(Kind::Bezier, {});
    if (surface_->IsKind(STANDARD_TYPE(Geom_BSplineSurface))) return form_of(Kind::Bspline, {});
    return form_of(Kind::Other, {});
  });
}

Spans Surface::spans() const {
  return guard("surface spans", [&]() -> Spans {
    if (auto s = Handle(Geom_BSplineSurface)::DownCast(surface_)) return spans_of(s);
    if (auto s = Handle(Geom_BezierSurface)::DownCast(surface_)) {
      Spans spans{};
      spans.degree_u = s->UDegree();
      spans.degree_v = s->VDegree();
      for (auto* knots : {&spans.knots_u, &spans.knots_v})
        for (double knot : {0.0, 1.0}) knots->push_back(knot);
      push_patch(spans, s);
      return spans;
    }
    throw std::runtime_error("not a B-spline");
  });
}

std::unique_ptr<Surface> Surface::basis_surface() const {
  return guard("basis surface", [&] {
    auto s = Handle(Geom_OffsetSurface)::DownCast(surface_);
    if (s.IsNull()) throw std::runtime_error("not an offset surface");
    return std::make_unique<Surface>(s->BasisSurface());
  });
}

std::unique_ptr<Curve> Surface::basis_curve() const {
  return guard("basis curve", [&] {
    auto s = Handle(Geom_SweptSurface)::DownCast(surface_);
    if (s.IsNull()) throw std::runtime_error("not a swept surface");
    return std::make_unique<Curve>(s->BasisCurve());
  });
}

Curve::Curve(Handle(Geom_Curve) curve) : curve_(untrimmed(curve)) {}

void Curve::d2(double t, std::array<double, 9>& jet) const {
  guard("curve evaluation", [&] {
    gp_Pnt p;
    gp_Vec d1, d2;
    curve_->D2(t, p, d1, d2);
    put(&jet[0], p.XYZ());
    put(&jet[3], d1.XYZ());
    put(&jet[6], d2.XYZ());
  });
}

Form Curve::form() const {
  return guard("curve form", [&]() -> Form {
    if (auto c = Handle(Geom_Line)::DownCast(curve_)) {
      const gp_Ax1 axis = c->Position();
      return form_of(Kind::Line, frame(gp_Ax2(axis.Location(), axis.Direction())));
    }
    if (auto c = Handle(Geom_Circle)::DownCast(curve_)) return form_of(Kind::Circle, frame(c->Position()), c->Radius(), c->Radius());
    if (auto c = Handle(Geom_Ellipse)::DownCast(curve_))
      return form_of(Kind::Ellipse, frame(c->Position()), c->MajorRadius(), c->MinorRadius());
    if (auto c = Handle(Geom_Parabola)::DownCast(curve_)) return form_of(Kind::Parabola, frame(c->Position()), c->Focal());
    if (auto c = Handle(Geom_Hyperbola)::DownCast(curve_))
      return form_of(Kind::Hyperbola, frame(c->Position()), c->MajorRadius(), c->MinorRadius());
    if (auto c = Handle(Geom_OffsetCurve)::DownCast(curve_)) return form_of(Kind::Offset, {}, c->Offset());
    if (curve_->IsKind(STANDARD_TYPE(Geom_BezierCurve))) return form_of(Kind::Bezier, {});
    if (curve_->IsKind(STANDARD_TYPE(Geom_BSplineCurve))) return form_of(Kind::Bspline, {});
    return form_of(Kind::Other, {});
  });
}

Spans Curve::spans(double first, double last) const {
  return guard("curve spans", [&]() -> Spans {
    if (auto c = Handle(Geom_BSplineCurve)::DownCast(curve_)) return spans_of(c);
    if (auto c = Handle(Geom_BezierCurve)::DownCast(curve_)) return spans_of(GeomConvert::CurveToBSplineCurve(c));
    return spans_of(GeomConvert::CurveToBSplineCurve(new Geom_TrimmedCurve(curve_, first, last)));
  });
}

std::unique_ptr<Curve> Curve::basis_curve() const {
  return guard("basis curve", [&] {
    auto c = Handle(Geom_OffsetCurve)::DownCast(curve_);
    if (c.IsNull()) throw std::runtime_error("not an offset curve");
    return std::make_unique<Curve>(c->BasisCurve());
  });
}

Pcurve::Pcurve(Handle(Geom2d_Curve) curve, double first, double last) : curve_(curve), first_(first), last_(last) {}

void Pcurve::d1(double t, std::array<double, 4>& jet) const {
  guard("pcurve evaluation", [&] {
    gp_Pnt2d p;
    gp_Vec2d d;
    curve_->D1(t, p, d);
    jet = {p.X(), p.Y(), d.X(), d.Y()};
  });
}

Spans Pcurve::spans() const {
  return guard("pcurve spans", [&]() -> Spans {
    Handle(Geom2d_BSplineCurve) curve = Geom2dConvert::CurveToBSplineCurve(new Geom2d_TrimmedCurve(curve_, first_, last_));
    if (curve->IsPeriodic()) curve->SetNotPeriodic();
    Geom2dConvert_BSplineCurveToBezierCurve convert(curve);
    TColStd_Array1OfReal knots(1, convert.NbArcs() + 1);
    convert.Knots(knots);
    Spans spans{};
    push_knots(spans.knots_u, knots);
    spans.degree_u = curve->Degree();
    for (int i = 1; i <= convert.NbArcs(); i++) {
      Handle(Geom2d_BezierCurve) arc = convert.Arc(i);
      for (int k = 1; k <= arc->NbPoles(); k++)
        push_pole(spans.poles, gp_XYZ(arc->Pole(k).X(), arc->Pole(k).Y(), 0), arc->Weight(k));
    }
    return spans;
  });
}

} // namespace occt
