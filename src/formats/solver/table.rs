//! The table of solvers.

use super::intake::{Groups, Intake, Solver};
use super::names::NameRule;
use crate::element::Cell;
#[cfg(feature = "cgns")]
use crate::formats::hopr;
use crate::formats::options::{Encoding, Version};
use crate::formats::{mfem, msh, nektar, su2, vtk};
use crate::mesh::Mesh;

const ALL: &[(Cell, usize)] =
    &[(Cell::Triangle, 4), (Cell::Quad, 4), (Cell::Tet, 4), (Cell::Pyramid, 4), (Cell::Prism, 4), (Cell::Hex, 4)];

/// Text or binary MSH of all cells, from which others differ.
const MSH: Intake = Intake {
    format: &msh::FORMAT,
    endings: &["msh"],
    version: Version::V4_1,
    encoding: Encoding::Binary,
    cells: ALL,
    one_kind: false,
    groups: None,
    misfit: |_| None,
    notes: "",
};

/// One group for each boundary element and each cell.
const ONE_EACH: Groups = Groups { cells: None, one_each: true, names: NameRule::any(127) };

/// The solvers, by name.
pub static SOLVERS: &[Solver] = &[
    Solver {
        name: "dolfinx",
        title: "DOLFINx 0.11",
        intakes: &[Intake {
            cells: &[
                (Cell::Triangle, 3),
                (Cell::Quad, 3),
                (Cell::Tet, 3),
                (Cell::Pyramid, 2),
                (Cell::Prism, 2),
                (Cell::Hex, 2),
            ],
            one_kind: true,
            groups: Some(ONE_EACH),
            notes: "by `dolfinx.io.gmsh.read_from_msh`; groups as mesh tags",
            ..MSH
        }],
    },
    #[cfg(feature = "cgns")]
    Solver {
        name: "flexi",
        title: "FLEXI, GALAEXI and FLUXO",
        intakes: &[Intake {
            format: &hopr::FORMAT,
            endings: &["h5"],
            cells: &[(Cell::Hex, 4)],
            groups: Some(Groups { names: NameRule::any(255), ..ONE_EACH }),
            notes: "HOPR's format; types of boundaries are set by name in the solver's parameters",
            ..MSH
        }],
    },
    Solver { name: "gmsh", title: "Gmsh 4.15", intakes: &[Intake { notes: "the mesh as it is", ..MSH }] },
    Solver {
        name: "mfem",
        title: "MFEM 4.10",
        intakes: &[
            Intake {
                format: &mfem::FORMAT,
                endings: &["mesh", "mfem"],
                groups: Some(Groups { one_each: false, ..ONE_EACH }),
                notes: "numbers of groups as attributes, their names as attribute sets",
                ..MSH
            },
            Intake {
                version: Version::V2_2,
                cells: &[
                    (Cell::Triangle, 4),
                    (Cell::Quad, 4),
                    (Cell::Tet, 4),
                    (Cell::Pyramid, 2),
                    (Cell::Prism, 4),
                    (Cell::Hex, 4),
                ],
                groups: Some(ONE_EACH),
                notes: "numbers of groups as attributes, without names",
                ..MSH
            },
        ],
    },
    Solver {
        name: "nektar",
        title: "Nektar++ 5",
        intakes: &[Intake {
            format: &nektar::FORMAT,
            endings: &["xml"],
            cells: &[
                (Cell::Triangle, 4),
                (Cell::Quad, 4),
                (Cell::Tet, 4),
                (Cell::Pyramid, 2),
                (Cell::Prism, 4),
                (Cell::Hex, 4),
            ],
            groups: Some(ONE_EACH),
            notes: "geometry, composites and an expansion of the mesh's order; nodes inside cells follow from the faces",
            ..MSH
        }],
    },
    Solver {
        name: "ngsolve",
        title: "NGSolve 6.2",
        intakes: &[Intake {
            version: Version::V2_2,
            encoding: Encoding::Ascii,
            cells: &[
                (Cell::Triangle, 2),
                (Cell::Quad, 1),
                (Cell::Tet, 2),
                (Cell::Pyramid, 1),
                (Cell::Prism, 1),
                (Cell::Hex, 1),
            ],
            groups: Some(Groups { names: NameRule { spaces: false, ..NameRule::any(127) }, ..ONE_EACH }),
            notes: "by `netgen.read_gmsh.ReadGmsh`",
            ..MSH
        }],
    },
    Solver {
        name: "paraview",
        title: "ParaView and VTK 9",
        intakes: &[Intake { format: &vtk::VTU, endings: &["vtu"], notes: "pictures, with fields", ..MSH }],
    },
    Solver {
        name: "pyfr",
        title: "PyFR 3.1",
        intakes: &[Intake {
            version: Version::V2_2,
            encoding: Encoding::Ascii,
            groups: Some(Groups {
                cells: Some("fluid"),
                names: NameRule { lower_case: true, refused: not_a_periodic_pair, ..NameRule::any(127) },
                ..ONE_EACH
            }),
            misfit: bases_of_pyramids,
            notes: "pyramids on parallelograms only; all names in lower case; pairs of patches `periodic_NAME_l` and `periodic_NAME_r`",
            ..MSH
        }],
    },
    Solver {
        name: "su2",
        title: "SU2 8",
        intakes: &[Intake {
            format: &su2::FORMAT,
            endings: &["su2"],
            groups: Some(Groups { names: NameRule { spaces: false, ..NameRule::any(127) }, ..ONE_EACH }),
            notes: "P1 for all solvers, P2 to P4 for the finite-element one (`SOLVER= FEM_...`)",
            ..MSH
        }],
    },
];

