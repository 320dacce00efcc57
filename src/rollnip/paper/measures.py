"""Numbers that the paper's statements about its figures speak of."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray
from scipy.integrate import cumulative_trapezoid

from rollnip.lda import Side, SpeedProfile
from rollnip.solution import Solution

Array = NDArray[np.float64]

_BESIDE = 0.02  # of the stick zone left out at either end, where slip begins
_REACH, _PLACES = 7.0, 2801  # half-widths on either side of the middle, places


def edge_peak(solution: Solution) -> float:
    """Highest pressure in the outer tenth of the leading half of the contact [MPa]."""
    edge = solution.contact[-1][1]
    x = solution.nodes
    return float(np.max(solution.pressure[x > 0.9 * edge], initial=0.0))


def edge_load(solution: Solution, width: float) -> float:
    """Load carried within ``width`` [mm] of the leading edge [N/mm]."""
    x, pressure = solution.profiles.x, solution.profiles.pressure
    carried = np.concatenate([[0.0], cumulative_trapezoid(pressure, x)])
    edge = solution.contact[-1][1]
    return float(np.interp(edge, x, carried) - np.interp(edge - width, x, carried))


def pressure_offset(solution: Solution) -> float:
    """Centre of pressure, from the middle of the contact, over the half-width; > 0: leading."""
    x, pressure = solution.profiles.x, solution.profiles.pressure
    centre = float(np.trapezoid(pressure * x, x) / np.trapezoid(pressure, x))
    first, last = solution.contact[0][0], solution.contact[-1][1]
    return (centre - 0.5 * (first + last)) / (0.5 * (last - first))


def stress_centre(solution: Solution, z: Array) -> Array:
    """Return the centre of s_zz over the whole length, at depths ``z`` of the upper roller.

    It is measured from the middle of the contact, over the half-width; > 0: towards the inlet.
    Seven half-widths on either side hold all of the stress of a bonded covering.

    Parameters
    ----------
    z : (n,) depths [mm].

    Returns
    -------
    (n,) places over the half-width.
    """
    first, last = solution.contact[0][0], solution.contact[-1][1]
    middle, half = 0.5 * (first + last), 0.5 * (last - first)
    x = middle + half * np.linspace(-_REACH, _REACH, _PLACES)
    stress = solution.interior("upper", z, x).s_zz
    centre = np.trapezoid(x * stress, x) / np.trapezoid(stress, x)
    return np.asarray((centre - middle) / half)


def strain_in_stick(solution: Solution, side: Side = "upper") -> Array:
    """Strain of a surface along the stick zone, its ends left out, (n,)."""
    profiles = solution.profiles
    stick = [zone for zone in solution.zones if zone.state == "stick"]
    first, last = stick[0].start, stick[-1].stop
    beside = _BESIDE * (last - first)
    inside = (profiles.x > first + beside) & (profiles.x < last - beside)
    strain = profiles.strain_upper if side == "upper" else profiles.strain_lower
    return strain[inside]


def strain_change(one: Solution, other: Solution, side: Side = "upper") -> float:
    """Root mean square difference of two solutions' strain, to half a nip width outside."""
    first = min(one.contact[0][0], other.contact[0][0]) - 0.5 * one.nip_width
    last = max(one.contact[-1][1], other.contact[-1][1]) + 0.5 * one.nip_width
    x = np.linspace(first, last, 2001)
    strains = []
    for solution in (one, other):
        profiles = solution.profiles
        strain = profiles.strain_upper if side == "upper" else profiles.strain_lower
        strains.append(SpeedProfile(profiles.x, strain).at(x))
    return float(np.sqrt(np.mean((strains[0] - strains[1]) ** 2)))
