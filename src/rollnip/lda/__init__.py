"""Laser-Doppler anemometry of a rolling surface: bursts, frequencies, velocities, comparison."""

from rollnip.lda.bursts import Record, synthesise
from rollnip.lda.comparison import Comparison, FittedNumber, compare
from rollnip.lda.detection import Burst, detect_bursts
from rollnip.lda.frequency import (
    Tone,
    estimate_tone,
    frequency_bound,
    frequency_scatter,
    window_penalty,
)
from rollnip.lda.instrument import Instrument, fringe_spacing
from rollnip.lda.scan import Scan, Seeding, simulate_scan, surface_speed
from rollnip.lda.statistics import VelocityProfile, estimate_profile, profile_from_means
from rollnip.lda.volume import SpeedProfile
from rollnip.rollers import Side

__all__ = [
    "Burst",
    "Comparison",
    "FittedNumber",
    "Instrument",
    "Record",
    "Scan",
    "Seeding",
    "Side",
    "SpeedProfile",
    "Tone",
    "VelocityProfile",
    "compare",
    "detect_bursts",
    "estimate_profile",
    "estimate_tone",
    "frequency_bound",
    "frequency_scatter",
    "fringe_spacing",
    "profile_from_means",
    "simulate_scan",
    "surface_speed",
    "synthesise",
    "window_penalty",
]
