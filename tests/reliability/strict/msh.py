"""Gmsh MSH 2.2 and 4.1 as text (gmsh.info/doc, "MSH file format")."""

import re
from math import isfinite

from .mesh import KINDS, Mesh, Refused, integer, real, refuse_unless, split

TYPES = {15: ("point", 1)}
for order, codes in enumerate([(1, 2, 3, 4, 5, 6, 7), (8, 9, 10, 11, 12, 13, 14), (26, 21, 36, 29, 92, 90, 118), (27, 23, 37, 30, 93, 91, 119)], 1):
    for kind, code in zip(("line", "triangle", "quad", "tet", "hex", "prism", "pyramid"), codes):
        TYPES[code] = (kind, order)


class Lines:
    """Lines with something on them."""

    def __init__(self, lines):
        self.lines = [split(line) for line in lines if line.strip()]
        self.at = 0

    def row(self, count=None):
        refuse_unless(self.at < len(self.lines), "a section ends early")
        words = self.lines[self.at]
        self.at += 1
        refuse_unless(count is None or len(words) == count, f"{len(words)} words in place of {count}")
        return words

    def end(self):
        refuse_unless(self.at == len(self.lines), "a section has more than it announces")


def sections(text):
    found, name, lines = {}, None, []
    for line in text.split("\n"):
        line = line.strip(" \t\r\n\f")
        if name is None:
            if not line:
                continue
            refuse_unless(line.startswith("$") and not line.startswith("$End"), f"{line[:20]!r} between sections")
            name, lines = line[1:], []
        elif line == "$End" + name:
            refuse_unless(name not in found or name not in KNOWN, f"two sections {name}")
            found[name], name = Lines(lines), None
        elif name in KNOWN and line.startswith("$"):
            raise Refused(f"{line[:20]!r} within {name}")
        else:
            lines.append(line)
    refuse_unless(name is None, "a section does not end")
    return found


KNOWN = ("MeshFormat", "PhysicalNames", "Entities", "PartitionedEntities", "Nodes", "ParametricNodes", "Elements", "Periodic")


def read(content, _):
    text = content.decode("latin-1")
    refuse_unless(text.startswith("$MeshFormat"), "no $MeshFormat")
    found = sections(text)
    words = found["MeshFormat"].row(3)
    refuse_unless(words[1:] == ["0", "8"], "not text, or not of 8 bytes")
    found["MeshFormat"].end()
    refuse_unless("Nodes" in found and "Elements" in found, "no nodes or no elements")
    names = list(found)
    refuse_unless(names.index("Nodes") < names.index("Elements"), "elements before nodes")
    physical_names(found.get("PhysicalNames"))
    if words[0] == "4.1":
        return version41(found)
    refuse_unless(words[0] in ("2", "2.0", "2.1", "2.2"), f"version {words[0]}")
    refuse_unless("Entities" not in found and "PartitionedEntities" not in found, "entities in a file of version 2")
    return version22(found)


NAME = re.compile(r'(\S+) ([^\s"]+) ?"([^"]*)"\Z')


def physical_names(lines):
    if lines is None:
        return
    for _ in range(integer(lines.row(1)[0], 0)):
        row = NAME.match(" ".join(lines.row()))
        refuse_unless(row, "a line that is not dimension, tag and name in quotation marks")
        integer(row[1], 0, 3), integer(row[2], -(2**31), 2**31 - 1)
    lines.end()


def version22(found):
    mesh, places = Mesh(), {}
    lines = found["Nodes"]
    for _ in range(integer(lines.row(1)[0], 0)):
        number, *point = lines.row(4)
        number = integer(number, 1, 2**31 - 1)
        refuse_unless(number not in places, f"two nodes {number}")
        places[number] = len(mesh.points)
        mesh.points.append([real(x) for x in point])
    lines.end()
    lines, groups = found["Elements"], {}
    for _ in range(integer(lines.row(1)[0], 0)):
        words = [integer(word, -(2**31), 2**31 - 1) for word in lines.row()]
        refuse_unless(len(words) > 3, "an element without nodes")
        number, code, tags = words[:3]
        refuse_unless(number >= 0 and code in TYPES and tags >= 0, "an element that is none")
        kind, order = TYPES[code]
        tags, nodes = words[3 : 3 + tags], words[3 + tags :]
        refuse_unless(len(tags) == words[2], "too few tags")
        physical, entity = (tags + [0, 0])[:2]
        nodes = place(nodes, places)
        # An element in several groups stands there once for each.
        known = groups.setdefault((kind, nodes, entity), [])
        if known and physical and 0 not in known and physical not in known:
            known.append(physical)
            continue
        known.append(physical)
        mesh.add(kind, order, nodes, entity, physical, number)
    lines.end()
    periodic22(found.get("Periodic"), places)
    return mesh


