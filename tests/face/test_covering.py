"""Coverings that vary along the face: against plane nips of the local covering."""

from dataclasses import replace

import numpy as np
import pytest
from press_face import CURVED, FACE, press, solve_face

import rollnip as rn
from rollnip.face import CoveringTable, NipRows
from rollnip.face.covering import CoveringAxis


def frictionless(covering, **changes):
    return replace(press(covering=covering, **changes), friction=0.0)


def plane(solution, i, layer, lower=()):
    """The cross-section at one place, solved afresh with its own covering."""
    nip = solution.nip
    changed = replace(
        nip,
        upper=replace(nip.upper, layers=(layer,), shaft=None),
        lower=replace(nip.lower, layers=lower, shaft=None),
        normal=rn.LineLoad(float(solution.load[i])),
    )
    return rn.solve(changed, CURVED)


def assert_is_plane(solution, i, fresh, tolerance):
    assert solution.approach[i] == pytest.approx(fresh.approach, rel=tolerance)
    assert solution.nip_width[i] == pytest.approx(fresh.nip_width, rel=tolerance)
    assert solution.peak_pressure[i] == pytest.approx(fresh.peak_pressure, rel=tolerance)


@pytest.fixture(scope="module")
def kept():
    """Plane nips of this file, which has no friction."""
    return NipRows()


def test_a_covering_that_is_harder_at_one_end(kept):
    """One covering alone: a factor on its modulus is a factor on load, and no other is solved.

    As close to plane nips as the table without it, 1e-3.
    """
    even = solve_face(frictionless(None), FACE, rows=kept)
    table = CoveringTable([-800.0, 800.0], stiffness=[0.9, 1.1])
    found = solve_face(frictionless(table), FACE, rows=kept)
    assert found.law.axes == ()
    assert found.load[-1] > found.load[0]
    assert even.load[-1] == pytest.approx(even.load[0])
    for i in (0, 40, 64):
        modulus = 3.6 * float(np.interp(found.y[i], [-800.0, 800.0], [0.9, 1.1]))
        fresh = plane(found, i, rn.Layer(12.0, rn.Elastic(modulus=modulus, poisson=0.5)))
        assert_is_plane(found, i, fresh, 1e-3)


def test_a_covering_that_is_worn_in_the_middle(kept):
    """Thicknesses from 10 to 12 mm: their interpolation is claimed, and good to 1e-3."""
    table = CoveringTable([-800.0, 0.0, 800.0], thickness=[12.0, 10.0, 12.0])
    found = solve_face(frictionless(table), FACE, rows=kept)
    assert found.converged
    assert 0.0 < found.error["upper_thickness"] < 1e-3
    for i in (0, 20, 32):
        thickness = float(np.interp(found.y[i], [-800.0, 0.0, 800.0], [12.0, 10.0, 12.0]))
        fresh = plane(found, i, rn.Layer(thickness, rn.Elastic(modulus=3.6, poisson=0.5)))
        assert_is_plane(found, i, fresh, 1e-3)


def test_the_table_of_a_varying_covering_is_kept(kept):
    table = CoveringTable([-800.0, 800.0], thickness=[11.0, 12.0])
    first = solve_face(frictionless(table), FACE, rows=kept)
    known = len(kept)
    again = solve_face(frictionless(table, crown=rn.Crown(0.1)), FACE, law=first.law)
    assert len(kept) == known
    assert again.converged
    with pytest.raises(rn.InvalidInputError, match="same cross-section, covering and model"):
        solve_face(frictionless(None), FACE, law=first.law)


def test_two_coverings_of_which_one_is_harder_at_one_end():
    """No scaling holds: cross-sections of several stiffnesses are solved, good to 1e-3."""
    soft = rn.Layer(6.0, rn.Elastic(modulus=2.0, poisson=0.5))
    table = CoveringTable([-800.0, 800.0], stiffness=[0.8, 1.25])
    nip = frictionless(table)
    found = solve_face(replace(nip, lower=replace(nip.lower, layers=(soft,))), FACE)
    assert found.error["upper_stiffness"] < 1e-3
    for i in (0, 25):
        factor = float(np.interp(found.y[i], [-800.0, 800.0], [0.8, 1.25]))
        layer = rn.Layer(12.0, rn.Elastic(modulus=3.6 * factor, poisson=0.5))
        assert_is_plane(found, i, plane(found, i, layer, (soft,)), 1e-3)


def test_every_modulus_times_a_factor(kept):
    """Dimensions: twice the modulus and twice the load on rigid rollers, the same lengths."""
    nip = frictionless(None)
    bare = replace(nip, upper=replace(nip.upper, shaft=None), lower=replace(nip.lower, shaft=None))
    one = solve_face(bare, FACE, rows=kept)
    two = solve_face(replace(bare, normal=rn.LineLoad(12.0)), FACE, stiffness=2.0, rows=kept)
    for name, factor in (("approach", 1.0), ("nip_width", 1.0), ("peak_pressure", 2.0)):
        np.testing.assert_allclose(getattr(two, name), factor * getattr(one, name), rtol=1e-9)
    np.testing.assert_allclose(two.torque_lower, 2.0 * one.torque_lower, atol=1e-9)


def test_weights_of_nodes_are_those_of_the_polynomial():
    """A parabola in the logarithm through three nodes is kept exactly."""
    axis = CoveringAxis.between(("upper", "thickness"), 8.0, 12.0)
    x = np.linspace(8.0, 12.0, 7)
    exact = 1.0 + np.log(x) - 0.3 * np.log(x) ** 2
    nodes = np.array(axis.nodes)
    at_nodes = 1.0 + np.log(nodes) - 0.3 * np.log(nodes) ** 2
    np.testing.assert_allclose(axis.weights(x) @ at_nodes, exact, rtol=1e-12)
    assert set(np.round(nodes, 9)) <= set(np.round(axis.finer.nodes, 9))


@pytest.mark.parametrize(
    ("make", "sentence"),
    [
        (lambda: CoveringTable([0.0, 1.0]), "`covering` must hold thickness or stiffness"),
        (lambda: CoveringTable([0.0, 1.0], thickness=[1.0, 0.0]), "`thickness` must be positive"),
        (lambda: CoveringTable([0.0, 1.0], thickness=[1.0]), "each of the 2 places, got 1"),
        (
            lambda: solve_face(
                frictionless(CoveringTable([-10.0, 10.0], thickness=[1.0, 1.0])), FACE
            ),
            "`covering` must cover the whole face, from -800 to 800 mm; its table goes from -10",
        ),
        (
            lambda: solve_face(
                frictionless(CoveringTable([-800.0, 800.0], thickness=[0.1, 12.0]), crown=0.3), FACE
            ),
            "`crown` must be smaller than the covering, 0.1 mm thick",
        ),
    ],
)
def test_coverings_that_cannot_be(make, sentence):
    with pytest.raises(rn.InvalidInputError, match=sentence):
        make()
