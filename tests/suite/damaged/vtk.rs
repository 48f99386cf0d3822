//! Legacy VTK: counts and sections; the hexahedron of 27 nodes in all versions of both formats.

use glam::DVec3;
use sagitta::element::{Cell, Order};
use sagitta::mesh::Mesh;

use super::{Place, text, with};

#[test]
fn legacy_vtk_counts_are_compared() {
    let place = Place::new();
    let (old, new) = (text("cylprism_p1.vtk"), text("hexpyrtet_p1_legacy51_ascii.vtk"));
    let line = |text: &str, word: &str| text.lines().find(|line| line.starts_with(word)).unwrap().to_owned();
    for (whole, word, needle) in [
        (&old, "CELLS ", "cells (CELLS)"),
        (&old, "CELL_DATA ", "cells (CELL_DATA)"),
        (&old, "CELL_TYPES ", "line"),
        (&old, "POINTS ", "line"),
        (&new, "CELLS ", "line"),
        (&new, "CELL_DATA ", "cells (CELL_DATA)"),
    ] {
        let row = line(whole, word);
        let words: Vec<&str> = row.split(' ').collect();
        let fewer = words[1].parse::<u64>().unwrap() - 1;
        let spoilt = with(whole, &row, &format!("{} {fewer} {}", words[0], words[2..].join(" ")));
        place.refuses("counts.vtk", spoilt, &[needle]);
    }
    let twice =
        format!("{old}\n{}\n1 2 3\n", with(&line(&old, "POINTS "), " ", " 1 double x").split(" x").next().unwrap());
    place.refuses("twice.vtk", twice, &["POINTS occurs twice"]);
    let row = line(&old, "SCALARS ");
    place.refuses("scalars.vtk", with(&old, &row, &format!("{row} 1 1 1")), &["line", "a keyword"]);
    place.refuses("table.vtk", with(&old, "LOOKUP_TABLE", "LOOKUP_TABLETABLE"), &["line", "expected LOOKUP_TABLE"]);
    // Metadata without end take no stack.
    let meta = format!("{old}\nFIELD f 1\n{}", "METADATA\n\n".repeat(200_000));
    place.refuses("meta.vtk", meta, &["ends inside a field's array"]);
}

/// A file that was cut off between sections is none.
#[test]
fn sections_of_legacy_vtk_that_are_missing_are_named() {
    let place = Place::new();
    let vtk = text("hexpyrtet_p1.vtk");
    place.refuses("version.vtk", with(&vtk, "Version 2.0", "Ver"), &["line 1", "Version"]);
    let missing = |section: &str| format!("the section {section} is missing");
    place.refuses("head.vtk", &vtk[..vtk.find("POINTS").unwrap()], &["line", &missing("POINTS")]);
    place.refuses("points.vtk", &vtk[..vtk.find("CELLS").unwrap()], &["line", &missing("CELLS")]);
    place.refuses("types.vtk", &vtk[..vtk.find("CELL_TYPES").unwrap()], &["line", &missing("CELL_TYPES")]);
}

/// The lattice points of VTK's hexahedron of 27 nodes (`vtkTriQuadraticHexahedron`), which is the same in files of all versions.
const HEX27: [[u8; 3]; 27] = [
    [0, 0, 0],
    [2, 0, 0],
    [2, 2, 0],
    [0, 2, 0],
    [0, 0, 2],
    [2, 0, 2],
    [2, 2, 2],
    [0, 2, 2], // corners
    [1, 0, 0],
    [2, 1, 0],
    [1, 2, 0],
    [0, 1, 0],
    [1, 0, 2],
    [2, 1, 2],
    [1, 2, 2],
    [0, 1, 2], // edges below and above
    [0, 0, 1],
    [2, 0, 1],
    [2, 2, 1],
    [0, 2, 1], // upright edges
    [0, 1, 1],
    [2, 1, 1],
    [1, 0, 1],
    [1, 2, 1],
    [1, 1, 0],
    [1, 1, 2],
    [1, 1, 1], // faces, centre
];

#[test]
fn the_hexahedron_of_27_nodes_has_one_order_in_all_versions() {
    let place = Place::new();
    let points: Vec<String> = HEX27.iter().map(|x| x.map(|x| x.to_string()).join(" ")).collect();
    let nodes: Vec<String> = (0..27).map(|n| n.to_string()).collect();
    for version in ["2.0", "4.2", "5.1"] {
        let cells = match version {
            "5.1" => {
                format!("CELLS 2 27\nOFFSETS vtktypeint64\n0 27\nCONNECTIVITY vtktypeint64\n{}\n", nodes.join(" "))
            }
            _ => format!("CELLS 1 28\n27 {}\n", nodes.join(" ")),
        };
        let file = format!(
            "# vtk DataFile Version {version}\nhex\nASCII\nDATASET UNSTRUCTURED_GRID\nPOINTS 27 double\n{}\n{cells}CELL_TYPES 1\n29\n",
            points.join("\n")
        );
        check_hex(&place.read("hex.vtk", file).unwrap(), version);
    }
    for version in ["0.1", "2.2"] {
        let array = |kind: &str, name: &str, values: String| {
            format!(
                "<DataArray type=\"{kind}\" Name=\"{name}\" NumberOfComponents=\"3\" format=\"ascii\">{values}</DataArray>"
            )
        };
        let file = format!(
            "<VTKFile type=\"UnstructuredGrid\" version=\"{version}\"><UnstructuredGrid><Piece NumberOfPoints=\"27\" NumberOfCells=\"1\">\
             <Points>{}</Points><Cells>{}{}{}</Cells></Piece></UnstructuredGrid></VTKFile>",
            array("Float64", "Points", points.join(" ")),
            array("Int64", "connectivity", nodes.join(" ")),
            array("Int64", "offsets", "27".into()),
            array("UInt8", "types", "29".into()),
        );
        check_hex(&place.read("hex.vtu", file).unwrap(), version);
    }
}

/// Every node of the hex must lie where its lattice has it.
fn check_hex(mesh: &Mesh, version: &str) {
    let hex = mesh.elements_of(Cell::Hex).iter().next().unwrap();
    let lattice = sagitta::element::lattice(Cell::Hex, Order::new(2).unwrap());
    for (node, at) in hex.nodes.iter().zip(lattice) {
        assert_eq!(mesh.points()[node.index()], DVec3::from(at.map(f64::from)), "version {version}");
    }
}
