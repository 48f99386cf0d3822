"""UGRID as text and as bytes (simcenter.msstate.edu, "AFLR3 file formats"): the name's ending says how numbers are written."""

import struct

from .mesh import Mesh, Refused, integer, real, refuse_unless, split

CELLS = (("tet", 4), ("pyramid", 5), ("prism", 6), ("hex", 8))


class Bytes:
    def __init__(self, content, word):
        self.content, self.at = content, 0
        self.order = "<" if word.startswith("l") else ">"
        word = word.removeprefix("l")
        self.long = word.endswith("l")
        word = word.removesuffix("l")
        self.records, self.real = word[0] == "r", {"8": "d", "4": "f"}[word[1]]

    def take(self, count, code):
        form = f"{self.order}{count}{code}"
        end = self.at + struct.calcsize(form)
        refuse_unless(end <= len(self.content), "the file ends early")
        values = struct.unpack(form, self.content[self.at : end])
        self.at = end
        return values

    def integers(self, count):
        # No count of a small file is larger, and none may be asked of `struct`.
        refuse_unless(0 <= count <= len(self.content), "a count that the file cannot hold")
        return self.take(count, "q" if self.long else "i")

    def reals(self, count):
        refuse_unless(0 <= count <= len(self.content), "a count that the file cannot hold")
        return self.take(count, self.real)

    def record(self):
        return self.take(1, "I")[0] if self.records else None

    def rest(self):
        return len(self.content) - self.at


class Words:
    def __init__(self, content):
        self.words, self.at = split(content.decode("latin-1")), 0

    def take(self, count, parse):
        refuse_unless(0 <= count <= len(self.words) - self.at, "the file ends early")
        self.at += count
        return [parse(word) for word in self.words[self.at - count : self.at]]

    def integers(self, count):
        return self.take(count, integer)

    def reals(self, count):
        return self.take(count, lambda word: real(word, "eEdD"))

    def record(self):
        return None

    def rest(self):
        return len(self.words) - self.at


def read(content, path):
    parts = path.rsplit("/", 1)[-1].split(".")
    source = Bytes(content, parts[-2]) if len(parts) > 2 else Words(content)
    length = source.record()
    points, triangles, quads, *cells = source.integers(7)
    if length is not None:
        refuse_unless(length == source.at - 4 and source.record() == length, "the first record")
        length, start = source.record(), source.at
    refuse_unless(points > 0 and min(triangles, quads, *cells) >= 0, "counts")
    mesh = Mesh()
    values = source.reals(3 * points)
    mesh.points = [values[3 * n : 3 * n + 3] for n in range(points)]
    triangles, quads = rows(source, triangles, 3), rows(source, quads, 4)
    surfaces = source.integers(len(triangles) + len(quads))
    refuse_unless(all(0 < surface < 2**31 for surface in surfaces), "a surface's number")
    for face, surface in zip(triangles + quads, surfaces):
        mesh.add("triangle" if len(face) == 3 else "quad", 1, face, surface)
    for (kind, corners), count in zip(CELLS, cells):
        for nodes in rows(source, count, corners):
            mesh.add(kind, 1, nodes, 1)
    if length is not None:
        refuse_unless(length == source.at - start and source.record() == length, "the second record")
    if source.rest():
        raise Refused("more than the counts announce")
    return mesh


def rows(source, count, corners):
    values = source.integers(count * corners)
    return [tuple(value - 1 for value in values[corners * n : corners * (n + 1)]) for n in range(count)]
