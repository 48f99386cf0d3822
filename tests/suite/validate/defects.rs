//! Defects of a linkage file: one change each, and what must be found.

use linkage_schema::Code;

/// One change to the weeble's linkage file and what must be found, each at the first line with its needle.
pub(crate) struct Defect {
    pub(crate) name: &'static str,
    pub(crate) from: &'static str,
    pub(crate) to: &'static str,
    pub(crate) found: &'static [(Code, &'static str)],
}

const fn defect(
    name: &'static str,
    from: &'static str,
    to: &'static str,
    found: &'static [(Code, &'static str)],
) -> Defect {
    Defect { name, from, to, found }
}

/// The first run of faces.
pub(crate) const FIRST_RUN: &str = "<MeshFace etype=\"Tri3\" format=\"text\" count=\"151\">";
const SEAM: &str = "<MeshEdge etype=\"Edge2\" count=\"5\">3 16 16 17 17 18 18 19 19 4<";
const SEAM_STRING: &str = "name=\"edge-5 (seam)\"";

/// What spoils a file in its text alone, or against its mesh and CAD.
pub(crate) const DEFECTS: &[Defect] = &[
    defect(
        "dangling gref",
        "name=\"wall/face-2\" gref=\"2\"",
        "name=\"wall/face-2\" gref=\"404\"",
        &[(Code::DanglingReference, "gref=\"404\"")],
    ),
    defect("dangling aref", "aref=\"4\"", "aref=\"44\"", &[(Code::DanglingReference, "aref=\"44\"")]),
    defect(
        "dangling member",
        "name=\"wall\">2 3 4<",
        "name=\"wall\">2 3 44<",
        &[(Code::DanglingReference, ">2 3 44<")],
    ),
    defect(
        "duplicate gid",
        "gid=\"3\" ref=\"face-3\"",
        "gid=\"2\" ref=\"face-3\"",
        &[
            (Code::DuplicateId, "ref=\"face-3\""),
            (Code::DanglingReference, "<GeometryGroup"),
            (Code::DanglingReference, "name=\"wall/face-3\""),
            (Code::DanglingReference, "gref=\"3\" dim"),
        ],
    ),
    defect(
        "duplicate attid",
        "attid=\"3\"",
        "attid=\"2\"",
        &[(Code::DuplicateId, "name=\"model size\""), (Code::DanglingReference, "<AttributeGroup")],
    ),
    defect(
        "group where an entity is needed",
        "vref=\"207\" gref=\"2\"",
        "vref=\"207\" gref=\"21\"",
        &[(Code::GroupAsEntity, "vref=\"207\"")],
    ),
    defect(
        "nested group",
        "<GeometryGroup gid=\"21\" name=\"wall\">2 3 4</GeometryGroup>",
        "<GeometryGroup gid=\"21\" name=\"wall\">2 3 4</GeometryGroup>\n<GeometryGroup gid=\"22\">21</GeometryGroup>",
        &[(Code::NestedGroup, "gid=\"22\"")],
    ),
    defect(
        "count too large",
        "count=\"151\"",
        "count=\"152\"",
        &[
            (Code::CountTooLarge, "count=\"152\""),
            (Code::StrayVertex, "vref=\"207\""),
            (Code::StringWithoutSheet, SEAM_STRING),
        ],
    ),
    defect(
        "count of 1e9",
        "count=\"57\"",
        "count=\"1000000000\"",
        &[
            (Code::CountTooLarge, "count=\"1000000000\""),
            (Code::StrayVertex, "vref=\"326\""),
            (Code::StringWithoutSheet, "name=\"edge-9 (seam)\""),
        ],
    ),
    defect(
        "count too small",
        SEAM,
        "<MeshEdge etype=\"Edge2\" count=\"4\">3 16 16 17 17 18 18 19 19 4<",
        &[(Code::ExtraContent, "count=\"4\">3 16")],
    ),
    defect(
        "index 0",
        ">3 16 16 17",
        ">3 16 0 17",
        &[(Code::BadIndex, ">3 16 0 17"), (Code::BrokenString, SEAM_STRING)],
    ),
    defect(
        "index beyond the mesh",
        ">3 16 16 17 17 18 18 19 19 4<",
        ">3 16 16 17 17 18 18 19 19 400000<",
        &[(Code::IndexBeyondMesh, "400000")],
    ),
    defect(
        "not a number",
        ">3 16 16 17",
        ">3 16 16 x",
        &[(Code::BadIndex, "16 x"), (Code::StrayVertex, "vref=\"16\" gref=\"9\"")],
    ),
    defect(
        "unknown etype",
        FIRST_RUN,
        "<MeshFace etype=\"Tri6\" count=\"151\">",
        &[(Code::UnknownType, "Tri6"), (Code::StrayVertex, "vref=\"207\""), (Code::StringWithoutSheet, SEAM_STRING)],
    ),
    defect(
        "unknown format",
        FIRST_RUN,
        "<MeshFace etype=\"Tri3\" format=\"lzw\" count=\"151\">",
        &[(Code::UnknownFormat, "lzw"), (Code::StrayVertex, "vref=\"207\""), (Code::StringWithoutSheet, SEAM_STRING)],
    ),
    defect(
        "broken base64",
        FIRST_RUN,
        "<MeshFace etype=\"Tri3\" format=\"base64\" count=\"151\">",
        &[(Code::BadBase64, "base64"), (Code::StrayVertex, "vref=\"207\""), (Code::StringWithoutSheet, SEAM_STRING)],
    ),
    defect(
        "string with a gap",
        ">3 16 16 17 17 18",
        ">3 16 17 17 17 18",
        &[
            (Code::DegenerateCell, "16 17 17 17"),
            (Code::EdgeNotInMesh, "16 17 17 17"),
            (Code::BrokenString, SEAM_STRING),
        ],
    ),
    defect(
        "string that lacks an edge",
        SEAM,
        "<MeshEdge etype=\"Edge2\" count=\"4\">3 16 17 18 18 19 19 4<",
        &[(Code::BrokenString, SEAM_STRING)],
    ),
    defect(
        "edge that is none",
        ">3 16 16 17 17 18",
        ">3 16 16 18 18 17 17 18",
        &[(Code::ExtraContent, "16 16 18"), (Code::EdgeNotInMesh, "16 16 18"), (Code::BrokenString, SEAM_STRING)],
    ),
    defect("missing attribute", "name=\"wall/face-2\" gref=\"2\"", "name=\"wall/face-2\"", &[]),
    defect(
        "missing gid",
        "<GeometryReference gid=\"9\" ref",
        "<GeometryReference ref",
        &[
            (Code::MissingAttribute, "ref=\"edge-5\""),
            (Code::DanglingReference, SEAM_STRING),
            (Code::DanglingReference, "gref=\"9\" dim"),
        ],
    ),
    defect(
        "missing vref",
        "<ParamVertex vref=\"207\"",
        "<ParamVertex",
        &[(Code::MissingAttribute, "<ParamVertex gref")],
    ),
    defect("reference to nothing", "ref=\"face-2\"", "ref=\"face-22\"", &[(Code::UnknownReference, "face-22")]),
    defect("not a reference", "ref=\"face-2\"", "ref=\"quilt 2\"", &[(Code::UnknownReference, "quilt 2")]),
    defect(
        "sheet on an edge",
        "name=\"wall/face-2\" gref=\"2\"",
        "name=\"wall/face-2\" gref=\"10\"",
        &[(Code::WrongKind, "count=\"151\""), (Code::OffGeometry, "count=\"151\"")],
    ),
    defect(
        "string on a vertex",
        "name=\"edge-6\" gref=\"10\"",
        "name=\"edge-6\" gref=\"18\"",
        &[(Code::WrongKind, "count=\"19\""), (Code::OffGeometry, "count=\"19\"")],
    ),
    defect(
        "sheet on another face",
        "name=\"wall/face-2\" gref=\"2\"",
        "name=\"wall/face-2\" gref=\"3\"",
        &[(Code::OffGeometry, "count=\"151\"")],
    ),
    defect(
        "string on another edge",
        "name=\"edge-6\" gref=\"10\"",
        "name=\"edge-6\" gref=\"12\"",
        &[(Code::OffGeometry, "count=\"19\"")],
    ),
    defect(
        "point at another vertex",
        "<MeshPointReference gref=\"18\" count=\"1\">4<",
        "<MeshPointReference gref=\"17\" count=\"1\">4<",
        &[(Code::OffGeometry, "gref=\"17\" count=\"1\">4<")],
    ),
    defect(
        "parameters of another place",
        "vref=\"208\" gref=\"2\" dim=\"2\">2.8525",
        "vref=\"208\" gref=\"2\" dim=\"2\">1.8525",
        &[(Code::WrongParameters, "vref=\"208\"")],
    ),
    defect(
        "entity bomb",
        "<MeshFile filename=\"weeble.msh\"",
        "<MeshFile filename=\"&lol9;\"",
        &[(Code::Unreadable, "&lol9;")],
    ),
    defect(
        "another mesh file",
        "filename=\"weeble.msh\"",
        "filename=\"C:\\meshes\\other.msh\"",
        &[(Code::OtherMeshFile, "other.msh")],
    ),
    defect(
        "another CAD file",
        "filename=\"weeble.step\"",
        "filename=\"other.step\"",
        &[(Code::OtherCadFile, "other.step")],
    ),
    defect(
        "geometry that cannot be read",
        "filename=\"weeble.step\"",
        "filename=\"weeble.nmb\"",
        &[(Code::UnreadableGeometry, "weeble.nmb")],
    ),
    defect(
        "wrong namespace",
        "xmlns=\"https://cadence.com\"",
        "xmlns=\"http://www.pointwise.com\"",
        &[(Code::ForeignNamespace, "<MeshLink")],
    ),
];
