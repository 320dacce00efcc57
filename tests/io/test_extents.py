"""Workbooks are scanned for the places of their cells before anything is built from them."""

import io
import struct
import tracemalloc
import zipfile

import pytest

from rollnip._errors import InvalidInputError
from rollnip.io import read_columns
from rollnip.io.columns import MOST_CELLS
from rollnip.io.extents import BrokenWorkbookError, Extent, extents

calamine = pytest.importorskip("python_calamine")

MAIN = "http://schemas.openxmlformats.org/spreadsheetml/2006/main"
RELATIONS = "http://schemas.openxmlformats.org/officeDocument/2006/relationships"
PACKAGE = "http://schemas.openxmlformats.org/package/2006"
ODF = "urn:oasis:names:tc:opendocument:xmlns:"


def packed(parts: dict[str, str | bytes]) -> bytes:
    target = io.BytesIO()
    with zipfile.ZipFile(target, "w", zipfile.ZIP_DEFLATED) as archive:
        for name, text in parts.items():
            archive.writestr(name, text)
    return target.getvalue()


def xlsx(rows: str) -> bytes:
    """A workbook of one sheet, its rows as XML."""
    sheet = f'<worksheet xmlns="{MAIN}"><sheetData>{rows}</sheetData></worksheet>'
    book = (
        f'<workbook xmlns="{MAIN}" xmlns:r="{RELATIONS}"><sheets>'
        '<sheet name="one" sheetId="1" r:id="rId1"/></sheets></workbook>'
    )
    link = f'<Relationships xmlns="{PACKAGE}/relationships"><Relationship Id="rId1" Type="{{}}" '
    return packed(
        {
            "xl/worksheets/sheet1.xml": sheet,
            "xl/workbook.xml": book,
            "xl/_rels/workbook.xml.rels": link.format(f"{RELATIONS}/worksheet")
            + 'Target="worksheets/sheet1.xml"/></Relationships>',
            "_rels/.rels": link.format(f"{RELATIONS}/officeDocument")
            + 'Target="xl/workbook.xml"/></Relationships>',
        }
    )


def ods(rows: str) -> bytes:
    names = "".join(f' xmlns:{name}="{ODF}{name}:1.0"' for name in ("office", "table", "text"))
    content = (
        f"<office:document-content{names}><office:body><office:spreadsheet>"
        f'<table:table table:name="one">{rows}</table:table>'
        "</office:spreadsheet></office:body></office:document-content>"
    )
    kind = "application/vnd.oasis.opendocument.spreadsheet"
    manifest = f'<manifest:manifest xmlns:manifest="{ODF}manifest:1.0"/>'
    return packed({"mimetype": kind, "content.xml": content, "META-INF/manifest.xml": manifest})


def xls(cells: list[tuple[int, int, float]]) -> bytes:
    """A workbook of 1997 by hand: records in a compound file of sectors of 512 bytes."""

    def record(kind: int, body: bytes = b"") -> bytes:
        return struct.pack("<HH", kind, len(body)) + body

    def begin(kind: int) -> bytes:
        return record(0x809, struct.pack("<HHHHII", 0x600, kind, 0, 0, 0, 0))

    end = record(0x0A)
    name = b"\x03\x00one"
    head = begin(5)
    at = len(head) + 4 + 6 + len(name) + len(end)
    head += record(0x85, struct.pack("<IBB", at, 0, 0) + name) + end
    numbers = [record(0x203, struct.pack("<HHHd", row, column, 0, v)) for row, column, v in cells]
    stream = (head + begin(16) + b"".join(numbers) + end).ljust(4096, b"\0")
    count = len(stream) // 512
    chain = [0xFFFFFFFD, 0xFFFFFFFE, *range(3, count + 2), 0xFFFFFFFE]
    table = struct.pack("<128I", *chain, *[0xFFFFFFFF] * (128 - len(chain)))

    def entry(name: str, kind: int, first: int, size: int, child: int) -> bytes:
        text = (name + "\0").encode("utf-16-le")
        links = struct.pack("<III", 0xFFFFFFFF, 0xFFFFFFFF, child)
        return (
            text.ljust(64, b"\0")
            + struct.pack("<HBB", len(text), kind, 1)
            + links
            + bytes(36)
            + struct.pack("<III", first, size, 0)
        )

    folder = entry("Root Entry", 5, 0xFFFFFFFE, 0, 1)
    folder += entry("Workbook", 2, 2, len(stream), 0xFFFFFFFF)
    header = b"\xd0\xcf\x11\xe0\xa1\xb1\x1a\xe1" + bytes(16)
    header += struct.pack("<HHHHH", 0x3E, 3, 0xFFFE, 9, 6) + bytes(6)
    header += struct.pack("<IIIIIIIIII", 0, 1, 1, 0, 4096, 0xFFFFFFFE, 0, 0xFFFFFFFE, 0, 0)
    header += struct.pack("<108I", *[0xFFFFFFFF] * 108)
    return header + table + folder.ljust(512, b"\0") + stream


def xlsb_sheet(cells: list[tuple[int, int, float]]) -> bytes:
    out = b""
    for row, column, value in cells:
        out += bytes([0, 17]) + struct.pack("<I", row) + bytes(13)
        out += bytes([5, 16]) + struct.pack("<IId", column, 0, value)
    return bytes([0x91, 0x01, 0]) + out


