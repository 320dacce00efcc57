"""How much the missing numbers matter: the changes come out as they must."""

import math
from dataclasses import replace

import pytest

import rollnip as rn
from rollnip.paper import Effect, effects, effects_table, figure_4


@pytest.fixture(scope="module")
def rows():
    return list(effects(figures=["6 A", "8 A", "8 B", "7 A"]))


def change(rows, figure, instead, measure):
    found = [
        row
        for row in rows
        if (row.figure, row.instead) == (figure, instead) and row.measure.startswith(measure)
    ]
    assert len(found) == 1
    return found[0].change


def test_friction_does_not_matter_where_all_sticks(rows):
    for measure in ("nip width", "creepage", "largest strain"):
        assert abs(change(rows, "8 A", "2.7", measure)) < 1e-3


def test_friction_matters_where_it_slips(rows):
    assert change(rows, "8 B", "1", "largest strain") < -0.3


def test_only_the_sum_of_curvatures_matters_to_first_order(rows):
    """Swapping the radii keeps it."""
    assert abs(change(rows, "6 A", "25 mm", "strain in the middle")) < 0.01


def test_the_scans_load_would_matter_most(rows):
    assert change(rows, "7 A", "7.78 N/mm", "strain in the middle") > 1.0


def test_a_bare_glass_roller_has_no_strain(rows):
    assert change(rows, "7 A", "none", "largest strain") == -1.0


def test_the_table_has_a_line_for_each_choice(rows):
    lines = effects_table(rows).splitlines()
    assert len(lines) == 2 + len({(r.figure, r.missing, r.instead) for r in rows})
    assert all(line.count("|") == 6 for line in lines)


def test_what_could_not_be_solved_is_not_a_number():
    effect = Effect("1", "a", "b", "c", "m", 1.0, math.nan)
    assert "nan" in effects_table([effect])
    assert math.isnan(effect.change)


@pytest.mark.slow
def test_the_foil_with_friction_is_solved():
    """At finite strain its zones do not settle: it gives way to "curved", verified, and says so."""
    foil = replace(figure_4(0.1), friction=2.7, tangential=rn.Traction(0.0))
    solution = rn.solve(foil)
    assert solution.converged
    assert solution.model.geometry == "finite" or solution.warnings
