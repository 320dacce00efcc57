"""The fit of a Prony series to relaxation or creep data."""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray
from scipy.optimize import brentq

from rollnip._errors import InvalidInputError
from rollnip.dma.fit import DmaMethod, rounded_law, shifted, to_six_digits, with_levels
from rollnip.dma.master import Master, robust_weights, unshifted
from rollnip.dma.quality import RMS_LIMIT, ROW_LIMIT, outlying_rows, row_of
from rollnip.dma.shifts import ShiftFit
from rollnip.dma.spectrum import crossvalidated, non_negative, relaxation_times
from rollnip.dma.timedata import TimeData
from rollnip.materials import Prony, creep_compliance, relaxation_modulus

Array = NDArray[np.float64]

_LEAST_PART = 1e-9  # fraction of the largest term below which a term is dropped
_SMALLEST = 1e-3  # least relaxed modulus or instantaneous compliance over the least value measured
_FLAT = 0.9  # least over largest value of the last decade, from which the plateau is reached


@dataclass(frozen=True, eq=False, slots=True, kw_only=True)
class TimeFit:
    """A material fitted to relaxation or creep data.

    Attributes
    ----------
    material : the material at the reference temperature, with the shift law if there are several
        temperatures.
    master : the data at the reference temperature.
    shift : the law with its constants and their standard errors.
    rms : relative rms deviation of the material from the data.
    largest : the largest relative deviation, computed over measured less 1.
    row : the row in which it occurs.
    time_range : shortest and longest time [s] at the reference temperature.
    temperature_range : lowest and highest temperature measured [degC].
    warnings : reservations, in plain words.
    """

    material: Prony
    master: Master
    shift: ShiftFit
    rms: float
    largest: float
    row: str
    time_range: tuple[float, float]
    temperature_range: tuple[float, float]
    warnings: tuple[str, ...]

    @property
    def frequency_range(self) -> tuple[float, float]:
        """Lowest and highest frequency [Hz] that correspond to the times, 1/(2 pi t)."""
        return self.master.frequency_range


def fit_time(data: TimeData, method: DmaMethod | None = None) -> TimeFit:
    """Fit a Prony series to a relaxation modulus or a creep compliance.

    A relaxation modulus is E + sum E_i e^(-t/tau_i), a creep compliance J + sum J_i (1 -
    e^(-t/lambda_i)), with no negative term. Retardation is converted to relaxation exactly, by
    E*(s) J*(s) = 1. Isotherms are shifted as in `fit_dma`.

    Parameters
    ----------
    data :
        from `read_time_data`.
    method :
        settings as for `fit_dma`; the model must be "prony".

    Raises
    ------
    InvalidInputError
        where the model is another, or the data cannot determine the shifts.
    """
    method = DmaMethod() if method is None else method
    if method.model != "prony":
        raise InvalidInputError(
            f'`model` must be "prony" for data over time, got "{method.model}".'
        )
    start = unshifted(data, method.reference, method.vertical, method.width)
    shift = shifted(start, method)
    if method.robust:
        start = replace(start, weights=robust_weights(shift.master).weights)
        shift = shifted(start, method)
    master = shift.master
    material = _material(master, shift, method)
    away = _deviations(material, master)
    worst = int(np.argmax(np.abs(away)))
    low, high = master.frequency_range
    found = TimeFit(
        material=material,
        master=master,
        shift=shift,
        rms=float(np.sqrt(np.mean(away**2))),
        largest=float(away[worst]),
        row=row_of(master, worst),
        time_range=(1.0 / (2.0 * np.pi * high), 1.0 / (2.0 * np.pi * low)),
        temperature_range=(float(np.min(data.temperature)), float(np.max(data.temperature))),
        warnings=(),
    )
    return replace(found, warnings=tuple(_warnings(found, away)))


