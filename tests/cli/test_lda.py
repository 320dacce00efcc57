"""The commands lda: what they write and print, and how they leave."""

import json
import math
import subprocess
import sys
from pathlib import Path

import pytest
from typer.testing import CliRunner

from rollnip.cli.app import app

CASE = str(Path(__file__).parents[2] / "examples" / "configuration-1-free.toml")
RIGID_LOWER = ("--roller", "lower")


def run(*arguments):
    return CliRunner().invoke(app, ["lda", *map(str, arguments)])


@pytest.fixture(scope="module")
def folder(tmp_path_factory):
    out = tmp_path_factory.mktemp("lda") / "scan"
    result = run("simulate", CASE, "--out", out, "--positions", 21, "--bursts", 25, "--seed", 2)
    assert result.exit_code == 0, result.stderr
    return out


def test_a_folder_holds_data_truth_and_picture(folder):
    assert {p.name for p in folder.iterdir()} == {"bursts.csv", "truth.csv", "bursts.png"}
    assert (folder / "bursts.csv").read_text("utf-8").startswith("# simulated")
    assert (folder / "bursts.png").read_bytes().startswith(b"\x89PNG")


def test_a_file_is_the_same_bursts(folder, tmp_path):
    path = tmp_path / "a.csv"
    options = ("--positions", 21, "--bursts", 25, "--seed", 2)
    assert run("simulate", CASE, "--out", path, *options).exit_code == 0
    assert path.read_bytes() == (folder / "bursts.csv").read_bytes()
    assert list(tmp_path.iterdir()) == [path]


def test_simulate_prints_the_bursts_as_json(tmp_path):
    """Few bursts, written and printed: the same numbers, to the digits of the file."""
    path = tmp_path / "a.csv"
    options = ("--positions", 3, "--bursts", 10, "--seed", 2, "--json")
    done = run("simulate", CASE, "--out", path, *options)
    assert done.exit_code == 0, done.stderr
    tree = json.loads(done.stdout)
    assert (tree["simulated"], tree["seed"], tree["roller"]) == (True, 2, "upper")
    assert tree["files"] == [str(path)]
    lines = [line for line in path.read_text("utf-8").splitlines() if line[0] in "-0123456789"]
    assert len(lines) == len(tree["x"]) == len(tree["velocity"]) == len(tree["snr"]) > 10
    fringe = 632.8e-6 / (2.0 * math.sin(math.radians(5.0)))  # wavelength over 2 sin of half angle
    for line, x, frequency, velocity in zip(
        lines, tree["x"], tree["frequency"], tree["velocity"], strict=True
    ):
        assert float(line.split(",")[0]) == pytest.approx(x, abs=1e-6)
        assert velocity == pytest.approx(frequency * fringe, rel=1e-9)
    assert tree["velocity"][0] == pytest.approx(tree["roller_speed"], rel=0.1)


def test_compare_as_json_says_what_the_text_says(folder):
    text = run("compare", CASE, folder / "bursts.csv")
    tree = json.loads(run("compare", CASE, folder / "bursts.csv", "--json").stdout)
    assert f"{tree['shift']['value']:.4f} mm" in text.stdout
    assert f"{tree['positions']} positions, SIMULATED" in text.stdout
    assert tree["shift"]["low"] <= tree["shift"]["value"] <= tree["shift"]["high"]
    assert tree["speed"]["low"] < tree["speed"]["value"] < tree["speed"]["high"]
    assert tree["degrees_of_freedom"] == tree["positions"] - 2


def test_estimate_prints_a_table(folder, tmp_path):
    result = run("estimate", folder / "bursts.csv", "--plot", tmp_path / "v.png")
    assert result.exit_code == 0
    lines = result.stdout.splitlines()
    assert "simulated" in lines[0]
    assert len(lines) == 3 + 21
    assert (tmp_path / "v.png").read_bytes().startswith(b"\x89PNG")
    to_file = run("estimate", folder / "bursts.csv", "--out", tmp_path / "v.csv")
    assert to_file.stdout == ""
    assert (tmp_path / "v.csv").read_text("utf-8") == result.stdout


def test_compare_finds_itself(folder, tmp_path):
    picture = tmp_path / "c.png"
    result = run("compare", CASE, folder / "bursts.csv", "--plot", picture, "--json")
    assert result.exit_code == 0
    tree = json.loads(result.stdout)
    assert tree["simulated"] is True
    assert abs(tree["shift"]["value"]) < 0.1
    head = (folder / "bursts.csv").read_text("utf-8").splitlines()[7]
    truth = float(head.removeprefix("# roller speed: ").removesuffix(" mm/s"))
    assert tree["speed"]["low"] < truth < tree["speed"]["high"]
    assert tree["probability"] > 1e-3
    assert picture.read_bytes().startswith(b"\x89PNG")
    shown = run("compare", CASE, folder / "bursts.csv").stdout
    for text in ("SIMULATED", "shift", "chi-square", "95 % from"):
        assert text in shown


