"""Every example is a case file that reads, solves and says what it assumes."""

from pathlib import Path

import pytest

import rollnip as rn
from rollnip.io import result_dict

EXAMPLES = sorted((Path(__file__).parents[2] / "examples").glob("*.toml"))


@pytest.mark.parametrize("path", EXAMPLES, ids=lambda path: path.stem)
def test_reads(path):
    case = rn.read_case(path)
    assert case.nip.title
    assert "ssumed" in path.read_text("utf-8") or path.stem == "configuration-1-free"


def test_the_paper_is_there():
    names = {path.stem for path in EXAMPLES}
    assert names >= {f"configuration-{n}-{how}" for n in (1, 2, 3) for how in ("free", "driven")}
    assert len([name for name in names if name.startswith("figure-4")]) == 4
    assert len([name for name in names if name.startswith("figure-5")]) == 2


@pytest.mark.parametrize("path", EXAMPLES, ids=lambda path: path.stem)
def test_solves(path):
    case = rn.read_case(path)
    solution = rn.solve(case.nip, case.model)
    assert solution.converged, solution.status
    tree = result_dict(solution)
    assert tree["nip_width"] > 0.0
    assert set(map(len, (p for p in tree["profiles"].values() if p is not None))) == {
        len(tree["profiles"]["x"])
    }
    if path.stem.endswith("free"):
        assert tree["traction"] == pytest.approx(0.0, abs=1e-9)
