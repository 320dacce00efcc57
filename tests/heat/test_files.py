"""Heat from case files, on the command line, in files, pictures and sweeps."""

import json
import tomllib
from pathlib import Path

import pytest
from typer.testing import CliRunner

import rollnip as rn
from rollnip.cli.app import app
from rollnip.heat import Branch, BranchPoint
from rollnip.heat.report import heat_dict
from rollnip.io import case_hash, case_parts, case_python, heat_text, parse_case
from rollnip.materials import TYPICAL
from rollnip.plots import plot_heat
from rollnip.sweeps import evaluate

EXAMPLES = Path(__file__).parents[2] / "examples"
CALENDER = (EXAMPLES / "heat-calender.toml").read_text(encoding="utf-8")
TEXT = """
title = "Warm press"
[nip]
load = 20
friction = 0.3
speed = 3000
[model]
geometry = "linear"
[heat]
ambient = "23 degC"
[upper]
radius = 100
[[upper.layers]]
thickness = 10
material = "rubber"
[upper.heat]
film = "50 W/(m2 K)"
[lower]
radius = 100
[lower.heat]
film = "50 W/(m2 K)"
[materials.rubber]
model = "standard-linear-solid"
modulus = 3
stiffening = 3
relaxation_time = "1 ms"
poisson = 0.49
thermal = "natural-rubber-filled"
"""
# the same without growth and shift: one nip
QUICK = TEXT.replace('"natural-rubber-filled"', '"natural-rubber-filled"\nexpansion = 0')
SHIFT = (
    'temperature = 23\nshift = { model = "wlf", c1 = 8.86, c2 = 101.6, reference = "23 degC" }\n'
)


def run(*arguments):
    return CliRunner().invoke(app, [str(one) for one in arguments])


@pytest.fixture
def case_file(tmp_path):
    path = tmp_path / "warm.toml"
    path.write_text(QUICK, encoding="utf-8")
    return path


def test_the_examples_are_read():
    case = parse_case(CALENDER)
    heat = case.heat
    assert heat.ambient == 25.0
    assert heat.upper.core == rn.Coolant(30.0, film=600.0)
    assert heat.upper.shell.thickness == 30.0
    assert heat.upper.shell.thermal == TYPICAL["steel"]
    assert heat.lower.core == rn.Held(60.0)
    assert case.nip.upper.layers[0].material.thermal == TYPICAL["sbr-filled"]
    idler = rn.read_case(EXAMPLES / "heat-idler.toml")
    assert idler.heat.upper == rn.Cooling(film=0.0)  # a plane needs no table


def test_units_and_single_keys():
    text = TEXT.replace(
        'thermal = "natural-rubber-filled"',
        'conductivity = "0.25 W/(m K)"\ndensity = "1.15 g/cm3"\nheat_capacity = "1.9 kJ/(kg K)"\n'
        'expansion = "200 ppm/K"',
    ).replace('film = "50 W/(m2 K)"', 'film = "5 BTU/(h ft2 degF)"', 1)
    case = parse_case(text)
    assert case.nip.upper.layers[0].material.thermal == rn.Thermal(
        conductivity=0.25, density=1150.0, heat_capacity=1900.0, expansion=2e-4
    )
    assert case.heat.upper.film == pytest.approx(28.391, rel=1e-4)
    text = TEXT.replace('"natural-rubber-filled"', '"natural-rubber-filled"\nconductivity = 0.4')
    thermal = parse_case(text).nip.upper.layers[0].material.thermal
    assert thermal.conductivity == 0.4
    assert thermal.density == TYPICAL["natural-rubber-filled"].density


def test_the_hash_knows_the_heat():
    base = case_hash(parse_case(TEXT))
    for old, new in (
        ("ambient = ", 'start = "30 degC"\nambient = '),
        ('film = "50', 'film = "51'),
        ("natural-rubber-filled", "polyurethane"),
    ):
        assert case_hash(parse_case(TEXT.replace(old, new))) != base
    without = TEXT
    for table in ('[heat]\nambient = "23 degC"\n',):
        without = without.replace(table, "")
    for side in ("upper", "lower"):
        without = without.replace(f'[{side}.heat]\nfilm = "50 W/(m2 K)"\n', "")
    # for a cold nip thermal properties do not count
    plain = without.replace('thermal = "natural-rubber-filled"\n', "")
    assert case_hash(parse_case(without)) == case_hash(parse_case(plain)) != base


