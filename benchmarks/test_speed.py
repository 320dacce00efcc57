"""How long things take, as ratios to one small linear system; `make bench` prints the table.

No part of the tests: times depend on the machine and on what else it does. Each row is CPU time.
"""

import os
import subprocess
import sys
import time
from dataclasses import replace
from math import sqrt
from pathlib import Path

import numpy as np
import pytest
from rates import (
    CURVED,
    EXAMPLES,
    SECOND,
    carter,
    measured_profile,
    memory_of_a_solve,
    nip_of,
    thicker,
    two_on_two,
)

import rollnip as rn


@pytest.mark.parametrize(
    ("what", "nip", "model", "goal"),
    [
        ("configuration II driven, curved", "configuration-2-driven", CURVED, "6 x (stretch 3)"),
        ("configuration II driven, second", "configuration-2-driven", SECOND, "-"),
        ("configuration I free, finite (default)", "configuration-1-free", rn.Model(), "20 x"),
        ("configuration II driven, finite", "configuration-2-driven", rn.Model(), "40 x"),
        ("configuration II free, curved", "configuration-2-free", CURVED, "-"),
        ("viscoelastic two layers on two, curved", None, CURVED, "12 x"),
        ("figure 4, top layer 0.2 mm", "figure-4-top-layer-0.2mm", CURVED, "12 x"),
        ("figure 4, top layer 0.1 mm", "figure-4-top-layer-0.1mm", CURVED, "12 x"),
        ("figure 4, top layer 0.025 mm", "figure-4-top-layer-0.025mm", CURVED, "12 x"),
    ],
)
def test_solve_with_nothing_cached(in_units, what, nip, model, goal):
    nip = two_on_two() if nip is None else nip_of(nip)
    in_units(what, lambda number: rn.solve(thicker(nip, number), model), goal)
    assert rn.solve(nip, model).converged


def test_solve_with_kernels_cached(in_units):
    nip, cache = nip_of("configuration-2-driven"), rn.KernelCache()

    def call(number):
        load = rn.LineLoad(nip.normal.load * (1.0 + 1e-3 * (number + 1)))
        rn.solve(replace(nip, normal=load), CURVED, cache=cache)

    in_units("configuration II driven, curved, kernels cached", call, "2 x")


def test_carter(in_units):
    model = rn.Model(geometry="linear")
    in_units("Carter", lambda number: rn.solve(carter(number), model), "2 x")
    found = rn.solve(replace(carter(-2)), model)
    half_width = 0.5 * found.nip_width
    stick = next(zone for zone in found.zones if zone.state == "stick")
    share = sqrt(1.0 - found.traction / (0.3 * found.load))
    assert 0.5 * (stick.stop - stick.start) / half_width == pytest.approx(share, rel=1e-3)


@pytest.mark.parametrize("name", ["configuration-2-driven", None])
def test_work_against_precision(watch, name):
    """Time and true error as the tolerance is halved, down to 1e-5."""
    nip, geometry = (carter(), "linear") if name is None else (nip_of(name), "curved")
    finest = rn.solve(nip, rn.Model(geometry=geometry, tolerance=3e-6))
    before = None
    for tolerance in (1e-3, 5e-4, 2.5e-4, 1e-4, 5e-5, 2.5e-5, 1e-5):
        model = rn.Model(geometry=geometry, tolerance=tolerance)
        seconds = watch.seconds_of(lambda _, model=model: rn.solve(nip, model), 3)
        solution = rn.solve(nip, model)
        error = abs(solution.nip_width / finest.nip_width - 1.0)
        what = f"{name or 'Carter'}, tolerance {tolerance:g}: {solution.solver.elements} elements"
        grown = "-" if before is None else f"{seconds / before:.2f} x"
        verdict = "" if solution.converged else ", not verified"
        watch.note(what, f"{1e3 * seconds:.0f} ms", grown, f"width to {error:.0e}{verdict}")
        before = seconds


@pytest.mark.parametrize("name", ["configuration-2-driven", "figure-4-top-layer-0.1mm"])
def test_interior(in_units, name):
    solution = rn.solve(nip_of(name), CURVED)
    depth = solution.nip.upper.coating_thickness
    z = np.linspace(0.0, depth, 100)
    x = np.linspace(-2.0, 2.0, 400) * solution.nip_width
    in_units(f"interior 400 x 100, {name}", lambda _: solution.interior("upper", z, x), "20 x")


def test_measured_profile(watch):
    nip = measured_profile()
    seconds = watch.seconds_of(lambda _: rn.solve(nip, rn.Model(geometry="linear")), 3)
    ratio = f"{seconds / watch.unit():.0f} x"
    watch.note("measured profile, 1e5 points", f"{seconds:.2f} s", ratio, "5 s")


@pytest.mark.parametrize(
    ("what", "arguments", "goal"),
    [
        ("rollnip --help, wall time", ["--help"], "0.3 s"),
        (
            "rollnip solve, configuration II, cold, wall time",
            ["solve", str(EXAMPLES / "configuration-2-driven.toml"), "-q"],
            "1.2 s",
        ),
    ],
)
def test_command(watch, what, arguments, goal):
    command = [str(Path(sys.executable).with_name("rollnip")), *arguments]
    times = []
    for _ in range(5):
        start = time.perf_counter()
        subprocess.run(command, check=True, capture_output=True, env=dict(os.environ))
        times.append(time.perf_counter() - start)
    watch.note(what, f"{np.median(times):.2f} s", "-", goal)


@pytest.mark.parametrize("model", [CURVED, rn.Model()], ids=lambda model: model.geometry)
def test_memory(watch, model):
    peak = memory_of_a_solve(model)
    watch.note(f"memory of one solve, {model.geometry}", f"{peak:.1f} MiB", "-", "30 MB")
