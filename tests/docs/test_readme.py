"""The Python of the README: it passes mypy --strict, and it runs."""

import re
from pathlib import Path

import pytest

ROOT = Path(__file__).parents[2]
BLOCKS = re.findall(r"```python\n(.*?)```", (ROOT / "README.md").read_text("utf-8"), re.DOTALL)


def test_there_is_code():
    assert BLOCKS


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
