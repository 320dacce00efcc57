"""A nip that cannot be is no result, however well its equations are solved."""

import importlib
import re
from dataclasses import replace

import numpy as np
import pytest

import rollnip as rn
from rollnip.no_nip import impossible

RUBBER = rn.Elastic(modulus=2.0, poisson=0.5)
FOAM = rn.Elastic(modulus=0.05, poisson=0.3)
NIP = rn.Nip(
    upper=rn.Roller(radius=50.0, layers=[rn.Layer(4.0, RUBBER)]),
    lower=rn.Roller(radius=30.0),
    normal=rn.LineLoad(3.0),
    friction=0.5,
    speed=100.0,
)
GEOMETRIES = ("linear", "curved", "second")


@pytest.mark.parametrize("geometry", GEOMETRIES)
@pytest.mark.parametrize("normal", [rn.LineLoad(1000.0), rn.Approach(3.9)])
def test_a_covering_that_is_squeezed_out_is_no_result(geometry, normal):
    """4 mm on a rigid core, pressed in by more than half, or by more than there is."""
    solution = rn.solve(replace(NIP, normal=normal), rn.Model(geometry=geometry))
    assert not solution.converged
    assert "The covering of the upper roller, 4 mm thick, is pressed in by" in solution.status


def test_a_load_sweep_ends_with_the_reason():
    """Approach and verdict along a sweep: good, then none, and never good again."""
    nip = replace(NIP, upper=rn.Roller(radius=50.0, layers=[rn.Layer(4.0, FOAM)]))
    loads = 0.05 * 2.0 ** np.arange(8)
    found = [
        rn.solve(replace(nip, normal=rn.LineLoad(load)), rn.Model(geometry="linear"))
        for load in loads
    ]
    good = [solution.converged for solution in found]
    assert good == sorted(good, reverse=True)
    assert 0 < sum(good) < len(good)
    for solution in found:
        # Against a bare roller the approach is what the covering is pressed in by at x = 0.
        assert solution.converged == (solution.approach < 0.5 * 4.0)


@pytest.mark.parametrize("core", [None, rn.Elastic(modulus=100.0, poisson=0.3)])
def test_a_soft_layer_on_a_hard_one_counts_by_itself(core):
    """1 mm of foam over 9 mm of something hard: the covering is 10 mm, what gives is not."""
    layers = [rn.Layer(1.0, FOAM), rn.Layer(9.0, rn.Elastic(modulus=100.0, poisson=0.3))]
    nip = replace(NIP, upper=rn.Roller(radius=50.0, layers=layers, core=core))
    light = rn.solve(replace(nip, normal=rn.LineLoad(0.04)))
    assert light.converged
    heavy = rn.solve(replace(nip, normal=rn.LineLoad(1.0)), rn.Model(geometry="linear"))
    assert not heavy.converged
    assert "Layer 1 (from the surface) of the upper roller, 1 mm thick" in heavy.status
    lower = rn.solve(
        replace(nip, upper=nip.lower, lower=nip.upper, normal=rn.LineLoad(1.0)),
        rn.Model(geometry="curved"),
    )
    assert not lower.converged
    assert "of the lower roller, 1 mm thick" in lower.status


def test_cores_that_would_touch_are_refused():
    with pytest.raises(
        rn.InvalidInputError, match=r"`approach` must be smaller than the coverings are thick, 4 mm"
    ):
        replace(NIP, normal=rn.Approach(4.5))
    both = replace(NIP, lower=rn.Roller(radius=30.0, layers=[rn.Layer(2.0, RUBBER)]))
    assert rn.solve(replace(both, normal=rn.Approach(0.5))).converged
    with pytest.raises(rn.InvalidInputError, match="6 mm in all"):
        replace(both, normal=rn.Approach(6.0))


def test_no_roller_turns_backwards():
    """F 60, T 250: the equations give a creepage of 6.5."""
    nip = replace(
        NIP, normal=rn.LineLoad(60.0), friction=5.0, tangential=rn.Traction(250.0), speed=None
    )
    solution = rn.solve(nip, rn.Model(geometry="linear"))
    assert abs(solution.creepage) > 2.0
    assert not solution.converged
    assert "one roller would rotate backwards" in solution.status
    assert "geometry" not in solution.status
    with pytest.raises(rn.ConvergenceError, match="rotate backwards"):
        rn.solve(nip, rn.Model(geometry="linear"), on_failure="raise")


