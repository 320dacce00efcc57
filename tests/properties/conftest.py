"""Random nips, and how many of them."""

import numpy as np
import pytest
from population import SEED

EXAMPLES = [12, pytest.param(100, marks=pytest.mark.slow)]


@pytest.fixture(params=EXAMPLES, ids=["few", "many"])
def for_all(request):
    """Calls a check with so many random values, each of them drawn from a generator of its own.

    The same values are drawn in every run, whatever else is tested (see `SEED`). A check that has
    nothing to say of a nip returns False; nine in ten must have something. ``many``: at most so
    many, where each takes several solutions.
    """

    def run(check, *draws, many=100):
        judged, count = 0, min(request.param, many)
        for number in range(count):
            rng = np.random.default_rng([SEED, number])
            values = [draw(rng) for draw in draws]
            try:
                judged += check(*values) is not False
            except Exception as broken:
                broken.add_note(f"draw {number} of seed {SEED}: {values}")
                raise
        assert judged >= 0.9 * count, f"{judged} of {count} judged"

    return run
