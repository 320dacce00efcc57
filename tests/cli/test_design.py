"""Design on the command line: answers, exit codes, files, one clear message."""

import json
import subprocess
import sys
import time
from math import pi
from pathlib import Path

import pytest
from typer.testing import CliRunner

import rollnip as rn
from rollnip.cli.app import app
from rollnip.closed_forms import contact_modulus, effective_radius
from rollnip.design.quantities import QUANTITIES
from rollnip.design.report import result_lines
from rollnip.sweeps import row as row_module
from rollnip.sweeps.store import Store

# Hertz: a^2 = 4 F R / (pi E*), Johnson (1985), eq. 4.43
LOAD = pi * contact_modulus(210e3, 0.3, 210e3, 0.3) * 0.2**2 / (4.0 * effective_radius(50.0, 25.0))
HERTZ = """
title = "Steel on steel"
[nip]
load = 100
friction = 0
[upper]
radius = "50 mm"
core = "steel"
[lower]
radius = "25 mm"
core = "steel"
[materials.steel]
model = "elastic"
modulus = "210 GPa"
poisson = 0.3
"""


@pytest.fixture
def case(tmp_path):
    path = tmp_path / "case.toml"
    path.write_text(HERTZ)
    return str(path)


def run(*arguments, stdin=None):
    return CliRunner().invoke(app, list(arguments), input=stdin)


def refused(*arguments) -> str:
    result = run(*arguments)
    assert (result.exit_code, result.stdout) == (2, "")
    assert "Traceback" not in result.stderr
    return result.stderr


def ask(case, *, wanted="nip_width=0.4 mm", between=("10 N/mm", "2 kN/mm"), path="nip.load"):
    return ("find", case, path, "--for", wanted, "--between", *between, "--geometry", "linear")


def test_a_tolerance_of_find_is_named_by_its_option(case):
    assert refused(*ask(case), "--tolerance", "0").startswith("rollnip: --tolerance: `tolerance`")


def test_find_says_what_where_and_how_sure(case):
    result = run(*ask(case))
    assert result.exit_code == 0
    assert result.stdout.startswith("nip.load = ")
    assert " ± " in result.stdout.splitlines()[0]
    assert "gives nip_width = 0.40000 mm. That is" not in result.stdout
    assert "solved again" in result.stdout


def test_whatever_was_asked_for_stands_among_the_results(case):
    row = json.loads(run(*ask(case), "--json").stdout)["scalars"]
    defined = [name for name in QUANTITIES if row.get(name) is not None]
    assert len(defined) > 5
    for name in defined:
        assert name in {line.partition("  ")[2].split(" ")[0] for line in result_lines(row, name)}
    long = "heat.upper.bond_temperature"
    assert f"  {long} 70.000 degC" in result_lines(row | {long: 70.0}, long)
    assert result_lines({}) == ["", "Results there, solved again"]


def test_find_refuses_a_second_result_rather_than_forget_the_first(case):
    result = run(*ask(case), "--for", "peak_pressure=1 MPa")
    assert result.exit_code == 2
    assert result.stdout == ""
    assert "--for: must be given once" in result.stderr


def test_find_answers_in_the_unit_of_the_question_too(case):
    result = run(*ask(case, between=("100 pli", "10000 pli")))
    assert " pli." in result.stdout.splitlines()[0]


def test_find_as_json_and_as_a_case(case, tmp_path):
    out = tmp_path / "found.json"
    result = run(*ask(case), "--json", "--out", str(out))
    tree = json.loads(result.stdout)
    assert tree["value"] == pytest.approx(LOAD, abs=tree["error"])
    found = rn.read_case(out)
    assert found.nip.normal.load == tree["value"]
    assert rn.solve(found.nip, found.model).nip_width == pytest.approx(0.4, rel=2e-4)


def test_find_writes_toml_with_units(case, tmp_path):
    out = tmp_path / "found.toml"
    assert run(*ask(case), "--out", str(out)).exit_code == 0
    found = rn.read_case(out)
    assert found.nip.title == "Steel on steel"
    assert 'load = "' in out.read_text()
    assert found.nip.normal.load == pytest.approx(LOAD, rel=0.01)


