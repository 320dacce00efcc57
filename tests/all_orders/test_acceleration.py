"""Anderson's method on maps whose fixed points are known, and when an iteration may stop."""

import numpy as np
import pytest

from rollnip.all_orders.acceleration import AndersonMixer, BestSolution, even_places
from rollnip.finite import Spline
from rollnip.rolling.displacements import SecondFields

PLACES = np.linspace(0.0, 1.0, 9)
LARGE, SMALL = np.sin(np.pi * PLACES), np.cos(np.pi * PLACES)  # two shapes of a correction


def correction(large, small):
    """Return a correction of u_x of the upper surface of two shapes."""
    function = Spline.natural_cubic(PLACES, large * LARGE + small * SMALL)
    return SecondFields((function, None, None, None), lost=(0.0, 0.0), rough=(None,) * 4)


def shares(one):
    """Return how much a correction has of either shape."""
    return np.linalg.lstsq(np.array([LARGE, SMALL]).T, one.at(PLACES).four[0], rcond=None)[0]


@pytest.mark.parametrize("factor", [0.98, 1.2, -3.0])
def test_a_small_part_that_converges_slowly_is_found_beside_a_large_one(factor):
    """Of a large error 0.3 are left in each iteration, of a small one ``factor``.

    The differences of the small part are those of the large one long before; if these decide what
    counts as different, the small part is never accelerated.
    """
    mixer, held = AndersonMixer(even_places((0.0, 1.0))), correction(1.0, 1e-4)
    for _ in range(12):
        large, small = shares(held)
        # A little of the large part responds with its square, as equilibria do.
        held = mixer.mixed(held, correction(0.3 * large + 0.05 * large**2, factor * small))
    assert np.abs(shares(held)).max() < 1e-9


def test_an_iteration_at_rest_gives_its_own_correction():
    """Differences that no longer change have no direction."""
    mixer, held = AndersonMixer(even_places((0.0, 1.0))), correction(0.5, 0.2)
    for _ in range(4):
        held = mixer.mixed(held, correction(0.5, 0.2))
    assert shares(held) == pytest.approx([0.5, 0.2])


@pytest.mark.parametrize(
    ("violation", "change", "stops"),
    [
        (2.9, 0.02, True),  # at rest, and still violated
        (1.1, 0.02, False),  # another mesh like this one may end the violation
        (2.9, 0.5, False),  # not at rest
        (0.2, 5.0, True),  # the conditions are met
        (0.8, 5.0, False),
    ],
)
def test_an_iteration_stops_where_hardly_anything_changes(violation, change, stops):
    best = BestSolution()
    assert best.may_stop("it", violation, change) is stops
    assert best.found == ("it" if violation <= 1.0 else None)
