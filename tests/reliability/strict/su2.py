"""SU2's native meshes of linear elements (su2code.github.io, "Mesh File")."""

from .mesh import KINDS, Mesh, integer, real, refuse_unless

TYPES = {3: "line", 5: "triangle", 9: "quad", 10: "tet", 12: "hex", 13: "prism", 14: "pyramid"}


def read(content, _):
    rows = [line.split("%")[0].strip() for line in content.decode("latin-1").split("\n")]
    rows = [row for row in rows if row]
    at, seen = 0, {}
    dimension, points, cells, markers = None, None, None, []

    def take(count):
        nonlocal at
        refuse_unless(0 <= count <= len(rows) - at, "more rows announced than there are")
        at += count
        return [row.split() for row in rows[at - count : at]]

    while at < len(rows):
        refuse_unless("=" in rows[at], f"{rows[at][:20]!r} where a key should be")
        key, value = (part.strip() for part in rows[at].split("=", 1))
        at += 1
        refuse_unless(key in ("NDIME", "NELEM", "NPOIN", "NMARK", "MARKER_TAG"), f"the key {key}, which this parser does not know")
        refuse_unless(key == "MARKER_TAG" or key not in seen, f"{key} twice")
        seen[key] = value
        if key == "NDIME":
            refuse_unless(value in ("2", "3"), "a dimension")
            dimension = int(value)
        elif key == "NELEM":
            cells = elements(take(integer(value.split()[0] if value else "", 0)), dimension)
        elif key == "NPOIN":
            points = take(integer(value.split()[0] if value else "", 0))
        elif key == "MARKER_TAG":
            refuse_unless(at < len(rows) and "=" in rows[at], "a marker without a count")
            word, count = (part.strip() for part in rows[at].split("=", 1))
            refuse_unless(word == "MARKER_ELEMS", "a marker without a count")
            at += 1
            refuse_unless(dimension, "a marker before the dimension")
            markers.append((value, elements(take(integer(count, 0)), dimension - 1)))
    refuse_unless(points is not None and cells is not None and dimension, "no points or no cells")
    refuse_unless("NMARK" not in seen or integer(seen["NMARK"], 0) == len(markers), "another number of markers than announced")
    mesh = Mesh()
    refuse_unless(len({len(row) for row in points}) <= 1, "rows of points of several lengths")
    for row in points:
        refuse_unless(dimension <= len(row) <= dimension + 2, "a point")
        mesh.points.append([real(word) for word in row[:dimension]] + [0.0] * (3 - dimension))
        [integer(word) for word in row[dimension:]]
    for kind, nodes in cells or []:
        mesh.add(kind, 1, nodes, 1)
    for tag, (name, own) in enumerate(markers):
        for kind, nodes in own:
            mesh.add(kind, 1, nodes, name)
    return mesh


def elements(rows, dimension):
    refuse_unless(dimension, "elements before the dimension")
    found, behind = [], set()
    for row in rows:
        code, *nodes = [integer(word) for word in row]
        refuse_unless(code in TYPES and KINDS[TYPES[code]][1] == dimension, f"type {code} among elements of dimension {dimension}")
        corners = KINDS[TYPES[code]][0]
        refuse_unless(len(nodes) >= corners, "too few nodes")
        behind.add(len(nodes) - corners)
        found.append((TYPES[code], nodes[:corners]))
    refuse_unless(len(behind) <= 1 and max(behind, default=0) <= 2, "rows of elements of several lengths")
    return found
