"""How commands meet a terminal, a pipe and a shell."""

import io
import json
import os
import re
import subprocess
import sys
from pathlib import Path

import pytest
from typer.main import get_command
from typer.testing import CliRunner

import rollnip.cli
from rollnip.cli.app import app

ROOT = Path(__file__).parents[2]
START = "from rollnip.cli import main; main()"
CASE = """
title = "Düse"
[nip]
load = "1 N/mm"
friction = 0.3
[model]
geometry = "linear"
[upper]
radius = "50 mm"
layers = [ { thickness = "2 mm", material = { model = "elastic", modulus = 1, poisson = 0.5 } } ]
[lower]
radius = "25 mm"
"""
STUDY = '[[parameters]]\npath = "nip.load"\nvalues = [1.0, 2.0]\n'


@pytest.fixture
def folder(tmp_path):
    (tmp_path / "case.toml").write_text(CASE, "utf-8")
    (tmp_path / "study.toml").write_text('case = "case.toml"\n' + STUDY, "utf-8")
    rows = "".join(f"{x},100\n" for x in range(-20, 21) for _ in range(6))
    (tmp_path / "bursts.csv").write_text("x [mm],velocity [mm/s]\n" + rows, "utf-8")
    return tmp_path


def start(folder, *arguments, **options):
    return subprocess.Popen(
        [sys.executable, "-c", START, *arguments],
        cwd=folder,
        stderr=subprocess.PIPE,
        text=True,
        **options,
    )


def check_letters(arguments, encoding, code, text, errors):
    assert "Traceback" not in errors
    assert code == (2 if "ü" in arguments[1] else 0), errors
    if arguments == ("solve", "case.toml"):
        assert {"ascii": "D\\xfcse"}.get(encoding, "Düse") in text
        assert {"latin-1": "±", "cp437": "±"}.get(encoding, "+-") in text
    if "--json" in arguments:
        assert json.loads(text)["title"] == "Düse"


@pytest.mark.parametrize("encoding", ["ascii", "latin-1", "cp437"])
@pytest.mark.parametrize(
    "arguments",
    [
        ("solve", "case.toml"),
        ("solve", "case.toml", "--json"),
        ("sweep", "study.toml", "--out", "table.csv", "--workers", "1"),
        ("verify", "--only", "Carter"),
        ("solve", "none-ü.toml"),
    ],
    ids=lambda one: "-".join(one[:2]),
)
def test_letters_that_the_terminal_has_not_are_written_as_others(
    folder, arguments, encoding, monkeypatch
):
    streams = [io.TextIOWrapper(io.BytesIO(), encoding=encoding) for _ in range(2)]
    monkeypatch.chdir(folder)
    monkeypatch.setattr(rollnip.cli, "keep_freed_memory", lambda: None)
    monkeypatch.setattr(sys, "argv", ["rollnip", *arguments])
    monkeypatch.setattr(sys, "stdout", streams[0])
    monkeypatch.setattr(sys, "stderr", streams[1])
    with pytest.raises(SystemExit) as left:
        rollnip.cli.main()
    for stream in streams:
        stream.flush()
    text, errors = (stream.buffer.getvalue().decode(encoding) for stream in streams)
    check_letters(arguments, encoding, left.value.code or 0, text, errors)


@pytest.mark.parametrize("arguments", [("solve", "case.toml"), ("solve", "none-ü.toml")])
def test_letters_of_a_process_whose_terminal_has_few(folder, arguments):
    environment = os.environ | {"PYTHONIOENCODING": "ascii", "PYTHONUTF8": "0"}
    process = start(folder, *arguments, stdout=subprocess.PIPE, env=environment, encoding="ascii")
    text, errors = process.communicate(timeout=300)
    check_letters(arguments, "ascii", process.returncode, text, errors)


