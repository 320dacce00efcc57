"""Columns of elements: as dense as the nodes, and dense and far enough under a stiff skin."""

import numpy as np
import pytest

import rollnip as rn
import rollnip.finite.columns as columns_module
from rollnip.finite import Body, Depths, FiniteResponse, Strip, linear_between_nodes
from rollnip.finite.columns import Columns
from rollnip.influence import covering_window, surface_kernels

RUBBER = rn.Elastic(modulus=0.5, poisson=0.5)
HALF = 1.5


def coated(*layers, radius=15.0):
    return rn.Roller(radius=radius, layers=layers)


def skinned(stiffer, thickness=0.05):
    skin = rn.Elastic(modulus=0.5 * stiffer, poisson=0.4)
    return coated(rn.Layer(thickness, skin), rn.Layer(3.0, RUBBER))


PLAIN, FOIL = coated(rn.Layer(3.0, RUBBER)), skinned(900.0)
NODES = HALF * np.sin(0.5 * np.pi * np.linspace(-1.0, 1.0, 97))


def response_of(roller):
    window = covering_window((roller, coated(radius=25.0)), None)
    surface = surface_kernels(roller, None, "second", window)
    return FiniteResponse(roller, HALF, surface.displacement)


def test_without_a_skin_columns_follow_the_nodes():
    under = Columns.of(PLAIN, HALF).under(NODES)
    assert under == pytest.approx(NODES[::3])


def test_under_a_skin_columns_resolve_its_thickness_beside_the_edges():
    """Also on nodes that do not: the first elements there are a few."""
    for nodes in (NODES, NODES[::16]):
        under = Columns.of(FOIL, HALF).under(nodes)
        assert (under[0], under[-1]) == (nodes[0], nodes[-1])
        lengths = np.diff(under)
        assert np.all(lengths > 0.0)
        assert max(lengths[0], lengths[-1]) < 0.3 * 0.05
        assert lengths.max() < 5.0 * 0.05


def test_a_layer_that_is_hardly_stiffer_is_no_skin():
    """Between a skin and none there is no step."""
    columns = [Columns.of(skinned(stiffer), HALF) for stiffer in (0.999, 1.001)]
    assert columns[0].skin == np.inf
    assert columns[1].under(NODES) == pytest.approx(columns[0].under(NODES))
    assert columns[1].reach == pytest.approx(columns[0].reach, rel=1e-2)


def test_a_layer_a_little_stiffer_has_no_short_waves_of_its_own():
    """Configuration III (2.5 times as stiff) did not come to rest with those of a skin."""
    weak, stiff = (Columns.of(skinned(stiffer), HALF).cut for stiffer in (2.5, 900.0))
    assert weak < 0.02 * stiff
    assert stiff == pytest.approx(8.0 / 0.05, rel=2e-3)
    assert Columns.of(skinned(0.999), HALF).cut == Columns.of(PLAIN, HALF).cut == 0.0
    assert Columns.of(skinned(1.001), HALF).cut == pytest.approx(0.0, abs=1e-3)


