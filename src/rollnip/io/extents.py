"""Extents of the cells of a workbook, found before anything is built from it.

A reader of workbooks makes a rectangle of cells from the first to the last: two cells in opposite
corners of a sheet are 1.7e10. The files are scanned for the places of their cells alone:

- .xlsx: ``r="B12"`` of cells and ``r="12"`` of rows (ECMA-376 part 1, 18.3.1.4 and 18.3.1.73);
- .ods: cells and rows in order, each repeated so many times (OpenDocument 1.3, part 3, 9.1);
- .xlsb: records of rows and cells ([MS-XLSB] 2.1.4, 2.4.711);
- .xls: records of cells ([MS-XLS] 2.4) in a compound file ([MS-CFB] 2).
"""

from __future__ import annotations

import io
import re
from collections.abc import Iterator
from dataclasses import dataclass
from struct import error as StructError
from struct import unpack_from
from xml.parsers import expat
from zipfile import BadZipFile, ZipFile
from zlib import error as ZlibError

from rollnip.io.compound import workbook_stream

_UNPACKED = 256 * 2**20  # bytes of all parts of a workbook together
_CHUNK = 2**20
_LONGEST_TAG = 2**12
_TAG = re.compile(rb"<(?:\w+:)?(row|c)(?=[\s/>])([^>]*)")
_PLACE = re.compile(rb"\sr\s*=\s*[\"']([A-Za-z]{0,4})(\d{1,9})[\"']")
_XLSB_ROW, _XLSB_CELLS = 0, range(1, 12)
# NUMBER, LABEL, RK, LABELSST, FORMULA, BOOLERR, MULRK, RSTRING; of 1997 and before
_XLS_CELLS = {0x203, 0x204, 0x27E, 0xFD, 0x06, 0x205, 0xBD, 0xD6, 0x03, 0x04, 0x02, 0x05, 0x206}


class BrokenWorkbookError(Exception):
    """An error in a workbook; its text is the end of a sentence."""


@dataclass(slots=True)
class Extent:
    """The extent of one sheet: its last row and column, and the number of cells."""

    rows: int = 0
    columns: int = 0
    filled: int = 0

    def add(self, row: int, column: int, count: int = 1) -> None:
        """Take in ``count`` cells, the last of them in this row and column, counted from 1."""
        self.rows, self.columns = max(self.rows, row), max(self.columns, column)
        self.filled += count


def extents(data: bytes, suffix: str) -> Iterator[Extent]:
    """The extent of each sheet of a workbook; of an .xls one for all sheets together.

    Raises
    ------
    BrokenWorkbookError
        where it is no such workbook, is damaged or unpacks to more than 256 MiB.
    """
    try:
        if suffix == ".xls" and not data.startswith(b"PK"):
            yield _xls(workbook_stream(data))
            return
        yield from _packed(data)
    except (BadZipFile, ZlibError, EOFError, NotImplementedError, RuntimeError) as error:
        raise BrokenWorkbookError(f"{error}") from None
    except (StructError, IndexError, ValueError, expat.ExpatError) as error:
        raise BrokenWorkbookError(f"it is damaged ({error})") from None


def _packed(data: bytes) -> Iterator[Extent]:
    left = _UNPACKED
    with ZipFile(io.BytesIO(data)) as book:
        for part in book.infolist():
            left -= part.file_size
            if left < 0:
                raise BrokenWorkbookError(f"it unpacks to more than {_UNPACKED >> 20} MiB")
            # Read whole, whatever it is: zipfile then refuses a size or a checksum that lies.
            with book.open(part) as stream:
                chunks = iter(lambda: stream.read(_CHUNK), b"")
                if part.filename == "content.xml":
                    yield from _ods(chunks)
                elif re.fullmatch(r"/?xl/worksheets/[^/]+\.xml", part.filename, re.IGNORECASE):
                    yield _xlsx(chunks)
                elif re.fullmatch(r"/?xl/worksheets/[^/]+\.bin", part.filename, re.IGNORECASE):
                    yield _xlsb(b"".join(chunks))
                for _ in chunks:
                    pass


