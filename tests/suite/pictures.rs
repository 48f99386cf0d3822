//! Pictures of meshes: what is drawn, and what is refused.

use std::path::{Path, PathBuf};

use crate::common::{fixture, root, sagitta};

/// Pixels of a PNG file by rows, and its width.
fn pixels(path: &Path) -> (Vec<[u8; 3]>, usize) {
    let decoder = png::Decoder::new(std::io::BufReader::new(std::fs::File::open(path).unwrap()));
    let mut reader = decoder.read_info().unwrap();
    let mut bytes = vec![0; reader.output_buffer_size().unwrap()];
    let frame = reader.next_frame(&mut bytes).unwrap();
    let pixels = bytes.chunks_exact(3).map(|own| [own[0], own[1], own[2]]).collect();
    (pixels, frame.width as usize)
}

fn drawn(mesh: &Path, dir: &Path, name: &str, options: &[&str]) -> (PathBuf, String) {
    let path = dir.join(name);
    let mut arguments = args!["picture", mesh, "-o", path].to_vec();
    arguments.extend(options.iter().map(Into::into));
    let outcome = sagitta(&arguments).expect(0);
    (path, outcome.stdout)
}

/// The part of the pixels that are not paper.
fn covered(path: &Path) -> f64 {
    let (pixels, _) = pixels(path);
    pixels.iter().filter(|own| **own != [255; 3]).count() as f64 / pixels.len() as f64
}

/// An octant of a sphere is seen as a quarter of a disc, which straight faces would not cover.
#[test]
fn curved_faces_are_drawn_curved() {
    let dir = tempfile::tempdir().unwrap();
    let (mesh, cad) = (fixture("sphere_shell", "msh"), fixture("sphere_shell", "step"));
    let curved = dir.path().join("sphere_p3.msh");
    sagitta(args!["curve", mesh, "--cad", cad, "--order", "3", "-o", curved, "--quiet"]).expect(0);
    let (path, _) =
        drawn(&curved, dir.path(), "sphere.png", &["--patch", "farfield", "--view", "z", "--color", "patch"]);
    let (pixels, width) = pixels(&path);
    // Left of the legend, below the title.
    let inside = |x: usize, y: usize| x < width - 200 && y > 40 && pixels[y * width + x] != [255; 3];
    let (mut low, mut high) = ([usize::MAX; 2], [0; 2]);
    let all = (0..width).flat_map(|x| (0..pixels.len() / width).map(move |y| [x, y]));
    for at in all.clone().filter(|at| inside(at[0], at[1])) {
        for k in 0..2 {
            low[k] = low[k].min(at[k]);
            high[k] = high[k].max(at[k]);
        }
    }
    let [wide, tall] = [0, 1].map(|k| (high[k] + 1 - low[k]) as f64);
    assert!((wide - tall).abs() <= 2.0, "{wide} across and {tall} down");
    let area = all.filter(|at| inside(at[0], at[1])).count() as f64;
    let disc = std::f64::consts::PI / 4.0 * wide * tall;
    assert!((area / disc - 1.0).abs() < 0.01, "{area} pixels are covered, {disc} of a disc would be");
}

#[test]
fn what_stands_far_round_the_walls_is_left_out_and_said() {
    let dir = tempfile::tempdir().unwrap();
    let mesh = fixture("weeble", "msh");
    let (path, said) = drawn(&mesh, dir.path(), "walls.png", &["--color", "patch"]);
    assert!(said.contains("left out") && said.contains("farfield"), "{said}");
    assert!(covered(&path) > 0.1);
    let (path, said) = drawn(&mesh, dir.path(), "far.png", &["--color", "patch", "--patch", "farfield"]);
    assert!(!said.contains("left out"), "{said}");
    assert!(covered(&path) > 0.3);
}

#[test]
fn plane_meshes_sections_and_worst_elements_are_drawn() {
    let dir = tempfile::tempdir().unwrap();
    let (path, said) = drawn(&fixture("naca0012_sharp", "msh"), dir.path(), "plane.png", &["--worst", "2"]);
    assert!(covered(&path) > 0.5 && said.lines().filter(|line| line.contains("J/J_c")).count() == 2, "{said}");
    let plane = fixture("naca0012_sharp", "msh");
    let (_, against) = drawn(&plane, dir.path(), "plane.png", &["--worst", "2", "--linear", plane.to_str().unwrap()]);
    assert_eq!(against, said, "a linear mesh is its own");
    let mesh = root().join("fixtures/samples/hexpyrtet_p3_msh41a.msh");
    let (whole, _) = drawn(&mesh, dir.path(), "whole.png", &["--view", "x"]);
    let (cut, _) = drawn(&mesh, dir.path(), "cut.png", &["--view", "x", "--cut", "x:0.5", "--color", "scaled"]);
    assert!(
        covered(&whole) > 0.2 && (covered(&cut) / covered(&whole) - 1.0).abs() < 0.05,
        "a cube, cut or not, is a square"
    );
    let cad = fixture("weeble", "step");
    let cad = cad.to_str().unwrap();
    let (path, _) =
        drawn(&fixture("weeble", "msh"), dir.path(), "distance.png", &["--color", "distance", "--cad", cad]);
    assert!(covered(&path) > 0.1);
}

/// The same picture on any number of threads and any day.
#[test]
fn a_picture_is_the_same_bytes_again() {
    let dir = tempfile::tempdir().unwrap();
    let mesh = fixture("weeble", "msh");
    let one =
        ["one.png", "two.png"].map(|name| std::fs::read(drawn(&mesh, dir.path(), name, &["--cut", "y:0"]).0).unwrap());
    assert!(one[0] == one[1]);
}

#[test]
fn wrong_wishes_are_refused_with_a_remedy() {
    let dir = tempfile::tempdir().unwrap();
    let (out, mesh, plane) = (dir.path().join("x.png"), fixture("weeble", "msh"), fixture("naca0012_sharp", "msh"));
    let refused = |mesh: &Path, options: &[&str], words: &str| {
        let mut arguments = args!["picture", mesh, "-o", out].to_vec();
        arguments.extend(options.iter().map(Into::into));
        let stderr = sagitta(&arguments).expect(2).stderr;
        assert!(stderr.contains(words), "{options:?}: {stderr}");
        assert!(!out.exists());
    };
    refused(&mesh, &["--color", "distance"], "--cad");
    refused(&mesh, &["--patch", "wing"], "it has no patch \"wing\"; it has");
    refused(&mesh, &["--cut", "w:1"], "z:0.25");
    refused(&mesh, &["--cut", "z:inf"], "z:0.25");
    refused(&mesh, &["--size", "10x10"], "200x200");
    refused(&plane, &["--cut", "x:0"], "leave --cut away");
    let onto_itself = sagitta(args!["picture", mesh, "-o", mesh]).expect(2);
    assert!(onto_itself.stderr.contains(".png"), "{}", onto_itself.stderr);
}
