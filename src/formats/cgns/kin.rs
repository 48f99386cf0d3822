//! Files on HDF5 or ADF that are not CGNS.

use crate::formats::detect::{Head, Refusal};

/// What a file on HDF5 or ADF is that is not CGNS, as far as its name and first bytes tell.
pub(super) fn refusal(head: &Head) -> Option<Refusal> {
    let name = head.path.file_name().unwrap_or_default().to_string_lossy().to_ascii_lowercase();
    let holds = |word: &[u8]| head.bytes.windows(word.len()).any(|window| window == word);
    let told = if name.ends_with(".med") || holds(b"INFOS_GENERALES") || holds(b"ENS_MAA") {
        "a MED file (Salome), which is not read; convert it: gmsh IN.med -save -format msh41 -o OUT.msh"
    } else if name.ends_with(".msh.h5") || name.ends_with(".cas.h5") {
        "a Fluent mesh, which is not read; export the mesh as CGNS"
    } else if name.ends_with(".ccm") || name.ends_with(".ccmg") {
        "a STAR-CCM+ mesh (CCM), which is not read; export the mesh as CGNS"
    } else if holds(b"VTKHDF") {
        "a VTKHDF file, which is not read; save the mesh as VTU"
    } else {
        return None;
    };
    Some(Refusal::unread(told))
}
