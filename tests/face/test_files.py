"""Faces from case files and on the command line."""

import json
import signal
import tomllib
from dataclasses import replace
from io import StringIO
from math import inf, isnan, pi
from pathlib import Path
from time import monotonic, sleep

import pytest
from rich.console import Console
from typer.testing import CliRunner

import rollnip as rn
import rollnip.face
from rollnip._results.case import case_tree
from rollnip.cli.app import app
from rollnip.cli.face import _per_cent, _processes
from rollnip.face import with_crown
from rollnip.face.figures import FACE_FIGURES, FACE_PROFILES
from rollnip.face.reservations import reservations_of
from rollnip.io import case_hash, parse_case
from rollnip.io.document import parse_document
from rollnip.plots import plot_face
from rollnip.plots.style import palette_of

EXAMPLE = Path(__file__).parents[2] / "examples" / "press-face.toml"
TEXT = EXAMPLE.read_text(encoding="utf-8")
SMOOTH = TEXT.replace("friction = 0.5", "friction = 0") + '\n[model]\ngeometry = "curved"\n'


@pytest.fixture
def smooth(tmp_path):
    """The example without friction and in "curved", whose table is soon made."""
    path = tmp_path / "case.toml"
    path.write_text(SMOOTH)
    return path


def run(*arguments):
    return CliRunner().invoke(app, [str(one) for one in arguments])


def test_the_example_is_read():
    case = rn.read_case(EXAMPLE)
    assert case.face == rn.Face(length=1600.0)
    shaft = case.nip.upper.shaft
    assert shaft.bearing_distance == 1900.0
    assert shaft.crown == rn.Crown(0.25)
    assert shaft.modulus == 206e3
    assert case.nip.lower.shaft.journal_diameter is None


def test_units_and_shapes():
    text = TEXT.replace('length = "1600 mm"', 'length = "63 in"\nskew = "0.1 deg"').replace(
        'crown = "0.25 mm"',
        'density = "0.2836 lb/in3"\ncrown = { height = "10 mil", shape = "cosine" }',
    )
    case = parse_case(text)
    assert case.face.length == pytest.approx(1600.2)
    assert case.face.skew == pytest.approx(0.1 * 3.141592653589793 / 180.0)
    assert case.nip.upper.shaft.crown == rn.Crown(0.254, "cosine")
    assert case.nip.upper.shaft.density == pytest.approx(7850.0, rel=1e-3)


def test_end_loads_take_the_place_of_the_load():
    text = TEXT.replace('load = "6 N/mm" ', "# ").replace(
        'length = "1600 mm"', 'length = "1600 mm"\nend_loads = ["4.8 kN", 5000]'
    )
    case = parse_case(text)
    assert case.face.end_loads == (4800.0, 5000.0)
    assert case.nip.normal.load == pytest.approx(9800.0 / 1600.0)


def test_the_mean_load_of_end_loads_holds_the_weight_of_the_core():
    """The cross-section of such a case is that at the mean load of its face."""
    text = TEXT.replace('load = "6 N/mm" ', "# ").replace(
        'length = "1600 mm"', 'length = "1600 mm"\nend_loads = [4800, 5000]\nnip_angle = "60 deg"'
    )
    case = parse_case(text.replace("[upper.shaft]", '[upper.shaft]\ndensity = "7850 kg/m3"'))
    weight = 7850e-9 * 9.80665 * pi / 4.0 * (176.0**2 - 100.0**2)
    assert case.nip.normal.load == pytest.approx(9800.0 / 1600.0 + 0.5 * weight)


@pytest.mark.parametrize(
    ("crown", "said"),
    [
        ('"abc"', 'crown: must be a length such as "4.5 mm", got "abc"'),
        ("nan", "crown: must be a finite number, got nan"),
        ('{ hight = "1 mm" }', 'crown.hight: is not a known key; did you mean "height"'),
        ('{ height = "1 N" }', 'crown.height: must be a length such as "4.5 mm", got "1 N"'),
    ],
)
def test_a_wrong_crown_is_refused_in_one_line(crown, said):
    with pytest.raises(rn.CaseFileError) as error:
        parse_case(TEXT.replace('crown = "0.25 mm"', f"crown = {crown}"))
    assert f"upper.shaft.{said}" in str(error.value)
    assert "\n" not in str(error.value)


