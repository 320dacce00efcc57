"""Every extra in an environment of its own, and the core alone: what works, and what is said."""

from __future__ import annotations

import json
import os
import re
import subprocess
import sys
import venv
import zipfile
from pathlib import Path
from urllib.request import urlopen

import pytest

ROOT = Path(__file__).parents[2]
BARE = str(Path(__file__).with_name("bare.py"))
CASE = str(ROOT / "examples" / "configuration-1-free.toml")
STUDY = """
[case]
title = "One coated roller"
[case.nip]
load = 0.74
friction = 0.3
[case.model]
geometry = "linear"
[case.upper]
radius = 50
layers = [ { thickness = 2, material = { model = "elastic", modulus = 1.0, poisson = 0.5 } } ]
[case.lower]
radius = 25
[[parameters]]
path = "nip.load"
values = [0.5, 1.0]
"""
INSTALL = "of the extra `{0}`: install it with `pip install '.[{0}]'` in the folder of the source"


def bare(extras: str, *arguments: str, folder: Path) -> subprocess.CompletedProcess[str]:
    return subprocess.run(
        [sys.executable, BARE, extras, *arguments],
        cwd=folder,
        capture_output=True,
        text=True,
        check=False,
        timeout=300,
    )


@pytest.fixture
def folder(tmp_path: Path) -> Path:
    (tmp_path / "study.toml").write_text(STUDY, "utf-8")
    (tmp_path / "data.xlsx").write_bytes(b"PK")
    return tmp_path


def test_what_is_hidden_cannot_be_imported(folder: Path) -> None:
    code = "import importlib.util as u; print(*[u.find_spec(n) is None for n in {!r}])"
    extras = ("xarray", "polars", "distributed", "fastapi", "pytest")
    done = bare("-", "-c", code.format(extras), folder=folder)
    assert done.stdout.split() == ["True"] * 5, done.stderr
    done = bare("netcdf", "-c", code.format(extras), folder=folder)
    assert done.stdout.split() == ["False", "True", "True", "True", "True"], done.stderr


@pytest.mark.slow
@pytest.mark.parametrize(
    "arguments",
    [
        ("solve", CASE, "--plot", "nip.png", "--out", "nip.json"),
        ("solve", CASE, "--fields", "fields.vtr", "--quiet"),
        ("sweep", "run", "study.toml", "--out", "table.csv", "--workers", "1"),
        ("verify", "--only", "Carter"),
        ("schema",),
        ("--help",),
        ("serve", "--help"),
    ],
    ids=lambda arguments: "-".join(arguments[:2]) if arguments[0] == "sweep" else arguments[0],
)
def test_the_core_alone_works(folder: Path, arguments: tuple[str, ...]) -> None:
    if arguments[0] == "sweep":
        arguments = ("sweep", *arguments[2:])
    done = bare("-", *arguments, folder=folder)
    assert done.returncode == 0, done.stderr
    assert "Traceback" not in done.stderr


@pytest.mark.slow
@pytest.mark.parametrize(
    ("arguments", "extra"),
    [
        (("solve", CASE, "--out", "nip.nc"), "netcdf"),
        (("solve", CASE, "--fields", "fields.nc"), "netcdf"),
        (("sweep", "study.toml", "--out", "table.parquet"), "tables"),
        (("sweep", "study.toml", "--out", "a.csv", "--dask", "local"), "cluster"),
        (("pareto", "data.xlsx", "--minimise", "a", "--maximise", "b"), "tables"),
        (("serve", "--no-open"), "web"),
    ],
    ids=lambda one: one if isinstance(one, str) else one[0],
)
def test_the_core_alone_names_the_extra(
    folder: Path, arguments: tuple[str, ...], extra: str
) -> None:
    before = set(folder.iterdir())
    done = bare("-", *arguments, folder=folder)
    assert done.returncode == 2, done.stderr
    assert done.stdout == ""
    assert done.stderr.count("\n") == 1
    assert INSTALL.format(extra) in done.stderr
    assert {path.name for path in set(folder.iterdir()) - before} <= {"a.db", "table.db"}


