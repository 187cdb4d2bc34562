"""One block to one VTU file and back: binary, zlib, appended, every array to the bit.

meshio can write such files too, and a test reads these with it. It is not used because it drops field data,
where the display factor belongs, and not for its speed alone. Measured on the ring of 240 elements with
random fields (1440 nodes, 16 doubles each): 4.9 ms and 226 kB a frame with meshio and zlib, 1.5 ms and 173 kB
here; without compression meshio takes 0.6 ms and 275 kB, which is over 50 MB for 200 frames.
"""

from __future__ import annotations

import zlib
from collections.abc import Iterable, Mapping
from dataclasses import dataclass, field
from html import escape
from pathlib import Path
from typing import Any
from xml.etree import ElementTree

import numpy as np

from .fields import NODES, AnyArray, Block, SeriesError

_TYPES: dict[str, np.dtype[Any]] = {
    "Float64": np.dtype("<f8"),
    "Float32": np.dtype("<f4"),
    "Int64": np.dtype("<i8"),
    "Int32": np.dtype("<i4"),
    "UInt8": np.dtype("u1"),
    "Int8": np.dtype("i1"),
}
_NAMES = {dtype: name for name, dtype in _TYPES.items()}
BLOCK, UNIT = "block: ", "unit of "
"""How the names of fields begin that say what a file holds."""

_COMPONENTS = {"stress": ("xx", "yy", "xy")}
_HEAD = b'<?xml version="1.0"?>\n<VTKFile type="UnstructuredGrid" version="1.0" byte_order="LittleEndian"'
_MARK = b'<AppendedData encoding="raw">\n_'
_TAIL = b"\n</AppendedData>\n</VTKFile>\n"
_HEADER = 16  # bytes in front of an array: blocks, their size, that of the last one, that of its code


