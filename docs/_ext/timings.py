"""Times and rates of docs/rates.json, which `make rates` writes, as the pages state them."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any

FILE = Path(__file__).parents[1] / "rates.json"
ROWS = {
    "driven_curved": "configuration II driven, `curved`, nothing cached",
    "driven_cached": "the same with a `KernelCache`",
    "driven_second": "the same in `second`, nothing cached",
    "driven_finite": "the same in `finite`, the default",
    "free_finite": "configuration I free, `finite`",
    "three_finite": "configuration III driven, `finite`",
    "skin_finite": "a stiff skin of 0.1 mm (figure 4), `finite`",
    "free_curved": "configuration II free, `curved`",
    "carter": "Carter's problem to 0.1 %, `linear`",
    "viscoelastic": "two viscoelastic layers on two, `curved`",
    "skin_0.2": "a stiff skin of 0.2 mm (figure 4), `curved`",
    "skin_0.1": "the same of 0.1 mm",
    "skin_0.025": "the same of 0.025 mm",
    "inside": "stresses inside configuration II, 400 x 100 points, all components",
    "inside_skin": "the same under a skin of 0.1 mm",
    "profile": "a measured profile of 100 000 points, `linear`",
}
"""Rows of the table of times."""
GEOMETRIES = ("linear", "curved", "second", "finite")


def held() -> dict[str, Any]:
    """Return what the file holds."""
    found: dict[str, Any] = json.loads(FILE.read_text(encoding="utf-8"))
    return found


def substitutions() -> dict[str, str]:
    """Return what the pages may state, by name."""
    file = held()
    units, unit = file["units"], file["unit_ms"]
    rates = {name: 1e3 / (unit * units[f"sweep_{name}"]) for name in GEOMETRIES}
    near = [units[name] for name in units if name.startswith("near_")]
    return {
        "rates_date": file["date"],
        "rates_version": file["version"],
        "rates_unit": f"{_short(unit)} ms",
        "rates_memory": f"{_short(file['memory_MiB'])} MiB",
        "times": _times(units, unit),
        "time_curved": _time(units["driven_curved"] * unit),
        "time_finite": _time(units["driven_finite"] * unit),
        "rates": _rates(rates),
        "near_saves": _span([100.0 * (1.0 - share) for share in near]) + " %",
        "sheet_takes": _over_bare(units, ""),
        "sheet_takes_freely": _over_bare(units, "_freely"),
        "memory_takes": _span(
            [units[name] / units[f"{name}_elastic"] for name in ("memory_one", "memory_two")]
        ),
        **{
            f"{slow}_over_{fast}": _span(
                [
                    units[f"driven_{slow}"] / units[f"driven_{fast}"],
                    units[f"sweep_{slow}"] / units[f"sweep_{fast}"],
                ]
            )
            for slow, fast in (("finite", "second"), ("finite", "curved"), ("second", "curved"))
        },
    }


def _over_bare(units: dict[str, float], kind: str) -> str:
    """Times of nips with a sheet over those of their rollers alone."""
    names = ("feed", "laminator", "pull")
    return _span([units[f"sheet_{one}{kind}"] / units[f"sheet_{one}_without"] for one in names])


def _short(value: float) -> str:
    """Two digits, without an exponent."""
    return f"{float(f'{value:.2g}'):g}"


def _span(values: list[float]) -> str:
    low, high = _short(min(values)), _short(max(values))
    return low if low == high else f"{low} to {high}"


def _times(units: dict[str, float], unit: float) -> str:
    lines = ["| what | time | ratio |", "| --- | ---: | ---: |"]
    lines += [
        f"| {what} | {_time(units[name] * unit)} | {_short(units[name])} |"
        for name, what in ROWS.items()
    ]
    return "\n".join(lines)


def _time(milliseconds: float) -> str:
    if milliseconds >= 100.0:
        return f"{_short(1e-3 * milliseconds)} s"
    return f"{_short(milliseconds)} ms"


def _rates(rates: dict[str, float]) -> str:
    lines = ["| geometry | cases a second |", "| --- | ---: |"]
    lines += [f"| `{name}` | {_short(rate)} |" for name, rate in rates.items()]
    return "\n".join(lines)
