"""Figures of a plate on meshes of one size: losses, tensions, and creepages on a narrow contact."""

import numpy as np
import pytest
from sheet_population import random_case

import rollnip as rn
from rollnip.sheet.plate.formulation import PlateFormulation
from rollnip.sheet.plate.search import PlateSearch

NARROW = 19020  # on a bare roller, where its contact is a quarter as wide as the sheet is thick


@pytest.fixture(scope="module")
def iterate():
    """A search, and the solution on meshes of a size that places ends closely."""
    case = random_case(NARROW, bending=True)
    assert case.geometry == "linear"
    model = rn.Model(geometry="linear")
    found = rn.solve(case.nip, model)
    assert found.nip_width < 0.25 * case.nip.sheet.thickness
    search = PlateSearch(found.final.contact)
    return lambda count: search.settle_zones(
        found.refined.iterate.zones, count, found.refined.iterate, 0.01
    ), search


def figures(search, iterate):
    return PlateFormulation(search.contact).figures(iterate)[0]


def test_the_loss_of_friction_hardly_feels_where_slip_begins(iterate):
    """Before, the slip beside a misplaced transition was lost: 1 % for .1 % of the width."""
    solved, search = iterate
    right = solved(51)
    loss = figures(search, right).friction_upper
    for off in (-3e-3, -1e-3, 1e-3, 3e-3):
        ends = right.zones.ends.copy()
        ends[1] += off * right.zones.upper.width
        moved, _ = search._solve_with_zones(
            right.zones.with_ends(ends), (51, {}), (1e-9, 1e-9), right
        )
        assert figures(search, moved).friction_upper == pytest.approx(loss, rel=2e-3)


def test_a_contact_narrower_than_the_sheet_is_felt_at_both_of_its_edges(iterate):
    """With nodes of the wide contact at one edge alone the creepage kept an error of 1e-3."""
    solved, search = iterate
    coarse, middle, fine = (
        figures(search, solved(count)).creepage_upper for count in (20, 51, 131)
    )
    assert coarse == pytest.approx(fine, rel=5e-4)
    assert middle == pytest.approx(fine, rel=1e-4)


def test_the_largest_tension_is_found_between_nodes(iterate):
    """At the nodes alone .1 % is left of it on twenty elements."""
    solved, search = iterate
    found = solved(20)
    here = figures(search, found)
    lower, upper = (np.array(found.zones.edges).min(), np.array(found.zones.edges).max())
    x = np.linspace(lower, upper, 20001)
    along = found.problem.tension_at(found.state, found.lagged.known, x)
    assert along.max() <= here.tension_max * (1.0 + 1e-12)
    assert along.max() == pytest.approx(here.tension_max, rel=1e-5)
    assert along.min() >= here.tension_min * (1.0 + 1e-12)
    assert here.tension_max == pytest.approx(figures(search, solved(131)).tension_max, rel=1.5e-3)
