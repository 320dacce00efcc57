"""The fit of a material to dynamic-mechanical data: shift factors, spectrum, warnings."""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import Literal, get_args

import numpy as np
from numpy.typing import NDArray
from scipy.optimize import least_squares

from rollnip._errors import InvalidInputError
from rollnip.dma.data import DmaData
from rollnip.dma.master import Master, Vertical, robust_weights, scatter, unshifted
from rollnip.dma.quality import Quality, judged, plateau_warnings, quality_warnings
from rollnip.dma.shifts import Law, ShiftFit, fit_free, fit_law
from rollnip.dma.spectrum import (
    Reduced,
    crossvalidated,
    non_negative,
    relaxation_times,
)
from rollnip.materials import WLF, Arrhenius, FractionalZener, Prony
from rollnip.materials.shift import checked_temperature

Array = NDArray[np.float64]
Kind = Literal["prony", "fractional-zener"]

_DIGITS = 6  # significant digits of the numbers of the material
_MOST_ISOTHERMS = 200  # beyond it free shifts take too long to be worth it
_FAR, _MANY = 0.15, 4.0  # decades and standard errors by which a free shift departs from the law
_NEAR_POLE = 3.0  # K, between the pole of WLF and the coldest isotherm
_VAGUE = 0.5  # relative standard error above which a constant counts as undetermined
_NO_PLATEAU = 1e-3  # least relaxed modulus over the least storage modulus: the data only bound it
_SOFTEST = 1e-9  # MPa, the least modulus a material may have
_REWEIGHED = 2  # number of repeated searches of the shifts with the weights of a robust fit


@dataclass(frozen=True, slots=True, kw_only=True)
class DmaMethod:
    """The settings of a fit of a material to dynamic-mechanical data.

    Parameters
    ----------
    model :
        "prony" or "fractional-zener".
    shift :
        "wlf" or "arrhenius": the law whose constants are fitted; or a law with its constants.
    reference :
        temperature of the master curve [degC]; that of the middle isotherm by default.
    vertical :
        vertical shifts: "none"; "entropic", moduli proportional to the absolute temperature;
        "free",
        a fitted factor for each isotherm.
    terms :
        number of terms of the Prony series; by default 1.5 to 3 per decade, chosen with its
        smoothing
        by cross-validation.
    width :
        temperatures within this range [K] form one isotherm.
    robust :
        give less weight to outlying rows.

    Raises
    ------
    InvalidInputError
        where a choice is unknown or a number out of range.
    """

    model: Kind = "prony"
    shift: Law | WLF | Arrhenius = "wlf"
    reference: float | None = None
    vertical: Vertical = "none"
    terms: int | None = None
    width: float = 1.0
    robust: bool = False

    def __post_init__(self) -> None:
        for name, kinds in (("model", Kind), ("vertical", Vertical)):
            if getattr(self, name) not in get_args(kinds):
                known = ", ".join(get_args(kinds))
                raise InvalidInputError(
                    f"`{name}` must be one of {known}, got {getattr(self, name)!r}."
                )
        if not isinstance(self.shift, WLF | Arrhenius) and self.shift not in get_args(Law):
            raise InvalidInputError(
                f"`shift` must be wlf, arrhenius, none or a law, got {self.shift!r}."
            )
        if self.terms is not None and not 1 <= self.terms <= 100:
            raise InvalidInputError(f"`terms` must lie between 1 and 100, got {self.terms!r}.")
        if self.reference is not None:
            checked_temperature("reference", self.reference)
        if not 0.0 < self.width <= 20.0:
            raise InvalidInputError(f"`width` must lie in (0, 20] K, got {self.width!r}.")


@dataclass(frozen=True, eq=False, slots=True, kw_only=True)
class DmaFit:
    """A material fitted to dynamic-mechanical data.

    Attributes
    ----------
    material : Prony or FractionalZener at the reference temperature, with the shift law, if it has
        one, and its vertical shifts.
    master : the data at the reference temperature, shifted by the law.
    shift : the law with its constants and their standard errors.
    free : the data with each isotherm shifted independently of a law; None where that was not done.
    free_errors : (m,) standard errors of those shifts [decades].
    scatter : relative scatter of storage and loss modulus between neighbouring frequencies; None
        where the isotherms have too few points to tell.
    quality : deviations of the material from the data.
    frequency_range : lowest and highest frequency [Hz] of the data at the reference temperature.
    temperature_range : lowest and highest temperature measured [degC].
    crossvalidation : (k,) mean square of the residuals of held-out data for each spectrum tried; or
        empty.
    warnings : reservations, in plain words.
    """

    material: Prony | FractionalZener
    master: Master
    shift: ShiftFit
    free: Master | None
    free_errors: Array
    scatter: tuple[float, float] | None
    quality: Quality
    frequency_range: tuple[float, float]
    temperature_range: tuple[float, float]
    crossvalidation: Array
    warnings: tuple[str, ...]

    @property
    def deviation(self) -> tuple[float, float]:
        """Relative rms deviation of storage and loss modulus of the material from the data."""
        return self.quality.rms


