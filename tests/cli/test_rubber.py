"""The command rubber fit: tables in, a strain energy out."""

import json
import tomllib
from pathlib import Path

import pytest
from typer.testing import CliRunner

from rollnip.cli.app import app

TRELOAR = str(Path(__file__).parents[2] / "examples" / "rubber" / "treloar.csv")


def run(*arguments):
    return CliRunner().invoke(app, ["rubber", "fit", *map(str, arguments)])


def test_the_material_is_printed_or_written(tmp_path):
    printed = run(TRELOAR, "--law", "ogden", "--terms", 3, "--name", "natural")
    assert printed.exit_code == 0, printed.stderr
    assert printed.stderr == ""
    table = tomllib.loads(printed.stdout)["materials"]["natural"]
    assert len(table["energy"]["terms"]) == 3
    out, plot = tmp_path / "rubber.toml", tmp_path / "rubber.png"
    written = run(TRELOAR, "--law", "gent", "--out", out, "--plot", plot, "--strain", "100 %")
    assert written.exit_code == 0, written.stderr
    assert written.stdout == ""
    assert tomllib.loads(out.read_text("utf-8"))["materials"]["rubber"]["energy"]["model"] == "gent"
    assert plot.read_bytes().startswith(b"\x89PNG")


def test_json_and_files_of_one_test_each(tmp_path):
    file = tmp_path / "shear.csv"
    rows = "".join(f"{0.1 * n},{0.05 * n}\n" for n in range(1, 8))
    file.write_text("strain,stress [MPa]\n" + rows, "utf-8")
    found = run(file, "--test", "shear", "--law", "neo-hookean", "--json")
    assert found.exit_code == 0, found.stderr
    tree = json.loads(found.stdout)
    assert abs(tree["material"]["shear_modulus"] - 0.5) < 1e-9
    assert "One kind of test alone (shear)" in found.stderr


def test_wrong_input_is_said():
    for options, said in (
        (("--law", "mooney"), "`law` must be one of"),
        (("--strain", "1 mm"), "--strain"),
        (("--strain", "1 %"), "must leave measurements"),
        (("--test", "shear"), "must not be given"),
        (("--out", "x.txt"), ".toml"),
        (("--poisson", "0.7"), "`poisson`"),
        (("--poisson", "nan"), "`poisson` must be a finite number"),
        ((TRELOAR,), "must be given once; its rows would count twice"),
    ):
        found = run(TRELOAR, *options)
        assert found.exit_code == 2
        assert found.stdout == ""
        assert said in found.stderr, found.stderr


def test_the_file_is_named_once(tmp_path):
    file = tmp_path / "rest.csv"
    file.write_text("stretch,stress [MPa]\n" + "1,0.1\n" * 6, "utf-8")
    found = run(file, "--test", "tension")
    assert found.exit_code == 2
    assert found.stderr.count(str(file)) == 1
    assert "with a strain" in found.stderr


@pytest.mark.parametrize(
    ("head", "row", "said"),
    [
        ("stretch", "-1.2,0.3", 'line 4: "stretch" must be positive and finite, got -1.2.'),
        ("strain [%]", "-300,0.3", 'line 4: the stretch, 1 + "strain", must be positive'),
        ("stretch", "1.2,1e99", 'line 4: "stress" must be at most 1e+12 MPa'),
    ],
)
def test_a_row_that_no_rubber_has_is_told_by_its_line(tmp_path, head, row, said):
    file = tmp_path / "tests.csv"
    file.write_text(f"# tension\n{head},stress [MPa]\n1.1,0.1\n{row}\n", encoding="utf-8")
    result = run(file, "--test", "tension")
    assert result.exit_code == 2
    assert result.stderr.startswith(f"rollnip: {file}, {said}")