@pytest.mark.parametrize("ending", ["json", "toml"])
def test_find_with_a_plane(case, tmp_path, ending):
    # its radius is infinite, which JSON has no number for
    Path(case).write_text(HERTZ.replace('radius = "50 mm"', "radius = inf"))
    out = tmp_path / f"found.{ending}"
    result = run(*ask(case), "--json", "--out", str(out))
    assert result.exit_code == 0
    assert json.loads(result.stdout)["case"]["upper"]["radius"] == "inf"
    found = rn.read_case(out).nip
    # half the curvature more than before: F = pi E* a^2 / (4 R)
    assert found.normal.load == pytest.approx(LOAD * (50.0 * 25.0 / 75.0) / 25.0, rel=0.01)


def test_find_nothing_is_exit_1_and_no_file(case, tmp_path):
    out = tmp_path / "found.json"
    result = run(*ask(case, wanted="nip_width=40 mm"), "--out", str(out))
    assert (result.exit_code, result.stderr) == (1, "")
    assert result.stdout.startswith("No nip.load between 10.000 N/mm and 2000.0 N/mm was found")
    assert result.stdout.endswith(" cases tried.\n")  # solved or not
    assert not out.exists()


@pytest.mark.parametrize(
    ("changes", "message"),
    [
        ({"wanted": "nip_width"}, "`--for` must be a result and its value"),
        ({"wanted": "nip_width="}, "`--for` must be a result and its value"),
        ({"wanted": "nipwidth=4 mm"}, "--for: "),
        ({"wanted": "nipwidth=4 mm"}, 'did you mean "nip_width"?'),
        ({"wanted": "nip_width=4"}, '--for: `wanted` must be a length such as "4.5 mm", got "4"'),
        ({"path": "nip.lod"}, 'did you mean "load"'),
        ({"between": ("2 kN/mm", "10 N/mm")}, "--between: `low` must be below `high`; give the"),
        ({"between": ("20", "1")}, 'got "20": it needs a unit, as in "20 N/mm".'),
        ({"between": ("1 mm", "10 N/mm")}, "--between: `low` must be a force per length"),
    ],
)
def test_find_refuses(case, changes, message):
    assert message in refused(*ask(case, **changes))


def test_find_refuses_files(case, tmp_path):
    assert "must end in .toml or .json" in refused(*ask(case), "--out", str(tmp_path / "a.txt"))
    assert "there is no such file" in refused(*ask(str(tmp_path / "none.toml")))
    assert "model.geometry: must be 'linear'" in refused(*ask(case)[:-1], "flat")
    assert not Path(tmp_path / "a.txt").exists()


OPTIMISE = """
title = "Largest load"
case = "case.toml"
[[parameters]]
path = "nip.load"
low = "10 N/mm"
high = "500 N/mm"
[objective]
maximise = "load"
[[limits]]
result = "nip_width"
at_most = "0.4 mm"
[search]
solves = 60
"""
TOLERANCE = """
case = "case.toml"
[[parameters]]
path = "nip.load"
distribution = "normal"
deviation = "5 N/mm"
[[limits]]
result = "nip_width"
at_most = "{limit}"
[sampling]
count = 20
"""


@pytest.fixture
def study(case, tmp_path):
    def written(text):
        path = tmp_path / "study.toml"
        path.write_text(text)
        return str(path)

    return written


def test_optimise_says_writes_and_leaves_with_0(study, tmp_path):
    out = tmp_path / "best.json"
    arguments = ("--geometry", "linear", "--out", str(out))
    result = run("optimise", study(OPTIMISE), *arguments)
    assert (result.exit_code, result.stderr) == (0, "")
    assert result.stdout.startswith("Largest load\n\nThe largest load found is ")
    assert "The limit decides: nip_width at most 0.40000 mm." in result.stdout
    # the search ends at 1e-3 of the interval, the width is known to 1e-3: the load to 2e-3
    assert rn.read_case(out).nip.normal.load == pytest.approx(LOAD, abs=0.002 * LOAD + 0.5)


def test_optimise_without_a_case_that_keeps_the_limits_is_exit_1(study, tmp_path):
    out = tmp_path / "best.json"
    text = OPTIMISE.replace("0.4 mm", "0.01 mm")
    result = run("optimise", study(text), "--geometry", "linear", "--json", "--out", str(out))
    assert (result.exit_code, result.stderr) == (1, "")
    tree = json.loads(result.stdout)
    assert tree["is_feasible"] is False
    assert tree["message"].startswith("No case was found that keeps all limits.")
    assert not out.exists()


