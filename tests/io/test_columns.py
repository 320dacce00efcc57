"""Tables with units in their heads."""

import re
import zipfile

import numpy as np
import pytest

from rollnip._errors import InvalidInputError
from rollnip.io import read_columns


@pytest.fixture
def table(tmp_path):
    def write(text, name="data.csv"):
        path = tmp_path / name
        path.write_text(text, encoding="utf-8")
        return path

    return write


@pytest.mark.parametrize(
    "text",
    [
        "load [kN/m],nip width [in]\n1.5,0.2\n2,1e-1\n",
        "# measured on a Monday\nload [N/mm]; nip width [mm]\n1,5;5,08\n\n2;2,54\n",
        "load\tnip width\n1.5\t0.2 in\n2 kN/m\t2.54\n",
    ],
)
def test_units_of_the_head_or_of_the_cell_are_converted(table, text):
    columns = read_columns(table(text))
    assert columns.names == ("load", "nip width")
    np.testing.assert_allclose(columns.numbers("load", "line load"), [1.5, 2.0])
    np.testing.assert_allclose(columns.numbers("nip width", "length"), [5.08, 2.54])


@pytest.mark.parametrize("encoding", ["utf-8-sig", "utf-16", "utf-16-le", "cp1252"])
def test_the_encodings_that_spreadsheets_write(tmp_path, encoding):
    path = tmp_path / "data.csv"
    path.write_bytes("load [N/mm];thickness [µm]\n1;6580\n".encode(encoding))
    assert read_columns(path).numbers("thickness", "length") == pytest.approx([6.58])


def test_a_first_line_may_say_what_parts_the_columns(table):
    columns = read_columns(table("sep=;\nx, along [mm];y\n1,5;2\n"))
    assert columns.names == ("x, along", "y")
    assert columns.lines == (3,)
    assert list(columns.numbers("x, along", "length")) == [1.5]


def test_a_path_may_head_a_column(table):
    columns = read_columns(table("upper.layers[0].thickness [in],upper.layers[0].material\n1,a\n"))
    assert columns.names == ("upper.layers[0].thickness", "upper.layers[0].material")
    assert columns.units == ("in", "")
    assert columns.numbers("upper.layers[0].thickness", "length") == pytest.approx([25.4])
    assert columns.cells("upper.layers[0].material") == ("a",)


def test_comments_are_kept_and_lines_counted(table):
    columns = read_columns(table("# roller: 7\nx [mm]\n# not this\n1\n2\n"))
    assert columns.comments == ((1, "roller: 7"), (3, "not this"))
    assert columns.lines == (4, 5)


@pytest.mark.parametrize("head", ["x [mm]", "x"])
@pytest.mark.parametrize("mark", [";", "\t"])
def test_a_decimal_comma_where_commas_part_nothing(table, head, mark):
    columns = read_columns(table(f"{head}{mark}y\n1,250{mark}0\n-1,5e2{mark}0\n"))
    for read in (columns.numbers, columns.samples):
        assert list(read("x", "length")) == [1.25, -150.0]


@pytest.mark.parametrize("head", ["x [mm]", "x"])
def test_a_comma_that_may_part_thousands_is_refused(table, head):
    columns = read_columns(table(f'{head},y\n"1,250",0\n'))
    for read in (columns.numbers, columns.samples):
        with pytest.raises(InvalidInputError, match=r"the comma may mean 1250 or 1\.250"):
            read("x", "length")


@pytest.mark.parametrize(
    ("unit", "dimension"),
    [
        ("in", "length"),
        ("kHz", "frequency"),
        ("degF", "temperature"),
        ("°", "angle"),
        ("%", "ratio"),
    ],
)
def test_samples_are_the_numbers(table, unit, dimension):
    columns = read_columns(table(f"a [{unit}]\n0.3\n-7\n1e3\n.5\n"))
    np.testing.assert_allclose(
        columns.samples("a", dimension), columns.numbers("a", dimension), rtol=1e-14
    )


def test_a_unit_may_have_to_be_said(table):
    columns = read_columns(table("a,b [mm],c\n1,2,3 mm\n4,5,6 mm\n"))
    for name in "bc":
        columns.require_unit(name, "length")
    with pytest.raises(InvalidInputError, match=r'"a" must say its unit, such as "a \[mm\]"'):
        columns.require_unit("a", "length")


