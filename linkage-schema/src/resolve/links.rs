//! Sheets, strings and points with the CAD entities on which they lie.

use std::sync::Arc;

use super::tables::{Entity, GeometryTable, Target};
use crate::{Common, EdgeRun, EntityRun, FaceRun, Findings, GeometryId, MeshFile, MeshModel, MeshString, Origin};
use crate::{ParamVertex, PointRun, Sheet, SheetBody, StringBody};

/// A mesh model and all that is linked in it.
#[derive(Debug)]
pub struct ModelLinks<'a> {
    /// The file of the model.
    pub file: &'a MeshFile,
    /// The model.
    pub model: &'a MeshModel,
    /// Its sheets, in the order of the document.
    pub sheets: Vec<SheetLinks<'a>>,
    /// Its strings, in the order of the document.
    pub strings: Vec<StringLinks<'a>>,
    /// Its single points, in the order of the document.
    pub points: Vec<PointLink<'a>>,
}

/// A sheet with its geometry. Exactly one of `faces`, `named` and `reference` tells the faces.
#[derive(Debug)]
pub struct SheetLinks<'a> {
    /// The sheet.
    pub sheet: &'a Sheet,
    /// The geometry of the sheet as a whole; that of a run can differ.
    pub target: Option<Arc<Target<'a>>>,
    /// Faces by point indices.
    pub faces: Vec<FaceLink<'a>>,
    /// Faces by names of the mesh file.
    pub named: Vec<EntityLink<'a>>,
    /// The name of the whole sheet in the mesh file.
    pub reference: Option<&'a str>,
}

/// A string with its geometry. Exactly one of `edges`, `named` and `reference` tells the edges.
#[derive(Debug)]
pub struct StringLinks<'a> {
    /// The string.
    pub string: &'a MeshString,
    /// The geometry of the string as a whole; that of a run can differ.
    pub target: Option<Arc<Target<'a>>>,
    /// Edges by point indices.
    pub edges: Vec<EdgeLink<'a>>,
    /// Edges by names of the mesh file.
    pub named: Vec<EntityLink<'a>>,
    /// The name of the whole string in the mesh file.
    pub reference: Option<&'a str>,
}

macro_rules! link {
    ($(#[$doc:meta])* $name:ident of $run:ident) => {
        $(#[$doc])*
        #[derive(Debug)]
        pub struct $name<'a> {
            /// What is linked; its [`origin`](crate::Origin) is the place for messages.
            pub run: &'a $run,
            /// Its geometry, its own or inherited; `None` where it is linked to nothing (or to nothing that exists).
            pub target: Option<Arc<Target<'a>>>,
        }

        impl<'a> $name<'a> {
            /// The CAD entities on which it lies; empty where it is linked to nothing.
            pub fn entities(&self) -> &[Entity<'a>] {
                self.target.as_deref().map_or(&[], |target| &target.entities)
            }
        }
    };
}

link! {
    /// Faces with their geometry: `link.run.faces()` on any of `link.entities()`.
    FaceLink of FaceRun
}
link! {
    /// Edges with their geometry: `link.run.edges()` on any of `link.entities()`.
    EdgeLink of EdgeRun
}
link! {
    /// Faces or edges that the mesh file names, with their geometry.
    EntityLink of EntityRun
}
link! {
    /// Points with their geometry: `link.run.indices` on any of `link.entities()`.
    PointLink of PointRun
}

impl<'a> SheetLinks<'a> {
    /// The sheet's name, if it has one.
    pub fn name(&self) -> Option<&'a str> {
        self.sheet.common.name.as_deref()
    }

    /// The sheet's parameter vertices.
    pub fn parameters(&self) -> &'a [ParamVertex] {
        &self.sheet.parameters
    }
}

impl<'a> StringLinks<'a> {
    /// The string's name, if it has one.
    pub fn name(&self) -> Option<&'a str> {
        self.string.common.name.as_deref()
    }

    /// The string's parameter vertices.
    pub fn parameters(&self) -> &'a [ParamVertex] {
        &self.string.parameters
    }
}

/// Looks up geometry and says who asked.
struct Finder<'t, 'a> {
    geometry: &'t GeometryTable<'a>,
    findings: &'t mut Findings,
}

