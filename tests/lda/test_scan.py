from dataclasses import replace

import numpy as np
import pytest

import rollnip as rn
from rollnip._errors import InvalidInputError
from rollnip.lda import Instrument, Seeding, estimate_profile, simulate_scan, surface_speed


def test_the_bursts_bring_back_the_computed_speed(free, instrument):
    profile, _ = surface_speed(free)
    off = []
    for seed in range(6):
        scan = simulate_scan(free, instrument, positions=15, seed=seed)
        found = estimate_profile(scan.x, scan.velocity)
        truth = profile.averaged(found.x, instrument.averaging_width)
        off.append((found.velocity - truth) / found.error)
    # 90 values tell a standard deviation to 7.5 %; t of about 40 bursts spreads by 1.03
    assert np.std(off) == pytest.approx(1.03, abs=0.2)
    assert abs(np.mean(off)) < 0.35


def test_the_rollers_speed_is_that_of_the_creepage(driven):
    _, upper = surface_speed(driven, "upper")
    _, lower = surface_speed(driven, "lower")
    assert (upper - lower) / (0.5 * (upper + lower)) == pytest.approx(driven.creepage)


def test_a_rigid_roller_is_measured_too(free, instrument):
    scan = simulate_scan(free, instrument, side="lower", positions=3, seed=1)
    assert np.mean(scan.velocity) == pytest.approx(scan.roller_speed, rel=2e-3)


def test_seeds(free, instrument):
    first, again, other = (
        simulate_scan(free, instrument, positions=3, seed=s).frequency for s in (1, 1, 2)
    )
    assert np.array_equal(first, again)
    assert not np.array_equal(first, other)


def test_refusals(free, driven, instrument):
    for options, hint in (
        ({"positions": np.array([100.0])}, "inside the solution"),
        ({"positions": 1}, "positions"),
    ):
        with pytest.raises(InvalidInputError, match=hint):
            simulate_scan(free, instrument, **options)
    with pytest.raises(InvalidInputError, match="Nyquist"):
        simulate_scan(driven, Instrument(sample_rate=60e3))
    for wrong in ({"bursts": 0}, {"snr": -1.0}, {"spread": 0.5}, {"spacing": 0.0}):
        with pytest.raises(InvalidInputError, match=next(iter(wrong))):
            Seeding(**wrong)


def test_a_nip_without_speed_has_no_surface_speed(free):
    still = rn.solve(replace(free.nip, speed=None), rn.Model(tolerance=1e-2))
    with pytest.raises(InvalidInputError, match="speed"):
        surface_speed(still)
