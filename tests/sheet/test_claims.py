"""Claimed errors of nips with a sheet against solutions on finer meshes."""

from dataclasses import replace

import numpy as np
import pytest
from sheet_nips import RIGID, nip_with, paper
from sheet_population import random_case

import rollnip as rn
from rollnip.contact.problem import shear_signs
from rollnip.rolling import peak_pressure
from rollnip.sheet.figures import NAMES, SHARES_OF_MODEL, scales
from rollnip.sheet.formulation import END_TOLERANCE
from rollnip.sheet.membrane.formulation import MembraneFormulation
from rollnip.sheet.membrane.search import MembraneSearch
from rollnip.sheet.plate.search import PlateSearch
from rollnip.sheet.status import relative_errors

ALLOWED = 3.0  # times the claim, as for a bare nip (tests/properties)


def _errors(number, geometry=None):
    """Errors and claims of all figures over their scales, (2, 20); None without a reference.

    ``geometry``: None: that of the case.
    """
    case = random_case(number)
    if geometry is not None:
        case = replace(case, geometry=geometry)
    try:
        solution = rn.solve(case.nip, rn.Model(geometry=case.geometry))
    except rn.RollnipError:
        return None
    if not solution.converged:
        return None
    refined, model = solution.refined, replace(solution.model, tolerance=5e-4)
    # Not the estimates, nor where refinement stops, but meshes, zones and matrices are shared.
    search = MembraneSearch(solution.final.contact.with_model(model))
    zones, count = refined.iterate.zones, round(2.2 * solution.solver.elements)
    try:
        fine = search.settle_zones(zones, count, refined.iterate, END_TOLERANCE)
    except np.linalg.LinAlgError:  # no zones on so much finer a mesh, as where they do not settle
        return None
    if not fine.settled:
        return None
    (truth,) = MembraneFormulation(solution.final.contact).figures(fine)
    scale = scales(case.nip, truth)
    scale[scale == 0.0] = 1.0  # losses of elastic layers: rounding
    claim = refined.errors.values / scale
    if model.geometry in SHARES_OF_MODEL:
        claim = np.maximum(claim, SHARES_OF_MODEL[model.geometry])
    return np.stack([np.abs(refined.figures.values - truth.values) / scale, claim])


@pytest.mark.slow
@pytest.mark.parametrize(
    ("numbers", "geometry"), [(range(7000, 7016), None), (range(7016, 7024), "finite")]
)
def test_no_error_of_a_sheet_is_claimed_smaller_than_a_third_of_it(numbers, geometry):
    # numbers that neither the least errors nor the order of convergence were looked at with
    tried = {number: _errors(number, geometry) for number in numbers}
    judged = {number: found for number, found in tried.items() if found is not None}
    assert len(judged) >= 0.6 * len(numbers)
    wrong = [
        (number, NAMES[i], error[i], claim[i])
        for number, (error, claim) in judged.items()
        for i in np.flatnonzero(error > ALLOWED * np.maximum(claim, 1e-9))
    ]
    assert not wrong
    # and hardly any is larger than claimed at all
    beyond = [np.mean(error > np.maximum(claim, 1e-9)) for error, claim in judged.values()]
    assert np.mean(beyond) < 0.03


@pytest.mark.slow
@pytest.mark.parametrize("bending", [False, None])
def test_both_tractions_have_the_same_error(bending):
    """The upper one of 9344 as a plate was 3.3 times its own claim off: it is the smaller one."""
    solution = rn.solve(random_case(9344, bending=bending).nip, rn.Model(geometry="linear"))
    figures, error = solution.refined.figures, solution.refined.errors
    given = solution.nip.sheet.tension_in - solution.nip.sheet.tension_out
    assert figures.traction_upper - figures.traction_lower == pytest.approx(given, rel=1e-9)
    assert error.traction_upper == error.traction_lower > 0.0


def test_ends_are_placed_as_closely_as_errors_are_claimed():
    # On 170 elements errors of 5e-5 are claimed; ends off by 1e-4 of the width made twice and four
    # times as much of it in creepages and tractions.
    error, claim = _errors(45000)
    assert np.all(error <= 1.2 * np.maximum(claim, 1e-9))


@pytest.mark.parametrize("number", [104014, 105132, 105172])
def test_the_largest_strain_is_found_beside_an_edge_too(number):
    """Where the pressure adds to the strain by tension: between the first nodes, as a root of x.

    By a parabola in x it was up to four times its claim off.
    """
    error, claim = _errors(number, "curved")[:, NAMES.index("strain_max")]
    assert error <= claim


@pytest.mark.parametrize(
    ("number", "figure"),
    [(104029, "tension_max"), (104039, "friction_upper"), (107079, "friction_upper")],
)
def test_short_zones_are_refined_from_size_to_size_too(number, figure):
    """Slip on 2 to 8 % of the width had six elements on both sizes of mesh, which agreed.

    The largest tension was 15 times its claim off.
    """
    error, claim = _errors(number, "curved")[:, NAMES.index(figure)]
    assert error <= claim


