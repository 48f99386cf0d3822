//! Writing: a document as text that reads back to an equal document.

use std::fmt::Display;
use std::fs::File;
use std::io::{BufWriter, Write};
use std::path::Path;

use base64::Engine;
use base64::engine::general_purpose::STANDARD;

use crate::{Common, Document, Encoding, EntityRun, FaceRun, GeometryFile, MeshFile, MeshModel, MeshString, NAMESPACE};
use crate::{EdgeRun, ParamVertex, Parameters, PointRun, Sheet, SheetBody, StringBody, WriteError};

/// Writes a document to a file. A file that could not be written whole is left as far as it got.
pub fn write_path(document: &Document, path: &Path) -> Result<(), WriteError> {
    let file = File::create(path).map_err(|source| WriteError::Create { file: path.to_owned(), source })?;
    let mut stream = BufWriter::with_capacity(256 * 1024, file);
    write(document, &mut stream)?;
    stream.flush()?;
    Ok(())
}

/// Writes a document.
pub fn write(document: &Document, stream: impl Write) -> Result<(), WriteError> {
    let mut out = Writer { stream };
    out.document(document)
}

struct Writer<W> {
    stream: W,
}

type Done = Result<(), WriteError>;

impl<W: Write> Writer<W> {
    fn document(&mut self, document: &Document) -> Done {
        self.raw("<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n<MeshLink")?;
        self.attribute("version", &document.version)?;
        self.attribute("xmlns", NAMESPACE)?;
        self.raw(">\n")?;
        for attribute in &document.attributes {
            self.open(1, "Attribute")?;
            self.attribute("attid", attribute.id)?;
            self.optional("name", attribute.name.as_deref())?;
            self.text_element("Attribute", &attribute.value)?;
        }
        for group in &document.attribute_groups {
            self.open(1, "AttributeGroup")?;
            self.attribute("attid", group.id)?;
            self.optional("name", group.name.as_deref())?;
            self.list_element("AttributeGroup", &group.members)?;
        }
        for file in &document.geometry_files {
            self.geometry_file(file)?;
        }
        for group in &document.geometry_groups {
            self.open(1, "GeometryGroup")?;
            self.attribute("gid", group.id)?;
            self.optional("aref", group.aref)?;
            self.optional("name", group.name.as_deref())?;
            self.list_element("GeometryGroup", &group.members)?;
        }
        for file in &document.mesh_files {
            self.mesh_file(file)?;
        }
        self.transforms(document)?;
        self.raw("</MeshLink>\n")
    }

    fn transforms(&mut self, document: &Document) -> Done {
        for transform in &document.transforms {
            self.open(1, "Transform")?;
            self.attribute("xid", transform.id)?;
            self.optional("aref", transform.aref)?;
            self.optional("name", transform.name.as_deref())?;
            self.text_element("Transform", &transform.content)?;
        }
        for linkage in &document.linkages {
            self.open(1, "MeshElementLinkage")?;
            self.attribute("sourceEntityRef", &linkage.source)?;
            self.attribute("targetEntityRef", &linkage.target)?;
            self.optional("xref", linkage.transform)?;
            self.optional("aref", linkage.aref)?;
            self.optional("name", linkage.name.as_deref())?;
            self.raw("/>\n")?;
        }
        Ok(())
    }

    fn geometry_file(&mut self, file: &GeometryFile) -> Done {
        self.open(1, "GeometryFile")?;
        self.attribute("filename", &file.filename)?;
        self.optional("aref", file.aref)?;
        self.raw(">\n")?;
        for reference in &file.references {
            self.open(2, "GeometryReference")?;
            self.attribute("gid", reference.id)?;
            self.attribute("ref", &reference.reference)?;
            self.optional("aref", reference.aref)?;
            self.optional("name", reference.name.as_deref())?;
            self.raw("/>\n")?;
        }
        self.close(1, "GeometryFile")
    }

    fn mesh_file(&mut self, file: &MeshFile) -> Done {
        self.open(1, "MeshFile")?;
        self.attribute("filename", &file.filename)?;
        self.optional("aref", file.aref)?;
        self.raw(">\n")?;
        for model in &file.models {
            self.model(model)?;
        }
        self.close(1, "MeshFile")
    }

