//! The bridge to OpenCASCADE (OCCT): the only C++ and the only `unsafe` of the workspace.
//!
//! Thin on purpose: reading a file into a [`Shape`], numbering its faces, edges and vertices, copying their plain data out,
//! and evaluating immutable geometry ([`Surface`], [`Curve`], [`Pcurve`]). Every function that can fail returns
//! [`cxx::Exception`] with OCCT's own text. `README.md` tells why this is not the published crate of that name.
#![allow(missing_docs)] // the bridge macro does not hand documentation of shared types on; their meaning stands below

#[allow(clippy::missing_safety_doc, clippy::too_many_arguments)]
#[cxx::bridge(namespace = "occt")]
mod ffi {
    /// Format that [`read_file`] is told to read.
    #[derive(Debug)]
    enum Format {
        Step,
        Iges,
        Brep,
    }

    /// What a surface or a curve is.
    #[derive(Debug, Hash, PartialOrd, Ord)]
    enum Kind {
        Plane,
        Cylinder,
        Cone,
        Sphere,
        Torus,
        Revolution,
        Extrusion,
        Offset,
        Bezier,
        Bspline,
        Line,
        Circle,
        Ellipse,
        Parabola,
        Hyperbola,
        Other,
    }

    /// Elementary data: `axes` are origin, x, y, z (12 numbers); `a` and `b` radii, semi-angle or offset, as OCCT defines them.
    #[derive(Debug)]
    struct Form {
        kind: Kind,
        axes: Vec<f64>,
        a: f64,
        b: f64,
    }

    /// A B-spline cut into Bezier spans: poles are x, y, z, weight; spans u-major, in a span again u-major.
    #[derive(Debug)]
    struct Spans {
        degree_u: u32,
        degree_v: u32,
        knots_u: Vec<f64>,
        knots_v: Vec<f64>,
        /// 0 where not periodic
        period_u: f64,
        period_v: f64,
        poles: Vec<f64>,
    }

    #[derive(Debug)]
    struct FaceData {
        reversed: bool,
        natural: bool,
        tolerance: f64,
        u_min: f64,
        u_max: f64,
        v_min: f64,
        v_max: f64,
    }

    /// `start` and `end` are vertex numbers, -1 where there is none.
    #[derive(Debug)]
    struct EdgeData {
        degenerate: bool,
        tolerance: f64,
        first: f64,
        last: f64,
        start: i32,
        end: i32,
    }

    #[derive(Debug)]
    struct VertexData {
        x: f64,
        y: f64,
        z: f64,
        tolerance: f64,
    }

    /// One use of an edge by a face; `edge` is -1 where the edge is not in the shape.
    #[derive(Debug)]
    struct Coedge {
        edge: i32,
        wire: i32,
        reversed: bool,
        seam: bool,
        first: f64,
        last: f64,
    }

    /// Name and reference of an entity: kind 0 face, 1 edge, 2 vertex, 3 face as a member of a named group.
    #[derive(Debug)]
    struct Label {
        kind: u8,
        index: u32,
        reference: String,
        name: String,
    }