@dataclass
class Encoder:
    """Blocks to bytes; remembers the code of words, and of connectivities that nobody can write to."""

    #: of zlib: only runs of one byte are looked for. In doubles there is little else; to look for that too takes twice
    #: the time and makes a file 5 % smaller, and higher levels save nothing on their low bits
    strategy: int = zlib.Z_RLE
    _kept: dict[int, tuple[AnyArray, list[tuple[str, bytes]]]] = field(default_factory=dict)
    _words: dict[str, tuple[str, bytes]] = field(default_factory=dict)

    def encode(self, block: Block, time: float, name: str = "", units: Mapping[str, str] | None = None) -> bytes:
        """The bytes of the VTU file of ``block``, with its time as VTK's field ``TimeValue``.

        What opens the file alone finds there too which block it is, ``block: ring``, and the unit of each field that
        ``units`` has, ``unit of stress: m g/R²``: words as names of fields, each with the number 1, as not every reader
        of VTU takes words for values.
        """
        parts: list[bytes] = []
        offset = 0

        # meshio looks an array up by its offset, having moved those before it to where they are in base64, unpacked:
        # one that begins at such a place would be taken for the other
        moved, taken = 0, set[int]()

        def add(items: Iterable[tuple[str, bytes]]) -> str:
            nonlocal offset, moved
            lines = []
            for attributes, code in items:
                taken.add(moved)
                moved += 4 * -(-(4 + int.from_bytes(code[4:8], "little")) // 3)
                flushes = 0
                while offset + len(code) in taken:
                    flushes += 1
                    code = _coded(zlib.decompress(code[_HEADER:]), self.strategy, flushes)
                lines.append(f'<DataArray {attributes} format="appended" offset="{offset}"/>')
                parts.append(code)
                offset += len(code)
            return "\n".join(lines)

        known = {field: (units or {}).get(field, "") for field in (*block.point_data, *block.cell_data)}
        words = [
            f"{BLOCK}{name}" if name else "",
            *(f"{UNIT}{field}: {unit}" if unit else "" for field, unit in known.items()),
        ]
        values = {"TimeValue": np.array([time]), **block.field_data}
        header = "\n".join(
            [
                ' header_type="UInt32" compressor="vtkZLibDataCompressor">',
                "<UnstructuredGrid>",
                "<FieldData>",
                add(self._array(name, v, _tuples(v)) for name, v in values.items()),
                add(self._word(word) for word in words if word),
                "</FieldData>",
                f'<Piece NumberOfPoints="{len(block.points)}" NumberOfCells="{len(block.cells)}">',
                "<PointData>",
                add(self._array(name, v) for name, v in block.point_data.items()),
                "</PointData>",
                "<CellData>",
                add(self._array(name, v) for name, v in block.cell_data.items()),
                "</CellData>",
                "<Points>",
                add([self._array("Points", block.points)]),
                "</Points>",
                "<Cells>",
                add(self._cells(block)),
                "</Cells>",
                "</Piece>",
                "</UnstructuredGrid>",
                "",
            ]
        )
        return b"".join([_HEAD, header.encode(), _MARK, *parts, _TAIL])

    def _array(self, name: str, value: AnyArray, more: str = "") -> tuple[str, bytes]:
        dtype = value.dtype.newbyteorder("<")
        if dtype not in _NAMES:
            raise SeriesError(f"field {name} holds {value.dtype}, which a VTU file does not.")
        if value.ndim == 2:  # one number each is what VTK takes where none is said; of one column meshio makes (n, 1)
            more = f'NumberOfComponents="{value.shape[1]}" {more}'
        for i, component in enumerate(_COMPONENTS.get(name, ())):
            more += f' ComponentName{i}="{component}"'
        attributes = f'type="{_NAMES[dtype]}" Name="{escape(name)}" {more}'
        return attributes, _coded(np.ascontiguousarray(value, dtype=dtype).tobytes(), self.strategy)

    def _word(self, word: str) -> tuple[str, bytes]:
        if word not in self._words:
            one = np.ones(1)
            self._words[word] = self._array(word, one, _tuples(one))
        return self._words[word]

    def _cells(self, block: Block) -> list[tuple[str, bytes]]:
        kept = self._kept.get(id(block.cells))
        if kept is None or kept[0] is not block.cells:
            count, width = block.cells.shape
            code = [
                self._array("connectivity", block.cells.astype("<i8").ravel()),
                self._array("offsets", np.arange(1, count + 1, dtype="<i8") * width),
                self._array("types", np.full(count, block.cell_type, dtype="u1")),
            ]
            if block.cells.flags.writeable:
                return code
            if len(self._kept) > 16:
                self._kept.clear()
            kept = self._kept[id(block.cells)] = (block.cells, code)
        return kept[1]


def _coded(raw: bytes, strategy: int, flushes: int = 0) -> bytes:
    """A header and a zlib stream, flushed behind each of some first bytes: longer, it says no more."""
    packer = zlib.compressobj(1, strategy=strategy)
    begun = b"".join(packer.compress(raw[i : i + 1]) + packer.flush(zlib.Z_SYNC_FLUSH) for i in range(flushes))
    code = begun + packer.compress(raw[flushes:]) + packer.flush()
    return np.array([1, len(raw), len(raw), len(code)], dtype="<u4").tobytes() + code


def _tuples(value: AnyArray) -> str:
    return f'NumberOfTuples="{len(value)}"'


def read_vtu(path: Path) -> Block:
    """The block of a file that :class:`Encoder` made, bit for bit.

    Raises
    ------
    SeriesError
        A file that is missing, damaged, or was written by something else.
    """
    try:
        content = path.read_bytes()
    except OSError as error:
        raise SeriesError(f"{path} cannot be read: {error.strerror}.") from None
    head, mark, data = content.partition(_MARK)
    if not head.startswith(_HEAD) or not mark:
        raise SeriesError(f"{path} is not a frame of a hoop-pulse series (zlib VTU with raw appended data).")
    if not data.endswith(_TAIL):
        raise SeriesError(f"{path} is damaged: it ends too early.")
    try:
        return _decode(ElementTree.fromstring(head + b"</VTKFile>"), data)
    except SeriesError as error:
        raise SeriesError(f"{path} is damaged: {error}") from None
    except (ElementTree.ParseError, zlib.error, KeyError, ValueError, TypeError, AttributeError, IndexError):
        raise SeriesError(f"{path} is damaged: its arrays do not decode.") from None


def _decode(root: ElementTree.Element, data: bytes) -> Block:
    def arrays(tag: str) -> dict[str, AnyArray]:
        parent = root.find(f".//{tag}")
        items = [] if parent is None else list(parent)
        return {item.attrib["Name"]: _decode_array(item.attrib, data) for item in items}

    cells = arrays("Cells")
    cell_type = int(cells["types"][0])
    values = arrays("FieldData")
    for label in [name for name in values if name == "TimeValue" or name.startswith((BLOCK, UNIT))]:
        del values[label]
    return Block(
        points=arrays("Points")["Points"],
        cells=cells["connectivity"].reshape(-1, NODES[cell_type]),
        cell_type=cell_type,
        point_data=arrays("PointData"),
        cell_data=arrays("CellData"),
        field_data=values,
    )


def _decode_array(attributes: Mapping[str, str], data: bytes) -> AnyArray:
    start = int(attributes["offset"])
    blocks, size, _, packed = (int(v) for v in np.frombuffer(data, "<u4", 4, start))
    raw = zlib.decompress(data[start + _HEADER : start + _HEADER + packed])
    if blocks != 1 or len(raw) != size:
        raise ValueError("wrong length")
    flat = np.frombuffer(raw, _TYPES[attributes["type"]])
    columns = int(attributes.get("NumberOfComponents", 1))
    return flat.reshape(-1, columns) if columns > 1 else flat
