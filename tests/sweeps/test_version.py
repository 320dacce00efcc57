"""The fingerprint of the code that solves: what it is made of, and what it is good for."""

from __future__ import annotations

import subprocess
import sys
from pathlib import Path
from shutil import copytree
from typing import Any

import pytest

import rollnip as rn
from rollnip._errors import RollnipError
from rollnip.sweeps import crew, version
from rollnip.sweeps.crew import processes
from rollnip.sweeps.version import BESIDE, fingerprint, own_version

PACKAGE = Path(rn.__file__).parent


@pytest.fixture
def copy(tmp_path: Path) -> Path:
    return copytree(PACKAGE, tmp_path / "rollnip", ignore=lambda *_: ["__pycache__"])


@pytest.fixture
def _afresh() -> Any:
    own_version.cache_clear()
    yield
    own_version.cache_clear()


def test_it_is_the_same_in_every_place_and_however_lines_end(copy: Path) -> None:
    assert fingerprint(copy) == fingerprint(PACKAGE)
    for file in copy.rglob("*.py"):
        file.write_bytes(file.read_bytes().replace(b"\n", b"\r\n"))
    assert fingerprint(copy) == fingerprint(PACKAGE)


@pytest.mark.parametrize(
    "name", ["solver.py", "contact/complementarity.py", "io/build.py", "sweeps/row.py", "_units.py"]
)
def test_any_change_of_what_decides_the_numbers_is_seen(copy: Path, name: str) -> None:
    file = copy / name
    file.write_bytes(file.read_bytes().replace(b"0.5", b"0.4") + b"x = 1\n")
    assert fingerprint(copy) != fingerprint(PACKAGE)
    file.unlink()
    assert fingerprint(copy) != fingerprint(PACKAGE)


def test_what_only_asks_or_shows_does_not_count(copy: Path) -> None:
    for name in BESIDE:
        assert (copy / name).is_dir()
        (copy / name / "new.py").write_text("x = 1\n", "utf-8")
    assert fingerprint(copy) == fingerprint(PACKAGE)


def test_nothing_that_a_case_needs_is_left_out() -> None:
    code = (
        "import sys, rollnip\n"
        "from rollnip.sweeps.row import evaluate\n"
        "tree = {'upper': {'radius': 50.0}, 'lower': {'radius': 50.0}, 'nip': {'load': 1.0}}\n"
        "evaluate(tree)\n"
        "print(*{m.split('.')[1] for m in sys.modules if m.startswith('rollnip.')})\n"
    )
    ran = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True)
    loaded = set(ran.stdout.split())
    assert "contact" in loaded
    assert not loaded & BESIDE


@pytest.mark.usefixtures("_afresh")
def test_rows_of_other_code_of_the_same_release_are_refused(
    tree: dict[str, Any], tmp_path: Path, copy: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    ours, database = own_version(), tmp_path / "a.db"
    rn.sweep(tree, workers=1, database=database)
    (copy / "solver.py").write_text("x = 1\n", "utf-8")
    monkeypatch.setattr(version, "_PACKAGE", copy)
    own_version.cache_clear()
    assert own_version() != ours
    with pytest.raises(RollnipError, match="results of two versions are not mixed") as caught:
        rn.sweep(tree, workers=1, database=database)
    assert ours in str(caught.value)
    assert own_version() in str(caught.value)
    with pytest.raises(RollnipError, match="results of two versions are not mixed"):
        rn.sweep(tree, workers=1, known=[database])


@pytest.mark.usefixtures("_afresh")
def test_without_sources_the_release_has_to_do(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(version, "_PACKAGE", tmp_path / "archive.zip" / "rollnip")
    assert own_version() == rn.__version__


def test_workers_that_have_read_newer_code_are_refused(monkeypatch: pytest.MonkeyPatch) -> None:
    # here this process takes itself for older; the workers are asked for theirs
    monkeypatch.setattr(crew, "own_version", lambda: "0.0.1")
    with pytest.raises(RollnipError, match=r"changed since this process began"), processes(1):
        pass