    fn model(&mut self, model: &MeshModel) -> Done {
        self.open(2, "MeshModelReference")?;
        self.attribute("ref", &model.reference)?;
        self.common(&model.common)?;
        self.raw(">\n")?;
        self.vertices(3, &model.parameters)?;
        for run in &model.points {
            self.points(run)?;
        }
        for sheet in &model.sheets {
            self.sheet(sheet)?;
        }
        for string in &model.strings {
            self.mesh_string(string)?;
        }
        self.close(2, "MeshModelReference")
    }

    fn sheet(&mut self, sheet: &Sheet) -> Done {
        let name = match &sheet.body {
            SheetBody::Reference(_) => "MeshSheetReference",
            _ => "MeshSheet",
        };
        self.open(3, name)?;
        if let SheetBody::Reference(reference) = &sheet.body {
            self.attribute("ref", reference)?;
        }
        self.common(&sheet.common)?;
        self.raw(">\n")?;
        self.vertices(4, &sheet.parameters)?;
        match &sheet.body {
            SheetBody::Faces(runs) => runs.iter().try_for_each(|run| self.faces(run))?,
            SheetBody::FaceReferences(runs) => self.entities("MeshFaceReference", runs)?,
            SheetBody::Reference(_) => {}
        }
        self.close(3, name)
    }

    fn mesh_string(&mut self, string: &MeshString) -> Done {
        let name = match &string.body {
            StringBody::Reference(_) => "MeshStringReference",
            _ => "MeshString",
        };
        self.open(3, name)?;
        if let StringBody::Reference(reference) = &string.body {
            self.attribute("ref", reference)?;
        }
        self.common(&string.common)?;
        self.raw(">\n")?;
        self.vertices(4, &string.parameters)?;
        match &string.body {
            StringBody::Edges(runs) => runs.iter().try_for_each(|run| self.edges(run))?,
            StringBody::EdgeReferences(runs) => self.entities("MeshEdgeReference", runs)?,
            StringBody::Reference(_) => {}
        }
        self.close(3, name)
    }

    fn faces(&mut self, run: &FaceRun) -> Done {
        self.open(4, "MeshFace")?;
        self.common(&run.common)?;
        self.attribute("etype", run.shape.etype())?;
        self.indices("MeshFace", 4, &run.indices, run.shape.corners(), run.encoding)
    }

    fn edges(&mut self, run: &EdgeRun) -> Done {
        self.open(4, "MeshEdge")?;
        self.common(&run.common)?;
        self.attribute("etype", EdgeRun::ETYPE)?;
        self.indices("MeshEdge", 4, &run.indices, 2, run.encoding)
    }

    fn points(&mut self, run: &PointRun) -> Done {
        self.open(3, "MeshPointReference")?;
        self.common(&run.common)?;
        self.indices("MeshPointReference", 3, &run.indices, 1, run.encoding)
    }

    fn entities(&mut self, name: &'static str, runs: &[EntityRun]) -> Done {
        if runs.is_empty() {
            return Err(unwritable(name, "there is none in its container"));
        }
        for run in runs {
            let word = |word: &String| !word.is_empty() && !word.contains(|c: char| c.is_ascii_whitespace());
            if run.references.is_empty() || !run.references.iter().all(word) {
                return Err(unwritable(name, "it needs references without blanks in them"));
            }
            self.open(4, name)?;
            self.common(&run.common)?;
            self.attribute("etype", &run.etype)?;
            self.attribute("count", run.references.len())?;
            self.list_element(name, &run.references)?;
        }
        Ok(())
    }

    fn indices(&mut self, name: &'static str, depth: usize, indices: &[u32], width: usize, encoding: Encoding) -> Done {
        if indices.is_empty() || !indices.len().is_multiple_of(width) || indices.contains(&0) {
            return Err(unwritable(name, "it needs whole cells of indices from 1"));
        }
        self.attribute("count", indices.len() / width)?;
        match encoding {
            Encoding::Text => {
                self.raw(">\n")?;
                for cell in indices.chunks(width) {
                    self.indent(depth)?;
                    for index in cell {
                        write!(self.stream, " {index}")?;
                    }
                    self.raw("\n")?;
                }
                self.close(depth, name)
            }
            Encoding::Base64 => {
                if indices.iter().any(|&index| i32::try_from(index).is_err()) {
                    return Err(unwritable(name, "an index is too large for base64"));
                }
                self.attribute("format", "base64")?;
                self.raw(">")?;
                // Three integers make sixteen characters: pieces of whole triples join without padding.
                for piece in indices.chunks(3 * 1024) {
                    let bytes: Vec<u8> = piece.iter().flat_map(|index| index.to_le_bytes()).collect();
                    self.raw(&STANDARD.encode(bytes))?;
                }
                writeln!(self.stream, "</{name}>")?;
                Ok(())
            }
        }
    }