@pytest.mark.parametrize(
    ("arguments", "hint"),
    [
        (("simulate", CASE, "--out", "a.csv", "--sample-rate", "40 kHz"), "Nyquist"),
        (("simulate", CASE, "--out", "a.csv", "--beam-angle", "10"), "an angle such as"),
        (("simulate", CASE, "--out", "a.csv", "--wavelength", "1 N"), "--wavelength"),
        (("simulate", CASE, "--out", "a.csv", "--half-width", "-1 mm"), "--half-width"),
        (("simulate", CASE, "--out", "a.csv", "--positions", "1"), "positions"),
        (("simulate", CASE, "--out", "a.csv", "--bursts", "0"), "bursts"),
        (("simulate", CASE, "--out", "a.csv", "--bursts", "10000000"), "at most 20000000 samples"),
        (("simulate", CASE, "--out", "a.csv", "--positions", "9999"), "positions"),
        (("simulate", CASE, "--out", "a.csv", "--positions", "3", "--snr", "1e-4"), "snr"),
        (("simulate", CASE, "--out", "a.csv", "--spread", "300 %"), "spread"),
        (("simulate", CASE, "--out", "a.csv", "--seed", "-1"), "--seed"),
        (("simulate", CASE, "--out", "a.csv", "--roller", "left"), "--roller"),
        (("simulate", CASE, "--out", "a.csv", "--geometry", "flat"), "--geometry"),
        (("simulate", CASE, "--out", "no/such/a.csv"), "there is no directory"),
        (("simulate", "none.toml", "--out", "a.csv"), "none.toml"),
        (("simulate", "none.toml", "--out", "folder"), "none.toml"),
        (("simulate", CASE, "--out", "wrong.txt"), "wrong.txt: must be a folder, it is a file."),
        (("estimate", "none.csv"), "there is no such file"),
        (("estimate", "wrong.csv"), "no known column"),
        (("estimate", "few.csv"), "at least 5 valid bursts"),
        (("estimate", "few.csv", "--plot", "a.exe"), "must end in"),
        (("estimate", "few.csv", "--out", "a.txt"), "must end in .csv"),
        (("compare", CASE, "outside.csv"), "inside the solution"),
        (("compare", CASE, "outside.csv", *RIGID_LOWER), "rigid"),
        (("compare", CASE, "outside.csv", "--confidence", "2"), "confidence"),
    ],
)
def test_wrong_input_is_one_line_and_exit_2(tmp_path, monkeypatch, arguments, hint):
    monkeypatch.chdir(tmp_path)
    Path("wrong.csv").write_text("x [mm],speed [mm/s]\n1,2\n", "utf-8")
    Path("wrong.txt").touch()
    Path("few.csv").write_text("x [mm],velocity [mm/s]\n1,2\n", "utf-8")
    far = "".join(f"{x},100,1\n" for x in range(50, 60))
    Path("outside.csv").write_text("x [mm],velocity [mm/s],error [mm/s]\n" + far, "utf-8")
    before = set(Path().iterdir())
    result = run(*arguments)
    assert result.exit_code == 2, result.output
    assert result.stdout == ""
    assert hint in result.stderr
    assert result.stderr.count("\n") == 1
    assert set(Path().iterdir()) == before


@pytest.mark.parametrize(
    ("arguments", "start"),
    [
        (("simulate", CASE, "--out", "a.csv", "--positions", "0"), "--positions: `positions`"),
        (("simulate", CASE, "--out", "a.csv", "--bursts", "0"), "--bursts: `bursts`"),
        (("simulate", CASE, "--out", "a.csv", "--beam-angle", "400 deg"), "--beam-angle: "),
        (("simulate", CASE, "--out", "a.csv", "--sample-rate", "40 kHz"), "--sample-rate: "),
        (("simulate", CASE, "--out", "a.csv", "--half-width", "100 mm"), "--half-width: `half"),
        (("simulate", CASE, "--out", "a.csv", "--snr", "1e308"), "--snr: `snr` must be at most"),
        (("estimate", "means.csv", "--confidence", "120%"), "`--confidence` must be 50 % or more"),
        (("compare", CASE, "means.csv", "--confidence", "49 %"), "`--confidence` must be 50 %"),
    ],
)
def test_a_wrong_option_is_named_and_not_a_file(tmp_path, monkeypatch, arguments, start):
    monkeypatch.chdir(tmp_path)
    Path("means.csv").write_text("x [mm],velocity [mm/s],error [mm/s]\n1,100,1\n", "utf-8")
    result = run(*arguments)
    assert result.exit_code == 2, result.output
    assert result.stderr.startswith(f"rollnip: {start}")


def test_numerics_are_loaded_late():
    code = (
        "import sys; from rollnip.cli.app import app; "
        "sys.exit(any(n in sys.modules for n in ('numpy', 'scipy', 'rollnip.lda')))"
    )
    assert subprocess.run([sys.executable, "-c", code], check=False).returncode == 0
