"""Figures of docs/comparison.md: Hertz's line contact by rollnip and by Tamaas, one thread each.

Run from anywhere, with both installed: python docs/scripts/compare_programs.py
Tamaas (BSD-like licence, pip install tamaas) is a library for rough contact on half-spaces.
"""

import os

os.environ.setdefault("OMP_NUM_THREADS", "1")
os.environ.setdefault("OPENBLAS_NUM_THREADS", "1")

import statistics
import time

import numpy as np
import tamaas as tm

RADIUS, MODULUS, POISSON, LOAD = 50.0, 2.0, 0.5, 1.0  # mm, MPa, -, N/mm
STIFFNESS = MODULUS / (1.0 - POISSON**2)
HALF_WIDTH = float(np.sqrt(4.0 * LOAD * RADIUS / np.pi / STIFFNESS))
PEAK = 2.0 * LOAD / (np.pi * HALF_WIDTH)


def by_rollnip() -> tuple[float, float]:
    """Half-width and peak pressure of a rigid roller on a half-space."""
    import rollnip as rn

    nip = rn.Nip(
        upper=rn.Roller(radius=RADIUS),
        lower=rn.Roller(radius=np.inf, core=rn.Elastic(modulus=MODULUS, poisson=POISSON)),
        normal=rn.LineLoad(LOAD),
        friction=0.0,
    )
    solution = rn.solve(nip, rn.Model(geometry="linear"))  # Hertz is linear
    return 0.5 * solution.nip_width, solution.peak_pressure


def by_tamaas(points: int, width: float) -> tuple[float, float]:
    """The same on a periodic line of ``width`` half-widths with so many points."""
    length = width * HALF_WIDTH
    model = tm.Model(tm.model_type.basic_1d, [length], [points])
    model.E, model.nu = MODULUS, POISSON
    x = (np.arange(points) + 0.5) / points * length - 0.5 * length
    solver = tm.PolonskyKeerRey(model, -0.5 * x**2 / RADIUS, 1e-12)
    solver.solve(LOAD / length)
    pressure = model["traction"].ravel()
    touching = np.count_nonzero(pressure > 0.0) * length / points
    return 0.5 * touching, float(pressure.max())


def median_time(call, repeats: int = 7) -> float:
    """Median processor time of a call [s]."""
    times = []
    for _ in range(repeats):
        start = time.process_time()
        call()
        times.append(time.process_time() - start)
    return statistics.median(times)


def main() -> None:
    """Print a table: error of half-width and peak pressure, and time."""
    tm.set_log_level(tm.LogLevel.error)
    rows = [("rollnip, `linear`", by_rollnip)]
    for points, width in ((1024, 20), (4096, 20), (4096, 80), (16384, 80)):
        rows.append(
            (
                f"Tamaas, {points} points on {width} half-widths",
                lambda points=points, width=width: by_tamaas(points, width),
            )
        )
    print("| program | half-width | peak pressure | time |\n|---|---|---|---|")
    for name, call in rows:
        half, peak = call()
        print(
            f"| {name} | {100 * (half / HALF_WIDTH - 1):+.3f} % | {100 * (peak / PEAK - 1):+.3f} % "
            f"| {1e3 * median_time(call):.1f} ms |"
        )


if __name__ == "__main__":
    main()