def fit_dma(data: DmaData, method: DmaMethod | None = None) -> DmaFit:
    """Build the master curve and fit a material to it.

    Parameters
    ----------
    data :
        from `read_dma`.
    method :
        material, shift law, reference; ``DmaMethod()`` by default.

    Returns
    -------
    DmaFit. Its ``material`` can be used in a `rollnip.Layer`; `material_toml` writes it for a case.

    Raises
    ------
    InvalidInputError
        where the data cannot determine the shifts: one frequency only, and no law given.
    """
    method = DmaMethod() if method is None else method
    start = unshifted(data, method.reference, method.vertical, method.width)
    shift = shifted(start, method)
    for _ in range(_REWEIGHED if method.robust else 0):
        start = replace(start, weights=robust_weights(shift.master).weights)
        shift = shifted(start, method)
    master = shift.master
    free, errors = _free(master)
    material, squares = _material(master, shift, method)
    quality, noise = judged(material, master), scatter(master)
    return DmaFit(
        material=material,
        master=master,
        shift=shift,
        free=free,
        free_errors=errors,
        scatter=noise,
        quality=quality,
        frequency_range=master.frequency_range,
        temperature_range=(float(np.min(data.temperature)), float(np.max(data.temperature))),
        crossvalidation=squares,
        warnings=(
            *plateau_warnings(material, master),
            *_shift_warnings(master, shift, free, errors),
            *_model_warnings(quality, noise, master, shift.law, method),
        ),
    )


def shifted(start: Master, method: DmaMethod) -> ShiftFit:
    """Return the isotherms shifted by the law of the method, or by a law that is fitted."""
    law = method.shift
    if not isinstance(law, WLF | Arrhenius):
        return fit_law(start, law, levels=method.vertical == "free")
    # a law given at another reference is converted to that of the master curve
    at_reference = np.log10(law.factor(start.reference))
    factors = np.array([np.log10(law.factor(float(t))) for t in start.temperatures])
    moved = _moved(law, start.reference)
    return ShiftFit(moved, (), (), (), replace(start, horizontal=factors - at_reference))


def _moved(law: WLF | Arrhenius, reference: float) -> WLF | Arrhenius:
    """Return the law for another reference; the product C1 C2 and the pole of WLF are kept."""
    if isinstance(law, Arrhenius):
        return Arrhenius(law.activation_energy, reference)
    c2 = law.c2 + reference - law.reference
    return WLF(law.c1 * law.c2 / c2, c2, reference)


def _free(master: Master) -> tuple[Master | None, Array]:
    several = all(np.ptp(master.data.frequency[group]) > 0.0 for group in master.groups)
    if not 1 < master.temperatures.size <= _MOST_ISOTHERMS or not several:
        return None, np.zeros(0)
    return fit_free(master)


def _material(
    master: Master, shift: ShiftFit, method: DmaMethod
) -> tuple[Prony | FractionalZener, Array]:
    law = with_levels(shift.law, master, method.vertical)
    temperature = None if law is None else master.reference
    data, poisson = master.reduced, master.data.poisson
    if method.model == "fractional-zener":
        modulus, stiffening, time, order = (to_six_digits(v) for v in fractional_zener(data))
        zener = FractionalZener(
            modulus=modulus,
            stiffening=stiffening,
            relaxation_time=time,
            order=min(order, 1.0),
            poisson=poisson,
            temperature=temperature,
            shift=rounded_law(law),
        )
        return zener, np.zeros(0)
    count, strength, squares = method.terms or 0, 0.0, np.zeros(0)
    if not method.terms:
        count, strength, squares = crossvalidated(data)
    times = relaxation_times(data.omega, count)
    moduli, _ = non_negative(data, times, strength)
    least = max(_NO_PLATEAU * float(np.min(data.storage)), _SOFTEST)
    terms = [
        (to_six_digits(float(e)), to_six_digits(float(t)))
        for e, t in zip(moduli[1:], times, strict=True)
        if e > 1e-9 * float(np.max(moduli))
    ]
    prony = Prony(
        modulus=to_six_digits(max(float(moduli[0]), least)),
        terms=tuple(terms) or ((0.0, to_six_digits(float(times[0]))),),
        poisson=poisson,
        temperature=temperature,
        shift=rounded_law(law),
    )
    return prony, squares


def with_levels(
    law: WLF | Arrhenius | None, master: Master, vertical: Vertical
) -> WLF | Arrhenius | None:
    """Return the law with the vertical shifts; None where the reference is outside their table."""
    if law is None or vertical == "none":
        return law
    if vertical == "entropic":
        return replace(law, vertical="entropic")
    temperatures = master.temperatures
    if not float(temperatures[0]) <= master.reference <= float(temperatures[-1]):
        return None
    levels = zip(temperatures, np.exp(master.vertical), strict=True)
    pairs = tuple((to_six_digits(float(t)), to_six_digits(float(b))) for t, b in levels)
    return replace(law, vertical=pairs)


