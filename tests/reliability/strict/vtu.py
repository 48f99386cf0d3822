"""VTU (docs.vtk.org, "VTK XML formats"): text, and appended raw or base64, plain or by zlib."""

import base64
import binascii
import re
import struct
import xml.etree.ElementTree as xml
import zlib

from .mesh import Mesh, integer, real, refuse_unless
from .vtk import add_cells

NUMBERS = {"Int8": "b", "UInt8": "B", "Int16": "h", "UInt16": "H", "Int32": "i", "UInt32": "I", "Int64": "q", "UInt64": "Q", "Float32": "f", "Float64": "d"}
LAGRANGE_HEX = 72


def read(content, _):
    appended, raw = b"", False
    start = content.find(b"<AppendedData")
    if start >= 0:
        tag = content.find(b">", start)
        mark = content.find(b"_", tag)
        refuse_unless(tag >= 0 and mark >= 0, "appended data without a beginning")
        appended, raw = content[mark + 1 :], b'"raw"' in content[start:tag]
        content = content[:start] + b"</VTKFile>"
    # Python does not know every encoding that a damaged declaration may name, and nothing that is used is not ASCII.
    content = re.sub(rb"""\A(<\?xml version=(?:"1\.[01]"|'1\.[01]'))\s+encoding=(?:"[!-~]*"|'[!-~]*')(\s*\?>)""", rb"\1\2", content)
    try:
        root = xml.fromstring(content)
    except (xml.ParseError, LookupError, ValueError) as error:
        refuse_unless(False, f"no XML: {error}")
    refuse_unless(root.tag == "VTKFile" and root.get("type") == "UnstructuredGrid", "no unstructured grid")
    refuse_unless(root.get("compressor") in (None, "vtkZLibDataCompressor"), "a compressor that this parser does not know")
    refuse_unless(root.get("byte_order") in (None, "LittleEndian", "BigEndian"), "an order of bytes that is none")
    refuse_unless(root.get("header_type") in (None, "UInt32", "UInt64"), "lengths that are none")
    version = root.get("version")
    refuse_unless(version is None or re.match(r"\s*[0-9]+(\.[0-9]+)?\s*\Z", version), "a version that is none")
    order = {None: None, "LittleEndian": "<", "BigEndian": ">"}[root.get("byte_order")]
    file = (order, "Q" if root.get("header_type") == "UInt64" else "I", root.get("compressor"), appended, raw)
    for tag in ("VTKFile", "UnstructuredGrid", "Piece", "Points", "Cells", "CellData", "PointData"):
        for element in root.iter(tag):
            between = (element.text or "") + "".join(child.tail or "" for child in element)
            refuse_unless(not between.strip(), "text between tags")
    pieces = root.findall("./UnstructuredGrid/Piece")
    refuse_unless(len(pieces) == 1, "not one piece")
    piece = pieces[0]
    counts = [integer(piece.get(name, "").strip(), 0) for name in ("NumberOfPoints", "NumberOfCells")]
    mesh = Mesh()
    points = piece.findall("./Points/DataArray")
    refuse_unless(len(points) == 1 and points[0].get("NumberOfComponents") == "3", "points")
    flat = [float(x) for x in values(points[0], file, real)]
    refuse_unless(len(flat) == 3 * counts[0], "another number of points than announced")
    mesh.points = [flat[n : n + 3] for n in range(0, len(flat), 3)]
    arrays = {}
    for array in piece.findall("./Cells/DataArray"):
        refuse_unless(array.get("Name") not in arrays, "an array of cells twice")
        arrays[array.get("Name")] = values(array, file, integer)
    refuse_unless({"connectivity", "offsets", "types"} <= set(arrays), "an array of cells is missing")
    refuse_unless(len(arrays["types"]) == counts[1], "another number of cells than announced")
    entities = None
    for array in piece.findall("./CellData/DataArray"):
        if array.get("Name") == "CellEntityIds" and array.get("NumberOfComponents", "1") == "1":
            refuse_unless(entities is None, "CellEntityIds twice")
            entities = values(array, file, integer)
    # The order of a Lagrange hex' nodes changed with version 2.1.
    refuse_unless(version is not None or LAGRANGE_HEX not in arrays["types"], "hexes without a version")
    add_cells(mesh, arrays["connectivity"], arrays["offsets"], arrays["types"], entities)
    return mesh


def values(array, file, parse):
    kind, form = array.get("type"), array.get("format")
    refuse_unless(kind in NUMBERS, f"numbers of type {kind}")
    if form == "ascii":
        return [parse(word) for word in (array.text or "").split()]
    refuse_unless(form == "appended", f"the form {form}")
    order, header, compressor, appended, raw = file
    refuse_unless(order, "bytes without their order")
    start = integer(array.get("offset", "").strip(), 0)
    refuse_unless(start <= len(appended), "an offset beyond the file")
    data = block(appended[start:], order, header, compressor, raw)
    size = struct.calcsize(NUMBERS[kind])
    refuse_unless(len(data) % size == 0, "a part of a number")
    found = struct.unpack(f"{order}{len(data) // size}{NUMBERS[kind]}", data)
    if parse is integer:
        refuse_unless(all(value == int(value) for value in found if value == value), "no whole number")
        refuse_unless(all(value == value for value in found), "no number")
        return [int(value) for value in found]
    return found


class Stream:
    """Bytes from the front, out of base64 where need be; each part of base64 has an end of its own."""

    def __init__(self, content, raw):
        self.content, self.raw = content, raw

    def take(self, count):
        refuse_unless(count <= len(self.content), "the data end early")
        if self.raw:
            taken, self.content = self.content[:count], self.content[count:]
            return taken
        letters = 4 * ((count + 2) // 3)
        try:
            taken = base64.b64decode(self.content[:letters], validate=True)
        except binascii.Error as error:
            refuse_unless(False, f"no base64: {error}")
        self.content = self.content[letters:]
        refuse_unless(len(taken) == count, "the data end early")
        return taken


def block(content, order, header, compressor, raw):
    width = struct.calcsize(header)
    if compressor is None:
        peek = Stream(content, raw).take(width) if raw else base64_head(content, width)
        length = struct.unpack(order + header, peek)[0]
        refuse_unless(length <= len(content), "the data end early")
        return Stream(content, raw).take(width + length)[width:]
    blocks = struct.unpack(order + header, Stream(content, raw).take(width) if raw else base64_head(content, width))[0]
    refuse_unless(blocks <= len(content), "more blocks than bytes")
    stream = Stream(content, raw)
    words = struct.unpack(f"{order}{3 + blocks}{header}", stream.take(width * (3 + blocks)))
    size, last, lengths = words[1], words[2], words[3:]
    packed, data = stream.take(sum(lengths)), b""
    for n, length in enumerate(lengths):
        expander = zlib.decompressobj()
        try:
            part = expander.decompress(packed[:length], 2**24)
        except zlib.error as error:
            refuse_unless(False, f"zlib: {error}")
        refuse_unless(expander.eof, "a block does not end")
        refuse_unless(len(part) == (last if last and n + 1 == blocks else size), "a block of another size than announced")
        data, packed = data + part, packed[length:]
    return data


def base64_head(content, width):
    try:
        head = base64.b64decode(content[: 4 * ((width + 2) // 3)], validate=False)
    except binascii.Error as error:
        refuse_unless(False, f"no base64: {error}")
    refuse_unless(len(head) >= width, "no base64")
    return head[:width]
