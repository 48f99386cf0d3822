//! Reading the mesh side: files, models, sheets, strings, runs, parameter vertices.

use std::io::BufRead;

use super::content::Shape;
use super::{positive, shorten};
use crate::cursor::Cursor;
use crate::vocabulary::Element;
use crate::{Code, Common, EdgeRun, Encoding, EntityRun, FaceRun, FaceShape, MeshFile, MeshModel, MeshString, Origin};
use crate::{ParamVertex, PointRun, ReadError, Sheet, SheetBody, StringBody, VertexRef};

impl<R: BufRead> Cursor<R> {
    pub(super) fn mesh_file(&mut self) -> Result<MeshFile, ReadError> {
        let mut file = MeshFile {
            filename: self.required("filename"),
            aref: self.optional_id("aref"),
            models: Vec::new(),
            origin: self.tag.origin,
        };
        while let Some(element) = self.child()? {
            match element {
                Element::MeshModelReference => file.models.push(self.mesh_model()?),
                _ => self.unknown()?,
            }
        }
        if file.models.is_empty() {
            self.empty(file.origin, "MeshFile has no MeshModelReference");
        }
        Ok(file)
    }

    fn mesh_model(&mut self) -> Result<MeshModel, ReadError> {
        let mut model = MeshModel {
            reference: self.required("ref"),
            common: self.common(),
            sheets: Vec::new(),
            strings: Vec::new(),
            points: Vec::new(),
            parameters: Vec::new(),
            origin: self.tag.origin,
        };
        while let Some(element) = self.child()? {
            match element {
                Element::MeshSheet => model.sheets.push(self.sheet()?),
                Element::MeshSheetReference => model.sheets.push(self.sheet_reference()?),
                Element::MeshString => model.strings.push(self.mesh_string()?),
                Element::MeshStringReference => model.strings.push(self.string_reference()?),
                Element::MeshPointReference => model.points.extend(self.point_run()?),
                Element::ParamVertex => model.parameters.extend(self.param_vertex()?),
                _ => self.unknown()?,
            }
        }
        model.parameters.shrink_to_fit();
        Ok(model)
    }

    fn sheet(&mut self) -> Result<Sheet, ReadError> {
        let (common, origin) = (self.common(), self.tag.origin);
        let (mut faces, mut references, mut parameters) = (Vec::new(), Vec::new(), Vec::new());
        let mut first = None;
        while let Some(element) = self.child()? {
            match element {
                Element::ParamVertex => {
                    self.check_order(first.is_some());
                    parameters.extend(self.param_vertex()?);
                    continue;
                }
                Element::MeshFace => faces.extend(self.face_run()?),
                Element::MeshFaceReference => references.extend(self.entity_run("MeshFaceReference")?),
                _ => {
                    self.unknown()?;
                    continue;
                }
            }
            self.check_mixture(*first.get_or_insert(element), element, origin);
        }
        if first.is_none() {
            self.empty(origin, "MeshSheet has no faces");
        }
        parameters.shrink_to_fit();
        let body = match first {
            Some(Element::MeshFaceReference) => SheetBody::FaceReferences(references),
            _ => SheetBody::Faces(faces),
        };
        Ok(Sheet { common, body, parameters, origin })
    }

    fn mesh_string(&mut self) -> Result<MeshString, ReadError> {
        let (common, origin) = (self.common(), self.tag.origin);
        let (mut edges, mut references, mut parameters) = (Vec::new(), Vec::new(), Vec::new());
        let mut first = None;
        while let Some(element) = self.child()? {
            match element {
                Element::ParamVertex => {
                    self.check_order(first.is_some());
                    parameters.extend(self.param_vertex()?);
                    continue;
                }
                Element::MeshEdge => edges.extend(self.edge_run()?),
                Element::MeshEdgeReference => references.extend(self.entity_run("MeshEdgeReference")?),
                _ => {
                    self.unknown()?;
                    continue;
                }
            }
            self.check_mixture(*first.get_or_insert(element), element, origin);
        }
        if first.is_none() {
            self.empty(origin, "MeshString has no edges");
        }
        parameters.shrink_to_fit();
        let body = match first {
            Some(Element::MeshEdgeReference) => StringBody::EdgeReferences(references),
            _ => StringBody::Edges(edges),
        };
        Ok(MeshString { common, body, parameters, origin })
    }

    fn sheet_reference(&mut self) -> Result<Sheet, ReadError> {
        let (common, origin, body) = (self.common(), self.tag.origin, SheetBody::Reference(self.required("ref")));
        Ok(Sheet { common, body, parameters: self.param_vertices()?, origin })
    }

    fn string_reference(&mut self) -> Result<MeshString, ReadError> {
        let (common, origin, body) = (self.common(), self.tag.origin, StringBody::Reference(self.required("ref")));
        Ok(MeshString { common, body, parameters: self.param_vertices()?, origin })
    }

    /// The rest of an element in which only parameter vertices may be.
    fn param_vertices(&mut self) -> Result<Vec<ParamVertex>, ReadError> {
        let mut vertices = Vec::new();
        while let Some(element) = self.child()? {
            match element {
                Element::ParamVertex => vertices.extend(self.param_vertex()?),
                _ => self.unknown()?,
            }
        }
        vertices.shrink_to_fit();
        Ok(vertices)
    }