def fractional_zener(data: Reduced) -> tuple[float, float, float, float]:
    """Return E0 [MPa], k [MPa], tau [s] and order of the best-fitting fractional Zener solid."""
    low, high = float(np.min(data.storage)), float(np.max(data.storage))
    times = 1.0 / np.array([np.min(data.omega), np.max(data.omega)])

    def solid(x: Array) -> FractionalZener:
        modulus, stiffening, time = np.exp(x[:3])
        return FractionalZener(
            modulus=modulus, stiffening=stiffening, relaxation_time=time, order=x[3], poisson=0.5
        )

    def residuals(x: Array) -> Array:
        found = solid(x).modulus_at(1j * data.omega)
        return np.concatenate(
            [
                (found.real / data.storage - 1.0) / data.errors[0],
                (found.imag / data.loss - 1.0) / data.errors[1],
            ]
        )

    bounds = (
        [np.log(1e-3 * low), np.log(1e-3 * low), np.log(1e-4 * times[1]), 0.01],
        [np.log(1e3 * high), np.log(1e4 * high), np.log(1e4 * times[0]), 1.0],
    )
    starts = [
        [np.log(low), np.log(max(high - low, 0.1 * low)), np.log(time), order]
        for time in np.geomspace(times[1], times[0], 5)
        for order in (0.3, 0.6, 0.9)
    ]
    ends = [least_squares(residuals, start, bounds=bounds, x_scale="jac") for start in starts]
    best = solid(min(ends, key=lambda end: float(end.cost)).x)
    return best.modulus, best.stiffening, best.relaxation_time, best.order


def _shift_warnings(
    master: Master, shift: ShiftFit, free: Master | None, errors: Array
) -> list[str]:
    said = _gaps(master)
    if isinstance(shift.law, WLF) and shift.values:
        coldest = float(np.min(master.temperatures))
        pole = master.reference - shift.law.c2
        if coldest - pole < _NEAR_POLE:
            said.append(
                f"The pole of the WLF law, {pole:.1f} degC, lies right below the coldest "
                f"measurement, {coldest:.1f} degC: such temperatures are near the glass "
                "transition or below it, where WLF does not hold; leave them out."
            )
    vague = [
        name
        for name, value, error in zip(shift.names, shift.values, shift.standard_errors, strict=True)
        if error > _VAGUE * abs(value)
    ]
    if vague:
        said.append(
            f"The data do not determine {' and '.join(vague)} of the shift law: their standard "
            "errors are half their size or more. Measure at more temperatures, or give the law."
        )
    if free is not None and shift.law is not None:
        away = free.horizontal - master.horizontal
        far = (np.abs(away) > _FAR) & (np.abs(away) > _MANY * errors)
        if np.any(far):
            worst = int(np.argmax(np.abs(away) * far))
            said.append(
                f"The isotherm of {master.temperatures[worst]:.1f} degC departs from the shift law "
                f"by {away[worst]:+.2f} decades: the law does not hold for all of these data."
            )
    return said


def _gaps(master: Master) -> list[str]:
    """Return a warning about neighbouring isotherms whose reduced frequencies do not overlap."""
    ends = [
        np.log10(master.data.frequency[group]) + a
        for group, a in zip(master.groups, master.horizontal, strict=True)
    ]
    gaps = [
        (cold, warm)
        for cold, warm, above, below in zip(
            master.temperatures, master.temperatures[1:], ends, ends[1:], strict=False
        )
        if float(np.min(above)) > float(np.max(below))
    ]
    if not gaps:
        return []
    shown = ", ".join(f"{cold:.0f} and {warm:.0f}" for cold, warm in gaps[:3])
    return [
        f"Isotherms do not overlap between {shown} degC: their shift rests on the law alone, and "
        "errors of its constants are larger than said; measure at temperatures between."
    ]


def _model_warnings(
    quality: Quality,
    noise: tuple[float, float] | None,
    master: Master,
    law: WLF | Arrhenius | None,
    method: DmaMethod,
) -> list[str]:
    prony = method.model == "prony"
    other = (
        " More terms follow them closer." if prony else ' `model = "prony"` follows them closer.'
    )
    said = quality_warnings(quality, noise, best=prony and not method.terms, other=other)
    if np.any(master.vertical) and with_levels(law, master, method.vertical) is None:
        said.append(
            "Moduli were shifted too, and the reference lies outside of the isotherms: the "
            f"material holds at {master.reference:g} degC only."
        )
    return said


def rounded_law(law: WLF | Arrhenius | None) -> WLF | Arrhenius | None:
    """Return the law with its constants rounded to six digits."""
    if isinstance(law, WLF):
        return replace(law, c1=to_six_digits(law.c1), c2=to_six_digits(law.c2))
    if isinstance(law, Arrhenius):
        return replace(law, activation_energy=to_six_digits(law.activation_energy))
    return None


def to_six_digits(value: float) -> float:
    """Return the value rounded to six digits."""
    return float(f"{value:.{_DIGITS - 1}e}")
