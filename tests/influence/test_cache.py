"""Influence functions kept between solves."""

from dataclasses import replace

import numpy as np
import pytest

import rollnip as rn
from rollnip._errors import InvalidInputError

RUBBER = rn.Elastic(modulus=2.0, poisson=0.5)
SLOW = rn.StandardLinearSolid(modulus=2.0, stiffening=3.0, relaxation_time=0.007, poisson=0.5)


def nip(material=RUBBER, radius=50.0):
    return rn.Nip(
        upper=rn.Roller(radius=radius, layers=[rn.Layer(2.0, material)]),
        lower=rn.Roller(radius=25.0, layers=[rn.Layer(1.0, RUBBER)]),
        normal=rn.LineLoad(1.0),
        friction=0.3,
        speed=100.0,
    )


@pytest.mark.parametrize("geometry", ["linear", "curved", "second"])
def test_results_are_the_same_to_the_last_bit(geometry):
    cache, model = rn.KernelCache(), rn.Model(geometry=geometry)
    for load in (1.0, 1.2):
        case = replace(nip(), normal=rn.LineLoad(load))
        kept, fresh = rn.solve(case, model, cache=cache), rn.solve(case, model)
        np.testing.assert_array_equal(kept.pressure, fresh.pressure)
        np.testing.assert_array_equal(kept.shear, fresh.shear)
        assert kept.creepage == fresh.creepage
    assert len(cache) == (4 if geometry == "second" else 2)


@pytest.mark.parametrize(
    "changed",
    [
        nip(radius=51.0),
        nip(SLOW),
        replace(nip(SLOW), speed=101.0),
        replace(nip(), lower=rn.Roller(radius=25.0)),
        replace(nip(), upper=nip().lower, lower=nip().upper),
    ],
)
@pytest.mark.parametrize("geometry", ["linear", "curved"])
def test_a_cache_never_mixes_up_pairs(geometry, changed):
    cache = rn.KernelCache()
    for case, other in ((nip(), "curved"), (nip(SLOW), geometry), (nip(), "linear")):
        rn.solve(case, rn.Model(geometry=other), cache=cache)
    kept = rn.solve(changed, rn.Model(geometry=geometry), cache=cache)
    fresh = rn.solve(changed, rn.Model(geometry=geometry))
    np.testing.assert_array_equal(kept.pressure, fresh.pressure)
    assert kept.approach == fresh.approach


@pytest.mark.parametrize(
    ("changed", "tables"),
    [
        (replace(nip(), normal=rn.LineLoad(2.0), friction=0.1), 2),
        (replace(nip(), speed=200.0), 2),
        (nip(SLOW), 4),  # its memory lengthens the window of both
        (nip(radius=51.0), 3),
    ],
)
def test_what_a_table_depends_on(changed, tables):
    cache = rn.KernelCache()
    for case in (nip(), changed):
        rn.solve(case, rn.Model(geometry="curved"), cache=cache)
    assert len(cache) == tables


def test_flat_layers_do_not_depend_on_the_radius():
    cache = rn.KernelCache()
    for radius in (50.0, 51.0):
        rn.solve(nip(radius=radius), rn.Model(geometry="linear"), cache=cache)
    assert len(cache) == 2


def test_viscoelastic_tables_depend_on_the_speed():
    cache = rn.KernelCache()
    for speed in (100.0, 101.0):
        rn.solve(replace(nip(SLOW), speed=speed), rn.Model(geometry="curved"), cache=cache)
    assert len(cache) == 3


LIGHT = rn.Nip(
    upper=rn.Roller(radius=50.0, layers=[rn.Layer(2.0, SLOW)]),
    lower=rn.Roller(radius=25.0),
    normal=rn.Approach(0.05),
    friction=0.3,
    speed=100.0,
)


@pytest.mark.parametrize(
    ("changed", "new"),
    [
        (replace(LIGHT, tangential=rn.Traction(0.01), friction=0.5), 0),
        (replace(LIGHT, normal=rn.Approach(0.052)), 0),  # a nip 2 % wider
        (replace(LIGHT, normal=rn.Approach(0.1)), 1),  # 40 % wider: the second order's alone
        (replace(LIGHT, speed=101.0), 2),
    ],
)
def test_what_the_second_order_depends_on(changed, new):
    cache, model = rn.KernelCache(), rn.Model(geometry="second")
    rn.solve(LIGHT, model, cache=cache)
    before = len(cache)
    kept = rn.solve(changed, model, cache=cache)
    assert len(cache) - before == new
    np.testing.assert_array_equal(kept.pressure, rn.solve(changed, model).pressure)


def test_few_tables_of_second_order_are_kept():
    cache, roller = rn.KernelCache(most=8), nip().upper
    tables = [cache.second(roller, None, half_width) for half_width in (1.0, 2.0, 4.0)]
    assert len(cache) == 2
    assert cache.second(roller, None, 4.1).fields is tables[2].fields
    assert cache.second(roller, None, 1.0).fields is not tables[0].fields


def test_the_oldest_tables_go_first():
    cache = rn.KernelCache(most=2)
    for radius in (50.0, 60.0, 70.0):
        rn.solve(nip(radius=radius), rn.Model(geometry="curved"), cache=cache)
    assert len(cache) == 2
    with pytest.raises(InvalidInputError, match="`most` must be 1 or more, got 0"):
        rn.KernelCache(most=0)