    unsafe extern "C++" {
        include!("airfoil.hxx");
        include!("import.hxx");
        include!("oracle.hxx");
        include!("place.hxx");

        type Surface;
        type Curve;
        type Pcurve;
        type Loops;
        type Shape;
        type Import;
        type Oracle;

        fn d2(self: &Surface, u: f64, v: f64, jet: &mut [f64; 18]) -> Result<()>;
        fn form(self: &Surface) -> Result<Form>;
        fn spans(self: &Surface) -> Result<Spans>;
        fn basis_surface(self: &Surface) -> Result<UniquePtr<Surface>>;
        fn basis_curve(self: &Surface) -> Result<UniquePtr<Curve>>;

        fn d2(self: &Curve, t: f64, jet: &mut [f64; 9]) -> Result<()>;
        fn form(self: &Curve) -> Result<Form>;
        fn spans(self: &Curve, first: f64, last: f64) -> Result<Spans>;
        fn basis_curve(self: &Curve) -> Result<UniquePtr<Curve>>;

        fn d1(self: &Pcurve, t: f64, jet: &mut [f64; 4]) -> Result<()>;
        fn spans(self: &Pcurve) -> Result<Spans>;

        fn count(self: &Loops) -> usize;
        fn coedge(self: &Loops, i: usize) -> Result<Coedge>;
        fn pcurve(self: &Loops, i: usize) -> Result<UniquePtr<Pcurve>>;

        fn face_count(self: &Shape) -> usize;
        fn edge_count(self: &Shape) -> usize;
        fn vertex_count(self: &Shape) -> usize;
        fn face(self: &Shape, i: usize) -> Result<FaceData>;
        fn edge(self: &Shape, i: usize) -> Result<EdgeData>;
        fn vertex(self: &Shape, i: usize) -> Result<VertexData>;
        fn loops(self: &Shape, face: usize) -> Result<UniquePtr<Loops>>;
        fn surface(self: &Shape, face: usize) -> Result<UniquePtr<Surface>>;
        fn curve(self: &Shape, edge: usize) -> Result<UniquePtr<Curve>>;
        fn bytes(self: &Shape) -> Result<Vec<u8>>;
        fn shape_from_bytes(bytes: &[u8]) -> Result<UniquePtr<Shape>>;

        /// Coordinates come in the unit of the file times `scale`. Turns OCCT's own messages off for the whole process.
        /// With `announce`, what [`Import::warnings`] tells is written to standard error as well, before OCCT goes on to use it.
        fn read_file(path: &str, format: Format, scale: f64, announce: bool) -> Result<UniquePtr<Import>>;
        /// From here on a crash of this process is told of on standard error, with the place: for a process that does nothing but read.
        fn tell_crashes();
        /// The place that is told if OCCT crashes from here on.
        fn stand_at(entity: &str);
        fn shape(self: &Import) -> &Shape;
        fn unit(self: &Import) -> String;
        fn millimetres_per_unit(self: &Import) -> f64;
        fn labels(self: &Import) -> Vec<Label>;
        fn dropped(self: &Import) -> Vec<String>;
        /// What OCCT's checks say of entities.
        fn warnings(self: &Import) -> Vec<String>;

        /// The C2 spline through points (x, y one after the other) from one end of the trailing edge round the nose, which has the given
        /// number, to the other end, and where the ends differ a straight base between them; as STEP. Turns OCCT's own messages off.
        fn write_airfoil(path: &str, points: &[f64], nose: usize) -> Result<()>;

        /// OCCT's own searches on a face, for tests and benchmarks: `found` is u, v, distance; the point of `extrema`.
        fn oracle(shape: &Shape, face: usize) -> Result<UniquePtr<Oracle>>;
        fn project(self: Pin<&mut Oracle>, x: f64, y: f64, z: f64, found: &mut [f64; 3]) -> Result<bool>;
        fn analyse(self: Pin<&mut Oracle>, x: f64, y: f64, z: f64, found: &mut [f64; 3]) -> Result<()>;
        fn extrema(self: &Oracle, x: f64, y: f64, z: f64, found: &mut [f64; 3]) -> Result<f64>;
        fn off(self: &Oracle, x: f64, y: f64, z: f64, slack: f64) -> Result<f64>;
    }
}

pub use cxx::{Exception, UniquePtr};
pub use ffi::{
    Coedge, Curve, EdgeData, FaceData, Form, Format, Import, Kind, Label, Loops, Oracle, Pcurve, Shape, Spans, Surface,
    VertexData, oracle, read_file, shape_from_bytes, stand_at, tell_crashes, write_airfoil,
};

// SAFETY (the three types below): each holds one `Handle(Geom_*)` or `Handle(Geom2d_*)` that is never replaced or edited after
// construction. Their methods are `const`; those that are called from several threads evaluate through `D1`/`D2`, which write
// only to their arguments (measured: helgrind clean, 0 wrong points of 600 000, where a shared adaptor gave 32 287).
// `form`, `spans` and `basis_*` read and copy. Reference counts of handles are atomic, so dropping on any thread is sound.
unsafe impl Send for Surface {}
// SAFETY: as above.
unsafe impl Sync for Surface {}
// SAFETY: as above.
unsafe impl Send for Curve {}
// SAFETY: as above.
unsafe impl Sync for Curve {}
// SAFETY: as above.
unsafe impl Send for Pcurve {}
// SAFETY: as above.
unsafe impl Sync for Pcurve {}
