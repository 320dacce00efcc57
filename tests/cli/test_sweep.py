"""The commands ``sweep``: files, messages, exit codes; a process killed at any moment."""

from __future__ import annotations

import json
import os
import random
import resource
import signal
import sqlite3
import subprocess
import sys
import time
from pathlib import Path
from typing import Any

import pytest
from typer.testing import CliRunner

from rollnip.cli import progress
from rollnip.cli.app import app
from rollnip.sweeps import cluster, read_study
from rollnip.sweeps.store import Store

ROOT = Path(__file__).parents[2]
COMMAND = [sys.executable, "-c", "from rollnip.cli import main; main()", "sweep"]


@pytest.fixture
def study(tmp_path: Path) -> Path:
    """Six cases, one of them refused."""
    layer = {"thickness": 2.0, "material": {"model": "elastic", "modulus": 0.91, "poisson": 0.45}}
    tree = {
        "case": {
            "nip": {"load": 0.74, "friction": 0.3},
            "model": {"geometry": "linear"},
            "upper": {"radius": 50.0, "layers": [layer]},
            "lower": {"radius": 25.0},
        },
        "parameters": [
            {"path": "upper.layers[0].thickness", "values": ["1 mm", "2 mm"]},
            {"path": "nip.load", "values": [0.5, -1.0, 1.0]},
        ],
    }
    path = tmp_path / "study.json"
    path.write_text(json.dumps(tree))
    return path