def _xlsx(chunks: Iterator[bytes]) -> Extent:
    """Cells in order; a row or a cell that does not say its place follows the one before."""
    extent, row, column = Extent(), 0, 0
    for name, attributes in _tags(chunks):
        place = _PLACE.search(attributes)
        if name == b"row":
            row, column = int(place[2]) if place else row + 1, 0
            continue
        column += 1
        if place:
            row, column = int(place[2]), _column(place[1])
        if not attributes.endswith(b"/"):  # else it is empty, and only has a format
            extent.add(row, column)
    return extent


def _tags(chunks: Iterator[bytes]) -> Iterator[tuple[bytes, bytes]]:
    """Name and attributes of the tags of rows and cells."""
    rest = b""
    for chunk in chunks:
        text = rest + chunk
        # What may be the beginning of a tag waits for the next chunk.
        cut = max(text.rfind(b"<"), len(text) - _LONGEST_TAG) if b"<" in text else len(text)
        yield from _TAG.findall(text[:cut])
        rest = text[cut:]
    yield from _TAG.findall(rest)


def _column(letters: bytes) -> int:
    number = 0
    for letter in letters.upper():
        number = 26 * number + letter - 64
    return number


def _ods(chunks: Iterator[bytes]) -> Iterator[Extent]:
    found: list[Extent] = []
    place = {"row": 0, "repeat": 1, "column": 0, "filled": 0, "last": 0}

    def start(name: str, attributes: dict[str, str]) -> None:
        kind = name.rpartition(":")[2]
        if kind == "table":
            found.append(Extent())
            place.update(row=0)
        elif kind == "table-row":
            repeat = int(attributes.get("table:number-rows-repeated", 1))
            place.update(repeat=repeat, column=0, filled=0, last=0)
        elif kind in ("table-cell", "covered-table-cell"):
            count = int(attributes.get("table:number-columns-repeated", 1))
            place["column"] += count
            if any(name.endswith((":value-type", ":formula")) for name in attributes):
                place["filled"] += 1
                place["last"] = place["column"]

    def end(name: str) -> None:
        if name.rpartition(":")[2] == "table-row" and found:
            place["row"] += place["repeat"]
            if place["last"]:
                found[-1].add(place["row"], place["last"], place["filled"])

    parser = expat.ParserCreate()
    parser.StartElementHandler, parser.EndElementHandler = start, end
    for chunk in chunks:
        parser.Parse(chunk)
    parser.Parse(b"", True)
    yield from found


def _xlsb(data: bytes) -> Extent:
    extent, row, at = Extent(), 0, 0
    while at < len(data):
        kind, at = _variable(data, at, 2)
        size, at = _variable(data, at, 4)
        if kind == _XLSB_ROW:
            row = unpack_from("<I", data, at)[0] + 1
        elif kind in _XLSB_CELLS:
            extent.add(row, unpack_from("<I", data, at)[0] + 1)
        at += size
    return extent


def _variable(data: bytes, at: int, most: int) -> tuple[int, int]:
    """A number of seven bits a byte, and the place behind it."""
    value = 0
    for i in range(most):
        byte = data[at]
        at += 1
        value |= (byte & 0x7F) << 7 * i
        if byte < 0x80:
            break
    return value, at


def _xls(data: bytes) -> Extent:
    extent, at = Extent(), 0
    while at + 4 <= len(data):
        kind, size = unpack_from("<HH", data, at)
        if kind in _XLS_CELLS and size >= 4:
            row, column = unpack_from("<HH", data, at + 4)
            count = 1
            if kind == 0xBD:  # several cells of one row; the last two bytes are the last column
                last = unpack_from("<H", data, at + 2 + size)[0]
                count, column = max(1, last - column + 1), max(last, column)
            extent.add(row + 1, column + 1, count)
        at += 4 + size
    return extent
