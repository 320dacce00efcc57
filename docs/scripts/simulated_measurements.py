"""Write the simulated measurements in examples/fit and examples/dma.

Run from anywhere: ``python docs/scripts/simulated_measurements.py``; the same every time.
"""

from __future__ import annotations

from pathlib import Path

import numpy as np

import rollnip as rn
from rollnip.io import parse_case, with_values
from rollnip.io.document import read_document

EXAMPLES = Path(__file__).parents[2] / "examples"
TRUE = {"materials.cover.modulus": 2.2, "upper.layers[0].thickness": 8.6}
LOADS = (1.0, 2.0, 3.0, 4.5, 6.0, 8.0, 10.0)  # N/mm
WIDTH_ERROR, APPROACH_ERROR = 0.15, 0.008  # mm
DMA_ERROR = 0.02


def nips() -> None:
    """Nip widths and approaches of a cover at seven loads, with noise."""
    tree = with_values(read_document(EXAMPLES / "fit" / "cover.toml"), TRUE)
    rng = np.random.default_rng(7)
    widths, approaches = [], []
    for load in LOADS:
        case = parse_case(with_values(tree, {"nip.load": load}))
        solution = rn.solve(case.nip, case.model)
        widths.append(solution.nip_width + WIDTH_ERROR * rng.standard_normal())
        assert solution.approach is not None
        approaches.append(solution.approach + APPROACH_ERROR * rng.standard_normal())
    said = ", ".join(f"{path} = {value:g}" for path, value in TRUE.items())
    head = f"# Simulated, no measurement: {said}"
    rows = [f"{load:g},{width:.2f}" for load, width in zip(LOADS, widths, strict=True)]
    noise = f"noise of {WIDTH_ERROR} mm"
    write("fit/nip-widths.csv", [f"{head}; {noise}", "load [N/mm],nip width [mm]", *rows])
    rows = [
        f"{load:g},{approach:.3f},{APPROACH_ERROR}"
        for load, approach in zip(LOADS, approaches, strict=True)
    ]
    columns = "load [N/mm],approach [mm],standard error [mm]"
    write("fit/approaches.csv", [head, columns, *rows])


def isotherms() -> None:
    """Storage modulus and tan delta of a fractional Zener solid at nine temperatures, noisy."""
    law = rn.WLF(c1=8.9, c2=101.0, reference=23.0)
    solid = rn.FractionalZener(
        modulus=2.0, stiffening=800.0, relaxation_time=1e-7, order=0.45, poisson=0.5
    )
    rng = np.random.default_rng(8)
    rows = []
    for temperature in range(-20, 61, 10):
        for frequency in np.geomspace(0.1, 100.0, 13):
            omega = 2.0 * np.pi * frequency * law.factor(temperature)
            modulus = complex(solid.modulus_at(1j * omega))
            noise = 1.0 + DMA_ERROR * rng.standard_normal(2)
            tangent = modulus.imag / modulus.real * noise[1]
            rows.append(
                f"{temperature},{frequency:.4g},{modulus.real * noise[0]:.5g},{tangent:.5g}"
            )
    head = (
        "# Simulated, no measurement: fractional Zener, E0 2 MPa, k 800 MPa, tau 1e-7 s, order "
        f"0.45, at 23 degC; WLF c1 8.9, c2 101 K; noise of {100 * DMA_ERROR:g} %"
    )
    columns = "temperature [degC],frequency [Hz],E' [MPa],tan delta"
    write("dma/isotherms.csv", [head, columns, *rows])


def write(name: str, lines: list[str]) -> None:
    """One file of the examples."""
    (EXAMPLES / name).write_text("\n".join(lines) + "\n", encoding="utf-8")


if __name__ == "__main__":
    nips()
    isotherms()
