"""MFEM's meshes as text, version 1.0 without nodes (mfem.org/mesh-format-v1.0)."""

from .mesh import KINDS, Mesh, integer, real, refuse_unless, split

GEOMETRIES = ["point", "line", "triangle", "quad", "tet", "hex", "prism", "pyramid"]


def read(content, _):
    text = content.decode("latin-1")
    first, _, rest = text.partition("\n")
    refuse_unless(first.strip(" \t\r\f") == "MFEM mesh v1.0", "another version")
    words = [(word, line) for line, text in enumerate(rest.split("\n")) for word in split(text)]
    at = 0

    def take():
        nonlocal at
        refuse_unless(at < len(words), "the file ends early")
        at += 1
        return words[at - 1][0]

    def comments():
        """Between sections alone: MFEM takes them for numbers elsewhere."""
        nonlocal at
        while at < len(words) and words[at][0].startswith("#"):
            line = words[at][1]
            while at < len(words) and words[at][1] == line:
                at += 1

    def key(name):
        comments()
        refuse_unless(take() == name, f"no {name}")

    def rows(own):
        found = []
        for _ in range(integer(take(), 0)):
            attribute, geometry = integer(take(), 1, 2**31 - 1), integer(take(), 0, 7)
            kind = GEOMETRIES[geometry]
            refuse_unless(KINDS[kind][1] == own, "elements of another dimension")
            found.append((kind, [integer(take(), 0) for _ in range(KINDS[kind][0])], attribute))
        return found

    key("dimension")
    dimension = integer(take(), 2, 3)
    key("elements")
    cells = rows(dimension)
    key("boundary")
    sides = rows(dimension - 1)
    key("vertices")
    count = integer(take(), 0)
    comments()
    axes = integer(take(), dimension, 3)
    mesh = Mesh()
    for _ in range(min(count, len(words))):
        mesh.points.append([real(take()) for _ in range(axes)] + [0.0] * (3 - axes))
    refuse_unless(len(mesh.points) == count, "the file ends early")
    comments()
    refuse_unless(at == len(words) or take() == "mfem_mesh_end", "more than announced")
    for kind, nodes, attribute in cells + sides:
        mesh.add(kind, 1, nodes, attribute)
    return mesh
