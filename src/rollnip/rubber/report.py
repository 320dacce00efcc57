"""A fitted strain energy as text for a case file, and as plain values for JSON."""

from __future__ import annotations

import re
from typing import Any

from rollnip._errors import InvalidInputError
from rollnip._units import format_quantity
from rollnip.materials import Energy, Gent, Ogden, Yeoh
from rollnip.rubber.fit import CONFIDENCE, Constant, RubberFit

_NAME = re.compile(r"[A-Za-z0-9_-]+")


def rubber_toml(fit: RubberFit, name: str = "rubber") -> str:
    """Return the material as a table ``[materials.name]`` ready to paste into a case file.

    Comments state its source, its deviation from the data, and the intervals of the constants.

    Raises
    ------
    InvalidInputError
        where the name cannot be a TOML key.
    """
    if _NAME.fullmatch(name) is None or name == "rigid":
        raise InvalidInputError(
            f'`name` must be letters, digits, - and _, and not "rigid", got "{name}".'
        )
    return "\n".join(
        [
            *(f"# {line}" for line in rubber_lines(fit)),
            f"[materials.{name}]",
            'model = "elastic"',
            f"shear_modulus = {fit.shear_modulus!r}",
            f"poisson = {fit.material.poisson!r}",
            f"energy = {{ {_energy_keys(fit.energy)} }}",
            "",
        ]
    )


def rubber_lines(fit: RubberFit) -> list[str]:
    """Return a summary of the fit, line by line: data, deviations, constants, warnings."""
    counts = ", ".join(f"{int(fit.data.rows(test).sum())} of {test}" for test in fit.data.tests)
    lines = [f"{fit.law}, fitted to {fit.data.source}: {counts}"]
    lines += [
        f"{test}: rms deviation {100.0 * rms:.2g} % of the largest stress"
        for test, rms in fit.rms.items()
    ]
    lines += [_constant(one) for one in fit.constants]
    return [*lines, *fit.warnings]


def fit_dict(fit: RubberFit) -> dict[str, Any]:
    """Return a fit as plain values for JSON; moduli in MPa, deviations over the largest stress."""
    return {
        "schema": 1,
        "source": fit.data.source,
        "law": fit.law,
        "measurements": {test: int(fit.data.rows(test).sum()) for test in fit.data.tests},
        "material": {
            "model": "elastic",
            "shear_modulus": fit.shear_modulus,
            "poisson": fit.material.poisson,
            "energy": _energy_tree(fit.energy),
        },
        "constants": {
            one.name: {"value": one.value, "low": _finite(one.low), "high": _finite(one.high)}
            for one in fit.constants
        },
        "deviation": {test: {"rms": rms} for test, rms in fit.rms.items()},
        "unstable": {test: list(ends) for test, ends in fit.unstable.items()},
        "warnings": list(fit.warnings),
    }


def _finite(value: float) -> float | None:
    return value if abs(value) < 1e300 else None


def _constant(one: Constant) -> str:
    parts = (format_quantity(part, digits=4) for part in (one.value, one.low, one.high))
    value, low, high = parts
    unit = f" {one.unit}" if one.unit else ""
    return f"{one.name} = {value}{unit} ({100 * CONFIDENCE:.0f} %: {low} to {high})"


def _energy_tree(energy: Energy) -> dict[str, Any]:
    if isinstance(energy, Yeoh):
        return {"model": "yeoh", "second": energy.second, "third": energy.third}
    if isinstance(energy, Gent):
        return {"model": "gent", "limit": energy.limit}
    if isinstance(energy, Ogden):
        terms = [{"weight": float(m), "exponent": float(a)} for m, a in energy.terms]
        return {"model": "ogden", "terms": terms}
    return {"model": "neo-hookean"}


def _energy_keys(energy: Energy) -> str:
    parts = []
    for key, value in _energy_tree(energy).items():
        if isinstance(value, list):
            rows = ", ".join(
                f"{{ weight = {one['weight']!r}, exponent = {one['exponent']!r} }}" for one in value
            )
            parts.append(f"{key} = [{rows}]")
        else:
            parts.append(f'{key} = "{value}"' if isinstance(value, str) else f"{key} = {value!r}")
    return ", ".join(parts)
