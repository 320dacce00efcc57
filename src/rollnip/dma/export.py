"""A fitted material as text for a case file, and checks that a nip stays within its data."""

from __future__ import annotations

import re
import tomllib
from collections.abc import Iterator
from typing import Any

import numpy as np

from rollnip._errors import InvalidInputError
from rollnip._units import format_quantity
from rollnip.dma.fit import DmaFit
from rollnip.dma.quality import NAMES
from rollnip.dma.timefit import TimeFit
from rollnip.materials import WLF, Arrhenius, FractionalZener, Prony, Shift
from rollnip.solution import Solution

_NAME = re.compile(r"[A-Za-z0-9_-]+")
_SAME = 0.5  # K, tolerance on the coldest and warmest isotherm


def material_toml(fit: DmaFit | TimeFit, name: str = "rubber") -> str:
    """Return the material as a table ``[materials.name]`` ready to paste into a case file.

    Comments state its source, its deviation from the data, and the frequencies for which it holds.
    Raises InvalidInputError where the name cannot be a TOML key.
    """
    checked_name(name)
    keys = material_keys(fit.material)
    return "\n".join([*_comments(fit), f"[materials.{name}]", *keys]) + "\n"


def checked_name(name: str) -> str:
    """Return the name of a material, or raise InvalidInputError where it cannot be a key."""
    if _NAME.fullmatch(name) is None or name == "rigid":
        raise InvalidInputError(
            f'`name` must be letters, digits, - and _, and not "rigid", got "{name}".'
        )
    return name


def fit_dict(fit: DmaFit | TimeFit) -> dict[str, Any]:
    """Return a fit as plain values for JSON: material, shift law, quality, range, warnings.

    Moduli are in MPa, times in s, temperatures in degC, frequencies in Hz. Deviations are
    relative: computed over measured, less 1.
    """
    shift = fit.shift
    errors = zip(shift.names, shift.values, shift.standard_errors, strict=True)
    return {
        "schema": 1,
        "source": fit.master.data.source,
        "kind": fit.master.data.kind,
        "measurements": int(fit.master.data.storage.size),
        "material": tomllib.loads("\n".join(material_keys(fit.material))),
        "reference": fit.master.reference,
        "isotherms": [
            {"temperature": float(t), "log10_a": float(a), "b": float(np.exp(b))}
            for t, a, b in zip(
                fit.master.temperatures, fit.master.horizontal, fit.master.vertical, strict=True
            )
        ],
        "shift": {name: {"value": v, "standard_error": e} for name, v, e in errors},
        "deviation": _deviation(fit),
        "frequency_range": list(fit.frequency_range),
        "temperature_range": list(fit.temperature_range),
        "warnings": list(fit.warnings),
    }


def _deviation(fit: DmaFit | TimeFit) -> dict[str, Any]:
    if isinstance(fit, TimeFit):
        return {fit.master.data.kind: {"rms": fit.rms, "largest": fit.largest, "row": fit.row}}
    quality = fit.quality
    parts = zip(NAMES, quality.rms, quality.largest, quality.rows, strict=True)
    found: dict[str, Any] = {
        name: {"rms": rms, "largest": largest, "row": row} for name, rms, largest, row in parts
    }
    return found | {"outlying": list(quality.outlying)}


def nip_frequency(solution: Solution) -> float:
    """Return the frequency of a nip [Hz], speed over nip width: the inverse of the time in contact.

    Raises InvalidInputError where the nip has no speed.
    """
    if solution.nip.speed is None:
        raise InvalidInputError("`speed` must be given: without it a nip has no frequency.")
    return solution.nip.speed / solution.nip_width


def frequency_warning(
    fit: DmaFit | TimeFit, solution: Solution, temperature: float | None = None
) -> str:
    """Return a warning where a nip's frequency is outside the data of its material, else "".

    Parameters
    ----------
    fit :
        fit of the material.
    solution :
        solution of the nip.
    temperature :
        temperature of the material in the nip [degC]; the reference temperature by default.
    """
    low, high = valid_range(fit, temperature)
    frequency = nip_frequency(solution)
    if low <= frequency <= high:
        return ""
    side = "below" if frequency < low else "above"
    at = fit.master.reference if temperature is None else temperature
    return (
        f"The nip works at {format_quantity(frequency, digits=3)} Hz (speed over nip width), "
        f"{side} the data of the material, {format_quantity(low, digits=3)} to "
        f"{format_quantity(high, digits=3)} Hz at {at:g} degC: the material is extrapolated."
    )


def temperature_warning(fit: DmaFit | TimeFit, temperature: float) -> str:
    """Return a warning where a material is used at a temperature outside its data, else "".

    Parameters
    ----------
    fit :
        fit of the material.
    temperature :
        temperature of the material in the nip [degC].
    """
    cold, warm = fit.temperature_range
    if cold - _SAME <= temperature <= warm + _SAME:
        return ""
    side = "below" if temperature < cold else "above"
    return (
        f"The nip's material has {temperature:.4g} degC, {side} the temperatures of the data, "
        f"{cold:.4g} to {warm:.4g} degC: the shift is extrapolated."
    )


