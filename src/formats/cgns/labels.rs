//! Labels of CGNS nodes (SIDS) that are read or written.

pub(super) const VERSION: &str = "CGNSLibraryVersion_t";
pub(super) const BASE: &str = "CGNSBase_t";
pub(super) const FAMILY: &str = "Family_t";
pub(super) const FAMILY_BC: &str = "FamilyBC_t";
pub(super) const FAMILY_NAME: &str = "FamilyName_t";
pub(super) const MORE_FAMILIES: &str = "AdditionalFamilyName_t";
pub(super) const ORDINAL: &str = "Ordinal_t";
pub(super) const ZONE: &str = "Zone_t";
pub(super) const ZONE_TYPE: &str = "ZoneType_t";
pub(super) const COORDINATES: &str = "GridCoordinates_t";
pub(super) const ARRAY: &str = "DataArray_t";
pub(super) const ELEMENTS: &str = "Elements_t";
pub(super) const RANGE: &str = "IndexRange_t";
pub(super) const LIST: &str = "IndexArray_t";
pub(super) const ZONE_BC: &str = "ZoneBC_t";
pub(super) const BC: &str = "BC_t";
pub(super) const LOCATION: &str = "GridLocation_t";
pub(super) const CONNECTIVITY: &str = "ZoneGridConnectivity_t";
pub(super) const GENERAL_CONNECTION: &str = "GridConnectivity_t";
pub(super) const DIRECT_CONNECTION: &str = "GridConnectivity1to1_t";
pub(super) const TRANSFORM: &str = "int[IndexDimension]";
pub(super) const PERIODIC: &str = "Periodic_t";
pub(super) const CONNECTION_PROPERTY: &str = "GridConnectivityProperty_t";

/// What stands in place of a label for arrays of HOPR's files, which have none.
pub(in crate::formats) const HOPR: &str = "HOPR";

/// Those arrays: all that is read of them.
pub(super) const HOPR_ARRAYS: [&str; 6] = ["BCNames", "BCType", "ElemInfo", "GlobalNodeIDs", "NodeCoords", "SideInfo"];

/// Everything that the reading child hands on.
pub(super) const READ: [&str; 23] = [
    VERSION,
    BASE,
    FAMILY,
    FAMILY_BC,
    FAMILY_NAME,
    MORE_FAMILIES,
    ORDINAL,
    ZONE,
    ZONE_TYPE,
    COORDINATES,
    ARRAY,
    ELEMENTS,
    RANGE,
    LIST,
    ZONE_BC,
    BC,
    LOCATION,
    CONNECTIVITY,
    GENERAL_CONNECTION,
    DIRECT_CONNECTION,
    CONNECTION_PROPERTY,
    TRANSFORM,
    PERIODIC,
];

/// Nodes that are not handed on, as nothing here needs their arrays.
pub(super) const PASSED_OVER: [&str; 4] =
    ["ParentElements", "ParentElementsPosition", "InwardNormalList", "ElementStartOffset"];

/// Kinds of data, as the bytes that stand for them between child and parent.
pub(super) mod kind {
    pub(in super::super) const NONE: u8 = 0;
    pub(in super::super) const TEXT: u8 = 1;
    pub(in super::super) const INT: u8 = 4;
    pub(in super::super) const LONG: u8 = 8;
    pub(in super::super) const REAL: u8 = 9;
}

/// First and last bytes of an answer that holds a tree, and last bytes of one that tells why there is none.
pub(super) const TREE: &[u8; 8] = b"cgnstree";
pub(super) const FAILURE: &[u8; 8] = b"cgnsfail";