@pytest.mark.parametrize(
    ("text", "said"),
    [
        ("", "must hold a line of column names and rows"),
        ("load [N/mm]\n", "must hold a line of column names and rows"),
        ("load [N/mm],load [N/mm]\n1,2\n", 'column "load" must not be there twice'),
        ("load [N/mm],\n1,2\n", "line 2: must have 1 cells, has 2"),
        ("load [N/mm],,x\n1,2,3\n", "every column must have a name"),
        ("load [N/mm],x\n1\n", "line 2: must have 2 cells, has 1"),
        ("load [mm]\n1\n", 'unit of column "load" must be a force per length such as'),
        ("load [mm]\n1\n", 'got "1 mm": that is a length'),
        ("load [lb/in]\n1\n", "mass or a force"),
        ("load [N/mm]\nlots\n", 'line 2: "load"'),
        ("load [N/mm],x\n,1\n", 'line 2: "load" must not be empty'),
        ("load\nnan\n", 'line 2: "load"'),
        ("load\n1e999\n", "beyond what can be computed with"),
        ("lad [N/mm]\n1\n", 'it has "lad": both names must be the same'),
        ("load (N/mm)\n1\n", 'write the unit in square brackets: "load [...]" for "load (N/mm)"'),
        ("load / N/mm\n1\n", 'write the unit in square brackets: "load [...]"'),
        ("load\n[N/mm]\n1\n", 'a unit belongs to the column name: "load [N/mm]"'),
        ("Press 3\nload [N/mm],x\n1,2\n", "a title above them must begin with #"),
        ("load\nN/mm\n1\n", 'got "N/mm"; a unit belongs to the column name: "load [N/mm]"'),
        ("load\n2024-01-02\n", 'must be a number, got the date "2024-01-02"; give its cell'),
        ("load\n1.5 n/mm\n", '"n/mm" is not a known unit; did you mean "N/mm"?'),
    ],
)
def test_what_is_wrong_is_said_with_file_line_and_column(table, text, said):
    with pytest.raises(InvalidInputError) as error:
        read_columns(table(text)).numbers("load", "line load")
    assert said in str(error.value)
    assert "data.csv" in str(error.value)
    assert not str(error.value).endswith("?.")


def test_files_that_are_no_tables(table, tmp_path):
    for path, said in [
        (tmp_path, "is a directory"),
        (tmp_path / "none.csv", "there is no such file"),
        (table("no workbook", "book.xlsx"), "cannot be read as a workbook"),
    ]:
        with pytest.raises(InvalidInputError, match=said):
            read_columns(path)
    with pytest.raises(InvalidInputError, match="has no sheets"):
        read_columns(table("x\n1\n"), sheet="one")
    binary = tmp_path / "binary.csv"
    binary.write_bytes(b"\xff\xfe\x00")
    with pytest.raises(InvalidInputError, match="UTF-8"):
        read_columns(binary)


@pytest.mark.parametrize("error", ["#DIV/0!", "#N/A", "#NV", "#NAME?", "#WERT!", "#ÜBERLAUF!"])
def test_an_error_of_a_spreadsheet_is_no_comment(table, error):
    read = read_columns(table(f"load;note\n1;a\n{error};b\n2;c\n#3;left out\n# WEAR! noted\n"))
    assert read.comments == ((5, "3;left out"), (6, "WEAR! noted"))
    with pytest.raises(
        InvalidInputError, match=rf'line 3: "load" must be .* got "{re.escape(error)}'
    ):
        read.numbers("load", "line load")


def workbook(path, sheets):
    """A minimal workbook: texts in the cells themselves, numbers as they are."""

    def cell(value):
        if isinstance(value, str):
            return f'<c t="inlineStr"><is><t>{value}</t></is></c>'
        return f"<c><v>{value!r}</v></c>"

    main = "http://schemas.openxmlformats.org/spreadsheetml/2006/main"
    office = "http://schemas.openxmlformats.org/officeDocument/2006/relationships"
    package = "http://schemas.openxmlformats.org/package/2006"
    book, links, kinds = "", "", ""
    with zipfile.ZipFile(path, "w") as archive:
        for number, (name, rows) in enumerate(sheets.items(), start=1):
            cells = "".join(f"<row>{''.join(map(cell, row))}</row>" for row in rows)
            text = f'<worksheet xmlns="{main}"><sheetData>{cells}</sheetData></worksheet>'
            archive.writestr(f"xl/worksheets/sheet{number}.xml", text)
            book += f'<sheet name="{name}" sheetId="{number}" r:id="rId{number}"/>'
            links += (
                f'<Relationship Id="rId{number}" Type="{office}/worksheet" '
                f'Target="worksheets/sheet{number}.xml"/>'
            )
            kinds += (
                f'<Override PartName="/xl/worksheets/sheet{number}.xml" ContentType="application/'
                'vnd.openxmlformats-officedocument.spreadsheetml.worksheet+xml"/>'
            )
        archive.writestr(
            "xl/workbook.xml",
            f'<workbook xmlns="{main}" xmlns:r="{office}"><sheets>{book}</sheets></workbook>',
        )
        archive.writestr(
            "xl/_rels/workbook.xml.rels",
            f'<Relationships xmlns="{package}/relationships">{links}</Relationships>',
        )
        archive.writestr(
            "_rels/.rels",
            f'<Relationships xmlns="{package}/relationships"><Relationship Id="rId1" '
            f'Type="{office}/officeDocument" Target="xl/workbook.xml"/></Relationships>',
        )
        archive.writestr(
            "[Content_Types].xml",
            f'<Types xmlns="{package}/content-types"><Default Extension="xml" '
            'ContentType="application/xml"/><Default Extension="rels" ContentType="application/'
            'vnd.openxmlformats-package.relationships+xml"/><Override PartName="/xl/workbook.xml" '
            'ContentType="application/vnd.openxmlformats-officedocument.spreadsheetml.sheet.'
            f'main+xml"/>{kinds}</Types>',
        )


