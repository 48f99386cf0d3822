//! What a query answers.

use crate::ids::{EdgeId, EntityId, VertexId};
use glam::{DVec2, DVec3};

/// The closest point of a group to a query point.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Foot {
    /// The point on the CAD, evaluated by OCCT, in the unit of the file.
    pub point: DVec3,
    /// The face, edge or vertex it lies on.
    pub entity: EntityId,
    /// OCCT's parameters on that entity: `u, v` of a face, `t, 0` of an edge, zeros of a vertex. For [`End::OnTrim`] they are those of
    /// the edge's pcurve: the surface there differs from `point` by up to the edge's tolerance.
    pub parameters: [f64; 2],
    /// Distance from the query point to `point`.
    pub distance: f64,
    /// How the search ended.
    pub end: End,
    /// Why another point of the group might be nearer; `None` where the foot is proven to be the closest point (up to rounding): every
    /// leaf was either farther away or had one minimum only.
    pub doubt: Option<Doubt>,
}

impl Foot {
    /// Whether the foot is proven to be the closest point of the group.
    pub fn is_proven(&self) -> bool {
        self.doubt.is_none()
    }
}

/// Why a foot is not proven to be the closest point; of several reasons, the last of these.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum Doubt {
    /// A surface or curve near by is of a kind whose hulls are sampled.
    SampledHull,
    /// The search spent [`CUT_BUDGET`](crate::tolerance::CUT_BUDGET) before it had cut all that may be nearer.
    Budget,
    /// The search was made without proof, or the query point is not finite.
    NotSearched,
}

impl std::fmt::Display for Doubt {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.write_str(match self {
            Self::SampledHull => "the hull of a surface or curve near by is sampled",
            Self::Budget => "too many parts are as near",
            Self::NotSearched => "not searched",
        })
    }
}

/// How a query ended.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum End {
    /// Inside a face or an edge; the line to the query point is normal to it.
    Interior,
    /// On a boundary edge of the face.
    OnTrim(EdgeId),
    /// On a line where the surface or curve is not smooth, or ends without an edge.
    OnCrease,
    /// At the end of an edge, or at a corner of the face.
    OnEnd(VertexId),
    /// The best point found is not a minimum: `residual` is the length of the tangential part of (foot − query point).
    Stalled {
        /// In the unit of the file.
        residual: f64,
    },
}

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
