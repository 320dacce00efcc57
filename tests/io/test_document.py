import numpy as np
import pytest

from rollnip._errors import CaseFileError
from rollnip.io import case_hash, parse_case
from rollnip.io.document import LARGEST, parse_document, read_document
from rollnip.sweeps.study_file import read_study

CASE = {
    "nip": {"load": 1.0, "friction": 0.5},
    "upper": {
        "radius": 50,
        "layers": [
            {"thickness": 2.0, "material": {"model": "elastic", "modulus": 1.0, "poisson": 0.5}}
        ],
    },
    "lower": {"radius": 25.0},
}


def refused(path) -> str:
    with pytest.raises(CaseFileError) as caught:
        read_document(path)
    message = str(caught.value)
    assert "\n" not in message
    assert message.startswith(str(path)) or "\0" in str(path)
    return message


def test_numbers_of_numpy_are_numbers():
    loads = np.linspace(0.5, 2.0, 4, dtype=np.float32)
    study = {"case": CASE, "parameters": [{"path": "nip.load", "values": loads}]}
    lists = {"case": CASE, "parameters": [{"path": "nip.load", "values": [0.5, 1, 1.5, 2]}]}
    cases = [[read_study(tree).case(place) for place in range(4)] for tree in (study, lists)]
    assert cases[0] == cases[1]
    of_numpy = CASE | {"nip": {"load": np.int64(2), "friction": np.float32(0.5)}}
    plain = CASE | {"nip": {"load": 2.0, "friction": 0.5}}
    assert case_hash(parse_case(of_numpy)) == case_hash(parse_case(plain))


def test_toml_and_json_are_the_same_tree(tmp_path):
    toml, json = tmp_path / "a.toml", tmp_path / "a.json"
    toml.write_text('title = "ä"\n[nip]\nload = 1.5\n', encoding="utf-8")
    json.write_text('{"title": "ä", "nip": {"load": 1.5}}', encoding="utf-8")
    assert read_document(toml) == read_document(json) == {"title": "ä", "nip": {"load": 1.5}}


@pytest.mark.parametrize(
    ("line", "number"),
    [("load = 3,5", "3.5"), ("load =  -0,25 # N/mm", "-0.25"), ("a = [{b = 1,5}]", "1.5")],
)
def test_a_bare_decimal_comma_is_told(line, number):
    with pytest.raises(CaseFileError) as caught:
        parse_document(f"[nip]\nfriction = 0.3\n{line}\n", "case.toml")
    comma = number.replace(".", ",")
    assert str(caught.value).endswith(
        f'; write {number}, or a text with its unit, such as "{comma} mm".'
    )


@pytest.mark.parametrize(
    ("line", "hint"),
    [
        ("load = 1.78 N/mm", 'write "1.78 N/mm", in quotes.'),
        ("load = 10pli  # of the drawing", 'write "10 pli", in quotes.'),
        ('load = 3"', 'write "3 in", in quotes.'),
        ("a = [{ b = 2 mm, c = 3 }]", 'write "2 mm", in quotes.'),
        ("a = [1 mm, 2 mm]", 'write "1 mm", in quotes.'),
        ("core = steel", 'write "steel", in quotes.'),
        ("bending = True", "write true."),
        ("load = \u201c2 N/mm\u201d", 'write straight quotes (").'),
        ("friction = 0.4", "a key is given twice: keep one of the two."),
        ("[nip]", "keep one of the two tables."),
    ],
)
def test_a_value_without_quotes_or_a_second_one_is_told(line, hint):
    with pytest.raises(CaseFileError) as caught:
        parse_document(f"[nip]\nfriction = 0.3\n{line}\n", "case.toml")
    assert str(caught.value).endswith(f"; {hint}")


@pytest.mark.parametrize("line", ["load = 05", "load = 1.", "load 3", "[upper", "load = .5"])
def test_a_fault_of_another_kind_gets_no_such_hint(line):
    with pytest.raises(CaseFileError) as caught:
        parse_document(f"[nip]\nfriction = 0.3\n{line}\n", "case.toml")
    assert "quotes" not in str(caught.value)


def test_other_faults_of_a_line_say_nothing_of_commas():
    with pytest.raises(CaseFileError) as caught:
        parse_document("[nip]\nload = 3 5\nfriction = 0,3\n", "case.toml")
    assert "write" not in str(caught.value)


def test_a_byte_order_mark_and_windows_lines_are_fine(tmp_path):
    path = tmp_path / "a.toml"
    path.write_bytes(b'\xef\xbb\xbftitle = "a"\r\n[nip]\r\nload = 1\r\n')
    assert read_document(path)["title"] == "a"


@pytest.mark.parametrize(
    ("content", "hint"),
    [
        (b"\x89PNG\r\n\x1a\n\0\0\0", "not a text file"),
        (b'title = "a"\nx = "\xe9"\n', "not UTF-8 text (byte 0xe9 on line 2)"),
        ("title = 'a'".encode("utf-16"), "not a text file"),
        (b"[nip]\nload = \n", "line 2"),
        (b"[nip]\nload = 1\nload = 2\n", "line 3"),
        (b"[nip]\nload = 1\n[nip]\nload = 2\n", "line 3"),
        (b"load 5", "not valid TOML"),
        (b'{"nip": {"load": 1, "load": 2}}', "'load' is given twice"),
        (b'{"nip": ', "not valid JSON"),
        (b'{"a":' * 100_000, "nested too deeply"),
        (b"a = " + b"[" * 100_000, "nested too deeply"),
        (b'{"a": ' + b"1" * 5000 + b"}", "not valid JSON"),
        (b"x" * (10 * LARGEST), "at most 1,000,000 bytes"),
        (bytes(range(256)) * 40_000, "at most 1,000,000 bytes"),
    ],
)
def test_bad_content_is_one_line(tmp_path, content, hint):
    path = tmp_path / "case.toml"
    path.write_bytes(content)
    assert hint in refused(path)


def test_json_that_is_no_table(tmp_path):
    path = tmp_path / "case.json"
    path.write_text("[1, 2]")
    assert "must hold a table" in refused(path)


def test_missing_directory_and_impossible_names(tmp_path):
    assert "no such file" in refused(tmp_path / "none.toml")
    assert "directory" in refused(tmp_path)
    assert "cannot be read" in refused(tmp_path / ("x" * 300))
    assert "cannot be the name" in refused("a\0b")


def test_an_endless_device_is_cut_off():
    assert "must be a regular file" in refused("/dev/zero")


def test_an_empty_text_is_an_empty_table():
    assert parse_document("", "case") == {}
