"""The tree of a patch: keys of every result beside those of its own."""

import pytest

import rollnip as rn
from rollnip.io import result_dict
from rollnip.patch.report import patch_dict

TYRE = rn.StandardLinearSolid(modulus=5.0, stiffening=5.0, relaxation_time=2e-3, poisson=0.5)
WHEEL = rn.Patch(
    upper=rn.Roller(radius=50.0, layers=[rn.Layer(8.0, TYRE)]),
    lower=rn.Roller(radius=float("inf")),
    across_upper=rn.Across(radius=200.0),
    normal=rn.Force(200.0),
    along=rn.Force(10.0),
    friction=0.6,
    speed=1000.0,
)
PLANE = rn.Nip(
    upper=WHEEL.upper,
    lower=rn.Roller(radius=50.0),
    normal=rn.LineLoad(5.0),
    friction=0.6,
    speed=1000.0,
)


def test_the_tree_has_the_keys_that_results_of_nips_have():
    solved, nip = rn.solve_patch(WHEEL, tolerance=0.1), rn.solve(PLANE, rn.Model(geometry="linear"))
    tree, plane = patch_dict(solved), result_dict(nip, interfaces=False)
    assert set(plane) <= set(tree)
    for table in ("dissipation", "error", "profiles"):
        assert set(plane[table]) == set(tree[table])
    assert set(plane["solver"]) - {"geometry_change"} <= set(tree["solver"])
    part, (contact,) = tree["patch"], tree["contact"]
    assert tree["load"] == part["load"]
    assert tree["traction"] == part["traction_x"]
    assert tree["nip_width"] == part["length"] == pytest.approx(contact[1] - contact[0])
    assert tree["dwell_time"] == pytest.approx(part["length"] / solved.patch.speed)
    assert tree["mean_pressure"] == pytest.approx(part["load"] / part["area"])
    assert tree["error"]["nip_width"] == part["error"]["length"]
    assert tree["dissipation"]["friction"] == part["dissipation_friction"]
    lost = tree["rolling_resistance"] * part["load"]
    assert lost == pytest.approx(part["viscous_resistance"], abs=1e-12)
    assert lost > 0.0
