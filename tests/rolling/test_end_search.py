"""When what another mesh size has shown of the ends of zones still holds."""

import numpy as np
import pytest

from rollnip.rolling.end_search import length_change_ratio


def test_zones_change_by_their_own_length_or_a_twentieth_of_the_nip():
    before = np.array([-1.0, -0.9, 1.0])
    longer, shorter = np.array([-1.0, -0.898, 1.0]), np.array([-1.0, -0.98, 1.0])
    # Over three tolerances of the length, or of 0.1, a twentieth of 2
    assert length_change_ratio(before, longer, 1e-3) == pytest.approx(0.002 / 0.000306)
    assert length_change_ratio(before, shorter, 1e-3) == pytest.approx(0.08 / 0.0003)
