"""How often elements are evaluated and contacts solved until turns of all orders come to rest."""

from pathlib import Path

import pytest

import rollnip as rn
from rollnip.finite import FiniteResponse
from rollnip.rolling import placing

EXAMPLES = Path(__file__).parents[2] / "examples"


@pytest.fixture
def counts(monkeypatch):
    """Count evaluations of either roller, and meshes of the contact."""
    found = {"evaluations": 0, "meshes": 0}

    def counted(name, call):
        def called(*given, **named):
            found[name] += 1
            return call(*given, **named)

        return called

    evaluation = counted("evaluations", FiniteResponse.displacement)
    monkeypatch.setattr(FiniteResponse, "displacement", evaluation)
    monkeypatch.setattr(placing, "mesh_on", counted("meshes", placing.mesh_on))
    return found


@pytest.mark.parametrize(
    ("name", "evaluations", "meshes"),
    [("configuration-1-free", 3, 7), ("configuration-2-free", 6, 7)],
)
def test_free_rolling_needs_three_turns(counts, name, evaluations, meshes):
    assert rn.solve(rn.read_case(EXAMPLES / f"{name}.toml").nip).converged
    assert counts["evaluations"] <= evaluations
    assert counts["meshes"] <= meshes


def test_beside_a_slipping_edge_there_are_nine_turns_at_most(counts):
    """Both coverings of configuration II are stretched there to twice their length and more."""
    assert rn.solve(rn.read_case(EXAMPLES / "configuration-2-driven.toml").nip).converged
    assert counts["evaluations"] <= 18
    assert counts["meshes"] <= 22