def test_tolerance_says_and_draws(study, tmp_path):
    plot = tmp_path / "t.png"
    arguments = ("--geometry", "linear", "--workers", "1")
    text = TOLERANCE.format(limit="1 mm")
    result = run("tolerance", study(text), *arguments, "--plot", str(plot))
    assert (result.exit_code, result.stderr) == (0, "")
    assert result.stdout.startswith("Steel on steel\n\n20 samples")
    assert "nip_width at most 1.0000 mm: 100.0 %" in result.stdout
    assert plot.read_bytes().startswith(b"\x89PNG")


def test_tolerance_as_json(study):
    text = TOLERANCE.format(limit="1 mm")
    result = run("tolerance", study(text), "--geometry", "linear", "--workers", "1", "--json")
    tree = json.loads(result.stdout)
    (scatter,) = tree["scatters"]
    # a ~ F^(1/2): 5 % of the load are 2.5 % of the width
    assert scatter["deviation"] / scatter["mean"] == pytest.approx(0.025, rel=0.05)
    assert tree["together"]["limits"] == [{"quantity": "nip_width", "limit": 1.0, "tolerance": 0.0}]


TABLE = """nip.load [N/mm],nip_width [mm],peak_pressure [MPa],converged
1,4,0.2,1
2,6,0.3,1
2.5,5,0.4,1
3,9,0.1,0
4,,,1
"""


def test_pareto_picks_rows(tmp_path):
    table, plot, out = (tmp_path / name for name in ("r.csv", "p.png", "front.csv"))
    table.write_text(TABLE)
    wanted = ("--minimise", "peak_pressure", "--maximise", "nip_width")
    result = run("pareto", str(table), *wanted, "--plot", str(plot))
    assert (result.exit_code, result.stderr) == (0, "")
    assert result.stdout.splitlines() == [*TABLE.splitlines()[:3]]
    assert plot.read_bytes().startswith(b"\x89PNG")
    assert run("pareto", str(table), *wanted, "--out", str(out)).stdout == ""
    assert out.read_text() == result.stdout


def test_pareto_refuses(tmp_path):
    table = tmp_path / "r.csv"
    table.write_text(TABLE)
    one = ("pareto", str(table), "--minimise", "peak_pressure")
    assert "must name two or more columns in all, got 1" in refused(*one)
    assert 'has no column "nip_widht"; did you mean "nip_width"?' in refused(
        *one, "--maximise", "nip_widht"
    )
    table.write_text(TABLE.replace("0.4", "high"))
    assert 'line 4: "peak_pressure" must be a number, got "high"' in refused(
        *one, "--maximise", "nip_width"
    )
    both = (*one[2:], "--maximise", "nip_width")
    assert "there is no such file" in refused("pareto", str(tmp_path / "n.csv"), *both)
    twice = refused(*one, "--maximise", "peak_pressure")
    assert "must name each column once, got peak_pressure twice" in twice


@pytest.mark.parametrize("command", ["optimise", "tolerance"])
def test_study_files_that_are_wrong(command, study, tmp_path):
    path = study('case = "case.toml"\nparameter = 3\n')
    result = run(command, path)
    assert (result.exit_code, result.stdout) == (2, "")
    assert 'parameter: is not a known key; did you mean "parameters"?' in result.stderr
    if command == "optimise":  # the parameters of a tolerance may come from a fit
        assert "parameters: is missing." in result.stderr
    assert "there is no such file" in refused(command, str(tmp_path / "none.toml"))


@pytest.fixture(params=["find", "optimise", "tolerance"])
def solving(request, case, study):
    """A command that solves many cases."""
    if request.param == "find":
        return ask(case)
    text = OPTIMISE if request.param == "optimise" else TOLERANCE.format(limit="0.3 mm")
    return (request.param, study(text), "--geometry", "linear", "--workers", "1")


class Solves:
    """Counts solves, and stops at one of them as Ctrl-C does."""

    def __init__(self, monkeypatch):
        self.count, self.stop_at = 0, 0
        self._solve = row_module.solve
        monkeypatch.setattr(row_module, "solve", self)

    def __call__(self, *arguments, **options):
        if self.count == self.stop_at - 1:
            raise KeyboardInterrupt
        self.count += 1
        return self._solve(*arguments, **options)


