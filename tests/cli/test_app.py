"""The command: exit codes, one clear message, nothing half-written."""

import json
import os
import subprocess
import sys
from dataclasses import replace
from importlib import import_module
from pathlib import Path
from types import SimpleNamespace

import pytest
from typer.testing import CliRunner

import rollnip as rn
from rollnip import cli
from rollnip.cli.app import app

EXAMPLE = Path(__file__).parents[2] / "examples" / "configuration-2-driven.toml"
CASE = """
[nip]
load = 1.78
friction = 2.8
[upper]
radius = "50 mm"
[[upper.layers]]
thickness = "2 mm"
material = { model = "elastic", modulus = "0.91 MPa", poisson = 0.5 }
[lower]
radius = "25 mm"
"""


@pytest.fixture
def quick(monkeypatch, solution):
    """The command with a solver that answers at once; the list takes what it was asked."""
    asked = []

    def solve(nip, model=None, on_failure="return"):
        asked.append((nip, model))
        return replace(solution, nip=nip, model=model)

    monkeypatch.setattr(import_module("rollnip.solver"), "solve", solve)
    return asked


@pytest.fixture
def case(tmp_path):
    path = tmp_path / "case.toml"
    path.write_text(CASE)
    return str(path)


def run(*arguments, stdin=None):
    return CliRunner().invoke(app, list(arguments), input=stdin)


def refused(*arguments, stdin=None) -> str:
    """The one message of a wrong input: exit 2, nothing on stdout, no traceback."""
    result = run(*arguments, stdin=stdin)
    assert result.exit_code == 2
    assert result.stdout == ""
    assert result.stderr.startswith("rollnip: ")
    assert "Traceback" not in result.stderr
    assert result.stderr.count("\n") == 1
    return result.stderr


def test_summary(quick, case):
    result = run("solve", case)
    assert result.exit_code == 0
    for text in ("converged and verified", "nip width", "7.220", "mm", "slip", "A reservation."):
        assert text in result.stdout
    assert result.stderr == ""


def test_json(quick, case):
    result = run("solve", case, "--json")
    assert result.exit_code == 0
    assert json.loads(result.stdout)["nip_width"] == 7.22


def test_quiet_prints_nothing(quick, case, tmp_path, monkeypatch):
    # a solution made by hand has nothing inside; the whole page is drawn in test_the_real_thing
    pictures = import_module("rollnip.plots")
    monkeypatch.setattr(pictures, "plot_overview", lambda solution: pictures.new_axes().figure)
    out, plot = tmp_path / "r.json", tmp_path / "p.png"
    result = run("solve", case, "--quiet", "--out", str(out), "--plot", str(plot))
    assert (result.exit_code, result.stdout, result.stderr) == (0, "", "")
    assert json.loads(out.read_text())["schema"] == 1
    assert plot.read_bytes().startswith(b"\x89PNG")


def test_standard_input(quick):
    assert run("solve", "-", "--json", stdin=CASE).exit_code == 0
    assert "is not valid TOML" in refused("solve", "-", stdin="load 5")


def test_options_override_the_file(quick, case):
    run("solve", case, "--geometry", "linear", "--tolerance", "1 %")
    assert quick[-1][1] == rn.Model(geometry="linear", tolerance=0.01)


def test_not_converged_is_exit_1_and_prints_all_the_same(monkeypatch, case, solution):
    def solve(nip, model=None, on_failure="return"):
        return replace(solution, converged=False, status="The mesh ran out.")

    monkeypatch.setattr(import_module("rollnip.solver"), "solve", solve)
    result = run("solve", case, "--json")
    assert result.exit_code == 1
    assert json.loads(result.stdout)["converged"] is False
    result = run("solve", case)
    assert result.exit_code == 1
    assert "NOT CONVERGED: The mesh ran out." in result.stdout


