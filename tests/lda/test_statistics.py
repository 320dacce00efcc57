import numpy as np
import pytest

from rollnip._errors import InvalidInputError
from rollnip.lda import estimate_profile, profile_from_means


def bursts(seed, places=20, each=12, *, spread=0.5, contamination=0.0):
    rng = np.random.default_rng(seed)
    x = np.repeat(np.linspace(-5.0, 5.0, places), each)
    v = 100.0 + np.sin(x) + spread * rng.standard_normal(x.size)
    wild = rng.random(x.size) < contamination
    return x, np.where(wild, rng.uniform(60.0, 140.0, x.size), v)


def covered(confidence, seeds=range(300), **options):
    """Shares of positions and of whole curves that the bands hold."""
    single, joint = [], []
    for seed in seeds:
        profile = estimate_profile(*bursts(seed, **options), confidence=confidence)
        off = np.abs(profile.velocity - (100.0 + np.sin(profile.x)))
        single.append(np.mean(off <= profile.band))
        joint.append(np.all(off <= profile.joint_band))
    return np.mean(single), np.mean(joint)


@pytest.mark.parametrize("confidence", [0.8, 0.95])
def test_bands_cover_as_often_as_they_say(confidence):
    single, joint = covered(confidence)
    # 6000 intervals tell a share to 0.5 %, 300 curves to 2.3 %
    assert single == pytest.approx(confidence, abs=0.015)
    assert joint == pytest.approx(confidence, abs=0.06)


def test_bands_cover_with_outliers_rejected():
    single, _ = covered(0.95, contamination=0.05, each=25)
    assert single == pytest.approx(0.95, abs=0.02)


def test_outliers_are_counted_and_do_no_harm():
    x, v = bursts(1)
    v[5] = 170.0
    profile = estimate_profile(x, v)
    assert profile.rejected[0] == 1
    assert profile.count[0] == 11
    assert abs(profile.velocity[0] - 100.0 - np.sin(-5.0)) < profile.joint_band[0]


def test_fast_scatterers_arrive_more_often_and_the_weight_undoes_it():
    rng = np.random.default_rng(2)
    moments = 100.0 * (1.0 + 0.15 * rng.standard_normal(400_000))
    moments = moments[moments > 20.0]
    seen = rng.choice(moments, size=60_000, p=moments / np.sum(moments))
    profile = estimate_profile(np.zeros(seen.size), seen)
    # the plain mean is too high by variance/mean = 2.25
    assert np.mean(seen) - np.mean(moments) == pytest.approx(2.25, abs=0.2)
    assert abs(profile.velocity[0] - np.mean(moments)) < 4.0 * profile.error[0]


def test_a_measured_stay_does_as_well_as_one_over_the_speed():
    x, v = bursts(3)
    own = estimate_profile(x, v)
    given = estimate_profile(x, v, weight=0.05 / v)
    assert given.velocity == pytest.approx(own.velocity)


def test_strain_is_the_speed_less_the_rollers():
    x, v = bursts(4)
    profile = estimate_profile(x, v, speed=98.0)
    assert profile.strain == pytest.approx(profile.velocity / 98.0 - 1.0)
    assert estimate_profile(x, v).strain is None


def test_order_does_not_matter():
    x, v = bursts(5)
    mixed = np.random.default_rng(0).permutation(x.size)
    assert estimate_profile(x[mixed], v[mixed]).velocity == pytest.approx(
        estimate_profile(x, v).velocity
    )


def test_means_with_errors_stand_as_given():
    profile = profile_from_means(
        np.array([1.0, 0.0]), np.array([5.0, 6.0]), np.array([0.1, 0.2]), confidence=0.95
    )
    assert list(profile.x) == [0.0, 1.0]
    assert profile.band == pytest.approx([0.2 * 1.959964, 0.1 * 1.959964])
    assert profile.variance == pytest.approx([0.04, 0.01])


def test_equal_velocities_have_a_band_of_almost_nothing():
    profile = estimate_profile(np.zeros(6), np.full(6, 50.0))
    assert profile.velocity == pytest.approx([50.0])
    assert 0.0 < profile.band[0] < 1e-10


@pytest.mark.parametrize(
    ("arguments", "hint"),
    [
        (([0.0] * 4, [1.0] * 4), "at least 5 valid bursts"),
        (([0.0] * 5, [1.0] * 4), "equal length"),
        (([], []), "not empty"),
        (([0.0] * 5, [1.0, 2.0, np.nan, 1.0, 1.0]), "without gaps"),
        (([0.0] * 5, [0.0] * 5), "must not be zero"),
    ],
)
def test_refuses(arguments, hint):
    x, v = (np.array(a, dtype=float) for a in arguments)
    with pytest.raises(InvalidInputError, match=hint):
        estimate_profile(x, v)


def test_refuses_options():
    x, v = bursts(6)
    for options, hint in (
        ({"confidence": 1.0}, "confidence"),
        ({"least": 2}, "least"),
        ({"speed": -1.0}, "speed"),
        ({"weight": -v}, "weight"),
    ):
        with pytest.raises(InvalidInputError, match=hint):
            estimate_profile(x, v, **options)
    with pytest.raises(InvalidInputError, match="twice"):
        profile_from_means(np.zeros(2), np.ones(2), np.ones(2))
    with pytest.raises(InvalidInputError, match="`error`"):
        profile_from_means(np.arange(2.0), np.ones(2), np.zeros(2))
