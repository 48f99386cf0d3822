//! `--curve-layers N`: elements beyond N layers off the curved walls keep their straight places, and are told of.

use std::path::Path;

use crate::common::{fixture, json, sagitta};
use glam::DVec3;
use sagitta::certify::{self, Settings};
use sagitta::element::Order;
use sagitta::formats;
use sagitta::mesh::Mesh;
use sagitta::mesh::elevate::elevate;

struct Curved {
    mesh: Mesh,
    /// Elements that the report says are straight.
    told: u64,
    /// 3 where walls were given up.
    code: i32,
}

/// The wing at P2 with so many layers.
fn curved(folder: &Path, layers: &str) -> Curved {
    let [out, report] = [folder.join("wing.msh"), folder.join("wing.json")];
    let [linear, cad] = ["msh", "step"].map(|extension| fixture("wing_sharp", extension));
    let outputs = args!["-o", out, "--report", report];
    let options = args!["curve", linear, "--cad", cad, "--order", "2", "--quiet", "--curve-layers", layers];
    let done = sagitta(options.iter().chain(&outputs));
    let code = done.code.unwrap();
    assert!([0, 3].contains(&code), "{layers} layers: {}", done.stdout);
    let report = json(&report);
    let told = report["cells"].as_array().unwrap().iter().map(|cell| cell["straight"].as_u64().unwrap()).sum();
    Curved { mesh: formats::read(&out).unwrap(), told, code }
}

/// Straight places, by the tags of the nodes.
fn straight_places() -> Vec<DVec3> {
    let elevated =
        elevate(&formats::read(&fixture("wing_sharp", "msh")).unwrap(), Order::new(2).unwrap()).unwrap().mesh;
    let mut places = vec![DVec3::NAN; 1 + *elevated.node_tags().iter().max().unwrap() as usize];
    for (tag, point) in elevated.node_tags().iter().zip(elevated.points()) {
        places[*tag as usize] = *point;
    }
    places
}

/// Which nodes of every volume element are off their straight places, corners first.
fn bent(mesh: &Mesh, straight: &[DVec3]) -> Vec<bool> {
    let off = |n: usize| mesh.points()[n] != straight[mesh.node_tags()[n] as usize];
    let elements = mesh.cell_blocks().flat_map(|block| block.elements(mesh.order()));
    elements.map(|nodes| nodes.iter().any(|n| off(n.index()))).collect()
}

/// The layer of every volume element, 1 at the wall, counted by common nodes.
fn layers(mesh: &Mesh, straight: &[DVec3]) -> Vec<usize> {
    let mut reached = vec![false; mesh.points().len()];
    let curved = |names: &[String]| names.iter().any(|name| ["wall", "farfield"].contains(&name.as_str()));
    for block in mesh.side_blocks().filter(|block| curved(&mesh.names_of(block.entity))) {
        let off = |n: usize| mesh.points()[n].distance(straight[mesh.node_tags()[n] as usize]) > 1e-6;
        for face in block.elements(mesh.order()).filter(|face| face.iter().any(|n| off(n.index()))) {
            face[..block.cell.corner_count()].iter().for_each(|n| reached[n.index()] = true);
        }
    }
    let elements: Vec<_> = mesh.cell_blocks().flat_map(|block| block.elements(mesh.order())).collect();
    let mut layers = vec![usize::MAX; elements.len()];
    for layer in 1..200 {
        let touches = |e: &usize| layers[*e] == usize::MAX && elements[*e].iter().any(|n| reached[n.index()]);
        let new: Vec<usize> = (0..elements.len()).filter(touches).collect();
        for e in new {
            layers[e] = layer;
            elements[e].iter().for_each(|n| reached[n.index()] = true);
        }
    }
    layers
}

#[test]
fn elements_beyond_are_straight_and_all_are_valid() {
    let folder = tempfile::tempdir().unwrap();
    let straight = straight_places();
    let free = curved(folder.path(), "auto");
    let layers = layers(&free.mesh, &straight);
    let free_bent = bent(&free.mesh, &straight);
    let reach = (0..layers.len()).filter(|&e| free_bent[e]).map(|e| layers[e]).max().unwrap();
    let count = |bent: &[bool]| bent.iter().filter(|b| **b).count();
    // The wall's displacement fits into 12 layers, but not into 8: there walls are given up, and all else holds.
    for (n, code) in [(12, 0), (8, 3)] {
        assert!(n < reach);
        let own = curved(folder.path(), &n.to_string());
        let own_bent = bent(&own.mesh, &straight);
        assert!((0..layers.len()).all(|e| !own_bent[e] || layers[e] <= n), "{n} of {reach} layers");
        assert!(count(&own_bent) > 0 && count(&own_bent) < count(&free_bent), "{n} of {reach} layers");
        assert!(certify::mesh(&own.mesh, own.mesh.points(), None, &Settings::default()).holds());
        assert_eq!((own.told as usize, own.code), (own_bent.len() - count(&own_bent), code), "{n} of {reach} layers");
    }
    let deep = curved(folder.path(), &(reach + 1).to_string());
    assert!(deep.told as usize >= free_bent.len() - count(&free_bent));
}
