//! Node orders of file formats, as permutations of the internal order (CGNS).
