"""What a parser finds in a file: points, elements by kind and entity; the checks that all formats have in common."""

import math
import re
from collections import Counter, defaultdict

# Corners and dimension of each kind; nodes by order.
KINDS = {
    "point": (1, 0, [1, 1, 1, 1]),
    "line": (2, 1, [2, 3, 4, 5]),
    "triangle": (3, 2, [3, 6, 10, 15]),
    "quad": (4, 2, [4, 9, 16, 25]),
    "tet": (4, 3, [4, 10, 20, 35]),
    "pyramid": (5, 3, [5, 14, 30, 55]),
    "prism": (6, 3, [6, 18, 40, 75]),
    "hex": (8, 3, [8, 27, 64, 125]),
}


class Refused(Exception):
    """The file is not what it says of itself."""


def refuse_unless(holds, why):
    if not holds:
        raise Refused(why)


# White space of ASCII, which alone stands between words.
split = re.compile(r"[^ \t\r\n\f]+").findall

INTEGER = re.compile(r"[+-]?[0-9]+\Z")
REAL = re.compile(r"[+-]?([0-9]+\.?[0-9]*|\.[0-9]+)([eE][+-]?[0-9]+)?\Z")


def integer(word, least=-(2**63), most=2**63 - 1):
    refuse_unless(INTEGER.match(word), f"{word!r} is no integer")
    value = int(word)
    refuse_unless(least <= value <= most, f"{word} is out of range")
    return value


def real(word, exponents="eE"):
    if "D" in exponents:
        word = word.replace("D", "E").replace("d", "e")  # Fortran's
    refuse_unless(REAL.match(word), f"{word!r} is no number")
    return float(word)


class Mesh:
    def __init__(self):
        self.points = []
        self.order = None
        self.elements = []  # kind, nodes from 0, entity, physical group or None, number or None

    def add(self, kind, order, nodes, entity, group=None, number=None):
        refuse_unless(len(nodes) == KINDS[kind][2][order - 1], f"a {kind} of {len(nodes)} nodes")
        refuse_unless(all(0 <= node < len(self.points) for node in nodes), "a node that there is not")
        if kind != "point":
            refuse_unless(self.order in (None, order), "two orders in one mesh")
            self.order = order
        self.elements.append((kind, tuple(nodes), entity, group, number))

    def check(self):
        refuse_unless(all(math.isfinite(x) for point in self.points for x in point), "a coordinate is not finite")
        dimension = max((KINDS[kind][1] for kind, *_ in self.elements), default=0)
        numbers, corners = defaultdict(set), defaultdict(set)
        for kind, nodes, entity, group, number in self.elements:
            own = KINDS[kind][1]
            if own == 0:
                continue
            if number is not None:
                refuse_unless(number not in numbers[own], f"two elements {number} of one dimension")
                numbers[own].add(number)
            patch = None if own == dimension else (entity, group)
            key = (kind, tuple(sorted(nodes[: KINDS[kind][0]])))
            refuse_unless(patch not in corners[key], "an element is there twice")
            corners[key].add(patch)

    def figures(self):
        """As `account.rs`: what neither the order of elements nor that of an element's nodes changes; with the size of the terms."""
        kinds, entities = defaultdict(lambda: [0, 0.0, 0.0, 0.0]), Counter()
        for kind, nodes, entity, _, _ in self.elements:
            if kind == "point":
                continue
            x, y, z = (sum(self.points[node][axis] for node in nodes) for axis in range(3))
            own = kinds[kind]
            own[0] += 1
            own[1] += x + 2 * y + 3 * z
            own[2] += x * x + y * y + z * z
            own[3] += abs(x) + 2 * abs(y) + 3 * abs(z)
            entities[KINDS[kind][1], entity] += 1
        sums = [sum(point[axis] for point in self.points) for axis in range(3)]
        size = sum(abs(x) for point in self.points for x in point)
        sizes = sorted(f"{dimension}:{count}" for (dimension, _), count in entities.items())
        return self.order or 1, len(self.points), sums, size, dict(kinds), sizes