def test_a_mesh_reaches_as_far_as_a_skin_carries_forces():
    """Twice as far changes the approach of a foil under a pull by 1e-3: it slid where it ended.

    A foil pulled on an infinite layer is displaced by T/(E h) times the length sqrt(E h t/G).
    """
    pressure, shear = np.zeros(NODES.size - 2), 1e-3 * np.ones(NODES.size - 2)
    moved = []
    for further in (1.0, 1.5):
        columns = Columns.of(FOIL, HALF)
        columns = Columns(columns.longest, further * columns.reach, columns.skin)
        places, loaded = columns.places(NODES, pressure + 1e-9)
        body = Body(Strip(Depths.of(FOIL, HALF), places))
        found = body.linear_displacements(linear_between_nodes(NODES, pressure, shear))
        moved.append(body.strip.on_surface(found)[::2, 0][loaded][NODES.size // 6])
    assert moved[0] == pytest.approx(moved[1], rel=2e-3)


def test_no_traction_acts_on_the_far_side():
    """A mesh that goes around the roller comes back to the places x of the contact."""
    ends = np.linspace(-1.9 * np.pi, 1.9 * np.pi, 200) * FOIL.radius
    surface = Strip(Depths.of(FOIL, HALF), ends).surface
    far = np.abs(surface.arcs) > 0.5 * np.pi * FOIL.radius
    assert np.all(surface.weights[far] == 0.0)
    assert surface.weights.sum() == pytest.approx(np.pi * FOIL.radius, rel=1e-2)


def test_contacts_of_other_nodes_one_after_the_other():
    """Their columns differ in number; the last response is that of a fresh calculation."""

    def response(used, half, count):
        nodes = half * np.sin(0.5 * np.pi * np.linspace(-1.0, 1.0, count))
        pressure = 0.05 * np.sqrt(1.0 - (nodes[1:-1] / half) ** 2)
        return used.correction(nodes, pressure, 0.2 * pressure)

    used, x = response_of(FOIL), np.linspace(-HALF, HALF, 9)
    for half, count in ((1.5, 41), (1.4, 31)):
        found = response(used, half, count)
    fresh = response(response_of(FOIL), half, count)
    for one, other in zip(found, fresh, strict=True):
        np.testing.assert_allclose(one(x), other(x), atol=2e-2 * np.abs(other(x)).max())


@pytest.mark.parametrize("layers", [((0.1, 0.5),), ((0.01, 0.5),), ((0.02, 0.5), (2.0, 500.0))])
def test_columns_resolve_the_thickness_of_what_is_squeezed(layers):
    """Under a thin layer on something stiff no element is longer than 0.4 of its thickness."""
    rubber = [rn.Layer(thick, rn.Elastic(modulus=young, poisson=0.5)) for thick, young in layers]
    lengths = np.diff(Columns.of(coated(*rubber), HALF).under(NODES))
    assert np.max(lengths) <= 0.4 * layers[0][0] * 1.01


def test_columns_are_bounded_under_coverings_beyond_all_measure():
    thinnest = coated(rn.Layer(1e-9, RUBBER))
    assert Columns.of(thinnest, HALF).under(NODES).size <= 1025


def test_a_thin_layer_on_a_softer_one_asks_for_no_columns_of_its_own():
    """It is not squeezed: what lies below gives way itself."""
    both = coated(rn.Layer(0.02, RUBBER), rn.Layer(3.0, rn.Elastic(modulus=0.5, poisson=0.4)))
    assert Columns.of(both, HALF).under(NODES) == pytest.approx(NODES[::3])


@pytest.mark.parametrize("thickness", [0.05, 0.01, 0.005])
def test_thin_coverings_keep_their_claims_on_denser_columns(thickness, monkeypatch):
    """With elements longer than the covering is thick its approach was 15 % off, and verified.

    A thin bonded covering of incompressible rubber also follows linear theory up to terms of the
    order of its compression, approach/thickness, here two per cent.
    """
    rubber = rn.Elastic(modulus=2.0, poisson=0.5)
    nip = rn.Nip(
        upper=coated(rn.Layer(thickness, rubber), radius=50.0),
        lower=coated(radius=25.0),
        normal=rn.LineLoad(1.0),
        friction=0.3,
    )
    solution = rn.solve(nip, on_failure="raise")
    monkeypatch.setattr(columns_module, "_OVER_SQUEEZED", 0.15)
    denser = rn.solve(nip, on_failure="raise")
    linear = rn.solve(nip, rn.Model(geometry="linear"), on_failure="raise")
    assert solution.model.geometry == denser.model.geometry == "finite"
    for name in ("approach", "nip_width", "peak_pressure", "creepage"):
        one, other = getattr(solution, name), getattr(denser, name)
        assert abs(one - other) <= solution.error[name]
    compression = linear.approach / thickness
    assert solution.approach == pytest.approx(linear.approach, rel=2.0 * compression)
