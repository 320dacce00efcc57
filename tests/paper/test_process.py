"""The paper's own process on whole nips: the same figures as `solve`, by another way."""

import json
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from typer.testing import CliRunner

import rollnip as rn
from rollnip.cli.app import app
from rollnip.paper import configuration, figure_5_viscoelastic
from rollnip.paper.process import solve_by_process

EXAMPLES = Path(__file__).parents[2] / "examples"
NIPS = {
    "configuration I, driven": (configuration(1, driven=True), "curved"),
    "configuration II, driven": (configuration(2, driven=True), "curved"),
    "configuration II, free": (configuration(2, driven=False), "linear"),
    "configuration II, corrected": (configuration(2, driven=True), "corrected"),
    "viscoelastic": (figure_5_viscoelastic(), "curved"),
    "without friction": (replace(configuration(2, driven=False), friction=0.0), "curved"),
}


@pytest.mark.parametrize("name", NIPS)
def test_agrees_with_solve(name):
    """Linear elements take 90 for 1e-3 in the creepage (decision 11); here are 100."""
    nip, geometry = NIPS[name]
    found = solve_by_process(nip, geometry)
    solution = rn.solve(nip, rn.Model(geometry=geometry, tolerance=1e-4))
    assert found.converged
    assert found.load == pytest.approx(solution.load, rel=1e-9)
    for figure in ("approach", "nip_width", "peak_pressure"):
        assert getattr(found, figure) == pytest.approx(getattr(solution, figure), rel=1e-3)
    if nip.friction == 0.0:
        assert found.creepage is None
        np.testing.assert_array_equal(found.shear, 0.0)
        return
    assert found.creepage == pytest.approx(solution.creepage, rel=1.5e-3)
    assert found.traction == pytest.approx(solution.traction, abs=1e-9)
    states = [int(zone.state) for zone in found.zones]
    assert states == [int(zone.state) for zone in solution.final.zones]


def test_what_it_does_not_know_is_refused():
    with pytest.raises(rn.InvalidInputError, match="`geometry` must be"):
        solve_by_process(configuration(2, driven=True), "second")


def test_command_prints_the_figures():
    path = EXAMPLES / "configuration-2-driven.toml"
    found = solve_by_process(rn.read_case(path).nip)
    plain, as_json = (
        CliRunner().invoke(app, ["paper", "process", str(path), *more]) for more in ([], ["--json"])
    )
    assert (plain.exit_code, as_json.exit_code) == (0, 0)
    rows = dict(line.split(maxsplit=1) for line in plain.stdout.splitlines())
    assert rows["converged"] == "yes"
    assert rows["approach"] == f"{found.approach:.6g} mm"
    assert float(rows["creepage"]) == pytest.approx(found.creepage, rel=1e-5)
    assert json.loads(as_json.stdout)["creepage"] == found.creepage


@pytest.mark.parametrize(
    ("arguments", "said"),
    [
        (["paper", "process", "nowhere.toml"], "nowhere.toml"),
        (["paper", "process", "CASE", "--geometry", "second"], "`geometry` must be"),
        (["paper"], "`--out` must name"),
    ],
)
def test_wrong_input_is_one_line_and_exit_2(arguments, said):
    path = str(EXAMPLES / "configuration-2-driven.toml")
    result = CliRunner().invoke(app, [path if a == "CASE" else a for a in arguments])
    assert (result.exit_code, result.stdout) == (2, "")
    assert said in result.stderr
    assert result.stderr.count("\n") == 1
