"""The command dma fit: tables in, a material out."""

import json
import tomllib
from pathlib import Path

import numpy as np
import pytest
from typer.testing import CliRunner

from rollnip.cli.app import app
from rollnip.io import read_case

EXAMPLES = Path(__file__).parents[2] / "examples" / "dma"
DATA, NIP = str(EXAMPLES / "isotherms.csv"), str(EXAMPLES / "nip.toml")


def run(*arguments):
    return CliRunner().invoke(app, ["dma", "fit", *map(str, arguments)])


def test_the_printed_table_completes_a_case(tmp_path):
    result = run(DATA, "--reference", "23 degC", "--name", "measured")
    assert result.exit_code == 0, result.stderr
    assert result.stderr == ""
    text = Path(NIP).read_text("utf-8").replace('material = "rubber"', 'material = "measured"')
    whole = tmp_path / "whole.toml"
    whole.write_text(text + result.stdout, "utf-8")
    solved = CliRunner().invoke(app, ["solve", str(whole), "--geometry", "linear", "--quiet"])
    assert solved.exit_code == 0, solved.output
    assert read_case(whole).nip.upper.layers[0].material.shift.reference == 23.0


def test_files_are_written_and_the_nip_is_looked_at(tmp_path):
    out, plot = tmp_path / "rubber.toml", tmp_path / "rubber.png"
    options = ("--model", "fractional-zener", "--reference", "23 degC", "--case", NIP)
    result = run(DATA, "--out", out, "--plot", plot, *options)
    assert result.exit_code == 0, result.stderr
    assert result.stdout == ""
    assert "order = 0.4" in out.read_text("utf-8")
    assert plot.read_bytes().startswith(b"\x89PNG")


def test_a_nip_beyond_the_data_is_warned_of(tmp_path):
    slow = tmp_path / "slow.toml"
    slow.write_text(Path(NIP).read_text("utf-8").replace("90 m/min", "1e-6 mm/s"), "utf-8")
    result = run(DATA, "--reference", "23 degC", "--case", slow)
    assert result.exit_code == 0
    assert "below the data of the material" in result.stderr


@pytest.mark.parametrize(
    ("temperature", "said"),
    [
        ("80 degC", "has 80 degC, above the temperatures of the data, -20 to 60 degC: the shift"),
        ("243.15 K", "has -30 degC, below the temperatures of the data, -20 to 60 degC: the shift"),
        ("60 degC", None),
    ],
)
def test_a_nip_warmer_or_colder_than_the_data_is_warned_of(tmp_path, temperature, said):
    """At 80 degC its frequency lies within the shifted data, and nothing was said."""
    nip = tmp_path / "nip.toml"
    given = f'poisson = 0.5\ntemperature = "{temperature}"'
    nip.write_text(Path(NIP).read_text("utf-8").replace("poisson = 0.5", given), "utf-8")
    result = run(DATA, "--reference", "23 degC", "--case", nip)
    assert result.exit_code == 0
    found = [line for line in result.stderr.splitlines() if "temperatures of the data" in line]
    assert [said in line for line in found] == ([] if said is None else [True])


@pytest.mark.parametrize(
    ("options", "said"),
    [
        (("--shift", "none"), "9 temperatures"),
        (("--shift", "vft"), "`shift`"),
        (("--model", "maxwell"), "`model`"),
        (("--modulus", "K"), "--modulus"),
        (("--modulus", "G"), "heads say E"),
        (("--reference", "23"), "--reference"),
        (("--c1", "8.9"), "--c2"),
        (("--c1", "8.9", "--c2", "101 K"), "--reference"),
        (("--energy", "60 kJ", "--reference", "23 degC"), "--energy"),
        (("--name", "a b"), "`name`"),
        (("--terms", "0"), "`terms`"),
        (("--out", "a.csv"), "must end in .toml"),
        (("--plot", "a.exe"), "must end in"),
        (("--sheet", "one"), "no sheets"),
        (("--terms", "0"), "rollnip: --terms: `terms`"),
        (("--poisson", "nan"), "rollnip: --poisson: `poisson`"),
        (("--reference", "-300 degC"), "rollnip: --reference: `reference`"),
        (("--c1", "-5", "--c2", "51 K", "--reference", "23 degC"), "rollnip: --c1: `c1`"),
        (("--case", NIP, "--name", "other"), "`other`"),
    ],
)
def test_wrong_input_is_one_line_and_exit_2(options, said):
    result = run(DATA, *options)
    assert result.exit_code == 2, result.output
    assert result.stdout == ""
    assert said in result.stderr
    assert result.stderr.count("\n") == 1


def test_show_says_what_is_understood():
    result = CliRunner().invoke(app, ["dma", "show", DATA])
    assert result.exit_code == 0
    for said in (
        "UTF-8, comma-separated",
        "heads in line 2",
        "117 rows",
        "storage modulus E (in MPa): 1.991 MPa to 750.5 MPa",
        "9 temperatures to the degree",
    ):
        assert said in result.stdout