def place(numbers, places):
    refuse_unless(all(number in places for number in numbers), "a node that there is not")
    return tuple(places[number] for number in numbers)


def periodic22(lines, places):
    if lines is None:
        return
    for _ in range(integer(lines.row(1)[0], 0)):
        dimension, slave, master = lines.row(3)
        integer(dimension, 0, 3), integer(slave), integer(master)
        words = lines.row()
        if words[0] == "Affine":
            [real(word) for word in words[1:]]
            words = lines.row(1)
        refuse_unless(len(words) == 1, "no count of nodes")
        for _ in range(integer(words[0], 0)):
            place([integer(word) for word in lines.row(2)], places)
    lines.end()


def version41(found):
    mesh, places = Mesh(), {}
    refuse_unless("PartitionedEntities" not in found, "a partitioned mesh, which this parser does not know")
    entities(found.get("Entities"))
    lines = found["Nodes"]
    blocks, announced, _, _ = [integer(word, 0, 2**64 - 1) for word in lines.row(4)]
    for _ in range(blocks):
        dimension, entity, parametric, count = lines.row(4)
        dimension, parametric = integer(dimension, 0, 3), integer(parametric)
        integer(entity, -(2**31), 2**31 - 1)
        numbers = [integer(lines.row(1)[0], 1, 2**64 - 1) for _ in range(integer(count, 0))]
        for number in numbers:
            refuse_unless(number not in places, f"two nodes {number}")
            places[number] = len(mesh.points)
            row = [real(x) for x in lines.row(3 + (dimension if parametric else 0))]
            mesh.points.append(row[:3])
    lines.end()
    refuse_unless(announced == len(mesh.points), "another number of nodes than announced")
    lines, found_elements = found["Elements"], 0
    blocks, announced, _, _ = [integer(word, 0, 2**64 - 1) for word in lines.row(4)]
    for _ in range(blocks):
        dimension, entity, code, count = [integer(word) for word in lines.row(4)]
        refuse_unless(code in TYPES and KINDS[TYPES[code][0]][1] == dimension, "elements of another dimension")
        refuse_unless(-(2**31) <= entity < 2**31, "an entity's tag")
        kind, order = TYPES[code]
        found_elements += count
        for _ in range(count):
            number, *nodes = [integer(word, 0, 2**64 - 1) for word in lines.row(1 + KINDS[kind][2][order - 1])]
            mesh.add(kind, order, place(nodes, places), entity, None, number)
    lines.end()
    refuse_unless(announced == found_elements, "another number of elements than announced")
    return mesh


def entities(lines):
    if lines is None:
        return
    counts = [integer(word, 0) for word in lines.row(4)]
    for dimension, count in enumerate(counts):
        for _ in range(count):
            words = lines.row()
            box = 3 if dimension == 0 else 6
            integer(words[0], -(2**31), 2**31 - 1)
            refuse_unless(len(words) > 1 + box, "an entity without its box")
            refuse_unless(all(isfinite(real(word)) for word in words[1 : 1 + box]), "a box that is not finite")
            rest = words[1 + box :]
            for _ in range(1 if dimension == 0 else 2):
                refuse_unless(rest, "an entity's counts are missing")
                listed = integer(rest[0], 0)
                refuse_unless(len(rest) > listed, "an entity's tags are missing")
                [integer(word, -(2**31), 2**31 - 1) for word in rest[1 : 1 + listed]]
                rest = rest[1 + listed :]
            refuse_unless(not rest, "more on an entity's line than announced")
    lines.end()
