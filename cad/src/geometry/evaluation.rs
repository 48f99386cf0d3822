//! Position and derivatives of an entity at its parameters.

use glam::{DVec2, DVec3};

/// Position and derivatives of an entity at parameters.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Evaluation {
    /// On a face.
    Surface(SurfacePoint),
    /// On an edge.
    Curve(CurvePoint),
    /// A vertex.
    Vertex(DVec3),
}

/// A point of a face.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SurfacePoint {
    /// Position.
    pub point: DVec3,
    /// Derivatives by `u` and `v`.
    pub first: [DVec3; 2],
    /// Derivatives by `uu`, `uv`, `vv`.
    pub second: [DVec3; 3],
    /// Unit normal, on the outer side of the face (its orientation applied); `None` where the tangents are dependent (poles).
    pub normal: Option<DVec3>,
    /// Principal curvatures, larger first, positive where the surface bends towards `normal`; `None` where there is no normal.
    pub curvatures: Option<[f64; 2]>,
}

/// A point of an edge.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct CurvePoint {
    /// Position.
    pub point: DVec3,
    /// First derivative.
    pub first: DVec3,
    /// Second derivative.
    pub second: DVec3,
    /// Unit tangent in the direction of growing parameter; `None` where the derivative vanishes.
    pub tangent: Option<DVec3>,
    /// Curvature; `None` where there is no tangent.
    pub curvature: Option<f64>,
}

impl Evaluation {
    /// The position.
    pub fn point(&self) -> DVec3 {
        match self {
            Self::Surface(s) => s.point,
            Self::Curve(c) => c.point,
            Self::Vertex(p) => *p,
        }
    }
}

impl SurfacePoint {
    /// From OCCT's `D2` and the face's orientation.
    pub(crate) fn new([point, su, sv, suu, suv, svv]: [DVec3; 6], reversed: bool) -> Self {
        let cross = if reversed { sv.cross(su) } else { su.cross(sv) };
        let independent = cross.length() > 1e-12 * su.length() * sv.length() && cross.length() > 0.0;
        let normal = independent.then(|| cross.normalize());
        let curvatures = normal.map(|n| {
            let [e, f, g] = [su.dot(su), su.dot(sv), sv.dot(sv)];
            let [l, m, k] = [suu.dot(n), suv.dot(n), svv.dot(n)];
            let area = e * g - f * f;
            let (mean, gauss) = ((e * k - 2.0 * f * m + g * l) / (2.0 * area), (l * k - m * m) / area);
            let spread = (mean * mean - gauss).max(0.0).sqrt();
            [mean + spread, mean - spread]
        });
        Self { point, first: [su, sv], second: [suu, suv, svv], normal, curvatures }
    }

    /// Parameters of a small move: the tangential part of `by`, in `u, v`.
    pub fn parameters_of(&self, by: DVec3) -> DVec2 {
        let [su, sv] = self.first;
        let [e, f, g] = [su.dot(su), su.dot(sv), sv.dot(sv)];
        let (a, b) = (by.dot(su), by.dot(sv));
        DVec2::new(g * a - f * b, e * b - f * a) / (e * g - f * f)
    }
}

impl CurvePoint {
    pub(crate) fn new([point, first, second]: [DVec3; 3]) -> Self {
        let tangent = first.try_normalize();
        let curvature = tangent.map(|_| first.cross(second).length() / first.length().powi(3));
        Self { point, first, second, tangent, curvature }
    }
}