def enlarged(study: Path, count: int) -> Path:
    """The same study with more loads."""
    tree = json.loads(study.read_text())
    tree["parameters"][1] = {"path": "nip.load", "start": 0.1, "stop": 2.0, "count": count // 2}
    study.write_text(json.dumps(tree))
    return study


def sweep(*arguments: Any) -> Any:
    return CliRunner().invoke(app, ["sweep", *map(str, arguments)])


def refused(*arguments: Any) -> str:
    result = sweep(*arguments)
    assert result.exit_code == 2, result.output
    assert result.stdout == ""
    assert result.stderr.startswith("rollnip: ")
    assert "Traceback" not in result.stderr
    return result.stderr


def test_one_command_makes_the_table_and_tells_what_became_of_the_cases(
    study: Path, tmp_path: Path
) -> None:
    out = tmp_path / "results.csv"
    result = sweep(study, "--out", out, "--workers", 1)
    assert result.exit_code == 0
    assert f"{out}: 6 cases: 4 solved, 2 refused\n" in result.stdout
    assert "first not solved, case 1: nip.load: must be positive" in result.stdout
    assert result.stderr == ""  # no bar where there is no terminal
    before = out.read_bytes()
    again = sweep("run", study, "--out", out, "--workers", 2)
    assert again.exit_code == 0
    assert " a second" not in again.stdout
    assert out.read_bytes() == before


def test_shards_are_merged(study: Path, tmp_path: Path) -> None:
    out = tmp_path / "results.csv"
    for part in ("1/2", "2/2"):
        assert sweep(study, "--out", out, "--shard", part, "--workers", 1).exit_code == 0
        assert not out.exists()
    files = [tmp_path / f"results.{i}-of-2.db" for i in (1, 2)]
    assert sweep("merge", *files, "--out", out).exit_code == 0
    whole = tmp_path / "whole.csv"
    assert sweep(study, "--out", whole, "--workers", 1).exit_code == 0
    assert out.read_bytes() == whole.read_bytes()
    assert "3 of 6 cases are missing" in refused("merge", files[0], "--out", out)


def test_profiles_are_written_beside(study: Path, tmp_path: Path) -> None:
    pytest.importorskip("h5netcdf")
    out, profiles = tmp_path / "a.csv", tmp_path / "p.nc"
    assert sweep(study, "--out", out, "--profiles", profiles, "--workers", 1).exit_code == 0
    assert profiles.stat().st_size > 1000


@pytest.mark.parametrize(
    ("options", "words"),
    [
        (["--shard", "3/2"], '--shard: must be i/n with 1 <= i <= n, such as 2/8, got "3/2"'),
        (["--shard", "half"], 'got "half"'),
        (["--out", "a.ods"], "must end in .csv or .parquet or .xlsx"),
        (["--profiles", "a.txt"], "must end in .nc"),
        (["--database", "none/a.db"], "none/a.db: cannot write, there is no directory none."),
        (["--dask", "somewhere"], 'must be like tcp://host:8786, or "local", got "somewhere"'),
        (["--dask", "tcp://127.0.0.1:1"], "no Dask scheduler answers there"),
    ],
)
def test_wrong_options_are_one_message(
    study: Path,
    tmp_path: Path,
    monkeypatch: pytest.MonkeyPatch,
    options: list[str],
    words: str,
) -> None:
    monkeypatch.chdir(tmp_path)
    if "--dask" in options:
        pytest.importorskip("distributed")
        monkeypatch.setattr(cluster, "PATIENCE", "1s")
    said = refused(study, *options)
    assert words in said
    assert "goes on from there" not in said  # nothing was done


def test_a_huge_study_wants_to_be_meant(study: Path) -> None:
    enlarged(study, 2_400_000)
    said = refused(study, "--workers", 1)
    assert "makes 2,400,000 cases, more than 1,000,000; say --yes if that is meant" in said


def test_the_example_is_a_study() -> None:
    for path in (ROOT / "examples" / "sweep").glob("*.toml"):
        if "[[parameters]]" in path.read_text():
            assert read_study(path).count == 24


def heed_interrupts() -> None:
    """A shell lets what it starts in the background ignore Ctrl-C, and so would this process."""
    signal.signal(signal.SIGINT, signal.SIG_DFL)


def start(study: Path, out: Path, **more: Any) -> subprocess.Popen[str]:
    """A process to be waited for with `communicate`."""
    more.setdefault("preexec_fn", heed_interrupts)
    return subprocess.Popen(
        [*COMMAND, str(study), "--out", str(out), "--workers", "2"],
        stdout=subprocess.PIPE,
        stderr=subprocess.PIPE,
        text=True,
        **more,
    )


def rows(database: Path) -> dict[int, Any]:
    """What a database holds; empty where it is none yet."""
    if not database.is_file() or not database.stat().st_size:
        return {}
    with Store(database) as store:
        return {row[0]: row[1:] for row in store.rows(["position", "hash", "nip_width", "status"])}


def wait_for_rows(database: Path, process: subprocess.Popen[str], more: int = 60_000) -> None:
    """Until the log of the database has grown by some bytes; the database itself is locked."""
    log = database.with_name(database.name + "-wal")
    size = log.stat().st_size if log.is_file() else 0
    until = time.monotonic() + 300.0
    while process.poll() is None and time.monotonic() < until:
        if log.is_file() and log.stat().st_size > size + more:
            return
        time.sleep(0.01)


def test_status_of_a_sweep_that_was_stopped_and_its_table_so_far(
    study: Path, tmp_path: Path
) -> None:
    whole, database = tmp_path / "whole.csv", tmp_path / "whole.db"
    done = sweep(study, "--out", whole, "--workers", 1, "--plot", tmp_path / "whole.png")
    assert done.exit_code == 0, done.stderr
    assert (tmp_path / "whole.png").read_bytes().startswith(b"\x89PNG")
    said = sweep("status", database)
    assert said.exit_code == 0
    assert f"{database}: 6 of 6 cases; no process is writing it" in said.stdout
    assert "4 solved, 2 refused" in said.stdout
    with sqlite3.connect(database) as base:
        base.execute("DELETE FROM cases WHERE position > 2")  # as if stopped there
    base.close()
    some = tmp_path / "some.csv"
    said = sweep("status", database, "--out", some, "--json")
    assert said.exit_code == 1
    tree = json.loads(said.stdout)
    assert [tree[key] for key in ("cases", "open", "solved", "refused")] == [6, 3, 2, 1]
    assert tree["is_running"] is False
    assert tree["first_not_solved"]["case"] == 1
    assert some.read_text().splitlines() == whole.read_text().splitlines()[:4]
    refused("status", tmp_path / "none.db")
    again = sweep(study, "--out", whole, "--workers", 1, "--json")
    assert [json.loads(again.stdout)[key] for key in ("cases", "open", "solved")] == [6, 0, 4]


@pytest.mark.slow
def test_status_while_it_runs(study: Path, tmp_path: Path) -> None:
    """The database was locked, and nobody could tell how far a sweep was."""
    enlarged(study, 2000)
    process = start(study, tmp_path / "out.csv", start_new_session=True)
    wait_for_rows(tmp_path / "out.db", process)
    first = json.loads(sweep("status", tmp_path / "out.db", "--json").stdout)
    table, second = tmp_path / "so-far.csv", first
    until = time.monotonic() + 300.0
    while second["solved"] == first["solved"] and time.monotonic() < until:
        time.sleep(0.1)
        second = json.loads(sweep("status", tmp_path / "out.db", "--out", table, "--json").stdout)
    os.killpg(process.pid, signal.SIGINT)
    process.communicate(timeout=300)
    assert first["is_running"]
    assert 0 < first["solved"] < second["solved"] < second["cases"]
    assert len(table.read_text().splitlines()) > second["solved"]


def test_a_log_has_a_line_now_and_then(
    capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    now = [0.0]
    monkeypatch.setattr(progress, "monotonic", lambda: now[0])
    with progress.progress(5000, "solving") as advance:
        for _ in range(1000):
            now[0] += 0.1
            advance()
    said = capsys.readouterr().err
    assert said == "rollnip: 600 of 5,000 cases, 10 a second, 0:07:20 left\n"


@pytest.mark.slow
def test_killed_at_any_moment_nothing_finished_is_lost(study: Path, tmp_path: Path) -> None:
    enlarged(study, 60)
    whole = tmp_path / "whole.csv"
    assert sweep(study, "--out", whole, "--workers", 1).exit_code == 0
    chance = random.Random(9)
    out, database = tmp_path / "out.csv", tmp_path / "out.db"
    known: dict[int, Any] = {}
    kills = 0
    while not out.exists():
        process = start(study, out, start_new_session=True)
        if kills < 4:
            wait_for_rows(database, process, chance.randrange(100, 60_000))
            time.sleep(chance.uniform(0.0, 0.05))
            kills += process.poll() is None
            process.kill()
        _, said = process.communicate()
        assert process.returncode in (0, -signal.SIGKILL), said  # or it would never end
        found = rows(database)
        assert known.items() <= found.items()
        known = found
    assert kills >= 1  # how many come before the end depends on the machine
    assert len(known) == 60
    assert out.read_bytes() == whole.read_bytes()


@pytest.mark.slow
def test_workers_end_with_a_killed_parent(study: Path, tmp_path: Path) -> None:
    enlarged(study, 2000)
    process = start(study, tmp_path / "out.csv", start_new_session=True)
    wait_for_rows(tmp_path / "out.db", process)
    workers = children(process.pid)
    assert len(workers) >= 2
    os.kill(process.pid, signal.SIGKILL)
    process.communicate()
    until = time.monotonic() + 300.0
    while any(map(is_alive, workers)) and time.monotonic() < until:
        time.sleep(0.05)
    assert not [pid for pid in workers if is_alive(pid)]


def children(parent: int) -> list[int]:
    found = []
    for status in Path("/proc").glob("[0-9]*/stat"):
        try:
            fields = status.read_text().rpartition(")")[2].split()
        except OSError:
            continue
        if int(fields[1]) == parent:
            found.append(int(status.parent.name))
    return found


def is_alive(pid: int) -> bool:
    try:
        return Path(f"/proc/{pid}/stat").read_text().rpartition(")")[2].split()[0] != "Z"
    except OSError:
        return False


@pytest.mark.slow
@pytest.mark.parametrize("of", [signal.SIGINT, signal.SIGTERM])
def test_an_interrupt_ends_it_cleanly_and_says_how_to_go_on(
    study: Path, tmp_path: Path, of: signal.Signals
) -> None:
    enlarged(study, 2000)
    out = tmp_path / "out.csv"
    process = start(study, out, start_new_session=True)
    wait_for_rows(tmp_path / "out.db", process)
    if of == signal.SIGINT:
        os.killpg(process.pid, of)  # as a terminal does: parent and workers
    else:
        process.send_signal(of)
    said = process.communicate(timeout=300)[1]
    assert process.returncode == 130
    assert said.startswith("rollnip: interrupted; ")
    assert (
        f"of 2,000 cases are in {tmp_path / 'out.db'}: the same command goes on from there" in said
    )
    assert said.count("\n") == 1
    assert not out.exists()
    assert len(rows(tmp_path / "out.db")) >= 1


@pytest.mark.slow
def test_three_interrupts_at_once_end_it_as_one_does(study: Path, tmp_path: Path) -> None:
    """Three within a tenth of a second left the pool of processes waiting for ever."""
    enlarged(study, 2000)
    for attempt, pause in enumerate((0.0, 0.02, 0.05)):
        out = tmp_path / f"out{attempt}.csv"
        process = start(study, out, start_new_session=True)
        wait_for_rows(out.with_suffix(".db"), process)
        for _ in range(3):
            os.killpg(process.pid, signal.SIGINT)
            time.sleep(pause)
        try:
            said = process.communicate(timeout=300)[1]
        finally:
            os.killpg(process.pid, signal.SIGKILL) if process.poll() is None else None
        assert process.returncode == 130, said
        assert said.startswith("rollnip: interrupted; ")
        assert "Traceback" not in said
        assert len(rows(out.with_suffix(".db"))) >= 1


@pytest.mark.slow
def test_a_full_disk_loses_nothing_that_was_finished(study: Path, tmp_path: Path) -> None:
    enlarged(study, 60)
    whole = tmp_path / "whole.csv"
    assert sweep(study, "--out", whole, "--workers", 1).exit_code == 0
    out, database = tmp_path / "out.csv", tmp_path / "out.db"

    def limited() -> None:
        resource.setrlimit(resource.RLIMIT_FSIZE, (150_000, 150_000))

    process = start(study, out, preexec_fn=limited)
    said = process.communicate(timeout=300)[1]
    assert process.returncode == 2
    assert f"{database}: cannot write" in said
    assert "the same command goes on from there" in said
    assert "Traceback" not in said
    kept = rows(database)
    assert 1 <= len(kept) < 60
    assert sweep(study, "--out", out, "--workers", 1).exit_code == 0
    assert kept.items() <= rows(database).items()
    assert out.read_bytes() == whole.read_bytes()