@pytest.mark.parametrize(
    ("arguments", "hint"),
    [
        (("--tolerance", "nan"), "--tolerance: "),
        (("--tolerance", "abc"), "--tolerance: must be a plain number"),
        (("--tolerance", "-1"), "--tolerance: "),
        (("--geometry", "flat"), "--geometry: "),
        (("--out", "result.csv"), "must end in .json or .nc"),
        (("--out", "."), "must end in"),
        (("--out", "none/result.json"), "no directory none"),
        (("--plot", "picture.gif"), "must end in .png"),
    ],
)
def test_wrong_options(quick, case, arguments, hint):
    assert hint in refused("solve", case, *arguments)
    assert quick == []  # refused before the work


def test_wrong_files(quick, tmp_path, case):
    assert "no such file" in refused("solve", str(tmp_path / "none.toml"))
    assert "is a directory" in refused("solve", str(tmp_path))
    Path(case).write_text(CASE.replace("0.91 MPa", "0.91 mm"))
    assert "upper.layers[0].material.modulus: must be a pressure" in refused("solve", case)


def test_a_traction_beyond_friction_names_the_limit(case):
    Path(case).write_text(CASE.replace("friction", "traction = 6\nfriction"))
    assert "nip.traction: must be smaller than friction * load = 4.984 N/mm" in refused(
        "solve", case
    )


def test_usage_errors_are_exit_2():
    for arguments in (("solve",), ("solve", "a", "b"), ("solve", "--what"), ("what",)):
        result = run(*arguments)
        assert (result.exit_code, result.stdout) == (2, "")


def test_version_and_schema():
    for arguments in (("version",), ("--version",)):
        assert run(*arguments).stdout == f"rollnip {rn.__version__}\n"
    assert json.loads(run("schema").stdout)["title"] == "rollnip case file"


COMMAND = [sys.executable, "-c", "from rollnip.cli import main; main()"]


def test_a_closed_pipe_is_no_traceback():
    with subprocess.Popen(
        [*COMMAND, "schema"], stdout=subprocess.PIPE, stderr=subprocess.PIPE
    ) as process:
        process.stdout.close()
        errors = process.stderr.read()
        assert process.wait(60) == 141
    assert errors == b""


@pytest.mark.skipif(not Path("/dev/full").exists(), reason="no /dev/full here")
@pytest.mark.parametrize("argument", ["schema", "--help"])
def test_a_full_disk_is_one_line(argument):
    with Path("/dev/full").open("w") as full:
        done = subprocess.run(
            [*COMMAND, argument], stdout=full, stderr=subprocess.PIPE, text=True, check=False
        )
    assert done.returncode == 2
    assert done.stderr == "rollnip: cannot write to the standard output: No space left on device.\n"


@pytest.mark.skipif(not Path("/dev/full").exists(), reason="no /dev/full here")
def test_messages_that_cannot_be_written_leave_the_exit_code():
    """An exit of 1 would say that a nip did not converge."""
    with Path("/dev/full").open("w") as full:
        done = subprocess.run(
            [*COMMAND, "dma", "fit", "none.csv"],
            stdout=subprocess.PIPE,
            stderr=full,
            text=True,
            check=False,
        )
    assert (done.returncode, done.stdout) == (2, "")


@pytest.mark.skipif(os.name == "nt", reason="closes descriptors of a child")
@pytest.mark.parametrize(("descriptor", "code"), [(0, 2), (1, 0), (2, 0)])
def test_closed_streams_are_empty_ones(descriptor, code):
    done = subprocess.run(
        [*COMMAND, *(["solve", "-"] if descriptor == 0 else ["version"])],
        preexec_fn=lambda: os.close(descriptor),
        capture_output=True,
        text=True,
        check=False,
    )
    assert done.returncode == code
    assert "Traceback" not in done.stderr


def test_interrupted_is_130(monkeypatch, case):
    def solve(nip, model=None, on_failure="return"):
        raise KeyboardInterrupt

    monkeypatch.setattr(import_module("rollnip.solver"), "solve", solve)
    result = run("solve", case)
    assert (result.exit_code, result.stdout) == (130, "")
    assert result.stderr == "rollnip: interrupted.\n"