def test_a_case_is_written_as_python():
    names = {"rn": rn}
    text = case_python(parse_case(CALENDER.replace('title = "Calender bowl"', "")))
    built = text.split("solution = ")[0] + "heat = " + text.split("heat = ")[1].split("warm =")[0]
    exec(built, names)
    case = parse_case(CALENDER)
    assert names["heat"] == case.heat
    assert names["nip"].upper == case.nip.upper


@pytest.mark.parametrize(
    ("old", "new", "sentence"),
    [
        ('ambient = "23 degC"', 'ambient = "-300 degC"', "heat.ambient: must be above absolute"),
        (
            'ambient = "23 degC"',
            "ambeint = 23",
            'heat.ambeint: is not a known key; did you mean "am',
        ),
        (
            "[lower.heat]\nfilm",
            "[lower.heat]\nflim",
            "lower.heat.flim: is not a known key; did you",
        ),
        ('[lower.heat]\nfilm = "50 W/(m2 K)"', "", "lower.heat: is missing; add a table"),
        ('[heat]\nambient = "23 degC"', "", "upper.heat: must stand beside a table"),
        ('"natural-rubber-filled"', '"cork"', "materials.rubber.thermal: must be one of natural"),
        ('thermal = "natural-rubber-filled"', "density = 1000", "rubber.conductivity: must be giv"),
        (
            "[lower.heat]",
            '[lower.heat]\ncore = "-300 degC"',
            "lower.heat.core: must be above absolute zero",
        ),
        ("[lower.heat]", '[lower.heat]\ncore = "hot"', "lower.heat.core: must be a temperature"),
        (
            "[lower.heat]",
            '[lower.heat]\ncore = { coolant = "-280 degC", film = 10 }',
            "lower.heat.core.coolant: must be above absolute zero",
        ),
        (
            "[lower.heat]",
            "[lower.heat]\nshell = { thickness = 3 }",
            "lower.heat.shell.conductivity: must be",
        ),
        ('film = "50 W/(m2 K)"', 'film = "50 W/(m K)"', "that is a thermal conductivity"),
        (
            "[upper]",
            "[sheet]\nthickness = 0.1\nmodulus = 3500\npoisson = 0.3\n[upper]",
            "heat.sheet: is missing; a sheet takes heat along: add a table",
        ),
        (
            "[upper]",
            '[heat.sheet]\ntemperature = 23\nthermal = "polyurethane"\n[upper]',
            "heat.sheet.thickness: must be given in a case without a table",
        ),
        ('film = "50 W/(m2 K)"', 'flim = "50 W/(m2 K)"', 'did you mean "film"'),
    ],
)
def test_wrong_files_say_what_is_wrong(old, new, sentence):
    assert old in TEXT
    with pytest.raises(rn.CaseFileError, match=sentence):
        parse_case(TEXT.replace(old, new, 1))


@pytest.fixture(scope="module")
def solved():
    case = parse_case(QUICK)
    return case, rn.solve_heat(case.nip, case.heat, case.model)


def test_the_command_prints_a_summary(case_file):
    result = run("heat", case_file)
    assert result.exit_code == 0, result.output
    assert "hot spot" in result.stdout
    assert "do not follow the temperature" in result.stdout


def test_the_files_hold_both_rollers_and_a_case_again(solved):
    case, solution = solved
    tree = json.loads(heat_text(solution))
    heat = tree["heat"]
    assert set(heat["upper"]) >= {
        "r", "temperature", "bond_temperature", "hot_spot", "hot_spot_depth", "power",
    }  # fmt: skip
    assert heat["stable"] is True
    assert abs(heat["balance"]) < 1e-4
    assert tree["case"]["upper"]["heat"] == {"film": 50.0, "core": "insulated"}
    assert tree["case_hash"] == case_hash(case)
    # the case in a result is a case again
    again = parse_case(tree["case"])
    assert (again.nip, again.heat) == (case.nip, case.heat)