def test_a_crown_from_a_file(tmp_path):
    (tmp_path / "crown.csv").write_text("y [mm], diameter [um]\n-800, 0\n0, 250\n800, 0\n")
    path = tmp_path / "case.toml"
    path.write_text(TEXT.replace('crown = "0.25 mm"', 'crown = { file = "crown.csv" }'))
    crown = rn.read_case(path).nip.upper.shaft.crown
    assert list(crown.diameter) == pytest.approx([0.0, 0.25, 0.0])


FULL = (
    TEXT.replace('load = "6 N/mm" ', "# ")
    .replace(
        'length = "1600 mm"',
        """length = "1600 mm"
arms = [{ bearing_lever = "250 mm", forces = [
    { force = "3 kN", lever = "400 mm" }, { force = "60 N", lever = "200 mm" } ] }]""",
    )
    .replace(
        'journal_diameter = "80 mm"',
        """bearing_middle = "10 mm"
journals = [{ diameter = "120 mm", length = "60 mm" }, { diameter = "80 mm" }]
profiles = [{ height = "-0.05 mm" }, { y = [-800, "800 mm"], diameter = [0, "20 um"] }]
covering = { y = [-800, 800], thickness = ["12 mm", "11 mm"], stiffness = [1, "110 %"] }""",
    )
)


def test_everything_a_shaft_may_have_is_read_and_written_again():
    case = parse_case(FULL)
    shaft = case.nip.upper.shaft
    assert shaft.bearing_middle == 10.0
    assert [(one.diameter, one.length) for one in shaft.journals] == [(120.0, 60.0), (80.0, inf)]
    assert shaft.profiles[0] == rn.Crown(-0.05)
    assert list(shaft.profiles[1].diameter) == pytest.approx([0.0, 0.02])
    assert list(shaft.covering.stiffness) == pytest.approx([1.0, 1.1])
    assert case.face.end_loads == pytest.approx((4848.0, 4848.0))
    again = parse_case(case_tree(case.nip, case.model))
    assert again.nip.upper == case.nip.upper


def gent(hardness):
    """Young's modulus by Gent's formula [MPa]."""
    return 0.0981 * (56.0 + 7.62336 * hardness) / (0.137505 * (254.0 - 2.54 * hardness))


@pytest.mark.parametrize(
    ("head", "values", "stiffness"),
    [
        ("y [mm], thickness [mm], modulus [MPa]", ("12, 3.6", "11, 3.96"), [1.0, 1.1]),
        ("y, stiffness", ("1", "1.1"), [1.0, 1.1]),
        ("y, shore_a", ("60", "65"), [gent(60.0) / 3.6, gent(65.0) / 3.6]),
    ],
)
def test_a_covering_from_a_file(tmp_path, head, values, stiffness):
    rows = "\n".join(f"{y}, {one}" for y, one in zip((800, -800), values[::-1], strict=True))
    (tmp_path / "covering.csv").write_text(f"{head}\n{rows}\n")
    path = tmp_path / "case.toml"
    path.write_text(TEXT.replace('crown = "0.25 mm"', 'covering = { file = "covering.csv" }'))
    covering = rn.read_case(path).nip.upper.shaft.covering
    assert list(covering.stiffness) == pytest.approx(stiffness, rel=1e-4)
    assert (covering.thickness is None) == ("thickness" not in head)


def test_a_file_that_is_no_covering(tmp_path):
    (tmp_path / "covering.csv").write_text("y, hardness\n-800, 60\n800, 60\n")
    path = tmp_path / "case.toml"
    path.write_text(TEXT.replace('crown = "0.25 mm"', 'covering = { file = "covering.csv" }'))
    with pytest.raises(rn.CaseFileError, match="must have thickness, or one of stiffness, modulus"):
        rn.read_case(path)