@pytest.mark.parametrize(
    "arguments",
    [
        ("solve", "case.toml"),
        ("solve", "case.toml", "--json"),
        ("sweep", "study.toml", "--out", "table.csv", "--workers", "1"),
        ("verify", "--only", "Carter", "--json"),
        ("lda", "estimate", "bursts.csv"),
        ("schema",),
        ("--version",),
        ("--help",),
    ],
    ids=lambda one: "-".join(one[:2] + one[-1:]),
)
def test_a_reader_that_has_gone_is_no_error(folder, arguments):
    reader, writer = os.pipe()
    os.close(reader)
    process = start(folder, *arguments, stdout=writer)
    os.close(writer)
    errors = process.communicate(timeout=300)[1]
    assert process.returncode == 141, errors
    assert "Traceback" not in errors
    assert "rollnip:" not in errors


def commands(group, path=()):
    yield path
    for name, command in getattr(group, "commands", {}).items():
        yield from commands(command, (*path, name))


@pytest.mark.parametrize("path", list(commands(get_command(app))), ids="-".join)
def test_every_command_answers_to_h(path):
    command = get_command(app)
    with command.make_context("rollnip", [], resilient_parsing=True) as context:
        for name in path:
            command = command.commands[name]
            context = command.make_context(name, [], parent=context, resilient_parsing=True)
        assert context.help_option_names == ["-h", "--help"]


def test_h_prints_the_help(folder):
    long, short = (
        start(folder, "solve", option, stdout=subprocess.PIPE).communicate(timeout=300)[0]
        for option in ("--help", "-h")
    )
    assert long == short
    assert "--geometry" in short


@pytest.mark.parametrize(
    ("shell", "words", "found"),
    [
        ("bash", {"COMP_WORDS": "rollnip so", "COMP_CWORD": "1"}, "solve"),
        ("bash", {"COMP_WORDS": "rollnip solve --geo", "COMP_CWORD": "2"}, "--geometry"),
        ("zsh", {"_TYPER_COMPLETE_ARGS": "rollnip lda es"}, "estimate"),
        (
            "fish",
            {"_TYPER_COMPLETE_ARGS": "rollnip sw", "_TYPER_COMPLETE_FISH_ACTION": "get-args"},
            "sweep",
        ),
    ],
)
def test_a_shell_can_complete(folder, shell, words, found):
    code = "import sys; sys.argv = ['rollnip']\n" + START
    done = subprocess.run(
        [sys.executable, "-c", code],
        env=os.environ | words | {"_ROLLNIP_COMPLETE": f"complete_{shell}"},
        cwd=folder,
        capture_output=True,
        text=True,
        check=False,
        timeout=300,
    )
    assert found in done.stdout, done.stderr


def test_results_of_lda_and_paper_are_json_too(folder):
    done = start(folder, "lda", "estimate", "bursts.csv", "--json", stdout=subprocess.PIPE)
    tree = json.loads(done.communicate(timeout=300)[0])
    assert len(tree["x"]) == len(tree["velocity"]) == 41
    assert tree["velocity"][0] == pytest.approx(100.0)
    assert tree["strain"] is None


def test_no_command_takes_private_names_of_another_file_or_imports_in_a_circle():
    sources = {
        path.stem: path.read_text("utf-8")
        for path in Path(rollnip.cli.__file__).parent.glob("*.py")
    }
    for text in sources.values():
        assert re.findall(r"from rollnip\.cli\.\w+ import .*\b_\w+", text) == []
    for name, text in sources.items():
        if name not in ("__init__", "app"):
            assert "rollnip.cli.app" not in text


@pytest.mark.parametrize(
    ("arguments", "said"),
    [
        (("solve", ""), "an argument is empty; give the name of a file"),
        (("feed", ""), "an argument is empty"),
        (("sweep", "status", ""), "an argument is empty"),
        (("lda", "simulate", "case.toml", "--out", ""), "`--out` is empty; give it a value"),
        (("solve", "case.toml", "--out="), "`--out` is empty"),
        (("find", "case.toml", "", "--for", "nip_width=1"), "an argument is empty"),
    ],
)
def test_an_empty_argument_is_refused_by_every_command(arguments, said, tmp_path, monkeypatch):
    """As of an unset shell variable; as a path it would mean the working directory."""
    monkeypatch.chdir(tmp_path)
    done = CliRunner().invoke(app, arguments)
    assert (done.exit_code, done.stdout) == (2, "")
    assert done.stderr.startswith(f"rollnip: {said}")
    assert done.stderr.count("\n") == 1
    assert not list(tmp_path.iterdir())
