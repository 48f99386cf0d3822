"""Legacy VTK as text (docs.vtk.org, "VTK file formats"), and what VTU shares with it: cells from arrays."""

from .mesh import KINDS, Mesh, integer, real, refuse_unless, split

LINEAR = {1: "point", 3: "line", 5: "triangle", 9: "quad", 10: "tet", 12: "hex", 13: "prism", 14: "pyramid"}
QUADRATIC = {21: "line", 22: "triangle", 24: "tet", 28: "quad", 29: "hex", 32: "prism"}
LAGRANGE = {68: "line", 69: "triangle", 70: "quad", 71: "tet", 72: "hex", 73: "prism"}
FLOATS = ("float", "double")
WHOLE = ("bit", "unsigned_char", "char", "unsigned_short", "short", "unsigned_int", "int", "unsigned_long", "long", "vtktypeint64", "vtkIdType")


def add_cells(mesh, connectivity, ends, types, entities):
    refuse_unless(len(ends) == len(types), "as many ends as types of cells")
    refuse_unless(entities is None or len(entities) == len(types), "as many numbers of entities as cells")
    start = 0
    for n, (code, end) in enumerate(zip(types, ends)):
        refuse_unless(start <= end <= len(connectivity), "an end of a cell")
        nodes, start = connectivity[start:end], end
        entity = entities[n] if entities is not None and 0 < entities[n] < 2**31 else 1
        kind = LINEAR.get(code) or QUADRATIC.get(code) or LAGRANGE.get(code)
        refuse_unless(kind, f"cells of type {code}")
        if code in LAGRANGE:
            refuse_unless(len(nodes) in KINDS[kind][2], f"a {kind} of {len(nodes)} nodes")
            order = KINDS[kind][2].index(len(nodes)) + 1
        else:
            order = 1 if code in LINEAR else 2
        mesh.add(kind, order, nodes, entity)
    refuse_unless(start == len(connectivity), "nodes that belong to no cell")


class Source:
    def __init__(self, text):
        self.lines = text.split("\n")
        self.at, self.words = 0, []

    def row(self):
        """The words of the next line with something on it."""
        refuse_unless(not self.words, "more numbers than announced")
        while self.at < len(self.lines):
            self.at += 1
            words = split(self.lines[self.at - 1])
            if words:
                return words
        return None

    def numbers(self, count, parse):
        found = []
        refuse_unless(0 <= count <= sum(map(len, self.lines)), "a count that the file cannot hold")
        while len(found) < count:
            if not self.words:
                self.words = self.row()
                refuse_unless(self.words is not None, "the file ends early")
            found.append(parse(self.words[0]))
            self.words = self.words[1:]
        return found

    def skip_paragraph(self):
        while self.at < len(self.lines) and self.lines[self.at].strip():
            self.at += 1


def parser_of(kind):
    refuse_unless(kind in FLOATS or kind in WHOLE, f"numbers of type {kind}")
    return real if kind in FLOATS else integer


def read(content, _):
    text = content.decode("latin-1")
    lines = text.split("\n", 2)
    refuse_unless(lines[0].startswith("# vtk DataFile Version") and len(lines) == 3, "no header")
    real(lines[0].removeprefix("# vtk DataFile Version").strip())
    source = Source(lines[2])
    refuse_unless(source.row() == ["ASCII"], "not text")
    refuse_unless(source.row() == ["DATASET", "UNSTRUCTURED_GRID"], "no unstructured grid")
    mesh, found, data_of = Mesh(), {}, None
    while (words := source.row()) is not None:
        key, values = words[0], words[1:]
        if key == "METADATA":
            source.skip_paragraph()
        elif key == "POINTS":
            refuse_unless(len(values) == 2 and key not in found, "POINTS")
            flat = source.numbers(3 * integer(values[0], 0), parser_of(values[1]))
            mesh.points = [[float(x) for x in flat[n : n + 3]] for n in range(0, len(flat), 3)]
            found[key] = True
        elif key == "CELLS":
            refuse_unless(len(values) == 2 and key not in found, "CELLS")
            found[key] = cells(source, integer(values[0], 0), integer(values[1], 0))
        elif key == "CELL_TYPES":
            refuse_unless(len(values) == 1 and key not in found, "CELL_TYPES")
            found[key] = source.numbers(integer(values[0], 0), integer)
        elif key in ("CELL_DATA", "POINT_DATA"):
            refuse_unless(len(values) == 1, key)
            data_of = key, integer(values[0], 0)
            wanted = len(found.get("CELL_TYPES", [])) if key == "CELL_DATA" else len(mesh.points)
            refuse_unless(data_of[1] == wanted, "another number of values than of cells or points")
        elif key == "SCALARS":
            refuse_unless(data_of and len(values) in (2, 3), "SCALARS")
            parse = parser_of(values[1])
            words = source.row()
            refuse_unless(words and words[0] == "LOOKUP_TABLE" and len(words) == 2, "no LOOKUP_TABLE")
            components = integer(values[2], 1, 4) if len(values) == 3 else 1
            scalars = source.numbers(components * data_of[1], parse)
            if values[0] == "CellEntityIds" and data_of[0] == "CELL_DATA" and components == 1:
                found["entities"] = scalars
        else:
            refuse_unless(False, f"{key[:20]!r}, which this parser does not know")
    refuse_unless("POINTS" in found and "CELLS" in found and "CELL_TYPES" in found, "no points or no cells")
    connectivity, ends = found["CELLS"]
    add_cells(mesh, connectivity, ends, found["CELL_TYPES"], found.get("entities"))
    return mesh


def cells(source, count, size):
    at = source.at
    words = source.row()
    if words and words[0] == "OFFSETS":
        refuse_unless(len(words) == 2, "OFFSETS")
        offsets = source.numbers(count, parser_of(words[1]))
        refuse_unless(not offsets or offsets[0] == 0, "the first offset is not 0")
        words = source.row()
        refuse_unless(words and words[0] == "CONNECTIVITY" and len(words) == 2, "CONNECTIVITY")
        return source.numbers(size, parser_of(words[1])), offsets[1:]
    source.at = at
    values = source.numbers(size, integer)
    connectivity, ends, at = [], [], 0
    while at < len(values):
        nodes = values[at]
        refuse_unless(0 <= nodes < len(values) - at, "a cell's number of nodes")
        connectivity += values[at + 1 : at + 1 + nodes]
        ends.append(len(connectivity))
        at += 1 + nodes
    refuse_unless(len(ends) == count, "another number of cells than announced")
    return connectivity, ends