@pytest.mark.parametrize(
    ("old", "new", "sentence"),
    [
        ('bore = "100 mm"', "bore = -1", "upper.shaft.bore: must be zero or positive"),
        ('bearing_distance = "1900 mm"\nbore', "bore", "upper.shaft.bearing_distance"),
        ('crown = "0.25 mm"', "crown = {}", "upper.shaft.crown: must hold either height or file"),
        (
            'length = "1600 mm"',
            'length = "1600 mm"\nend_loads = ["1 kN", "1 kN"]',
            "beside face",
        ),
        ('length = "1600 mm"', 'lenght = "1600 mm"', "length"),
        ('length = "1600 mm"', 'length = "1600 mm"\narms = []', "nip: must not hold load or app"),
        (
            'load = "6 N/mm" ',
            "# ",
            "nip: must hold load or approach, got neither",
        ),
        (
            'crown = "0.25 mm"',
            'crown = { height = 0.2, file = "crown.csv" }',
            "upper.shaft.crown: must hold either height or file, or y and diameter",
        ),
        ('crown = "0.25 mm"', "covering = {}", "upper.shaft.covering: must hold either file, or y"),
        (
            'crown = "0.25 mm"',
            "covering = { y = [-800, 800], thickness = [12] }",
            "upper.shaft.covering.thickness: must have one value for each of the 2 places, got 1",
        ),
        (
            'journal_diameter = "80 mm"',
            'journal_diameter = "80 mm"\njournals = [{ diameter = "80 mm" }]',
            "upper.shaft.journals: must be left out beside `journal_diameter`",
        ),
        (
            'crown = "0.25 mm"',
            "profiles = [{ y = [0, 0], diameter = [0, 0] }]",
            r"upper.shaft.profiles\[0\].y: must increase from place to place",
        ),
        ('length = "1600 mm"', 'length = "1600 kg"', "face.length"),
    ],
)
def test_wrong_files_say_what_is_wrong(old, new, sentence):
    assert old in TEXT
    with pytest.raises(rn.CaseFileError, match=sentence):
        parse_case(TEXT.replace(old, new, 1))


