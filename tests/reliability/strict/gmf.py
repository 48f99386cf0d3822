"""GMF as text (github.com/LoicMarechal/libMeshb, the documentation's list of keywords)."""

from .mesh import KINDS, Mesh, integer, real, refuse_unless, split

ELEMENTS = {"Edges": "line", "Triangles": "triangle", "Quadrilaterals": "quad", "Tetrahedra": "tet", "Pyramids": "pyramid", "Prisms": "prism", "Hexahedra": "hex"}
# Rows of one number each.
LISTS = ("Corners", "Ridges", "RequiredVertices", "RequiredEdges", "RequiredTriangles", "RequiredQuadrilaterals")


def read(content, _):
    lines = content.decode("latin-1").split("\n")
    words = [word for line in lines for word in split(line.split("#")[0])]
    at = 0

    def take():
        nonlocal at
        refuse_unless(at < len(words), "the file ends early")
        at += 1
        return words[at - 1]

    first = take()
    refuse_unless(first.startswith("MeshVersionFormatted"), "no version")
    integer(first.removeprefix("MeshVersionFormatted") or take(), 1, 4)
    mesh, dimension, vertices, rows = Mesh(), None, None, []
    while True:
        key = take()
        if key == "End":
            break
        if key == "Dimension":
            dimension = integer(take(), 2, 3)
        elif key == "Vertices":
            refuse_unless(dimension and vertices is None, "vertices twice, or before the dimension")
            vertices = integer(take(), 0)
            refuse_unless(vertices <= len(words), "more vertices than words")
            for _ in range(vertices):
                mesh.points.append([real(take(), "eEdD") for _ in range(dimension)] + [0.0] * (3 - dimension))
                integer(take())
        elif key in ELEMENTS:
            refuse_unless(vertices is not None, "elements before vertices")
            kind = ELEMENTS[key]
            count = integer(take(), 0)
            refuse_unless(count <= len(words), "more elements than words")
            for _ in range(count):
                nodes = [integer(take()) - 1 for _ in range(KINDS[kind][0])]
                rows.append((kind, nodes, integer(take(), -(2**31), 2**31 - 1)))
        elif key in LISTS:
            for _ in range(integer(take(), 0)):
                integer(take(), 1)
        else:
            refuse_unless(False, f"the keyword {key[:20]!r}, which this parser does not know")
    refuse_unless(vertices is not None, "no vertices")
    for kind, nodes, reference in rows:
        # A reference that is not positive says that there is none.
        mesh.add(kind, 1, nodes, max(reference, 0))
    return mesh
