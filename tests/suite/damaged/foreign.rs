//! Meshes of other programs' formats: named, with what to do.

use std::path::{Path, PathBuf};

use super::Place;
use crate::common::sagitta;

#[test]
fn foreign_meshes_are_named_with_a_remedy() {
    let place = Place::new();
    let hdf5: &[u8] = b"\x89HDF\r\n\x1a\n";
    let adf: &[u8] = b"\x01\x02\x03\x04ADF Database Version";
    let foreign: [(&str, &[u8], &str, &str); 17] = [
        ("dollar.bdf", b"$ made by a mesher\nBEGIN BULK\nGRID,1,,0.,0.,0.\n", "Nastran", "gmsh"),
        ("section.bdf", b"$NODES of the wing\nGRID           1              0.      0.      0.\n", "Nastran", "gmsh"),
        ("lower.nas", b"$\ngrid,1,,0.,0.,0.\n", "Nastran", "gmsh"),
        ("comments.bdf", b"$ nothing but comments\n$ for pages\n", "Nastran", "gmsh"),
        ("fluent.msh", b"(0 \"made by\")\n(2 3)\n", "Fluent", "CGNS"),
        ("bare.msh", b"(2 3)\n(10 (0 1 8 0 3))\n", "Fluent", "CGNS"),
        ("a.msh.h5", hdf5, "Fluent", "CGNS"),
        ("points", b"/*---*\\\nFoamFile\n{\n}\n", "OpenFOAM", "the case's folder"),
        ("a.stl", b"solid a\n facet normal 0 0 1\n", "STL", "STEP"),
        ("b.stl", &[0x20; 100], "STL", "STEP"),
        ("a.inp", b"** comment\n*HEADING\n", "Abaqus", "meshio"),
        ("a.unv", b"    -1\n  2411\n", "UNV", "gmsh"),
        ("a.med", hdf5, "MED", "gmsh"),
        ("a.ccm", adf, "CCM", "CGNS"),
        ("a.msh.gz", &[0x1f, 0x8b, 8, 0], "compressed", "unpack"),
        ("a.mesh", b"MFEM NURBS mesh v1.0\n", "MFEM", "SetCurvature"),
        ("a.exo", b"CDF\x01\x00", "Exodus", "meshio"),
    ];
    let files: Vec<(PathBuf, &str, &str)> =
        foreign.iter().map(|&(name, content, kind, remedy)| (place.write(name, content), kind, remedy)).collect();
    for (path, kind, remedy) in files {
        for command in ["info", "check"] {
            let told = sagitta(args![command, path]).expect(2).stderr;
            let name = Path::new(&path).file_name().unwrap().to_str().unwrap();
            assert!([name, kind, remedy].iter().all(|word| told.contains(word)), "{command} {name}: {told}");
        }
    }
}