def test_the_real_thing(tmp_path):
    out, plot = tmp_path / "r.json", tmp_path / "p.png"
    command = [*COMMAND, "solve", str(EXAMPLE), "--json", "--out", str(out), "--plot", str(plot)]
    done = subprocess.run(command, capture_output=True, text=True, check=False)
    assert (done.returncode, done.stderr) == (0, "")
    tree = json.loads(done.stdout)
    assert tree == json.loads(out.read_text())
    assert tree["converged"] is True
    assert tree["traction"] == pytest.approx(0.53, rel=1e-6)
    assert sorted(tmp_path.iterdir()) == [plot, out]


def test_what_only_the_solver_can_refuse_names_the_file(case):
    Path(case).write_text(CASE.replace("1.78", "1e6"))
    message = refused("solve", case)
    assert message.startswith(f"rollnip: {case}: `load` must be small enough")


def test_fields_inside_the_layers(tmp_path):
    target = tmp_path / "fields.vtr"
    result = run("solve", str(EXAMPLE), "--fields", str(target), "-q")
    assert result.exit_code == 0
    assert result.stdout == ""
    assert target.read_text().startswith("<?xml")


def test_fields_in_a_format_unknown(tmp_path):
    case = str(EXAMPLE)
    assert ".vtr" in refused("solve", case, "--fields", str(tmp_path / "fields.csv"))


def test_the_tree_of_a_face_is_made_once(monkeypatch, quick, case, tmp_path):
    along = SimpleNamespace(converged=True)
    made = []

    def parts(solution, warm):
        assert warm is None
        made.append(solution)
        return {"face": {"load": 1.0}}

    monkeypatch.setattr("rollnip.cli.app._along_the_face", lambda problem, model: along)
    monkeypatch.setattr("rollnip.io.case_parts", parts)
    out = tmp_path / "result.json"
    printed = run("solve", case, "--out", str(out), "--json")
    assert printed.exit_code == 0
    assert made == [along]
    assert (
        json.loads(printed.stdout)["face"] == json.loads(out.read_text())["face"] == {"load": 1.0}
    )


@pytest.mark.parametrize(
    ("layers", "geometry", "said"),
    [(300, "finite", True), (300, "curved", False), (20, "finite", False)],
)
def test_what_takes_minutes_is_said_first(quick, tmp_path, layers, geometry, said):
    material = '{ model = "elastic", modulus = 1, poisson = 0.5 }'
    layer = f"[[upper.layers]]\nthickness = 0.005\nmaterial = {material}\n"
    head = "[nip]\nload = 1.78\nfriction = 2.8\n[lower]\nradius = 25\n[upper]\nradius = 50\n"
    path = tmp_path / "many.toml"
    path.write_text(head + layers * layer)
    result = run("solve", str(path), "--geometry", geometry, "-q")
    assert ("300 layers take long" in result.stderr) == said


def test_ctrl_c_while_a_compiled_module_loads_is_130(monkeypatch, case):
    """Such a module makes another error of it; one that is broken by itself is still heard of."""

    def solve(nip, model=None, on_failure="return"):
        raise ImportError("initialization failed") from cause

    monkeypatch.setattr(import_module("rollnip.solver"), "solve", solve)
    cause = KeyboardInterrupt()
    result = run("solve", case)
    assert (result.exit_code, result.stderr) == (130, "rollnip: interrupted.\n")
    cause = None
    assert isinstance(run("solve", case).exception, ImportError)


def test_ctrl_c_before_the_commands_are_loaded_ends_quietly(monkeypatch):
    def interrupted():
        raise KeyboardInterrupt

    monkeypatch.setattr(cli, "keep_freed_memory", interrupted)
    with pytest.raises(SystemExit) as left:
        cli.main()
    assert left.value.code == 130


def test_the_help_names_what_most_users_want_first():
    lines = CliRunner().invoke(app, ["--help"]).stdout.split("Commands:")[1].splitlines()
    names = [line.split()[0] for line in lines if line.startswith("  ") and line[2] != " "]
    assert names[:3] == ["solve", "serve", "face"]
    assert len(names) == len(app.registered_commands) + len(app.registered_groups)
