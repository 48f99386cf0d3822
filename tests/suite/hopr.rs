//! HOPR's HDF5, written and read again.

use std::collections::BTreeMap;

use crate::common::sample::{curved, sample};
use hdf5_metno::File;
use sagitta::element::Cell;
use sagitta::formats::{self, WriteOptions};
use sagitta::mesh::Mesh;

/// Cells, and sides by name, as the bits of their nodes in their order.
fn content(mesh: &Mesh) -> BTreeMap<(Cell, String), Vec<Vec<[u64; 3]>>> {
    let mut found: BTreeMap<_, Vec<_>> = BTreeMap::new();
    for block in mesh.blocks().iter().filter(|block| block.cell.dimension() >= 2) {
        let is_side = block.cell.dimension() == 2;
        let name = if is_side { mesh.names_of(block.entity).join(",") } else { String::new() };
        for nodes in block.elements(mesh.order()) {
            let mut points: Vec<_> = mesh.points_of(nodes).map(|x| x.to_array().map(f64::to_bits)).collect();
            if is_side {
                points.sort_unstable(); // a side begins where its cell's does
            }
            found.entry((block.cell, name.clone())).or_default().push(points);
        }
    }
    found.iter_mut().filter(|((cell, _), _)| cell.dimension() == 2).for_each(|(_, own)| own.sort_unstable());
    found
}

#[test]
fn meshes_come_back_bit_for_bit() {
    let folder = tempfile::tempdir().unwrap();
    for p in 1..=4 {
        for name in ["hexpyrtet_p1_msh41b.msh", "cylprism_p1_msh41b.msh"] {
            let (mesh, path) = (curved(name, p), folder.path().join("mesh.h5"));
            formats::write(&path, &mesh, &WriteOptions::default()).unwrap();
            let again = formats::read(&path).unwrap();
            assert_eq!(content(&again), content(&mesh), "{name} P{p}");
            assert_eq!(again.points().len(), mesh.points().len(), "{name} P{p}");
            let second = folder.path().join("second.h5");
            formats::write(&second, &again, &WriteOptions::default()).unwrap();
            assert_eq!(content(&formats::read(&second).unwrap()), content(&again), "{name} P{p}");
        }
    }
}

#[test]
fn periodic_sides_keep_their_names() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("mesh.h5");
    let mesh = sample("periodic_tet_p1_msh41b.msh");
    formats::write(&path, &mesh, &WriteOptions::default()).unwrap();
    let again = formats::read(&path).unwrap();
    assert_eq!(again.sides().len(), mesh.sides().len());
    assert!(again.notes().iter().any(|note| note.contains("periodic sides")), "{:?}", again.notes());
}

#[test]
fn damage_is_refused() {
    let folder = tempfile::tempdir().unwrap();
    let whole = folder.path().join("whole.h5");
    formats::write(&whole, &sample("cylprism_p2_msh41b.msh"), &WriteOptions::default()).unwrap();
    let spoilt = |name: &str, spoil: &dyn Fn(&File)| {
        let path = folder.path().join(name);
        std::fs::copy(&whole, &path).unwrap();
        spoil(&File::open_rw(&path).unwrap());
        formats::read(&path).unwrap_err().to_string()
    };
    let set = |table: &'static str, place: usize, value: i32| {
        move |file: &File| {
            let set = file.dataset(table).unwrap();
            let mut values = set.read_raw::<i32>().unwrap();
            values[place] = value;
            set.write_raw(&values).unwrap();
        }
    };
    let told = spoilt("order.h5", &|file| file.group("/").unwrap().attr("Ngeo").unwrap().write_raw(&[9]).unwrap());
    assert!(told.contains("Ngeo is 9"), "{told}");
    let told = spoilt("kind.h5", &set("ElemInfo", 0, 207));
    assert!(told.contains("element 1 is of type 207"), "{told}");
    let told = spoilt("nodes.h5", &set("ElemInfo", 5, 900_000));
    assert!(told.contains("element 1 has the nodes 0 to 900000"), "{told}");
    let told = spoilt("sides.h5", &set("ElemInfo", 3, -1));
    assert!(told.contains("element 1 has the sides 0 to -1"), "{told}");
    let told = spoilt("condition.h5", &set("SideInfo", 4, 77));
    assert!(told.contains("a side of element 1 has condition 77, and there are"), "{told}");
    let told = spoilt("apart.h5", &set("GlobalNodeIDs", 0, 2));
    assert!(told.contains("is at two places"), "{told}");
    let told = spoilt("missing.h5", &|file| file.unlink("SideInfo").unwrap());
    assert!(told.contains("SideInfo"), "{told}");
    let bytes = std::fs::read(&whole).unwrap();
    for part in 1..20 {
        let path = folder.path().join("cut.h5");
        std::fs::write(&path, &bytes[..bytes.len() * part / 20]).unwrap();
        assert!(formats::read(&path).is_err());
    }
}
