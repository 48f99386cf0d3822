//! CAD of others: `SAGITTA_CAD` names folders (separated as in `PATH`), one of them with `iea15/IEA_15MW_CFD.stp` and `.igs`, the blade of the IEA 15 MW turbine (Apache-2.0,
//! <https://github.com/IEAWindTask37/IEA-15-240-RWT>). Its STEP file says millimetres and is 117 long; its IGES file says metres.

use crate::common::{Random, foreign_folders, options};
use cad::{Foot, Group, Model, ReadOptions, unit_factor};
use glam::DVec3;
use std::io::Write;
use std::path::{Path, PathBuf};

fn blade() -> Option<[PathBuf; 2]> {
    let blades = foreign_folders().into_iter().map(|folder| folder.join("iea15/IEA_15MW_CFD"));
    let blade = blades.map(|blade| ["stp", "igs"].map(|e| blade.with_extension(e))).find(|[step, _]| step.exists());
    if blade.is_none() {
        let _ = writeln!(std::io::stderr(), "!!! SAGITTA_CAD names no folder with it: the blade is NOT tried");
    }
    blade
}

fn all_faces(model: &Model) -> Group {
    Group::of_faces(model, &model.faces().iter().map(|face| face.id).collect::<Vec<_>>()).unwrap()
}

/// In metres, by what the files say of their units, one is a thousand times the other: the trap. The factor between them is found, and
/// with it both files give the same feet.
#[test]
fn step_and_iges_of_a_blade_are_one_shape_once_the_unit_is_right() {
    let Some([step, iges]) = blade() else { return };
    let metres = |path: &Path| {
        let plain = Model::read(path, &options()).unwrap();
        let scale = plain.unit().metres.unwrap();
        (Model::read(path, &ReadOptions { scale, ..options() }).unwrap(), scale)
    };
    let ((step_model, in_step), (iges_model, _)) = (metres(&step), metres(&iges));
    let factor = unit_factor(iges_model.diagonal(), step_model.diagonal());
    assert_eq!(factor, Some(1000.0), "{} and {} across", iges_model.diagonal(), step_model.diagonal());
    let right = Model::read(&step, &ReadOptions { scale: in_step * factor.unwrap(), ..options() }).unwrap();
    let (a, b) = (all_faces(&right), all_faces(&iges_model));
    let mut random = Random(53);
    let bounds = right.bounds();
    let diagonal = right.diagonal();
    let (mut apart, mut moved, mut count) = (0.0_f64, 0.0_f64, 0);
    for k in 0..6000 {
        let near = a.closest(random.in_box(bounds.min, bounds.max), None).unwrap().point;
        let reach = [1e-6, 1e-4, 0.01, 0.3][k % 4] * diagonal;
        let x = near + reach * (random.in_box(-DVec3::ONE, DVec3::ONE));
        let [one, other]: [Foot; 2] = [a.closest(x, None).unwrap(), b.closest(x, None).unwrap()];
        apart = apart.max((one.distance - other.distance).abs() / diagonal);
        // at equal distances from two places either is right
        if k % 4 < 2 {
            moved = moved.max(one.point.distance(other.point) / diagonal);
        }
        count += 1;
    }
    println!("{count} feet on STEP and IGES: distances {apart:.1e} of the diagonal apart, near feet {moved:.1e}");
    assert!(apart <= 1e-9 && moved <= 1e-9, "distances {apart:.1e}, feet {moved:.1e}");
}