def valid_range(fit: DmaFit | TimeFit, temperature: float | None = None) -> tuple[float, float]:
    """Return the lowest and highest frequency [Hz] that the data cover at a temperature [degC].

    Raises InvalidInputError where the material has no shift law and a temperature other than the
    reference is asked for.
    """
    low, high = fit.frequency_range
    if temperature is None or temperature == fit.master.reference:
        return low, high
    law = fit.material.shift
    if law is None:
        raise InvalidInputError(
            f"`temperature` must be {fit.master.reference:g} degC: the material has no shift law, "
            f"got {temperature!r}."
        )
    factor = law.factor(temperature)
    return low / factor, high / factor


def _comments(fit: DmaFit | TimeFit) -> Iterator[str]:
    low, high = (format_quantity(v, digits=3) for v in fit.frequency_range)
    cold, warm = fit.temperature_range
    yield f"# From {fit.master.data.source}, {fit.master.data.frequency.size} measurements."
    yield f"# Valid from {low} Hz to {high} Hz at {fit.master.reference:g} degC,"
    yield f"# measured at {cold:.4g} to {warm:.4g} degC; outside of that it is extrapolated."
    yield from _deviation_comments(fit)
    shift = fit.shift
    units = {"c1": "", "c2": " K", "activation_energy": " kJ/mol"}
    for name, value, error in zip(shift.names, shift.values, shift.standard_errors, strict=True):
        shown = format_quantity(value, digits=4), format_quantity(error, digits=2)
        yield f"# Shift law: {name} = {shown[0]} +- {shown[1]}{units[name]} (standard error)."
    yield from (f"# Warning: {said}" for said in fit.warnings)


def _deviation_comments(fit: DmaFit | TimeFit) -> Iterator[str]:
    if isinstance(fit, TimeFit):
        low, high = (format_quantity(v, digits=3) for v in fit.time_range)
        yield f"# That is {low} s to {high} s, as 1/(2 pi time)."
        rms, most = 100.0 * fit.rms, 100.0 * fit.largest
        name = "compliance" if fit.master.data.kind == "creep" else "modulus"
        yield f"# Deviation from the data: {name} {rms:.2g} % rms, {most:+.2g} % at most."
        return
    storage, loss = (100.0 * v for v in fit.quality.rms)
    most_storage, most_loss = (100.0 * v for v in fit.quality.largest)
    yield f"# Deviation from the data: storage {storage:.2g} % rms, {most_storage:+.2g} % at most;"
    yield f"# loss {loss:.2g} % rms, {most_loss:+.2g} % at most."


def material_keys(material: Prony | FractionalZener) -> Iterator[str]:
    """Yield the lines of a material below its ``[materials.name]``, with every digit."""
    yield f'model = "{"prony" if isinstance(material, Prony) else "fractional-zener"}"'
    yield f'modulus = "{material.modulus!r} MPa"'
    if isinstance(material, FractionalZener):
        yield f'stiffening = "{material.stiffening!r} MPa"'
        yield f'relaxation_time = "{material.relaxation_time!r} s"'
        yield f"order = {material.order!r}"
    yield f"poisson = {material.poisson!r}"
    law = material.shift
    if law is not None:
        yield f'temperature = "{material.temperature!r} degC"'
        yield f"shift = {{ {', '.join(shift_keys(law))} }}"
    if isinstance(material, Prony):
        yield "terms = ["
        for modulus, time in material.terms:
            yield f'  {{ modulus = "{modulus!r} MPa", relaxation_time = "{time!r} s" }},'
        yield "]"


def shift_keys(law: Shift) -> Iterator[str]:
    """Yield the keys of a shift law with their values, as a case file takes them."""
    if isinstance(law, WLF):
        yield 'model = "wlf"'
        yield f"c1 = {law.c1!r}"
        yield f'c2 = "{law.c2!r} K"'
    elif isinstance(law, Arrhenius):
        yield 'model = "arrhenius"'
        yield f'activation_energy = "{law.activation_energy!r} kJ/mol"'
    else:
        yield 'model = "table"'
        yield f"points = {_points(law.points)}"
    yield f'reference = "{law.reference!r} degC"'
    if isinstance(law.vertical, tuple):
        yield f"levels = {_points(law.vertical)}"
    elif law.vertical != "none":
        yield f'vertical = "{law.vertical}"'


def _points(points: tuple[tuple[float, float], ...]) -> str:
    shown = (f'{{ temperature = "{t!r} degC", factor = {v!r} }}' for t, v in points)
    return f"[{', '.join(shown)}]"