def test_slip_ends_where_its_creep_first_comes_to_zero():
    """And not where it comes to zero again, having crept back against its shear.

    The shear comes to its bound at both places. Between them it was at its bound the wrong way, on
    2 % of the width, and the largest tension 3.5 times its claim off.
    """
    solution = rn.solve(random_case(104039).nip, rn.Model(geometry="curved"))
    iterate = solution.refined.iterate
    signs = shear_signs(iterate.state.states_lower)
    slips = (signs[:-1] != 0.0) & (signs[:-1] == signs[1:])
    back = slips & (signs * iterate.creeps[1] < 0.0)[:-1]
    assert not np.any(back[:-1] & back[1:])  # one node may, at an end between two nodes
    lengths = np.diff(iterate.zones.lower.breaks) / iterate.zones.width
    assert lengths[1] > 0.03  # of the short zone of stick; it was 0.023


def _covered(radius, thickness, modulus, strength=0.0, time=None):
    """A roller whose modulus falls by ``strength`` times its last value within ``time`` [s]."""
    rubber = rn.Elastic(modulus=modulus, poisson=0.45)
    if time is not None:
        rubber = rn.StandardLinearSolid(
            modulus=modulus, stiffening=strength * modulus, relaxation_time=time, poisson=0.49
        )
    return rn.Roller(radius=radius, layers=[rn.Layer(thickness, rubber)])


def _web_between(upper, lower, load, friction, driven):
    """A web of 0.05 mm that runs at 100 mm/s and gains a twentieth of what friction carries."""
    pull = friction * load
    web = rn.Sheet(
        thickness=0.05,
        modulus=3000.0,
        poisson=0.3,
        tension_in=0.1 * pull,
        tension_out=0.05 * pull,
        bending=False,
    )
    return rn.Nip(
        upper=upper,
        lower=lower,
        normal=rn.LineLoad(load),
        tangential=driven,
        friction=friction,
        speed=100.0,
        sheet=web,
    )


def _bending(nip):
    """The nip with its sheet's stiffness counted."""
    return replace(nip, sheet=replace(nip.sheet, bending=True))


SHORT_MEMORIES = {
    "a smallest tension": _web_between(
        _covered(55.167384, 7.452618, 5.045284, 2.6, 4e-6),
        _covered(57.546155, 6.116001, 10.090568),
        1.0090567,
        0.22186972,
        rn.Traction(0.067163738),
    ),
    "an edge": _web_between(
        _covered(50.745, 4.1456, 4.0225, 8.8, 2.4e-4),
        _covered(22.318, 5.338, 4.0225, 8.8, 2.4e-4),
        0.80451,
        0.385823,
        rn.Creepage(-2.7276e-4),
    ),
    "a plate": _bending(
        _web_between(
            _covered(34.423899, 4.9202, 1.7269235, 2.6, 1.6e-5),
            _covered(32.912536, 5.370689, 1.7269235, 2.6, 1.6e-5),
            0.3453847,
            0.21599021,
            rn.Creepage(-0.0028677460),
        )
    ),
}


@pytest.mark.parametrize("name", list(SHORT_MEMORIES))
def test_memory_shorter_than_the_elements_is_claimed(name):
    """Edges lag behind where all sizes of mesh put them, and what tractions make with them.

    The smallest tension was beyond its claim. In the second nip the pressures beside an edge 1 % of
    the width off told no place to put it at; there it was left, and no size of mesh settled. The
    width of the plate was two of its claims off.
    """
    nip, model = SHORT_MEMORIES[name], rn.Model(geometry="curved")
    solution = rn.solve(nip, model)
    fine = rn.solve(nip, replace(model, tolerance=5e-5))
    assert solution.converged
    assert fine.converged
    figures, errors = solution.refined.figures, solution.refined.errors
    error = np.abs(figures.values - fine.refined.figures.values)
    assert np.all(error <= np.maximum(errors.values, 1e-9 * scales(nip, figures)))


def _errors_below(number):
    """Errors and claims of width and highest pressure on the lower side of a plate, (2, 2)."""
    case = random_case(number, bending=True)
    solution = rn.solve(case.nip, rn.Model(geometry=case.geometry))
    if not solution.converged:
        return None
    # a twentieth of the tolerance; not where refinement stops, but matrices are shared
    iterate, model = solution.refined.iterate, replace(solution.model, tolerance=5e-5)
    count = min(round(2.2 * solution.solver.elements), 240)
    search = PlateSearch(solution.final.contact.with_model(model))
    fine = search.settle_zones(iterate.zones, count, iterate, END_TOLERANCE)
    if not fine.settled:
        return None
    mesh, sheet = fine.problem.meshes[1], solution.sheet
    pressure = mesh.between(fine.state.pressure[1])
    truth = fine.zones.lower.width, peak_pressure(mesh.fine.nodes[1:-1], pressure)[0]
    found = sheet.nip_width_lower, sheet.peak_pressure_lower
    claimed = sheet.error["nip_width_lower"], sheet.error["peak_pressure_lower"]
    return np.stack([np.abs(np.subtract(found, truth)), claimed])


