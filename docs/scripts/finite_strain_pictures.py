"""Pictures of docs/validation.md: the geometry models over the finite-element profiles.

Run from the repository root: python docs/scripts/finite_strain_pictures.py
"""

import json
from pathlib import Path
from typing import Any, get_args

import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as plt
import numpy as np

import rollnip as rn
from rollnip.model import Geometry

ROOT = Path(__file__).parents[2]
# Okabe and Ito's colours, and a line style each: told apart without colour too.
STYLES = {
    "linear": {"color": "#E69F00", "linestyle": ":", "linewidth": 2.0},
    "corrected": {"color": "#009E73", "linestyle": "-.", "linewidth": 1.4},
    "curved": {"color": "#0072B2", "linestyle": "--", "linewidth": 1.6},
    "second": {"color": "#CC79A7", "linestyle": (0, (4, 1, 1, 1, 1, 1)), "linewidth": 1.4},
    "finite": {"color": "#D55E00", "linestyle": "-", "linewidth": 1.4},
}
MODELS = [name for name in get_args(Geometry) if name != "full"]
PICTURES = {
    "I_free": ("finite_strain_fe.json", "I", 0.0),
    "I_driven": ("finite_strain_fe.json", "I", 0.05),
    "IIb_free": ("finite_strain_fe.json", "IIb", 0.0),
    "thick_free": ("finite_strain_fe_own.json", "thick", 0.0),
}


def reference(name: str, case: str, traction: float) -> dict[str, Any]:
    """One result of the finite-element files."""
    text = (ROOT / "tests" / "data" / name).read_text(encoding="utf-8")
    for result in json.loads(text)["results"]:
        if result["case"] == case and result.get("traction") == traction:
            return dict(result)
    raise KeyError((name, case, traction))


def solve(case: dict[str, Any], geometry: str) -> rn.Solution:
    """The same nip by one of the geometry models."""
    layers = tuple(
        rn.Layer(layer["thickness"], rn.Elastic(modulus=layer["modulus"], poisson=layer["poisson"]))
        for layer in case["upper"]["layers"]
    )
    nip = rn.Nip(
        upper=rn.Roller(radius=case["upper"]["radius"], layers=layers),
        lower=rn.Roller(radius=case["lower"]["radius"]),
        normal=rn.LineLoad(case["load"]),
        friction=case["friction"],
        tangential=rn.Traction(case["traction"]),
    )
    return rn.solve(nip, rn.Model(geometry=geometry))  # type: ignore[arg-type]


def picture(name: str, case: dict[str, Any]) -> None:
    """Pressure, shear and stretch of every model over the finite elements."""
    figure, axes = plt.subplots(3, 1, figsize=(7.0, 8.4), sharex=True, layout="constrained")
    elements = case["profile"]
    for geometry in MODELS:
        profiles = solve(case, geometry).profiles
        inside = np.flatnonzero(profiles.pressure > 0.0)
        contact = slice(inside[0] - 1, inside[-1] + 2)
        curves = (
            (profiles.pressure, contact),
            (profiles.shear, contact),
            (100.0 * profiles.strain_upper, contact),
        )
        for axis, (values, part) in zip(axes, curves, strict=True):
            axis.plot(profiles.x[part], values[part], label=geometry, **STYLES[geometry])
    stretch = 100.0 * (np.array(elements["stretch"]) - 1.0)
    for axis, values in zip(
        axes, (elements["pressure"], elements["shear_on_upper"], stretch), strict=True
    ):
        axis.plot(
            elements["x"],
            values,
            "o",
            markersize=4.5,
            mfc="none",
            color="k",
            label="finite elements",
        )
        axis.axhline(0.0, color="0.8", linewidth=0.8, zorder=0)
        axis.grid(visible=True, color="0.93")
    edge = 1.08 * max(abs(place) for place in case["contact_x"])
    axes[0].set_xlim(-edge, edge)
    axes[0].set_ylabel("pressure [MPa]")
    axes[1].set_ylabel("shear on the coated roller [MPa]")
    middle, spread = float(np.median(stretch)), 0.5
    axes[2].set_ylim(middle - 2.2 * spread, middle + 2.2 * spread)
    axes[2].set_ylabel("stretch of the surface $-$ 1 [%]")
    axes[2].set_xlabel("x [mm], towards the leading edge")
    axes[0].legend(loc="lower center", fontsize=9)
    radius, layers = case["upper"]["radius"], case["upper"]["layers"]
    axes[0].set_title(
        f"Case {case['case']}: {sum(layer['thickness'] for layer in layers):g} mm on "
        f"R {radius:g} mm, rigid R {case['lower']['radius']:g} mm,\n"
        f"F = {case['load']:g} N/mm, T = {abs(case['traction']):g} N/mm",
        fontsize=11,
    )
    figure.savefig(ROOT / "docs" / "figures" / f"finite_strain_{name}.png", dpi=130)
    plt.close(figure)


if __name__ == "__main__":
    for title, key in PICTURES.items():
        picture(title, reference(*key))