/// How far the corners of a base may be from a parallelogram, in the mesh's unit (`pyfr/readers/base.py`).
const PARALLELOGRAM: f64 = 1e-10;

/// PyFR takes pyramids on parallelograms only.
fn bases_of_pyramids(mesh: &Mesh) -> Option<String> {
    let pyramids = mesh.elements_of(Cell::Pyramid);
    let is_odd = |corners: &[crate::mesh::NodeId]| {
        let x: Vec<_> = mesh.points_of(corners).collect();
        (x[0] - x[1] - x[3] + x[2]).abs().max_element() > PARALLELOGRAM
    };
    let odd = pyramids.iter().filter(|pyramid| is_odd(pyramid.corners())).count();
    (odd > 0).then(|| {
        format!("{odd} of {} pyramids stand on a base that is no parallelogram; replace them by tets", pyramids.len())
    })
}

/// A name that begins as that of a periodic patch must be one.
fn not_a_periodic_pair(name: &str) -> Option<String> {
    let rest = name.to_lowercase();
    let rest = rest.strip_prefix("periodic")?;
    let pair = rest.strip_prefix([' ', '_', '-']).and_then(|rest| rest.rsplit_once([' ', '_', '-']));
    let is_pair = pair.is_some_and(|(own, side)| {
        !own.is_empty() && own.bytes().all(|b| b.is_ascii_alphanumeric()) && matches!(side, "l" | "r")
    });
    (!is_pair).then(|| "a name that begins with periodic is periodic_NAME_l or periodic_NAME_r".to_owned())
}

#[cfg(test)]
#[allow(clippy::unwrap_used)]
mod tests {
    use super::*;

    #[test]
    fn no_solver_takes_more_than_its_format_holds() {
        for solver in SOLVERS {
            for intake in solver.intakes {
                let holds = &intake.format.writer.as_ref().unwrap().holds;
                for (cell, highest) in intake.cells {
                    assert!(holds.cells.contains(cell) && *highest <= holds.highest.get(), "{}: {cell}", solver.name);
                }
            }
        }
        assert!(SOLVERS.is_sorted_by_key(|solver| solver.name));
    }

    #[test]
    fn names_of_periodic_patches_are_pairs() {
        for good in ["periodic_x_l", "Periodic-12-r", "wall", "periodic y l"] {
            assert_eq!(not_a_periodic_pair(good), None, "{good}");
        }
        for bad in ["periodic", "periodic_x", "periodic_x_m", "periodic__l", "periodic_a_b_l"] {
            assert!(not_a_periodic_pair(bad).is_some(), "{bad}");
        }
    }
}