def test_python_names_the_extra(folder: Path) -> None:
    code = (
        "import rollnip as rn\n"
        f"case = rn.read_case({CASE!r})\n"
        "solution = rn.solve(case.nip, case.model)\n"
        "print(solution.summary()); solution._repr_html_()\n"
        "try: solution.to_xarray()\n"
        "except rn.RollnipError as error: print(error)\n"
        "from rollnip.web import create_app\n"
        "try: create_app()\n"
        "except rn.RollnipError as error: print(error)\n"
    )
    done = bare("-", "-c", code, folder=folder)
    assert done.returncode == 0, done.stderr
    for extra in ("netcdf", "web"):
        assert INSTALL.format(extra) in done.stdout


EXTRAS = {
    "netcdf": (("solve", CASE, "--out", "nip.nc", "--fields", "fields.nc"),),
    "tables": (("sweep", "study.toml", "--out", "table.parquet", "--workers", "1"),),
    "cluster": (
        ("sweep", "study.toml", "--out", "table.csv", "--dask", "local", "--workers", "1"),
    ),
}


@pytest.mark.slow
@pytest.mark.parametrize("extra", EXTRAS)
def test_each_extra_alone_is_enough(folder: Path, extra: str) -> None:
    for arguments in EXTRAS[extra]:
        done = bare(extra, *arguments, folder=folder)
        assert done.returncode == 0, done.stderr


@pytest.mark.slow
def test_the_page_needs_its_extra_alone(folder: Path) -> None:
    command = [sys.executable, BARE, "web", "serve", "--no-open", "--port", "0"]
    with subprocess.Popen(command, cwd=folder, stderr=subprocess.PIPE, text=True) as server:
        try:
            assert server.stderr is not None
            said = ""
            while not (found := re.search(r"http://\S+/", said)):
                line = server.stderr.readline()
                assert line, said
                said += line
            with urlopen(f"{found[0]}static/js/figures.js", timeout=60) as answer:
                assert b"nip_width" in answer.read()
        finally:
            server.kill()


@pytest.mark.slow
def test_the_wheel_in_a_clean_environment(tmp_path: Path) -> None:
    """The one real environment: it fetches the packages that the core asks for."""
    environment = {name: value for name, value in os.environ.items() if name != "PYTHONPATH"}

    def run(*command: str) -> str:
        done = subprocess.run(
            command, cwd=tmp_path, capture_output=True, text=True, check=False, env=environment
        )
        assert done.returncode == 0, done.stdout + done.stderr
        return done.stdout

    quiet = ("--quiet", "--disable-pip-version-check")
    run(sys.executable, "-m", "pip", "wheel", *quiet, "--no-deps", "--wheel-dir", ".", str(ROOT))
    (wheel,) = tmp_path.glob("*.whl")
    with zipfile.ZipFile(wheel) as archive:
        names = archive.namelist()
        files = [one for one in archive.infolist() if not one.filename.endswith("/RECORD")]
        largest = max(files, key=lambda one: one.file_size)
    # Code and small examples only: a picture, a page of documentation or a result is larger.
    assert largest.file_size < 50_000, largest.filename
    assert not [name for name in names if name.endswith((".png", ".pdf", ".svgz"))]
    assert "rollnip/examples/configuration-1-free.toml" in names
    assert wheel.stat().st_size < 1_500_000
    venv.create(tmp_path / "clean", with_pip=True)
    python = str(tmp_path / "clean" / "bin" / "python")
    run(python, "-m", "pip", "install", *quiet, str(wheel))
    command = str(tmp_path / "clean" / "bin" / "rollnip")
    tree = json.loads(run(command, "solve", CASE, "--json"))
    assert tree["converged"]
    assert tree["case"]["title"] == "Configuration I, free"
    installed = run(python, "-m", "pip", "list", "--format=freeze").lower()
    assert not [name for name in ("xarray", "polars", "fastapi") if f"{name}==" in installed]
    done = subprocess.run([command, "serve"], capture_output=True, text=True, check=False)
    assert (done.returncode, done.stderr.count("\n")) == (2, 1)
    assert INSTALL.format("web") in done.stderr