def test_show_as_json():
    done = CliRunner().invoke(app, ["dma", "show", DATA, "--json"])
    assert done.exit_code == 0
    tree = json.loads(done.stdout)
    (table,) = tree["tables"]
    assert (table["kind"], table["rows"]) == ("dynamic", 117)
    assert table["columns"]["temperature"] == {
        "head": "temperature [degC]",
        "unit": "degC",
        "low": -20.0,
        "high": 60.0,
    }
    assert set(table["columns"]) == {"frequency", "temperature", "storage", "tan delta"}


def test_show_of_what_is_no_table_as_json_says_why(tmp_path):
    path = tmp_path / "other.csv"
    path.write_text("temperature [degC]; storage modulus [MPa]\n20; 3\n30; 2\n", "utf-8")
    done = CliRunner().invoke(app, ["dma", "show", str(path), "--json"])
    (table,) = json.loads(done.stdout)["tables"]
    assert table["kind"] is None
    assert table["problem"]
    assert table["columns"] == {}


def test_show_of_what_is_no_table_says_so(tmp_path):
    path = tmp_path / "notes.txt"
    path.write_text("nothing\n")
    result = CliRunner().invoke(app, ["dma", "show", str(path)])
    assert result.exit_code == 0
    assert "no table whose heads are known" in result.stdout
    missing = CliRunner().invoke(app, ["dma", "show", str(tmp_path / "none.csv")])
    assert missing.exit_code == 2


def test_fit_as_json():
    result = run(DATA, "--reference", "23 degC", "--json")
    assert result.exit_code == 0
    tree = json.loads(result.stdout)
    assert tree["schema"] == 1
    assert tree["kind"] == "dynamic"
    assert tree["material"]["model"] == "prony"
    assert tree["shift"]["c2"]["value"] == pytest.approx(101.0, abs=5.0)
    assert tree["deviation"]["storage"]["rms"] < 0.03
    assert tree["deviation"]["loss"]["row"].startswith("line ")
    assert len(tree["isotherms"]) == 9
    assert tree["warnings"] == []


def test_fit_of_a_relaxation_test(tmp_path):
    time = np.geomspace(0.1, 1000.0, 25)
    values = 2.0 + 3.0 * np.exp(-time / 0.5) + np.exp(-time / 10.0)
    path = tmp_path / "relaxation.txt"
    rows = "".join(f"{t:.6g}\t{v:.6g}\n" for t, v in zip(time, values, strict=True))
    path.write_text("t\tE(t)\ns\tMPa\n" + rows, encoding="utf-8")
    plot = tmp_path / "relaxation.png"
    result = run(path, "--temperature", "23 degC", "--plot", plot)
    assert result.exit_code == 0, result.stderr
    assert "# Deviation from the data: modulus" in result.stdout
    assert plot.stat().st_size > 1000
    wrong = run(path, "--temperature", "23 degC", "--frequency", "1 Hz")
    assert wrong.exit_code == 2
    assert "is over time" in wrong.stderr


def convert(*arguments):
    return CliRunner().invoke(app, ["dma", "convert", *map(str, arguments)])


def test_a_material_goes_to_abaqus_and_back(tmp_path):
    material, deck = tmp_path / "rubber.toml", tmp_path / "rubber.inp"
    assert run(DATA, "--reference", "23 degC", "--out", material).exit_code == 0
    assert convert(material, "--to", "abaqus", "--out", deck).exit_code == 0
    assert "*VISCOELASTIC, TIME=PRONY" in deck.read_text()
    back = convert(deck, "--unit", "MPa")
    assert back.exit_code == 0
    one, other = (tomllib.loads(text) for text in (material.read_text(), back.stdout))
    for key in ("model", "poisson", "shift", "temperature"):
        assert one["materials"]["rubber"][key] == other["materials"]["rubber"][key]
    assert len(one["materials"]["rubber"]["terms"]) == len(other["materials"]["rubber"]["terms"])


def test_a_standard_linear_solid_goes_to_ansys(tmp_path):
    path = tmp_path / "black.toml"
    path.write_text(
        '[materials.rubber]\nmodel = "standard-linear-solid"\nmodulus = "2 MPa"\n'
        'stiffening = "3 MPa"\nrelaxation_time = "7 ms"\npoisson = 0.5\n'
    )
    result = convert(path, "--to", "ansys")
    assert result.exit_code == 0, result.stderr
    assert "MP,EX,1,5.0 " in result.stdout
    assert "TB,PRONY,1,1,1,SHEAR\nTBDATA,1,0.6,0.007\n" in result.stdout


@pytest.mark.parametrize(
    ("arguments", "said"),
    [
        ((NIP, "--to", "nastran"), "`--to` must be one of"),
        ((NIP, "--name", "nobody"), "must hold a material named `nobody`, has rubber"),
        ((NIP,), "must be a Prony series or a standard linear solid, got Elastic"),
        ((DATA,), "must hold *VISCOELASTIC"),
        (("missing.inp", "--unit", "MPa"), "missing.inp"),
    ],
)
def test_what_cannot_be_converted_is_said(arguments, said):
    result = convert(*arguments)
    assert result.exit_code == 2
    assert said in result.stderr
    assert result.stdout == ""
