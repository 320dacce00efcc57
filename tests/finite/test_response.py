"""What finite strain adds to the linear displacement, against the linear and the second order."""

import numpy as np
import pytest

import rollnip as rn
from rollnip.finite import (
    Body,
    Depths,
    FiniteResponse,
    Strip,
    linear_between_nodes,
    linear_surface,
    response,
)
from rollnip.finite.state import MeshState
from rollnip.finite.strip import LINEAR
from rollnip.influence import KernelCache, covering_window, displacement_under, surface_kernels

RUBBER, FOAM = rn.Elastic(modulus=1.0, poisson=0.5), rn.Elastic(modulus=1.0, poisson=0.3)
SKIN = rn.Elastic(modulus=20.0, poisson=0.4)
HALF = 2.0
BARE = rn.Roller(radius=25.0)


def covered(*layers, radius=25.0):
    return rn.Roller(radius=radius, layers=layers)


COVERINGS = {
    "rubber": covered(rn.Layer(2.0, RUBBER)),
    "foam": covered(rn.Layer(3.0, FOAM)),
    "thick": covered(rn.Layer(9.0, RUBBER)),
    "skin": covered(rn.Layer(0.1, SKIN), rn.Layer(2.0, RUBBER)),
    "plane": rn.Roller(radius=np.inf, layers=(rn.Layer(2.0, RUBBER),)),
}


def response_of(roller, half_width=HALF):
    surface = surface_kernels(roller, None, "second", covering_window((roller, BARE), None))
    return FiniteResponse(roller, half_width, surface.displacement)


def tractions(peak):
    """Nodes, and pressure and shear without a jump of their derivative inside."""
    nodes = HALF * np.sin(0.5 * np.pi * np.linspace(-1.0, 1.0, 61))
    x = nodes[1:-1] / HALF
    pressure = peak * np.sqrt(1.0 - x**2)
    return nodes, pressure, 0.4 * pressure * (1.0 - x**2) * (0.5 + x)


@pytest.mark.parametrize("roller", COVERINGS.values(), ids=COVERINGS)
def test_linear_elements_are_the_linear_theory(roller):
    """Ring layers harmonic by harmonic: 0.5 % of the largest displacement."""
    nodes, p, q = tractions(0.1)
    places = np.concatenate(
        [np.linspace(-40, -2.5, 30), HALF * np.sin(np.linspace(-1.57, 1.57, 33))]
    )
    places = np.concatenate([places, np.linspace(2.5, 40, 30)])
    body = Body(Strip(Depths.of(roller, HALF), places))
    u_x, u_z = linear_surface(body, body.linear_displacements(linear_between_nodes(nodes, p, q)))
    inside = np.abs(places) < HALF
    surface = surface_kernels(roller, None, "second", covering_window((roller, BARE), None))
    xx, zz, xz = displacement_under(
        surface.together, places[inside], nodes, np.stack([p, q], axis=1)
    )
    largest = np.abs(zz[:, 0]).max()
    np.testing.assert_allclose(u_x[inside], xx[:, 1] + xz[:, 0], atol=5e-3 * largest)
    np.testing.assert_allclose(u_z[inside], zz[:, 0] - xz[:, 1], atol=5e-3 * largest)


@pytest.mark.parametrize("roller", COVERINGS.values(), ids=COVERINGS)
def test_begins_as_the_second_order(roller):
    """At small strains all orders are the second one, which is derived by other means."""
    nodes, p, q = tractions(0.004)
    x = np.linspace(-0.9, 0.9, 19) * HALF
    all_orders = np.stack([f(x) for f in response_of(roller).correction(nodes, p, q)])
    response = KernelCache().second(roller, None, HALF)
    surface = surface_kernels(roller, None, "second", covering_window((roller, BARE), None))
    inward = surface.inward_at(0.0, nodes, p, q) if response.is_short else None
    second = np.stack([f(x) for f in response.displacement(nodes, p, q, inward)])
    np.testing.assert_allclose(all_orders, second, atol=0.05 * np.abs(second).max())


def test_a_material_that_stiffens_gives_less():
    """Under the same tractions; at small ones there is no difference."""
    u_z = []
    for peak in (0.2, 0.01):
        nodes, p, q = tractions(peak)
        for energy in (None, rn.Yeoh(0.5, 0.0)):
            rubber = rn.Elastic(modulus=1.0, poisson=0.5, energy=energy)
            response = response_of(covered(rn.Layer(2.0, rubber)))
            u_z.append(response.correction(nodes, p, q)[1](np.zeros(1))[0])
    assert u_z[1] < u_z[0] - 1e-3
    assert u_z[3] == pytest.approx(u_z[2], abs=2e-6)


def test_a_response_forgets_where_it_came_from():
    """Tractions have one answer, whatever others were asked before: to the tolerance of steps."""
    roller = COVERINGS["foam"]
    nodes, p, q = tractions(0.1)
    fresh, used = response_of(roller), response_of(roller)
    used.correction(1.1 * nodes - 0.2, 1.2 * p, -q)
    x = np.linspace(-1.0, 1.0, 9) * HALF
    for _ in range(3):  # each leaves a part of its step to the next
        both = [response.correction(nodes, p, q) for response in (fresh, used)]
    for one, other in zip(*both, strict=True):
        np.testing.assert_allclose(one(x), other(x), atol=2e-5)


def test_a_mirrored_load_has_a_mirrored_answer():
    nodes, p, q = tractions(0.15)
    x = np.linspace(-1.2, 1.2, 13) * HALF
    u, v = (response_of(COVERINGS["rubber"]) for _ in range(2))
    u_x, u_z = u.correction(nodes, p, q)
    v_x, v_z = v.correction(-nodes[::-1], p[::-1], -q[::-1])
    np.testing.assert_allclose(u_x(x), -v_x(-x), atol=1e-6)
    np.testing.assert_allclose(u_z(x), v_z(-x), atol=1e-6)