impl<'a> Finder<'_, 'a> {
    fn find(&mut self, what: &str, common: &Common, origin: Origin) -> Option<Arc<Target<'a>>> {
        self.geometry.find(common.gref, self.findings, origin, || called(what, common))
    }

    /// The geometry of a run in a container. A `gref` of its own that dangles is not replaced by the container's.
    fn inherit(
        &mut self,
        what: &str,
        own: &Common,
        origin: Origin,
        container: Option<&Arc<Target<'a>>>,
    ) -> Option<Arc<Target<'a>>> {
        match own.gref {
            None => container.cloned(),
            Some(_) => self.find(what, own, origin),
        }
    }
}

/// An element in a message: `MeshSheet "wall"`.
pub(super) fn called(what: &str, common: &Common) -> String {
    match (&common.name, common.mid) {
        (Some(name), _) => format!("{what} {name:?}"),
        (None, Some(mid)) => format!("{what} with mid {mid}"),
        (None, None) => what.to_owned(),
    }
}

/// The links of a model.
pub(super) fn model<'a>(
    file: &'a MeshFile,
    model: &'a MeshModel,
    geometry: &GeometryTable<'a>,
    findings: &mut Findings,
) -> ModelLinks<'a> {
    let mut finder = Finder { geometry, findings };
    finder.find("MeshModelReference", &model.common, model.origin);
    let sheets = model.sheets.iter().map(|one| sheet(one, &mut finder)).collect();
    let strings = model.strings.iter().map(|one| string(one, &mut finder)).collect();
    let points = model
        .points
        .iter()
        .map(|run| PointLink { run, target: finder.find("MeshPointReference", &run.common, run.origin) });
    let points = points.collect();
    parameter_targets(model, geometry, findings);
    ModelLinks { file, model, sheets, strings, points }
}

fn sheet<'a>(sheet: &'a Sheet, finder: &mut Finder<'_, 'a>) -> SheetLinks<'a> {
    let target = finder.find("MeshSheet", &sheet.common, sheet.origin);
    let mut links = SheetLinks { sheet, target, faces: Vec::new(), named: Vec::new(), reference: None };
    let of_sheet = links.target.as_ref();
    match &sheet.body {
        SheetBody::Reference(name) => links.reference = Some(name),
        SheetBody::Faces(runs) => {
            links.faces.extend(
                runs.iter()
                    .map(|run| FaceLink { run, target: finder.inherit("MeshFace", &run.common, run.origin, of_sheet) }),
            );
        }
        SheetBody::FaceReferences(runs) => links.named = named("MeshFaceReference", runs, of_sheet, finder),
    }
    links
}

fn string<'a>(string: &'a MeshString, finder: &mut Finder<'_, 'a>) -> StringLinks<'a> {
    let target = finder.find("MeshString", &string.common, string.origin);
    let mut links = StringLinks { string, target, edges: Vec::new(), named: Vec::new(), reference: None };
    let of_string = links.target.as_ref();
    match &string.body {
        StringBody::Reference(name) => links.reference = Some(name),
        StringBody::Edges(runs) => {
            links.edges.extend(
                runs.iter().map(|run| EdgeLink {
                    run,
                    target: finder.inherit("MeshEdge", &run.common, run.origin, of_string),
                }),
            );
        }
        StringBody::EdgeReferences(runs) => links.named = named("MeshEdgeReference", runs, of_string, finder),
    }
    links
}

fn named<'a>(
    what: &str,
    runs: &'a [EntityRun],
    container: Option<&Arc<Target<'a>>>,
    finder: &mut Finder<'_, 'a>,
) -> Vec<EntityLink<'a>> {
    let link =
        |run: &'a EntityRun| EntityLink { run, target: finder.inherit(what, &run.common, run.origin, container) };
    runs.iter().map(link).collect()
}

/// Parameter vertices must name one existing entity each.
fn parameter_targets(model: &MeshModel, geometry: &GeometryTable<'_>, findings: &mut Findings) {
    let of_sheets = model.sheets.iter().flat_map(|sheet| &sheet.parameters);
    let of_strings = model.strings.iter().flat_map(|string| &string.parameters);
    for vertex in of_sheets.chain(of_strings).chain(&model.parameters) {
        let id: GeometryId = vertex.gref;
        match geometry.get(id) {
            Some(target) if target.group => findings.push(crate::Code::GroupAsEntity, vertex.origin, || {
                format!("ParamVertex has gref {id}, which is a GeometryGroup")
            }),
            Some(_) => {}
            None => findings.push(crate::Code::DanglingReference, vertex.origin, || {
                format!("ParamVertex has gref {id}, which no GeometryReference defines")
            }),
        }
    }
}