def rectangle(data: bytes) -> tuple[int, int]:
    """What the reader of workbooks makes of it."""
    sheet = calamine.CalamineWorkbook.from_filelike(io.BytesIO(data)).get_sheet_by_index(0)
    return sheet.end[0] + 1, sheet.end[1] + 1


XLSX_ROWS = (
    '<row r="2"><c r="B2"><v>1</v></c><c><v>2</v></c></row>'
    '<row><c/><c t="inlineStr"><is><t>r</t></is></c></row>'
    "<row r='6'><c r='D6'><v>3</v></c><c r='ZZ6' s='1'/></row>"
)
ODS_ROWS = (
    '<table:table-row table:number-rows-repeated="2"><table:table-cell/></table:table-row>'
    "<table:table-row>"
    '<table:table-cell table:number-columns-repeated="3"/>'
    '<table:table-cell office:value-type="float" office:value="1"/>'
    '<table:table-cell table:number-columns-repeated="900"/>'
    "</table:table-row>"
    '<table:table-row table:number-rows-repeated="1000000">'
    '<table:table-cell table:number-columns-repeated="1000"/></table:table-row>'
)


@pytest.mark.parametrize(
    ("data", "suffix", "extent"),
    [
        (xlsx(XLSX_ROWS), ".xlsx", Extent(6, 4, 4)),
        (ods(ODS_ROWS), ".ods", Extent(3, 4, 1)),
        (xls([(0, 0, 1.0), (4, 2, 2.0)]), ".xls", Extent(5, 3, 2)),
    ],
    ids=["xlsx", "ods", "xls"],
)
def test_the_extent_is_what_a_reader_would_build(data, suffix, extent):
    assert list(extents(data, suffix)) == [extent]
    assert rectangle(data) == (extent.rows, extent.columns)


def test_the_records_of_a_binary_sheet():
    data = packed({"xl/worksheets/sheet1.bin": xlsb_sheet([(0, 0, 1.0), (6, 300, 2.0)])})
    assert list(extents(data, ".xlsb")) == [Extent(7, 301, 2)]


def test_a_sheet_in_many_chunks_loses_no_cell():
    rows = "".join(f'<row r="{i}"><c r="A{i}"><v>{i}</v></c></row>' for i in range(1, 60_001))
    assert list(extents(xlsx(rows), ".xlsx")) == [Extent(60_000, 1, 60_000)]


FAR_APART = {
    ".xlsx": xlsx(
        '<row r="1"><c r="A1"><v>1</v></c></row>'
        '<row r="1048576"><c r="XFD1048576"><v>1</v></c></row>'
    ),
    ".ods": ods(
        '<table:table-row table:number-rows-repeated="1000000"><table:table-cell '
        'office:value-type="float" office:value="1" table:number-columns-repeated="1000"/>'
        "</table:table-row>"
    ),
    ".xls": xls([(0, 0, 1.0), (65535, 255, 2.0)]),
    ".xlsb": packed({"xl/worksheets/sheet1.bin": xlsb_sheet([(0, 0, 1.0), (1048575, 16383, 1.0)])}),
}


@pytest.mark.parametrize("suffix", FAR_APART)
def test_cells_far_apart_are_refused_before_anything_is_built(tmp_path, suffix):
    path = tmp_path / f"data{suffix}"
    path.write_bytes(FAR_APART[suffix])
    assert path.stat().st_size < 8000
    tracemalloc.start()
    try:
        with pytest.raises(InvalidInputError, match="top left of a sheet of its own"):
            read_columns(path)
        assert tracemalloc.get_traced_memory()[1] < 8e6
    finally:
        tracemalloc.stop()


def test_a_workbook_that_unpacks_to_gigabytes_is_refused():
    zeros = io.BytesIO()
    with (
        zipfile.ZipFile(zeros, "w", zipfile.ZIP_DEFLATED) as archive,
        archive.open("xl/sharedStrings.xml", "w", force_zip64=True) as part,
    ):
        for _ in range(300):
            part.write(bytes(2**20))
    assert len(zeros.getvalue()) < 2**20
    with pytest.raises(BrokenWorkbookError, match="unpacks to more than 256 MiB"):
        list(extents(zeros.getvalue(), ".xlsx"))


@pytest.mark.parametrize("suffix", [".xlsx", ".ods", ".xls"])
def test_a_damaged_workbook_is_a_clear_sentence(suffix, tmp_path):
    whole = FAR_APART[suffix]
    path = tmp_path / f"data{suffix}"
    for cut in range(1, len(whole), max(1, len(whole) // 40)):
        path.write_bytes(whole[:cut] + bytes([whole[cut] ^ 0x5A]) + whole[cut + 1 :])
        with pytest.raises(InvalidInputError):
            read_columns(path)
        path.write_bytes(whole[:cut])
        with pytest.raises(InvalidInputError):
            read_columns(path)


def test_a_text_of_too_many_cells_is_refused_before_it_is_parted(tmp_path):
    path = tmp_path / "data.csv"
    path.write_text("a,b\n" + "," * MOST_CELLS, encoding="utf-8")
    with pytest.raises(InvalidInputError, match=r"at most 4,194,304 cells"):
        read_columns(path)