@pytest.mark.slow  # netCDF, a picture and a warm-up
def test_files_and_pictures(case_file, tmp_path):
    pytest.importorskip("xarray")
    pytest.importorskip("h5netcdf")
    import xarray as xr

    out, plot = tmp_path / "warm.nc", tmp_path / "warm.png"
    result = run("heat", case_file, "--out", out, "--plot", plot, "--duration=10 min", "--quiet")
    assert result.exit_code == 0, result.output
    assert plot.stat().st_size > 10_000
    with xr.open_dataset(out, group="upper", engine="h5netcdf") as upper:
        assert upper["temperature"].attrs["units"] == "degC"
        assert float(upper["hot_spot"]) == pytest.approx(float(upper["temperature"].max()))
        assert upper["hot_spot"].attrs["units"] == "degC"
        assert upper["to_air"].attrs["units"] == "mW/mm"
    with xr.open_dataset(out, engine="h5netcdf") as nip:
        assert nip.attrs["heat_converged"] == 1
        assert nip.attrs["heat_status"].startswith("Steady")
        assert float(nip["heat_stable"]) == 1.0
        assert abs(float(nip["heat_balance"])) < 1e-4
        assert float(nip["heat_warm_nip_width"]) == float(nip["nip_width"])
        assert float(nip["heat_cold_nip_width"]) > 0.0  # no shift: the same nip
        assert float(nip["heat_error_temperature"]) < 0.1
        parts = [xr.open_dataset(out, group=side, engine="h5netcdf") for side in ("upper", "lower")]
        assert float(nip["heat_power"]) == pytest.approx(sum(float(one["power"]) for one in parts))
    with xr.open_dataset(out, group="warm_up", engine="h5netcdf") as course:
        assert float(course["hot_spot_upper"][-1]) > float(course["hot_spot_upper"][0])


@pytest.mark.slow  # 30 nips with sub-layers
def test_a_branch_on_the_command_line(case_file):
    case_file.write_text(TEXT + SHIFT, encoding="utf-8")
    result = run(
        "heat", case_file, "--follow", "load=10 N/mm:30 N/mm", "--json", "--tolerance=5e-3"
    )
    assert result.exit_code == 0, result.output
    branch = json.loads(result.stdout)["branch"]
    assert branch["turning"] is None
    assert branch["reached"] is True
    values = [point["value"] for point in branch["points"]]
    assert values == sorted(values)
    assert values[-1] == pytest.approx(30.0)


@pytest.mark.parametrize(
    ("arguments", "sentence"),
    [
        (("--follow", "width=3 mm"), "`--follow` must be"),
        (("--follow", "speed=9 m/s:2 m/s"), "`--follow` must begin above 0 and below its end"),
        (
            ("--follow", "speed=1e-9 m/s:2 m/s"),
            "No heat arises where the branch begins, so there is none to follow: begin at more",
        ),
        (("--follow", "speed=20 N"), "--follow: must be a speed"),
        (("--duration", "2 mm"), "--duration: must be a time"),
        (("--duration", "-2 h"), "`--duration` must be positive, got -2 h."),
    ],
)
def test_wrong_options_say_what_is_wrong(case_file, arguments, sentence):
    result = run("heat", case_file, *arguments)
    assert result.exit_code == 2
    assert sentence in result.stderr


def test_a_case_without_heat_says_what_to_add():
    result = run("heat", EXAMPLES / "press-driven.toml")
    assert result.exit_code == 2
    assert "heat: is missing; add a table [heat]" in result.stderr


@pytest.mark.slow  # it is followed from cold to say where it ends
def test_no_steady_state_is_a_sentence_and_exit_code_1(case_file):
    """An entropic modulus rises with the temperature, and so does the heat at a given approach."""
    material = TEXT.index("[materials.rubber]")
    text = TEXT[:material].replace("load = 20", "approach = 0.8").replace("50 W", "5 W")
    text = text.replace("speed = 3000", "speed = 8000") + (
        '[materials.rubber]\nmodel = "loss-factor"\nmodulus = 5\nloss_factor = 0.2\n'
        'poisson = 0.49\nthermal = "natural-rubber-filled"\nexpansion = 0\ntemperature = 23\n'
        'shift = { model = "arrhenius", activation_energy = 60, reference = 23, '
        'vertical = "entropic" }\n'
    )
    case_file.write_text(text, encoding="utf-8")
    result = run("heat", case_file, "--json")
    assert result.exit_code == 1, result.output
    heat = json.loads(result.stdout)["heat"]
    assert heat["converged"] is False
    assert heat["stable"] is None
    assert heat["error"] == {"temperature": None}
    assert heat["status"].startswith("No steady state exists up to a rise of 400 K")


def test_solve_gives_the_cold_nip_and_its_heat(case_file, solved, tmp_path):
    case, warm = solved
    out = tmp_path / "warm.json"
    result = run("solve", case_file, "--out", out)
    assert result.exit_code == 0, result.output
    assert "Heat (converged and verified" in result.stdout
    assert "over the nip" in result.stdout
    tree = json.loads(out.read_text(encoding="utf-8"))
    # the keys of the nip keep their meaning; the warm nip stands in "heat"
    assert tree["nip_width"] == pytest.approx(warm.cold.nip_width, rel=1e-9)
    assert tree["heat"]["upper"]["hot_spot"] == pytest.approx(warm.upper.hot_spot, rel=1e-9)
    assert tree["case"]["heat"] == {"ambient": 23.0}
    assert tree["case_hash"] == case_hash(case)