def test_what_has_no_equilibrium_keeps_the_last_answer():
    nodes, p, q = tractions(0.1)
    response = response_of(COVERINGS["rubber"])
    before = response.correction(nodes, p, q)
    assert response.is_found
    after = response.correction(nodes, 1000.0 * p, 3000.0 * q)
    assert not response.is_found
    assert after is before
    assert response.correction(nodes, p, q) is not before
    assert response.is_found


def test_nothing_moves_without_pressure():
    nodes, p, q = tractions(0.1)
    u_x, u_z = response_of(COVERINGS["rubber"]).correction(nodes, 0.0 * p, 0.0 * q)
    assert u_x(nodes) == pytest.approx(0.0)
    assert u_z(nodes) == pytest.approx(0.0)


def test_a_mesh_that_lies_aside_gives_the_same(monkeypatch):
    """Elements are off alike at finite strain and in linear theory: it matters little where.

    The contact has moved by a fiftieth of its width since the mesh was made, with dense columns
    where the edges were: 0.5 % of the largest correction.
    """
    monkeypatch.setattr(response, "_STEP_TOLERANCE", (0.0, 0.0))
    nodes, p, q = tractions(0.15)
    kept, anew = (response_of(COVERINGS["rubber"]) for _ in range(2))
    kept.correction(nodes - 0.0396 * HALF, p, q)
    x = np.linspace(-0.98, 0.98, 99) * HALF
    old, new = (np.stack([f(x) for f in one.correction(nodes, p, q)]) for one in (kept, anew))
    assert np.any(old != new)
    np.testing.assert_allclose(old, new, atol=5e-3 * np.abs(new).max())


def test_a_mesh_laid_by_the_expected_correction_stays(monkeypatch):
    """Without it the loaded columns of a large correction lie aside, and are laid once more."""
    laid, inner = [], FiniteResponse._remeshed

    def counted(*given):
        laid.append(1)
        return inner(*given)

    monkeypatch.setattr(FiniteResponse, "_remeshed", counted)
    nodes, p, q = tractions(0.5)
    q *= -2.0
    twice, once = response_of(COVERINGS["rubber"]), response_of(COVERINGS["rubber"])
    wanted = twice.correction(nodes, p, q)
    assert len(laid) == 1
    found = once.correction(nodes, p, q, expected=wanted[0])
    assert len(laid) == 1
    x = np.linspace(-0.98, 0.98, 99) * HALF
    for one, other in zip(found, wanted, strict=True):
        np.testing.assert_allclose(one(x), other(x), atol=1e-3 * np.abs(other(x)).max())


@pytest.mark.parametrize("peak", [0.1, 1.0])
def test_a_roller_that_winds_up_on_a_thin_core_has_no_equilibrium(peak):
    """Columns pass each other, or none is left in front: this broke off the program."""
    wound = covered(rn.Layer(6.0, RUBBER), radius=6.1)
    response = response_of(wound)
    response.correction(*tractions(peak))
    assert not response.is_found


def test_a_state_is_carried_to_other_columns_as_it_is():
    """Displacements and pressures of each element are the same on finer columns."""
    depths = Depths.of(covered(rn.Layer(2.0, RUBBER)), HALF)
    coarse = Strip(depths, np.linspace(-4.0, 4.0, 9))
    fine = Strip(depths, np.linspace(-4.0, 4.0, 33))
    rng = np.random.default_rng(7)
    displacement, pressure = rng.normal(size=coarse.size), rng.normal(size=(coarse.layer.size, 3))
    there = MeshState(displacement, pressure).on_columns(coarse, fine)
    moved, pressed = there.displacement, there.pressure
    gradient = coarse.gradient(coarse.local(displacement))
    finer = fine.gradient(fine.local(moved))
    rows = depths.row_layers.size
    weights = coarse.volumes, fine.volumes
    for wide, narrow in ((gradient[2], finer[2]), (pressure @ LINEAR.T, pressed @ LINEAR.T)):
        whole = (weights[0] * wide)[3 * rows : 4 * rows].reshape(rows, 9).sum(axis=1)
        parts = (weights[1] * narrow)[12 * rows : 16 * rows].reshape(4, rows, 9).sum(axis=(0, 2))
        np.testing.assert_allclose(parts, whole, atol=1e-9)
    back = there.on_columns(fine, coarse)
    np.testing.assert_allclose(back.displacement, displacement, atol=1e-12)


def test_a_matrix_by_rows_gives_what_one_by_columns_does(monkeypatch):
    """Many layers on few columns: the band of its matrix is as wide as a row, not a column."""
    layers = [rn.Layer(0.05, RUBBER if i % 2 else FOAM) for i in range(40)]
    depths = Depths.of(covered(*layers), HALF)
    nodes, p, q = tractions(0.1)
    made = []
    for by_rows in (True, False):
        kind = property(
            lambda strip, rows=by_rows: (strip.columns, strip.depths.row_layers.size, rows, False)
        )
        body = Body(Strip(depths, np.linspace(-4.0, 4.0, 17)))
        assert body.strip.order is not None
        assert body.strip.bands == (8 * 16 + 9, 8 * 16 + 9)
        monkeypatch.setattr(Strip, "_kind", kind)
        acting = linear_between_nodes(nodes, p, q)
        made.append(
            body.equilibrium(acting, body.linear_state(acting), tolerance=1e-9).displacement
        )
        monkeypatch.undo()
    np.testing.assert_allclose(made[0], made[1], atol=1e-9 * np.abs(made[0]).max())
