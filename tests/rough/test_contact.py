"""The check of a rough contact: at the nodes, between them, and never passed by a nan."""

from dataclasses import replace
from math import isnan, nan

import numpy as np
import pytest

import rollnip as rn
from rollnip.model import Model
from rollnip.rolling import pair_kernels
from rollnip.rough import contact as contact_module
from rollnip.rough.contact import rough_contact
from rollnip.rough.sampling import sampled
from rollnip.rough.solved import _verdict


@pytest.fixture
def wavy(coated):
    x = np.linspace(-12.0, 12.0, 4001)
    profile = rn.Profile(x=x, height=1e-3 * np.cos(2.0 * np.pi * x / 0.5))
    upper = rn.Roller(radius=coated.upper.radius, layers=coated.upper.layers, profile=profile)
    return replace(coated, upper=upper)


def solved(nip):
    return rough_contact(nip, sampled(nip, 3.0), pair_kernels(nip, "linear"), 1e-3)


@pytest.mark.parametrize("name", ["residual", "between"])
def test_a_nan_in_the_check_is_not_converged(wavy, name):
    rough = solved(wavy)
    model = Model(geometry="linear")
    assert _verdict(wavy, model, rough)[0]
    assert not _verdict(wavy, model, replace(rough, **{name: nan}))[0]


@pytest.mark.parametrize("figure", [2, 3])
def test_a_width_or_a_peak_that_is_not_known_is_not_converged(wavy, figure):
    """Its value on every second sample may lie a tenth of the figure away, not more, nor be nan."""
    rough, model = solved(wavy), Model(geometry="linear")
    for share, is_met in ((0.05, True), (0.15, False), (4.0, False), (nan, False)):
        coarser = list(rough.coarser)
        coarser[figure] = (1.0 + share) * rough.figures[figure]
        converged, status = _verdict(wavy, model, replace(rough, coarser=tuple(coarser)))
        assert converged is is_met
        assert ("nip width" if figure == 2 else "peak pressure") in status


def test_displacements_that_are_nan_are_not_converged(wavy, monkeypatch):
    matrix = contact_module.displacement_matrix
    monkeypatch.setattr(contact_module, "displacement_matrix", lambda *a: nan * matrix(*a))
    rough = solved(wavy)
    assert isnan(rough.residual)
    assert isnan(rough.between)
    assert not rn.solve(wavy, Model(geometry="linear")).converged


def test_pressures_that_ripple_from_node_to_node_are_seen_between_them(wavy):
    """A saw tooth moves the surface at the nodes and half-way in opposite directions."""
    rough = solved(wavy)
    assert rough.between < 1e-3
    nip, sampling = wavy, rough.sampling
    kernel = contact_module.normal_kernel(rough.kernels)
    tooth = np.where(np.arange(rough.pressure.size) % 2, 1.0, -1.0)
    rippled = np.where(rough.pressure > 0.0, rough.pressure * (1.0 + 0.5 * tooth), 0.0)
    state = replace(rough.state, pressure=rippled)
    lift = contact_module._lift(nip, kernel, sampling)
    wrong = contact_module._between(nip, sampling, state, kernel, lift)
    right = contact_module._between(nip, sampling, rough.state, kernel, lift)
    assert wrong > 10.0 * right


def test_what_samples_far_apart_leave_open_shows_between_them_alone(coated):
    x = np.linspace(-12.0, 12.0, 25)
    profile = rn.Profile(x=x, height=5e-2 * np.cos(np.pi * x))
    upper = rn.Roller(radius=coated.upper.radius, layers=coated.upper.layers, profile=profile)
    nip = replace(coated, upper=upper)
    rough = solved(nip)
    assert rough.between > 100.0 * rough.residual