def test_what_was_stopped_goes_on_where_it_was(solving, tmp_path, monkeypatch):
    database = tmp_path / "kept.db"
    solves = Solves(monkeypatch)
    wanted = run(*solving)
    once, solves.count, solves.stop_at = solves.count, 0, 5
    stopped = run(*solving, "--database", str(database))
    assert (stopped.exit_code, stopped.stdout) == (130, "")
    assert stopped.stderr.startswith("rollnip: interrupted; 4 ")
    assert "are in " in stopped.stderr
    assert stopped.stderr.endswith(f"{database}: the same command goes on from there.\n")
    solves.count, solves.stop_at = 0, 0
    resumed = run(*solving, "--database", str(database))
    assert (resumed.exit_code, resumed.stdout) == (wanted.exit_code, wanted.stdout)
    assert solves.count <= once - 4  # a place asked for twice is solved once
    solves.stop_at = solves.count + 1
    assert run(*solving, "--database", str(database)).stdout == wanted.stdout


def test_without_a_database_an_interrupt_promises_nothing(solving, monkeypatch):
    Solves(monkeypatch).stop_at = 3
    stopped = run(*solving)
    assert (stopped.exit_code, stopped.stderr) == (130, "rollnip: interrupted.\n")


def test_a_database_of_another_question_is_refused(solving, case, tmp_path):
    database = tmp_path / "kept.db"
    assert run(*solving, "--database", str(database)).exit_code == 0
    Path(case).write_text(HERTZ.replace("50 mm", "60 mm"))
    said = refused(*solving, "--database", str(database))
    assert f'{database}: holds another study ("Steel on steel", ' in said
    assert "of nip.load): its case or its parameters differ" in said
    database.write_text("no database, but a text that is long enough to have been one")
    assert "is no database of a sweep" in refused(*solving, "--database", str(database))


def test_what_is_wanted_may_change_without_a_new_solve(case, tmp_path, monkeypatch):
    database = ("--database", str(tmp_path / "kept.db"))
    solves = Solves(monkeypatch)
    first = run(*ask(case), *database)
    before = solves.count
    again = run(*ask(case, wanted="peak_pressure=800 MPa"), *database)
    assert first.exit_code == again.exit_code == 0
    assert solves.count - before <= before - 5  # the five from limit to limit were there


@pytest.mark.slow
def test_killed_at_any_moment_a_search_goes_on_from_there(study, tmp_path):
    path = study(OPTIMISE.replace("solves = 30", "solves = 60"))
    wanted = run("optimise", path, "--geometry", "curved")
    database = tmp_path / "kept.db"
    code = "from rollnip.cli import main; main()"
    options = ("--geometry", "curved", "--database", str(database))
    command = [sys.executable, "-c", code, "optimise", path, *options]
    log, held = tmp_path / "kept.db-wal", [0]
    for _ in range(2):
        process = subprocess.Popen(command, stdout=subprocess.DEVNULL)
        size = log.stat().st_size if log.is_file() else 0
        until = time.monotonic() + 300.0
        while not (log.is_file() and log.stat().st_size > size + 60_000):
            assert process.poll() is None
            assert time.monotonic() < until
            time.sleep(0.01)
        process.kill()
        process.wait()
        with Store(database) as store:
            held.append(store.size)
    assert held == sorted(set(held))  # each went on where the one before was killed
    assert run("optimise", path, *options).stdout == wanted.stdout


@pytest.mark.parametrize(
    "arguments", [("find", "gone.toml", "nip.load"), ("optimise", "gone.toml")]
)
def test_a_file_that_is_missing_is_refused_before_the_numerics_are_loaded(arguments):
    extra = ("--for", "nip_width=8", "--between", "1", "2") if arguments[0] == "find" else ()
    code = (
        "import sys; from rollnip.cli import main\n"
        "try: main()\n"
        "except SystemExit as left: sys.exit(9 if 'rollnip.solver' in sys.modules else left.code)"
    )
    command = [sys.executable, "-c", code, *arguments, *extra]
    done = subprocess.run(command, capture_output=True, text=True, check=False)
    assert done.returncode == 2
    assert "there is no such file" in done.stderr


@pytest.mark.parametrize("command", ["optimise", "tolerance", "solve"])
def test_names_that_no_file_can_have_and_directories_are_refused_by_name(command, tmp_path):
    long = "n" * 5000 + ".toml"
    assert refused(command, str(tmp_path)).startswith(f"rollnip: {tmp_path}: is a directory")
    message = refused(command, long)
    assert message.startswith("rollnip: nnn")
    assert "standard output" not in message