def test_a_face_and_heat_stand_in_one_result():
    """The parts of a result with both: the case holds both, and so does its hash."""
    text = QUICK.replace("[heat]", '[face]\nlength = "500 mm"\n[heat]').replace(
        "[upper.heat]", '[upper.shaft]\nbearing_distance = "600 mm"\n[upper.heat]'
    )
    text = text.replace("friction = 0.3", "friction = 0")
    case = parse_case(text)
    along = rn.solve_face(case.nip, case.face, case.model)
    warm = rn.solve_heat(case.nip, case.heat, case.model)
    parts = case_parts(along, warm)
    assert parts["case_hash"] == case_hash(case)
    again = parse_case(parts["case"])
    assert (again.nip, again.face, again.heat) == (case.nip, case.face, case.heat)
    assert parts["heat"]["power"] == warm.power
    assert parts["face"]["mean_load"] == pytest.approx(20.0)


def test_a_speed_limit_for_a_bond_temperature_is_found():
    """Without a shift heat and rise are known at every speed, so the limit is the case's own."""
    from rollnip.design import find

    tree = tomllib.loads(QUICK)
    wanted = evaluate(tree)["heat.upper.bond_temperature"]
    where = ("nip.speed", "heat.upper.bond_temperature", wanted, "2 m/s", "4 m/s")
    found = find(tree, *where, points=3, tolerance=2e-3)
    assert found.value == pytest.approx(3000.0, rel=5e-3)
    assert found.scalars["heat.upper.bond_temperature"] == pytest.approx(wanted, rel=2e-3)


def test_rows_of_sweeps_hold_the_heat():
    row = evaluate(tomllib.loads(QUICK))
    assert row["status"] == "solved"
    assert row["heat.upper.hot_spot"] > row["heat.upper.surface_temperature"] > 23.0
    assert row["heat.power"] == pytest.approx(row["heat.upper.power"] + row["heat.lower.power"])
    cold = evaluate(
        tomllib.loads(
            QUICK.split("[heat]")[0]
            + "[upper]"
            + "".join(
                QUICK.split("[upper]")[1]
                .replace('[upper.heat]\nfilm = "50 W/(m2 K)"\n', "")
                .replace('[lower.heat]\nfilm = "50 W/(m2 K)"\n', "")
            )
        )
    )
    assert cold["status"] == "solved"
    assert cold["heat.power"] is None


def test_a_belt_has_no_radius_in_the_file():
    text = QUICK.replace("[lower]\nradius = 100", "[lower]\nradius = inf")
    text = text.replace('[lower.heat]\nfilm = "50 W/(m2 K)"\n', "")
    case = parse_case(text)
    solution = rn.solve_heat(case.nip, case.heat, case.model)
    assert heat_dict(solution)["lower"]["r"] == [None]
    json.dumps(heat_dict(solution), allow_nan=False)


@pytest.mark.parametrize("style", ["light", "dark"])
def test_a_picture_shows_both_rollers(style, solved, faint_words):
    figure = plot_heat(solved[1], style=style)
    assert faint_words(figure) == []
    labels = [text.get_text() for text in figure.axes[0].get_legend().get_texts()]
    assert labels[0].startswith("upper roller: hot spot")
    assert labels[1].startswith("lower roller")


def test_a_picture_of_a_branch_tells_stable_states_from_others(solved):
    def point(value, hot_spot, *, stable):
        return BranchPoint(value, hot_spot - 23.0, hot_spot, None, None, 1.0, stable, None)

    points = (
        point(10.0, 25.0, stable=True),
        point(30.0, 30.0, stable=True),
        point(20.0, 50.0, stable=False),
        point(15.0, 70.0, stable=False),
        point(40.0, 90.0, stable=True),
        point(60.0, 95.0, stable=True),
    )
    branch = Branch("load", "N/mm", points, points[1], False, "It reaches 60 N/mm.", 60)
    ax = plot_heat(solved[1], None, branch).axes[1]
    drawn = [(list(line.get_xdata()), line.get_linestyle()) for line in ax.lines]
    assert drawn[:3] == [
        ([10.0, 30.0], "-"),
        ([30.0, 20.0, 15.0, 40.0], "--"),
        ([40.0, 60.0], "-"),
    ]
    labels = [text.get_text() for text in ax.get_legend().get_texts()]
    assert labels == ["stable", "not stable", "thermal runaway at 30.00 N/mm", "this case"]