def test_beside_a_sheet_rollers_turn_backwards_by_the_difference_of_their_own_speeds():
    """And not by that of one of them and the sheet."""
    final = rn.solve(replace(NIP, sheet=rn.Sheet(thickness=0.1, modulus=3000.0))).final
    own, both = (
        replace(final, state=replace(final.state, creepage=upper), figures=figures)
        for upper, figures in (
            (2.5, final.figures),
            (1.2, replace(final.figures, creepage=2.4)),
        )
    )
    assert impossible(own) == ""
    assert "The creepage comes out as 2.4" in impossible(both)


def test_beside_a_sheet_layers_relax_at_the_speed_of_their_roller(monkeypatch):
    """Both rollers' speeds follow from their difference, on whichever interface it is."""
    checks = importlib.import_module("rollnip.no_nip")
    rubber = rn.StandardLinearSolid(modulus=1.0, stiffening=2.0, relaxation_time=0.01, poisson=0.5)
    layers = [rn.Layer(2.0, rubber), rn.Layer(2.0, RUBBER)]
    sheet = rn.Sheet(thickness=0.1, modulus=3000.0, bending=True, tension_in=1.0)
    nip = replace(NIP, upper=rn.Roller(radius=50.0, layers=layers), sheet=sheet)
    solution = rn.solve(nip, rn.Model(geometry="curved"))
    asked = []
    monkeypatch.setattr(checks, "MOST_PRESSED_IN", 1e-3)
    monkeypatch.setattr(checks, "beyond_linear", lambda *a: asked.append(a[-1]))
    impossible(solution.final)
    assert abs(solution.sheet.creepage_lower) > 1e-4
    assert asked[0] == (100.0, pytest.approx(100.0 * (1.0 + 0.5 * solution.creepage), rel=1e-12))


def test_no_field_is_computed_inside_layers_that_the_surface_hardly_moves(monkeypatch):
    """The peak is above half of a modulus, but the surface moves by less than half that layer."""
    rubber = [
        rn.Layer(2.0, rn.Elastic(modulus=8.0, poisson=0.5)),
        rn.Layer(6.0, rn.Elastic(modulus=1.0, poisson=0.5)),
    ]
    nip = rn.Nip(
        upper=rn.Roller(radius=60.0, layers=rubber),
        lower=rn.Roller(radius=40.0),
        normal=rn.LineLoad(8.0),
        friction=0.0,
    )
    checks = importlib.import_module("rollnip.no_nip")
    asked = []
    field = checks.interior_field
    monkeypatch.setattr(checks, "interior_field", lambda *a, **k: asked.append(1) or field(*a, **k))
    solution = rn.solve(nip)
    assert solution.peak_pressure > 0.5
    assert solution.converged
    assert not asked
    monkeypatch.setattr(checks, "MOST_PRESSED_IN", 0.15)
    assert not rn.solve(nip).converged
    assert asked


@pytest.mark.parametrize("geometry", ["curved", "finite"])
@pytest.mark.parametrize("thickness", [1e-2, 1e-6])
def test_a_covering_pressed_in_by_its_thickness_is_refused_at_once(geometry, thickness):
    """No mesh is refined for it: 300 systems at most, and in `finite` no equilibrium."""
    foam = rn.Elastic(modulus=3.0, poisson=0.3)
    covered = rn.Roller(radius=50.0, layers=[rn.Layer(thickness, foam)])
    nip = rn.Nip(
        upper=covered, lower=rn.Roller(radius=50.0), normal=rn.LineLoad(10.0), friction=0.3
    )
    solution = rn.solve(nip, rn.Model(geometry=geometry))
    assert not solution.converged
    assert f"{thickness:g} mm thick, is pressed in by" in solution.status
    assert solution.solver.iterations < 300
    assert solution.solver.elements < 100


@pytest.mark.parametrize("friction", [0.0, 0.3])
def test_finite_strain_refuses_what_it_presses_in_by_more_than_half(friction):
    """`finite` presses it in by 52 or 53 %, on the coarse contact that it is judged on.

    That `curved` says 76 % proves nothing: at 20 N/mm it says 65 %, and `finite` converges.
    """
    foam = rn.Elastic(modulus=3.0, poisson=0.3)
    covered = rn.Roller(radius=50.0, layers=[rn.Layer(1.0, foam)])
    nip = rn.Nip(
        upper=covered, lower=rn.Roller(radius=50.0), normal=rn.LineLoad(25.0), friction=friction
    )
    solution = rn.solve(nip, rn.Model(geometry="finite"))
    assert not solution.converged
    assert solution.model.geometry == "finite"
    assert re.search("is pressed in by 5[23] %", solution.status)
    assert solution.solver.elements < 100
    if not friction:
        lighter = replace(nip, normal=rn.LineLoad(20.0))
        assert rn.solve(lighter, rn.Model(geometry="finite")).converged
        start = rn.solve(lighter, rn.Model(geometry="curved"))
        assert "is pressed in by 65 %" in start.status