def relaxation_of_creep(compliance: Array, times: Array) -> tuple[Array, Array]:
    """Return moduli (m + 1,), the relaxed one first, and relaxation times (m,) of a creep test.

    For J*(s) = J_0 + sum J_i/(1 + lambda_i s) with positive J, the poles of 1/J* interlace with
    those
    of J*, one above each rate 1/lambda_i. So every relaxation time lies in a known bracket, and the
    moduli, which follow from the residues, are positive.

    Parameters
    ----------
    compliance : (m + 1,) [1/MPa], J_0 first, all positive.
    times : (m,) retardation times lambda [s], all different.

    References
    ----------
    Ferry (1980), Viscoelastic Properties of Polymers, 3rd ed., chapter 3; Park & Schapery (1999),
    Int. J. Solids Struct. 36, 1653-1675.
    """
    order = np.argsort(-times)
    rates, parts = 1.0 / times[order], compliance[1:][order]  # in ascending order of rates
    first = float(compliance[0])

    def value(rate: float) -> float:
        """Return J* at s = -rate."""
        return first + float(np.sum(parts / (1.0 - rate / rates)))

    roots = []
    ends = [*rates[1:], rates[-1] * (2.0 + float(np.sum(parts)) / first)]
    for low, high in zip(rates, ends, strict=True):
        inside = float(low) * (1.0 + 1e-13), float(high) * (1.0 - 1e-13)
        roots.append(brentq(value, *inside, xtol=1e-300, rtol=1e-14))
    found = np.array(roots)
    # E_i = 1/(rate dJ*/dr) with dJ*/dr = sum J_k/rates_k/(1 - r/rates_k)^2 at the root r
    slopes = np.array([float(np.sum(parts / rates / (1.0 - r / rates) ** 2)) for r in found])
    relaxed = 1.0 / (first + float(np.sum(parts)))
    return np.concatenate([[relaxed], 1.0 / (found * slopes)]), 1.0 / found


def _material(master: Master, shift: ShiftFit, method: DmaMethod) -> Prony:
    data = master.reduced
    count, smoothing = method.terms or 0, 0.0
    if not method.terms:
        count, smoothing, _ = crossvalidated(data)
    times = relaxation_times(data.omega, count)
    moduli, _ = non_negative(data, times, smoothing)
    kept = moduli[1:] > _LEAST_PART * float(np.max(moduli))
    times = times[kept]
    least = _SMALLEST * float(np.min(data.storage))
    moduli = np.concatenate([[max(float(moduli[0]), least)], moduli[1:][kept]])
    if data.kind == "creep":
        moduli, times = relaxation_of_creep(moduli, times) if times.size else (1.0 / moduli, times)
    law = with_levels(shift.law, master, method.vertical)
    terms = tuple(
        (to_six_digits(float(e)), to_six_digits(float(t)))
        for e, t in zip(moduli[1:], times, strict=True)
    )
    return Prony(
        modulus=to_six_digits(float(moduli[0])),
        terms=terms or ((0.0, 1.0),),
        poisson=master.data.poisson,
        temperature=None if law is None else master.reference,
        shift=rounded_law(law),
    )


def _deviations(material: Prony, master: Master) -> Array:
    """Return the relative deviations (n,) of the rounded material itself, not of the fit."""
    data = master.reduced
    plain = replace(material, temperature=None, shift=None)
    curve = creep_compliance if data.kind == "creep" else relaxation_modulus
    return np.asarray(curve(plain, 1.0 / data.omega) / data.storage - 1.0)


def _warnings(fit: TimeFit, away: Array) -> list[str]:
    said = []
    if fit.rms > RMS_LIMIT or abs(fit.largest) > ROW_LIMIT:
        said.append(
            f"The material departs from the data by {100 * fit.rms:.2g} % rms (limit 5 %), by "
            f"{100 * fit.largest:.2g} % at most ({fit.row})."
        )
    outlying = outlying_rows(fit.master, (away,))
    if outlying:
        said.append(
            f"Outlying: {'; '.join(outlying[:3])}. Look at the measurement, leave it out, or count "
            "it less (robust)."
        )
    data = fit.master.reduced
    late = data.omega <= 10.0 * float(np.min(data.omega))
    ends = float(np.min(data.storage[late])) / float(np.max(data.storage[late]))
    if ends < _FLAT:
        name = "compliance" if data.kind == "creep" else "modulus"
        said.append(
            f"The data do not reach the rubbery plateau: over their last decade the {name} still "
            f"changes by a factor of {1.0 / ends:.2g}. They do not determine the relaxed modulus, "
            f"{fit.material.modulus:.3g} MPa; beyond {fit.time_range[1]:.3g} s the material is a "
            "guess."
        )
    return said
