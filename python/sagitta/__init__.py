"""sagitta curves linear viscous meshes onto their CAD: P1 in, P2, P3 or P4 out, every element certified valid.

>>> import sagitta
>>> m = sagitta.curve("wing.msh", cad="wing.step", order=3)   # doctest: +SKIP
>>> m.report.min_jacobian, len(m.cells["tet"])                # doctest: +SKIP
>>> m.write("wing_p3.msh", target="pyfr")                     # doctest: +SKIP

Lengths are in the mesh's unit, indices count from 0. The work runs without Python's lock, on all cores; Ctrl-C ends it.
"""

from ._sagitta import Progress, node_order, node_orders
from .cad_model import Cad, Entity, Feet
from .curving import check, curve, link, validate
from .errors import AssociationError, CadError, Error, FileError, LinkageError, MeshError, NotCertified
from .mesh import CurvedMesh, Mesh, Patch, Patches, read
from .report import CheckReport, CurveReport, LinkReport, Report, Validation, WeakCell

__all__ = [
    "AssociationError",
    "Cad",
    "CadError",
    "CheckReport",
    "CurveReport",
    "CurvedMesh",
    "Entity",
    "Error",
    "Feet",
    "FileError",
    "LinkReport",
    "LinkageError",
    "Mesh",
    "MeshError",
    "NotCertified",
    "Patch",
    "Patches",
    "Progress",
    "Report",
    "Validation",
    "WeakCell",
    "check",
    "curve",
    "link",
    "node_order",
    "node_orders",
    "read",
    "validate",
]