    fn vertices(&mut self, depth: usize, vertices: &[ParamVertex]) -> Done {
        for vertex in vertices {
            self.open(depth, "ParamVertex")?;
            self.optional("mid", vertex.mid)?;
            self.attribute("vref", &vertex.vertex)?;
            self.attribute("gref", vertex.gref)?;
            let (dimension, first, second) = match vertex.parameters {
                Parameters::Curve(t) => (1, t, None),
                Parameters::Surface(u, v) => (2, u, Some(v)),
            };
            if !first.is_finite() || second.is_some_and(|v| !v.is_finite()) {
                return Err(unwritable("ParamVertex", "a parameter is not a finite number"));
            }
            self.attribute("dim", dimension)?;
            write!(self.stream, ">{first:?}")?;
            if let Some(second) = second {
                write!(self.stream, " {second:?}")?;
            }
            self.raw("</ParamVertex>\n")?;
        }
        Ok(())
    }

    fn common(&mut self, common: &Common) -> Done {
        self.optional("mid", common.mid)?;
        self.optional("name", common.name.as_deref())?;
        self.optional("aref", common.aref)?;
        self.optional("gref", common.gref)
    }
}

/// XML itself.
impl<W: Write> Writer<W> {
    fn raw(&mut self, text: &str) -> Done {
        Ok(self.stream.write_all(text.as_bytes())?)
    }

    fn indent(&mut self, depth: usize) -> Done {
        (0..depth).try_for_each(|_| self.raw("  "))
    }

    fn open(&mut self, depth: usize, name: &str) -> Done {
        self.indent(depth)?;
        Ok(write!(self.stream, "<{name}")?)
    }

    fn close(&mut self, depth: usize, name: &str) -> Done {
        self.indent(depth)?;
        Ok(writeln!(self.stream, "</{name}>")?)
    }

    fn optional(&mut self, name: &str, value: Option<impl Display>) -> Done {
        value.map_or(Ok(()), |value| self.attribute(name, value))
    }

    fn attribute(&mut self, name: &str, value: impl Display) -> Done {
        let value = value.to_string();
        write!(self.stream, " {name}=\"")?;
        self.escaped(name, &value, true)?;
        self.raw("\"")
    }

    fn text_element(&mut self, name: &str, text: &str) -> Done {
        self.raw(">")?;
        self.escaped(name, text, false)?;
        Ok(writeln!(self.stream, "</{name}>")?)
    }

    fn list_element<T: Display>(&mut self, name: &str, items: &[T]) -> Done {
        let text: Vec<String> = items.iter().map(T::to_string).collect();
        self.text_element(name, &text.join(" "))
    }

    /// Readers replace line ends and, in attributes, all blanks; so those are written as character references.
    fn escaped(&mut self, what: &str, text: &str, attribute: bool) -> Done {
        let special = |c: char| c < ' ' || matches!(c, '&' | '<' | '>' | '"' | '\u{fffe}' | '\u{ffff}');
        let mut rest = text;
        while let Some(at) = rest.find(special) {
            let (plain, tail) = rest.split_at(at);
            self.raw(plain)?;
            let mut characters = tail.chars();
            match characters.next() {
                Some('&') => self.raw("&amp;")?,
                Some('<') => self.raw("&lt;")?,
                Some('>') => self.raw("&gt;")?,
                Some('"') => self.raw("&quot;")?,
                Some(blank @ ('\t' | '\n')) if !attribute => write!(self.stream, "{blank}")?,
                Some(blank @ ('\t' | '\n' | '\r')) => write!(self.stream, "&#{};", u32::from(blank))?,
                Some(other) => return Err(unwritable(what, &format!("XML has no character {other:?}"))),
                None => {}
            }
            rest = characters.as_str();
        }
        self.raw(rest)
    }
}

fn unwritable(what: &str, why: &str) -> WriteError {
    WriteError::Unwritable { what: what.to_owned(), why: why.to_owned() }
}