def test_solve_prints_and_writes_the_face(tmp_path):
    result = run("solve", EXAMPLE, "--json")
    assert result.exit_code == 0, result.output
    tree = json.loads(result.stdout)
    face = tree["face"]
    assert set(face) >= {
        "creepage", "y", "load", "approach", "nip_width", "peak_pressure", "traction",
        "local_creepage", "deflection_upper", "deflection_lower",
    }  # fmt: skip
    assert face["y"][0] == -800.0
    assert face["y"][-1] == 800.0
    assert face["load"][0] > face["load"][len(face["load"]) // 2]
    assert tree["case"]["upper"]["shaft"]["crown"] == {"height": 0.25, "shape": "parabolic"}
    case = rn.read_case(EXAMPLE)
    assert tree["case_hash"] == case_hash(case)
    again = parse_case(tree["case"])
    assert (again.nip, again.face, again.model) == (case.nip, case.face, case.model)


def test_a_result_with_end_loads_is_a_case_again(tmp_path):
    text = SMOOTH.replace('load = "6 N/mm" ', "# ").replace(
        'length = "1600 mm"', 'length = "1600 mm"\nend_loads = ["4.8 kN", "5 kN"]'
    )
    path = tmp_path / "case.toml"
    path.write_text(text)
    tree = json.loads(run("solve", path, "--json").stdout)
    again = parse_case(tree["case"])
    assert again.face.end_loads == (4800.0, 5000.0)
    assert again.nip.normal.load == pytest.approx(9800.0 / 1600.0)


def test_face_solve_draws(tmp_path, smooth):
    result = run("face", "solve", smooth, "--plot", tmp_path / "face.png")
    assert result.exit_code == 0, result.output
    assert "line load" in result.stdout
    assert (tmp_path / "face.png").stat().st_size > 10_000


def test_a_bar_tells_how_many_cross_sections_are_solved(monkeypatch):
    from rollnip.cli import progress as module

    out = StringIO()
    monkeypatch.setattr(module, "Console", lambda **_: Console(file=out, force_terminal=True))
    with module.counting() as tell:
        tell(3, 40)
        tell(40, 40)
    assert "cross-sections" in out.getvalue()
    assert "40/40" in out.getvalue()


@pytest.mark.parametrize(
    ("within", "said"),
    [
        ("10", "--within: `within` must lie between 0 and 1, got 10.0."),
        ("1 mm", "--within: must be a plain number"),
    ],
)
def test_a_share_that_is_none_is_refused_before_anything_is_solved(smooth, within, said):
    result = run("face", "crown", smooth, "--within", within)
    assert (result.exit_code, result.stdout) == (2, "")
    assert said in result.stderr


def test_face_crown(smooth):
    result = run("face", "crown", smooth, "--json", "--within", "10 %")
    assert result.exit_code == 0, result.output
    tree = json.loads(result.stdout)
    assert tree["loads"]["within"] == 0.1
    assert 0.4 < tree["height"] < 0.55
    assert tree["loads"]["low"] < 6.0 < tree["loads"]["high"]


def test_a_crown_that_is_not_verified_says_so(smooth, monkeypatch):
    def unverified(*given, **named):
        best = even_crown(*given, **named)
        return replace(best, solution=replace(best.solution, converged=False, status="Not so."))

    even_crown = rollnip.face.even_crown
    monkeypatch.setattr(rollnip.face, "even_crown", unverified)
    result = run("face", "crown", smooth)
    assert result.exit_code == 1
    assert result.stderr.endswith("not converged: Not so.\n")


@pytest.mark.parametrize(
    ("share", "text"), [(0.0483, "4.8 %"), (0.38, "38 %"), (0.9972, "100 %"), (1.62, "162 %")]
)
def test_a_large_departure_is_no_power_of_ten(share, text):
    """The load of a press without a crown departed by 1.6e+02 %."""
    assert _per_cent(share) == text


def test_face_read(tmp_path, smooth):
    widths = tmp_path / "widths.csv"
    widths.write_text("y [mm], width [mm]\n-750, 14.1\n0, 13.6\n750, 14.4\n")
    result = run("face", "read", smooth, widths, "--unknown", "crown", "--json")
    assert result.exit_code == 0, result.output
    tree = json.loads(result.stdout)
    one = tree["estimates"]["crown"]
    assert one["low"] < one["value"] < one["high"]


def test_a_scatter_with_a_wrong_unit_is_named_by_its_option(tmp_path, smooth):
    widths = tmp_path / "widths.csv"
    widths.write_text("y [mm], width [mm]\n-750, 14.1\n0, 13.6\n750, 14.4\n")
    result = run("face", "read", smooth, widths, "--scatter", "0.15 MPa")
    assert result.exit_code == 2
    assert result.output.startswith("rollnip: --scatter: must be a length")


@pytest.mark.parametrize(
    ("rows", "options", "said"),
    [
        ("0,14\n900,13\n", (), "widths.csv: `y` must lie on the face, within 800 mm"),
        ("0,14\n900,13\n", (), "its length is 1600 mm), got 900 mm."),
        ("0,14\n-500,-13\n", (), "widths.csv: `width` must be positive and finite everywhere, "),
        ("0,14\n-500,-13\n", (), "got -13 mm at y = -500 mm."),
        ("0,14\n", (), "widths.csv: `width` must have as many values as there are unknowns, 2,"),
        ("0,14\n9,13\n", ("--unknown", "hardness"), "--unknown: `unknowns` must be among load,"),
        ("0,14\n9,13\n", ("--scatter", "0 mm"), "--scatter: `scatter` must be positive"),
        ("0,14\n-70,350\n", (), "widths.csv: `end_loads` must press between the ends of the"),
        ("-70,350\n0,14\n70,350\n", (), "widths.csv: `crown` must be small against the diameter"),
    ],
)
def test_a_wrong_value_of_an_impression_is_named_with_its_file(
    tmp_path, smooth, rows, options, said
):
    (tmp_path / "widths.csv").write_text("y [mm],width [mm]\n" + rows, "utf-8")
    found = run("face", "read", smooth, tmp_path / "widths.csv", *options)
    assert (found.exit_code, found.stdout) == (2, "")
    assert said in found.stderr


def test_a_large_error_of_the_shop_formula_has_no_exponent():
    assert [_per_cent(share, "+") for share in (0.018, -0.5, -1.0, 12.345)] == [
        "+1.8 %",
        "-50 %",
        "-100 %",
        "+1234 %",
    ]


def test_a_case_without_a_face_is_told_what_is_missing():
    result = run("face", "solve", EXAMPLE.parent / "press-driven.toml")
    assert result.exit_code == 2
    assert "add a table [face]" in result.output


@pytest.mark.parametrize("style", ["light", "dark"])
def test_the_picture_names_its_axes(straight, style):
    figure = plot_face(straight, style=style)
    title = next(
        one
        for one in figure.axes[0].texts + figure.axes[0].get_children()
        if getattr(one, "get_text", str)() == "impression"
    )
    assert title.get_color() == palette_of(style).ink
    labels = [ax.get_ylabel() for ax in figure.axes]
    assert labels == [
        "nip width [mm]",
        "line load [N/mm]",
        "traction [N/mm]",
        "minus ends [mm]",
    ]
    figure.canvas.draw()
    for ax in figure.axes:  # a longer one runs into the picture above
        assert ax.yaxis.label.get_window_extent().height <= ax.get_window_extent().height
    (mean,) = figure.axes[1].get_legend().get_texts()
    assert mean.get_text() == "mean"


def test_netcdf_holds_the_face(tmp_path):
    """Every number of the JSON key "face" is in the netCDF file, with its unit."""
    xr = pytest.importorskip("xarray")
    path = tmp_path / "case.toml"
    path.write_text(SMOOTH)
    result = run("solve", path, "--out", tmp_path / "r.nc", "--json")
    assert result.exit_code == 0, result.output
    tree = json.loads(result.stdout)["face"]
    with xr.open_dataset(tmp_path / "r.nc") as file:
        assert file["face_load"].dims == ("y",)
        assert file["face_load"].attrs["units"] == "N/mm"
        assert list(file["y"].values) == tree["y"]
        for key in FACE_PROFILES.keys() - {"y"}:
            assert list(file[f"face_{key}"].values) == tree[key], key
        assert tree["added_length"] is None  # the nip is plane up to the ends
        assert isnan(float(file["face_added_length"]))
        for key in FACE_FIGURES.keys() - {"creepage", "added_length"}:
            assert float(file[f"face_{key}"]) == tree[key], key
        assert list(file["face_bearing_forces_upper"].values) == tree["bearing_forces"]["upper"]
        assert float(file["face_error_places"]) == tree["error"]["places"]
        assert file.attrs["face_converged"] == 1


def test_a_face_as_a_dataset(straight):
    dataset = straight.to_xarray()
    assert dataset["face_load"].values[0] == straight.load[0]
    assert set(dataset.coords) == {"y"}


def test_a_crown_is_found_for_an_evenness(tmp_path):
    path = tmp_path / "case.toml"
    path.write_text(SMOOTH)
    result = run(
        "find", path, "upper.shaft.crown", "--for", "face.evenness=0.9",
        "--between", "0 mm", "0.45 mm", "--json",
    )  # fmt: skip
    assert result.exit_code == 0, result.output
    value = json.loads(result.stdout)["value"]
    case = rn.read_case(path)
    found = rn.solve_face(with_crown(case.nip, "upper", rn.Crown(value)), case.face, case.model)
    assert found.evenness == pytest.approx(0.9, rel=1e-3)


def test_load_along_crown_is_swept():
    """The cases of a sweep are those that a face alone gives, to the last digit."""
    tree = parse_document(SMOOTH, "case.toml")
    study = {
        "case": tree,
        "parameters": [
            {"path": "upper.shaft.crown", "values": ["0.2 mm", "0.4 mm"]},
            {"path": "nip.load", "values": ["4 N/mm", "8 N/mm"]},
        ],
        "results": ["face.evenness", "face.total_load"],
    }
    table = rn.sweep(study, workers=1)
    assert set(table["status"]) == {"solved"}
    for i, (crown, load) in enumerate([(0.2, 4.0), (0.2, 8.0), (0.4, 4.0), (0.4, 8.0)]):
        case = parse_case(tree)
        nip = replace(with_crown(case.nip, "upper", rn.Crown(crown)), normal=rn.LineLoad(load))
        alone = rn.solve_face(nip, case.face, case.model)
        assert table["face.evenness"][i] == alone.evenness
        assert table["face.total_load"][i] == alone.total_load


@pytest.mark.parametrize("command", ["solve", "crown"])
@pytest.mark.parametrize("side", ["upper", "lower"])
def test_a_shaft_that_does_not_fit_is_named_with_its_file(tmp_path, command, side):
    """Both rollers have a shaft: the sentence says which one is meant."""
    tree = tomllib.loads(EXAMPLE.read_text("utf-8"))
    tree[side]["shaft"]["bore"] = "1 m"
    (tmp_path / "bored.json").write_text(json.dumps(tree), "utf-8")
    found = run("face", command, tmp_path / "bored.json")
    assert (found.exit_code, found.stdout) == (2, "")
    assert "bored.json: `bore` must be smaller than the core's diameter, " in found.stderr
    assert found.stderr.endswith(f"mm, got 1000 mm (in `{side}.shaft`).\n")


def test_fewer_than_one_process_is_refused():
    result = run("face", "solve", EXAMPLE, "--workers", "0")
    assert result.exit_code == 2
    assert "`--workers` must be 1 or more, got 0." in result.output


@pytest.mark.slow
def test_ctrl_c_is_for_the_command_and_not_for_its_processes():
    """Theirs wrote a traceback each; stopped, the command does not wait for their nips."""
    with _processes(2) as executor:
        assert executor.submit(signal.getsignal, signal.SIGINT).result() == signal.SIG_IGN

    def stopped():
        with _processes(2) as executor:
            executor.submit(sleep, 60.0)
            raise KeyboardInterrupt

    began = monotonic()
    with pytest.raises(KeyboardInterrupt):
        stopped()
    assert monotonic() - began < 50.0


@pytest.mark.slow
def test_two_processes_give_the_same(tmp_path):
    path = tmp_path / "case.toml"
    path.write_text(SMOOTH)
    one, two = (
        json.loads(run("face", "solve", path, "--json", "--workers", n).stdout) for n in ("1", "2")
    )
    assert one == two


def test_a_strain_energy_that_a_face_leaves_out_is_said_once(tmp_path):
    """The second order has no strain energy; geometry finite has."""
    text = (EXAMPLE.parent / "press-face.toml").read_text("utf-8")
    text = text.replace(
        "poisson = 0.5 }", 'poisson = 0.5, energy = { model = "gent", limit = 9 } }'
    )
    text += '\n[model]\ngeometry = "second"\n'
    file = tmp_path / "case.toml"
    file.write_text(text, "utf-8")
    for command in (["face", "solve"], ["solve"]):
        found = CliRunner().invoke(app, [*command, str(file)])
        assert found.exit_code == 0, found.output
        assert " ".join(found.stdout.split()).count("has a strain energy (Gent)") == 1
    case = parse_case(text)
    assert (
        "strain energy"
        in rn.solve_face(case.nip, case.face, rn.Model(geometry="linear")).warnings[-1]
    )
    along = rn.solve_face(case.nip, case.face, rn.Model(geometry="linear"))
    assert "strain energy" in along.warnings[-1]
    full = reservations_of(along.problem, along.balance, rn.Model(geometry="finite"))
    assert full == along.reservations[:-1]
