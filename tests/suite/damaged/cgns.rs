//! CGNS: counts of zones and sections; which base is the mesh.

use sagitta::formats;
use sagitta::mesh::Mesh;

use super::{Place, sample};

/// A copy of a CGNS sample, changed.
fn cgns(place: &Place, name: &str, change: impl FnOnce(&hdf5_metno::File)) -> Result<Mesh, String> {
    let path = place.0.path().join(name);
    std::fs::copy(sample("hexpyrtet_p1.cgns"), &path).unwrap();
    let file = hdf5_metno::File::open_rw(&path).unwrap();
    change(&file);
    file.close().unwrap();
    formats::read(&path).map_err(|error| error.to_string())
}

/// Paths of a file's groups of a depth.
fn groups(file: &hdf5_metno::File, depth: usize) -> Vec<String> {
    let mut paths = vec![String::new()];
    for _ in 0..depth {
        paths = paths
            .into_iter()
            .flat_map(|path| {
                let own = if path.is_empty() { "/" } else { &path };
                let names = file.group(own).unwrap().member_names().unwrap();
                names
                    .into_iter()
                    .filter(|name| !name.starts_with(' '))
                    .map(move |name| format!("{path}/{name}"))
                    .collect::<Vec<_>>()
            })
            .filter(|path| file.group(path).is_ok())
            .collect();
    }
    paths
}

fn zone(file: &hdf5_metno::File) -> String {
    groups(file, 2).into_iter().find(|path| file.group(&format!("{path}/ZoneType")).is_ok()).unwrap()
}

#[test]
fn cgns_counts_are_compared() {
    let place = Place::new();
    cgns(&place, "whole.cgns", |_| ()).unwrap();
    let told = cgns(&place, "cells.cgns", |file| {
        let counts = file.dataset(&format!("{}/ data", zone(file))).unwrap();
        let mut values = counts.read_raw::<i64>().unwrap();
        values[1] += 1;
        counts.write_raw(&values).unwrap();
    })
    .unwrap_err();
    assert!(
        told.contains("cells.cgns, node /") && told.contains("the zone counts 123 cells, and its sections have 122"),
        "{told}"
    );
    // A base of surfaces that comes first is not the mesh.
    let mesh = cgns(&place, "bases.cgns", |file| {
        let base = groups(file, 1).into_iter().find(|path| zone(file).starts_with(&format!("{path}/"))).unwrap();
        let other = file.create_group("0surface").unwrap();
        for name in ["label", "name", "type"] {
            let text: hdf5_metno::types::FixedAscii<33> = file
                .group(&base)
                .unwrap()
                .attr(name)
                .unwrap()
                .read_scalar::<hdf5_metno::types::FixedAscii<33>>()
                .unwrap();
            other.new_attr::<hdf5_metno::types::FixedAscii<33>>().create(name).unwrap().write_scalar(&text).unwrap();
        }
        other.new_dataset::<i32>().shape([2]).create(" data").unwrap().write_raw(&[2, 3]).unwrap();
        file.link_hard(&zone(file), "/0surface/zone").unwrap();
    })
    .unwrap();
    assert_eq!(mesh.cells().len(), 122);
    assert!(mesh.notes().iter().any(|note| note.contains("2 bases")), "{:?}", mesh.notes());
}

/// A coordinate that is not found is not zero.
#[test]
fn a_coordinate_that_cgns_lacks_is_missed() {
    let place = Place::new();
    for (lost, name) in [("CoordinateZ", "CoordinateZ"), ("CoordinateX", "CoordinateR")] {
        let told = cgns(&place, "lost.cgns", |file| {
            let coordinates = file.group(&format!("{}/GridCoordinates", zone(file))).unwrap();
            coordinates.unlink(lost).unwrap();
            if name != lost {
                coordinates.link_hard("CoordinateY", name).unwrap();
            }
        })
        .unwrap_err();
        let needle = format!("GridCoordinates: no coordinate {lost} among");
        assert!(told.contains("lost.cgns, node /") && told.contains(&needle) && told.contains("Cartesian"), "{told}");
    }
}