def test_a_sheet_of_a_workbook_is_read_as_a_text_file_is(tmp_path):
    path = tmp_path / "data.xlsx"
    rows = [["load [kN/m]", "nip width [in]", "rubber"], [1.5, 0.2, "soft"], [2.0, "1e-1", "hard"]]
    workbook(path, {"notes": [["# of two nips"]], "data": rows})
    columns = read_columns(path, sheet="data")
    assert columns.names == ("load", "nip width", "rubber")
    assert columns.units == ("kN/m", "in", "")
    np.testing.assert_allclose(columns.numbers("load", "line load"), [1.5, 2.0])
    np.testing.assert_allclose(columns.numbers("nip width", "length"), [5.08, 2.54])
    assert columns.cells("rubber") == ("soft", "hard")
    assert columns.lines == (2, 3)


def test_the_first_sheet_counts_and_comments_and_blank_rows_do_not(tmp_path):
    path = tmp_path / "data.xlsx"
    workbook(path, {"one": [["# measured"], ["load", "note"], ["", ""], [1.5, ""]], "two": [["a"]]})
    columns = read_columns(path)
    assert columns.rows == ((1.5, ""),)
    assert columns.lines == (4,)


def test_comments_of_a_workbook_are_kept(tmp_path):
    path = tmp_path / "data.xlsx"
    workbook(path, {"one": [["# roller:", 7.0], ["x [mm]", "y"], ["#2"], [1.0, 2.0]]})
    columns = read_columns(path)
    assert columns.comments == ((1, "roller: 7.0"), (3, "2"))
    assert columns.lines == (4,)


@pytest.mark.parametrize(
    ("rows", "sheet", "words"),
    [
        ([["load"], [1.0]], "three", 'has no sheet "three" .there: one'),
        ([["load", "load"], [1.0, 2.0]], None, 'column "load" must not be there twice'),
        ([["load"]], None, "must hold a line of column names and rows below it"),
        ([["load", "width"], [1.0, ""]], None, 'line 2: "width" must not be empty'),
        ([["load", "width"], [1.0, ""]], None, "merged cells hold their value in the first only"),
        ([["load [mm]", "width"], [1.0, 2.0]], None, 'unit of column "load" '),
    ],
)
def test_what_is_wrong_with_a_workbook_is_said_with_its_name(tmp_path, rows, sheet, words):
    path = tmp_path / "data.xlsx"
    workbook(path, {"one": rows})

    def read():
        columns = read_columns(path, sheet=sheet)
        columns.numbers("load", "line load")
        columns.numbers("width", "length")

    with pytest.raises(InvalidInputError, match=words) as caught:
        read()
    assert "data.xlsx" in str(caught.value)


def test_empty_columns_of_a_sheet_are_left_out(tmp_path):
    path = tmp_path / "data.xlsx"
    workbook(path, {"one": [["", "load", "", "width"], ["", 1.0, "", 2.0], ["", 3.0, "", ""]]})
    columns = read_columns(path)
    assert columns.names == ("load", "width")
    assert columns.rows == ((1.0, 2.0), (3.0, ""))


def test_of_several_sheets_the_one_that_was_read_is_named(tmp_path):
    path = tmp_path / "data.xlsx"
    workbook(path, {"notes": [["of Monday"]], "data": [["load"], [1.0]]})
    with pytest.raises(InvalidInputError, match=r'data.xlsx, sheet "notes": must hold a line'):
        read_columns(path)


def test_what_is_no_workbook_is_said(table):
    with pytest.raises(InvalidInputError, match=r"data.xlsx: cannot be read as a workbook"):
        read_columns(table("load\n1\n", "data.xlsx"))
