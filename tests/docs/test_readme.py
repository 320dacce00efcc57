"""The Python of the README: it passes mypy --strict, and it runs."""

import re
import shlex
from pathlib import Path

import pytest

ROOT = Path(__file__).parents[2]
README = (ROOT / "README.md").read_text("utf-8")
BLOCKS = re.findall(r"```python\n(.*?)```", README, re.DOTALL)
COMMANDS = [shlex.split(line, comments=True) for line in re.findall(r"^rollnip .*", README, re.M)]


def test_there_is_code():
    assert BLOCKS


@pytest.mark.slow
def test_it_passes_mypy_strict(tmp_path):
    api = pytest.importorskip("mypy.api")
    for number, block in enumerate(BLOCKS):
        (tmp_path / f"readme_{number}.py").write_text(block, "utf-8")
    said, errors, code = api.run(
        ["--strict", "--config-file", str(ROOT / "pyproject.toml"), str(tmp_path)]
    )
    assert code == 0, said + errors


@pytest.mark.parametrize("block", BLOCKS)
def test_it_runs(block):
    exec(compile(block, "README.md", "exec"), {"__name__": "readme"})


@pytest.mark.parametrize("command", COMMANDS, ids=" ".join)
def test_its_commands_read_files_that_are_there(command):
    """As typed: the case of the tour where a case is enough, else a file of the examples."""
    read = [word for word in command[1:] if Path(word).suffix in {".toml", ".csv"}]
    read = [word for word in read if command[command.index(word) - 1] not in {"--out", "--plot"}]
    enough = {"solve", "find"}
    for word in read:
        there = (ROOT / word).is_file() and word.startswith("examples/")
        assert there or (word == "case.toml" and command[1] in enough)