def _with_layers(layers, load):
    return replace(NIP, upper=rn.Roller(radius=50.0, layers=layers), normal=rn.LineLoad(load))


def test_finite_strain_counts_a_soft_layer_as_it_is():
    """0.5 mm on 8 mm, pressed in by 46 and 52 %; linear fields under its tractions: 72 and 87 %."""
    soft, below = rn.Elastic(modulus=0.4, poisson=0.1), rn.Elastic(modulus=1.0, poisson=0.3)
    layers = [rn.Layer(0.5, soft), rn.Layer(8.0, below)]
    good = rn.solve(replace(_with_layers(layers, 3.0), friction=0.0))
    assert good.model.geometry == "finite"
    assert good.converged
    place = good.nodes[np.argmax(good.pressure)]
    depths = np.array([0.0, 0.5, 8.5])
    pressed = -np.diff(good.interior("upper", z=depths, x=place).u_z[:, 0]) / np.diff(depths)
    assert pressed[0] == pytest.approx(0.463, abs=0.005)
    deep = rn.solve(replace(_with_layers(layers, 4.0), friction=0.0))
    assert not deep.converged
    assert "0.5 mm thick, is pressed in by 51 %" in deep.status  # judged on a coarse contact


def test_plies_of_one_layer_count_as_it_does():
    """By 60 %, as a whole and, nearly, as two: the lower one is held a little less."""
    foam = rn.Elastic(modulus=0.2, poisson=0.3)
    for layers in ([rn.Layer(4.0, foam)], [rn.Layer(2.0, foam)] * 2):
        nip = replace(_with_layers(layers, 2.0), friction=0.0)
        solution = rn.solve(nip, rn.Model(geometry="curved"))
        assert solution.approach == pytest.approx(0.599 * 4.0, abs=0.01)
        assert "mm thick, is pressed in by 60 %" in solution.status


@pytest.mark.parametrize("geometry", ["curved", "second", "finite"])
def test_layers_share_what_the_surface_moves(geometry):
    """Of the order of the model: linear fields move the surface by up to 16 % more."""
    soft, below = rn.Elastic(modulus=0.4, poisson=0.1), rn.Elastic(modulus=1.0, poisson=0.3)
    layers = [rn.Layer(0.5, soft), rn.Layer(8.0, below)]
    nip = replace(_with_layers(layers, 2.0), friction=0.0)
    solution = rn.solve(nip, rn.Model(geometry=geometry))
    assert solution.model.geometry == geometry
    checks = importlib.import_module("rollnip.no_nip")
    side, roller, shares = checks._pressed_in_by(0.0, solution.final, geometry)
    assert (side, roller) == ("upper", nip.upper)
    assert shares @ (0.5, 8.0) == pytest.approx(solution.approach, rel=1e-3)


def test_a_strain_energy_that_yields_counts_too():
    """55 % under a peak of a fifth of the modulus, which presses no neo-Hookean layer in so far."""
    foam = rn.Elastic(
        modulus=1.0, poisson=0.0, energy=rn.materials.Ogden(terms=((1.0, 10.0),), volumetric="log")
    )
    nip = replace(_with_layers([rn.Layer(2.0, foam)], 2.0), friction=0.0)
    solution = rn.solve(nip)
    assert solution.peak_pressure < 0.25
    assert not solution.converged
    assert "2 mm thick, is pressed in by 55 %" in solution.status


@pytest.mark.parametrize(("across", "is_nip"), [(5.0, True), (1.5, False)])
def test_a_sheet_loses_no_more_of_its_thickness_than_it_has(across, is_nip):
    """p (1 - nu^2)/E_z at a pressure of some 1.2 MPa: by a fifth, or by seven tenths."""
    rubber = rn.Elastic(modulus=5.0, poisson=0.5)
    nip = rn.Nip(
        upper=rn.Roller(radius=50.0, layers=[rn.Layer(5.0, rubber)]),
        lower=rn.Roller(radius=50.0),
        normal=rn.LineLoad(10.0),
        friction=0.3,
        sheet=rn.Sheet(
            thickness=0.1, modulus=100.0, poisson=0.3, modulus_thickness=across, bending=False
        ),
    )
    solution = rn.solve(nip, rn.Model(geometry="curved"))
    lost = solution.peak_pressure * (1.0 - 0.3**2) / across
    assert solution.converged == is_nip
    assert (lost < 0.5) == is_nip
    if not is_nip:
        assert f"0.1 mm thick, is pressed together by {100.0 * lost:.0f} %" in solution.status
