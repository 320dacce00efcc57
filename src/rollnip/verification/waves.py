"""Measured profiles: a smooth one against Hertz, a wavy one against Westergaard."""

from __future__ import annotations

from functools import partial
from math import pi

import numpy as np

from rollnip.closed_forms import WavyContact, contact_modulus, hertz_line, wavy_contact
from rollnip.materials import Elastic
from rollnip.nip import LineLoad, Nip
from rollnip.rollers import Profile, Roller
from rollnip.solution import Solution
from rollnip.verification._nips import half_space, half_width, peak_pressure, solved
from rollnip.verification.case import AllowedError, Experiment, VerificationCase
from rollnip.verification.sources import HERTZ, WESTERGAARD

_STEEL = Elastic(modulus=210e3, poisson=0.3)
_MODULUS = contact_modulus(210e3, 0.3, 210e3, 0.3)
_LOAD = 500.0
_LENGTH = 0.01  # of a wave [mm]; the nip has 60
_WAVES = AllowedError(1e-2, "60 waves lie in the nip where the closed form has infinitely many")
_GRID = AllowedError(2e-3, "the edges fall between nodes of a grid of 530 in the nip")
_PARTIAL, _FULL = 0.5, 1.5  # mean pressure over that of full contact


def waves() -> tuple[VerificationCase, ...]:
    """Hertz by transforms; waves in the middle of a nip that touch in part and wholly."""
    hertz = hertz_line(load=_LOAD, radius=25.0, contact_modulus=_MODULUS)
    flat = Experiment("Measured profile, flat, on steel", HERTZ, _solve_flat).figure
    part = Experiment(
        "Measured profile, waves in partial contact", WESTERGAARD, partial(_solve_wavy, _PARTIAL)
    ).figure
    whole = Experiment(
        "Measured profile, waves in full contact", WESTERGAARD, partial(_solve_wavy, _FULL)
    ).figure
    return (
        flat("half-width", "mm", hertz.half_width, half_width, _GRID),
        flat("peak pressure", "MPa", hertz.peak_pressure, peak_pressure),
        part("peak over its closed form", "", 1.0, partial(_peak, _PARTIAL), _WAVES),
        part("share in contact over its closed form", "", 1.0, partial(_share, _PARTIAL), _WAVES),
        whole("peak over its closed form", "", 1.0, partial(_peak, _FULL), _WAVES),
        whole("share in contact", "", 1.0, _touching, _WAVES),
    )


def _solve_flat() -> Solution:
    return _solve(Profile(x=np.linspace(-0.8, 0.8, 1401), height=np.zeros(1401)))


def _solve_wavy(share: float) -> Solution:
    x = np.linspace(-0.5, 0.5, 20001)
    return _solve(Profile(x=x, height=_amplitude(share) * np.cos(2.0 * pi * x / _LENGTH)))


def _solve(profile: Profile) -> Solution:
    upper = Roller(radius=50.0, core=_STEEL, profile=profile)
    lower = half_space(50.0, _STEEL)
    return solved(Nip(upper=upper, lower=lower, normal=LineLoad(_LOAD), friction=0.0))


def _amplitude(share: float) -> float:
    """Return the amplitude [mm] of waves that Hertz's peak, times 1/``share``, would flatten."""
    hertz = hertz_line(load=_LOAD, radius=25.0, contact_modulus=_MODULUS)
    return hertz.peak_pressure / share * _LENGTH / (pi * _MODULUS)


def _middle(solution: Solution) -> np.ndarray[tuple[int], np.dtype[np.bool_]]:
    """The nodes of the wave in the middle of the nip."""
    return np.abs(solution.nodes) < 0.5 * _LENGTH


def _closed_form(share: float, solution: Solution) -> WavyContact:
    """Return the closed form at the mean pressure that the middle wave carries."""
    return wavy_contact(
        mean_pressure=float(np.mean(solution.pressure[_middle(solution)])),
        amplitude=_amplitude(share),
        wavelength=_LENGTH,
        contact_modulus=_MODULUS,
    )


def _peak(share: float, solution: Solution) -> float:
    largest = float(np.max(solution.pressure[_middle(solution)]))
    return largest / _closed_form(share, solution).peak_pressure


def _share(share: float, solution: Solution) -> float:
    exact = _closed_form(share, solution)
    return _touching(solution) * 0.5 * _LENGTH / exact.half_width


def _touching(solution: Solution) -> float:
    """Share of the middle wave in contact, by the edges of its interval."""
    half = 0.5 * _LENGTH
    inside = [
        min(leading, half) - max(trailing, -half)
        for trailing, leading in solution.contact
        if trailing < half and leading > -half
    ]
    return sum(inside) / _LENGTH
