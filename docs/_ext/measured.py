"""What simulated laser-Doppler measurements show, for the page about them.

Every number is simulated and evaluated by `rollnip.lda` while the page is built.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cache

import numpy as np
from judged import root
from numpy.typing import NDArray

import rollnip as rn
from rollnip.lda import (
    Comparison,
    Instrument,
    Scan,
    Seeding,
    SpeedProfile,
    compare,
    estimate_profile,
    estimate_tone,
    frequency_bound,
    profile_from_means,
    simulate_scan,
)

Array = NDArray[np.float64]

RATE, ENVELOPE, TONE = 250e3, 0.25e-3, 27546.0
BURSTS = 1000
RATIOS = (0.1, 0.3, 1.0, 3.0, 10.0, 100.0, 1000.0)


@cache
def solved(name: str, geometry: str) -> rn.Solution:
    """Return an example of the paper, solved in one geometry."""
    case = rn.read_case(root() / "examples" / f"{name}.toml")
    return rn.solve(case.nip, rn.Model(geometry=geometry))  # type: ignore[arg-type]


def scatter_over_bound(snr: float, *, is_complex: bool) -> float:
    """Return the scatter of the frequencies of noisy bursts over the Cramer-Rao bound."""
    centre = 6.0 * ENVELOPE
    time = np.arange(int(12.0 * ENVELOPE * RATE)) / RATE - centre
    rng = np.random.default_rng(11)
    off = []
    for _ in range(BURSTS):
        frequency = TONE * rng.uniform(0.9, 1.1)
        turns = 2.0 * np.pi * (frequency * time + rng.random())
        wave = np.exp(1j * turns) if is_complex else np.cos(turns)
        noise = rng.standard_normal(time.size) * np.sqrt(0.5 / snr)
        if is_complex:
            noise = noise + 1j * rng.standard_normal(time.size) * np.sqrt(0.5 / snr)
        samples = np.exp(-0.5 * (time / ENVELOPE) ** 2) * wave + noise
        found = estimate_tone(samples, RATE, centre=centre, envelope=ENVELOPE)
        off.append(found.frequency - frequency)
    return float(np.std(off) / frequency_bound(snr, RATE, ENVELOPE, is_complex=is_complex))


def bound_table() -> str:
    """Return the scatter over the bound at several SNR as Markdown."""
    lines = [f"| SNR at the peak | {' | '.join(f'{snr:g}' for snr in RATIOS)} |"]
    lines.append("|---" * (len(RATIOS) + 1) + "|")
    for name, is_complex in (("real", False), ("complex", True)):
        ratios = [scatter_over_bound(snr, is_complex=is_complex) for snr in RATIOS]
        cells = [f"{one:.0f}" if one > 5.0 else f"{one:.2f}" for one in ratios]
        lines.append(f"| scatter/bound, {name} | {' | '.join(cells)} |")
    return "\n".join(lines)


def band_coverage(confidence: float, each: int, outliers: float = 0.0) -> tuple[float, float]:
    """Return the shares of positions and of whole curves that the bands hold, over 300 seeds."""
    single, joint = [], []
    for seed in range(300):
        rng = np.random.default_rng(seed)
        x = np.repeat(np.linspace(-5.0, 5.0, 20), each)
        v = 100.0 + np.sin(x) + 0.5 * rng.standard_normal(x.size)
        v = np.where(rng.random(x.size) < outliers, rng.uniform(60.0, 140.0, x.size), v)
        profile = estimate_profile(x, v, confidence=confidence)
        off = np.abs(profile.velocity - (100.0 + np.sin(profile.x)))
        single.append(float(np.mean(off <= profile.band)))
        joint.append(bool(np.all(off <= profile.joint_band)))
    return float(np.mean(single)), float(np.mean(joint))


@dataclass(frozen=True)
class Blurred:
    """A scan with a measuring volume that is too long at the end of the slip zone."""

    plain: Comparison
    found: Comparison


@cache
def blurred() -> Blurred:
    """Compare velocities along the driven configuration II, measured with 0.2 mm."""
    at = Instrument(half_width=0.2, sample_rate=150e3)
    solution = solved("configuration-2-driven", "curved")
    places = np.concatenate(
        [np.linspace(-9.0, -4.0, 5), np.linspace(-3.8, -2.9, 10), np.linspace(-2.5, 8.0, 7)]
    )
    scan = simulate_scan(solution, at, Seeding(bursts=40), positions=places, seed=1)
    profile = estimate_profile(scan.x, scan.velocity)
    width = at.averaging_width
    return Blurred(
        compare(profile, solution, width=width),
        compare(profile, solution, width=width, blur=at.largest_blur),
    )


def interval_coverage() -> tuple[float, float]:
    """Return the shares of 200 simulated scans whose intervals hold the shift and V."""
    solution = solved("configuration-1-free", "curved")
    model = SpeedProfile(solution.profiles.x, solution.profiles.strain_upper)
    x, noise, held = np.linspace(-5.0, 5.0, 30), 0.08, []
    for seed in range(200):
        scatter = noise * np.random.default_rng(seed).standard_normal(x.size)
        means = 98.7 * (1.0 + model.averaged(x, 0.0)) + scatter
        one = compare(profile_from_means(x + 0.21, means, np.full(x.size, noise)), solution)
        held.append(
            (
                one.shift.low <= 0.21 <= one.shift.high,
                one.speed.low <= 98.7 <= one.speed.high,
            )
        )
    shift, speed = np.mean(np.array(held, dtype=float), axis=0)
    return float(shift), float(speed)


@cache
def scan_of_figures() -> Scan:
    """Return the scan that the pictures of the page show."""
    return simulate_scan(solved("configuration-2-driven", "curved"), Instrument(), seed=0)


def against(geometry: str) -> Comparison:
    """Compare the scan of the pictures with a solution in some geometry."""
    scan, at = scan_of_figures(), Instrument()
    profile = estimate_profile(scan.x, scan.velocity)
    solution = solved("configuration-2-driven", geometry)
    return compare(profile, solution, width=at.averaging_width, blur=at.largest_blur)
