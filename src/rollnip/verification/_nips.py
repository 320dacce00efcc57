"""The nips that the cases are made of, and the figures read from their solutions."""

from __future__ import annotations

from math import inf

from rollnip.materials import Material
from rollnip.model import Model
from rollnip.nip import Nip
from rollnip.rollers import Layer, Roller
from rollnip.solution import Solution, Zone
from rollnip.solver import solve

LINEAR = Model(geometry="linear")


def solved(nip: Nip, model: Model = LINEAR) -> Solution:
    """Solve a nip; a solution that could not be verified is an error."""
    return solve(nip, model, on_failure="raise")


def half_space(radius: float, material: Material) -> Roller:
    """Roller that deforms as a half-space."""
    return Roller(radius=radius, core=material)


def bed(thickness: float, material: Material) -> Roller:
    """Plane rigid body with one layer."""
    return Roller(radius=inf, layers=(Layer(thickness, material),))


def coated(radius: float, thickness: float, material: Material) -> Roller:
    """Rigid roller with one layer."""
    return Roller(radius=radius, layers=(Layer(thickness, material),))


def half_width(solution: Solution) -> float:
    """Half of the nip width [mm]."""
    return 0.5 * solution.nip_width


def trailing_edge(solution: Solution) -> float:
    """Return the place where the nip ends [mm]."""
    return solution.contact[0][0]


def leading_edge(solution: Solution) -> float:
    """Return the place where the nip begins [mm]."""
    return solution.contact[-1][1]


def approach(solution: Solution) -> float:
    """Approach of the axles [mm]."""
    return float("nan") if solution.approach is None else solution.approach


def creepage(solution: Solution) -> float:
    """Creepage; nan where it is free."""
    return float("nan") if solution.creepage is None else solution.creepage


def peak_pressure(solution: Solution) -> float:
    """Highest pressure [MPa]."""
    return solution.peak_pressure


def longest_zone(solution: Solution, state: str) -> Zone:
    """Longest zone of stick or slip; LookupError where there is none."""
    found = [zone for zone in solution.zones if zone.state == state]
    if not found:
        raise LookupError(f"no {state} zone")
    return max(found, key=lambda zone: zone.stop - zone.start)


def stick_length(solution: Solution) -> float:
    """Length of the longest stick zone [mm]."""
    zone = longest_zone(solution, "stick")
    return zone.stop - zone.start


def slip_length(solution: Solution) -> float:
    """Length of the longest slip zone [mm]."""
    zone = longest_zone(solution, "slip")
    return zone.stop - zone.start