@pytest.mark.slow
def test_no_error_on_the_lower_side_is_claimed_smaller_than_a_third_of_it():
    # numbers that nothing was chosen with
    judged = {n: found for n in range(9500, 9512) if (found := _errors_below(n)) is not None}
    assert len(judged) >= 7
    wrong = {
        number: (error, claim)
        for number, (error, claim) in judged.items()
        if np.any(error > ALLOWED * claim)
    }
    assert not wrong
    beyond = [np.mean(error > claim) for error, claim in judged.values()]
    assert np.mean(beyond) < 0.05


@pytest.mark.parametrize("geometry", ["curved", "finite"])
def test_the_status_names_the_errors_beyond_the_tolerance_as_they_are_claimed(geometry):
    nip = nip_with(paper(bending=True), lower=RIGID)
    solution = rn.solve(nip, rn.Model(geometry=geometry))
    assert solution.converged
    errors, tolerance = relative_errors(solution), solution.model.tolerance
    named = {name: f"{name} {100.0 * error:.2g} %" for name, error in errors.items()}
    assert "peak pressure on the lower roller" in named
    below = solution.sheet.error["peak_pressure_lower"] / solution.sheet.peak_pressure_lower
    assert errors["peak pressure on the lower roller"] == pytest.approx(below, rel=1e-12)
    for name, error in errors.items():
        assert (named[name] in solution.status) == (error > 1.0001 * tolerance), name


@pytest.mark.parametrize(("number", "bending"), [(147009, True), (146014, False), (316012, False)])
def test_a_viscous_loss_of_second_order_claims_what_linear_fields_leave_of_it(number, bending):
    """It is that of linear fields, 7 to 16 % off here, and claimed to 0.3 % before."""
    nip = random_case(number, bending=bending).nip
    driven = nip.tangential
    if isinstance(driven, rn.Traction):
        driven = rn.Traction(8.0 * driven.traction)
    tensions = {name: 8.0 * getattr(nip.sheet, name) for name in ("tension_in", "tension_out")}
    nip = replace(
        nip,
        normal=rn.LineLoad(8.0 * nip.normal.load),
        tangential=driven,
        sheet=replace(nip.sheet, **tensions),
    )
    second, finite = (rn.solve(nip, rn.Model(geometry=one)) for one in ("second", "finite"))
    off = abs(second.dissipation_viscous - finite.dissipation_viscous)
    assert off > 0.05 * finite.dissipation_viscous
    assert off <= second.error["dissipation_viscous"] < 3.0 * off
    lost = second.error["dissipation_viscous"] / nip.speed
    lost += second.rolling_resistance * second.error["load"]
    assert second.error["rolling_resistance"] == pytest.approx(lost / second.load)


def test_the_rolling_resistance_at_a_given_approach_claims_the_error_of_the_load():
    """Elsewhere the load is given; here it is known to some 0.1 %, and the resistance no better."""
    rubber = rn.StandardLinearSolid(modulus=1.0, stiffening=1.0, relaxation_time=0.01, poisson=0.5)
    nip = nip_with(
        paper(bending=False),
        upper=rn.Roller(radius=50, layers=[rn.Layer(2.0, rubber)]),
        normal=rn.Approach(0.1),
        speed=100.0,
    )
    solution = rn.solve(nip, rn.Model(geometry="linear"))
    assert solution.converged
    relative = {
        name: solution.error[name] / getattr(solution, name)
        for name in ("load", "dissipation_viscous", "rolling_resistance")
    }
    assert relative["load"] > 1e-5
    assert relative["rolling_resistance"] == pytest.approx(
        relative["load"] + relative["dissipation_viscous"]
    )


def test_a_size_solved_again_for_other_zones_has_ends_of_its_own():
    """With those of the finer size the two agreed too well: a creepage was 1.7 claims off.

    It was 1.6 tolerances off, too.
    """
    nip, figures = random_case(61048, bending=True).nip, ["creepage", "creepage_upper"]
    found, fine = (rn.solve(nip, rn.Model(geometry="linear", tolerance=t)) for t in (1e-3, 2e-4))
    assert found.converged
    assert fine.converged
    for name in figures:
        off = abs(getattr(found.refined.figures, name) - getattr(fine.refined.figures, name))
        assert off <= getattr(found.refined.errors, name), name