    fn param_vertex(&mut self) -> Result<Option<ParamVertex>, ReadError> {
        let (mid, origin) = (self.optional_id("mid"), self.tag.origin);
        let vertex = self.tag.get("vref").map(VertexRef::from);
        if vertex.is_none() {
            self.missing("vref");
        }
        let gref = self.required_id("gref");
        let dimension = self.positive_of("dim");
        if self.tag.get("dim").is_none() {
            self.missing("dim");
        }
        self.content()?;
        let parameters = dimension.and_then(|dimension| self.parameters(dimension, origin));
        let (Some(vertex), Some(gref), Some(parameters)) = (vertex, gref, parameters) else { return Ok(None) };
        Ok(Some(ParamVertex { mid, vertex, gref, parameters, origin }))
    }

    fn face_run(&mut self) -> Result<Option<FaceRun>, ReadError> {
        let (common, etype) = (self.common(), self.required("etype"));
        let known = FaceShape::from_etype(&etype);
        if known.is_none() && self.tag.get("etype").is_some() {
            self.unknown_type(&etype);
        }
        let width = known.map_or(1, FaceShape::corners);
        let content = self.run_shape(width);
        self.content()?;
        let (Some(shape), Some(content)) = (known, content) else { return Ok(None) };
        let (indices, origin, encoding) = (self.indices(&content), content.origin, content.encoding);
        Ok((!indices.is_empty()).then_some(FaceRun { common, shape, encoding, indices, origin }))
    }

    fn edge_run(&mut self) -> Result<Option<EdgeRun>, ReadError> {
        let (common, etype) = (self.common(), self.required("etype"));
        let known = etype == EdgeRun::ETYPE;
        if !known && self.tag.get("etype").is_some() {
            self.unknown_type(&etype);
        }
        let content = self.run_shape(2);
        self.note_base64(content.as_ref());
        self.content()?;
        let Some(content) = content.filter(|_| known) else { return Ok(None) };
        let (indices, origin, encoding) = (self.indices(&content), content.origin, content.encoding);
        Ok((!indices.is_empty()).then_some(EdgeRun { common, encoding, indices, origin }))
    }

    fn point_run(&mut self) -> Result<Option<PointRun>, ReadError> {
        let common = self.common();
        let content = self.run_shape(1);
        self.note_base64(content.as_ref());
        self.content()?;
        let Some(content) = content else { return Ok(None) };
        let (indices, origin, encoding) = (self.indices(&content), content.origin, content.encoding);
        Ok((!indices.is_empty()).then_some(PointRun { common, encoding, indices, origin }))
    }

    fn entity_run(&mut self, element: &'static str) -> Result<Option<EntityRun>, ReadError> {
        let (common, etype) = (self.common(), self.required("etype"));
        let content = self.run_shape(1);
        self.content()?;
        let Some(content) = content.map(|content| Shape { element, ..content }) else { return Ok(None) };
        let origin = content.origin;
        let references = match content.encoding {
            Encoding::Base64 => self.indices(&content).iter().map(u32::to_string).collect(),
            Encoding::Text => {
                let mut words: Vec<String> = self.string().split_ascii_whitespace().map(str::to_owned).collect();
                let kept = self.check_count(words.len(), 1, &content);
                words.truncate(kept.unwrap_or(0));
                words
            }
        };
        Ok((!references.is_empty()).then_some(EntityRun { common, etype, references, origin }))
    }
}

/// Attributes and checks that several elements share.
impl<R: BufRead> Cursor<R> {
    fn common(&mut self) -> Common {
        Common {
            mid: self.optional_id("mid"),
            name: self.tag.get("name").map(Box::from),
            aref: self.optional_id("aref"),
            gref: self.optional_id("gref"),
        }
    }

    /// `count` and `format` of a run; `None` where the format is unknown.
    fn run_shape(&mut self, width: usize) -> Option<Shape> {
        let (element, origin) = (self.tag.element().name(), self.tag.origin);
        let count = match self.tag.get("count") {
            None => Some(1),
            Some(_) => self.positive_of("count"),
        };
        let encoding = match self.tag.get("format") {
            None | Some("text") => Encoding::Text,
            Some("base64") => Encoding::Base64,
            Some(other) => {
                let other = shorten(other);
                self.findings.push(Code::UnknownFormat, origin, || format!("{element} has format {other:?}"));
                return None;
            }
        };
        Some(Shape { element, count, width, encoding, origin })
    }

    /// A positive number of any size.
    fn positive_of(&mut self, name: &str) -> Option<u64> {
        let text = self.tag.get(name)?;
        let number = positive(text);
        if number.is_none() {
            let element = self.tag.element().name();
            self.findings
                .push(Code::BadAttribute, self.tag.origin, || format!("{name} of {element} is {:?}", shorten(text)));
        }
        number
    }

    fn unknown_type(&mut self, etype: &str) {
        let element = self.tag.element().name();
        self.findings.push(Code::UnknownType, self.tag.origin, || format!("{element} has etype {:?}", shorten(etype)));
    }

    fn note_base64(&mut self, shape: Option<&Shape>) {
        if let Some(Shape { element, encoding: Encoding::Base64, origin, .. }) = shape {
            self.findings.push(Code::UnusualBase64, *origin, || format!("{element} in base64"));
        }
    }

    fn check_order(&mut self, late: bool) {
        if late {
            let origin = self.tag.origin;
            self.findings.push(Code::OutOfOrder, origin, || "ParamVertex after faces or edges".into());
        }
    }

    fn check_mixture(&mut self, first: Element, element: Element, origin: Origin) {
        if first != element {
            let (first, second) = (first.name(), element.name());
            self.findings.push(Code::MixedContents, origin, || format!("{first} and {second} in one element"));
        }
    }

    fn empty(&mut self, origin: Origin, message: &'static str) {
        self.findings.push(Code::EmptyElement, origin, || message.into());
    }
}
