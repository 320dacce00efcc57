"""Verdict on a solution: whether its claimed errors meet the tolerance, and a sentence about them.

`converged` and `status` of a solution follow from the same numbers.
"""

from __future__ import annotations

from collections.abc import Mapping
from math import inf, isnan

from rollnip.model import BEYOND, FINITE, Geometry, Model
from rollnip.nip import Nip
from rollnip.no_nip import impossible
from rollnip.no_solution import may_spin
from rollnip.rolling import MeshSolution, long_columns, model_shares, relative_claims
from rollnip.rolling.changes import ROUNDING

FINEST_OF_FINITE = Model().tolerance
"""The finest tolerance that the geometries of finite strain can meet: the default one.

What the models themselves leave out exceeds a finer one, however fine the mesh.
"""
_LEFT_BY: Mapping[Geometry, str] = {
    "second": 'the second order of "second"',
    "finite": 'the finite elements of "finite"',
}
ACCEPT_IT = "accept it with a larger tolerance"
"""The advice where no finer mesh or grid is available."""
# Thickness of a covering over half the nip width, below which rubber gives way by its change of
# volume, too, and takes fewer elements with it.
_THIN = 0.025
_LONG_COLUMNS = (
    "The columns of finite elements are too long for so thin a covering: take `geometry = "
    '"curved"`, which needs none.'
)
# The advice that `rollnip.volume` gives, too.
_VOLUME = (
    " So thin a rubber yields by its change of volume, too: give its Poisson ratio, "
    "0.5 - E/(6 K), with a bulk modulus K of some 2000 MPa."
)
WORDS: Mapping[str, str] = {
    "approach": "approach",
    "load": "load",
    "creepage": "creepage",
    "nip_width": "nip width",
    "peak_pressure": "peak pressure",
}
"""Words for the figures to which the tolerance applies."""


def check(final: MeshSolution) -> tuple[bool, str]:
    """Return whether the solution is verified, and the status sentence that says so or what helps.

    The conditions are checked in the order in which one makes the next meaningful: iterations
    settled, result possible, ends of zones found, contact conditions met, errors small enough.
    """
    is_verified, status = _first_failure(final)
    if not is_verified:
        status += too_thin(final) + too_slippery(final.nip, final.contact.tolerance)
    return is_verified, status


def _first_failure(final: MeshSolution) -> tuple[bool, str]:
    """Return `check` without what it adds on very thin coverings and very small friction."""
    geometry, tolerance = final.geometry, final.contact.tolerance
    if not final.settled and may_spin(final):
        return False, (
            "Contact, stick and slip did not settle: the nip needs a traction of about "
            f"{final.wanted_traction:.4g} N/mm, and friction carries about "
            f"{final.nip.friction * final.figures.load:.4g} N/mm (friction * load); lower the "
            "traction or torque, or raise the load or the friction."
        )
    if not final.settled:
        what = "Contact, stick and slip did not settle"
        if final.geometry_change > 0.1 * tolerance:
            name = "The geometry correction"
            if geometry == "linear":  # uncorrected; a torque's traction is iterated
                name = "The traction that gives `torque_lower`"
            what = f"{name} did not converge (last change {final.geometry_change:.1e})"
        simpler = "" if geometry == "linear" else '`geometry = "linear"`, '
        return False, f"{what}; try {simpler}a smaller load or another tolerance."
    if reason := impossible(final):
        return False, reason
    if not final.has_free_ends:
        return False, (
            "The contact, stick and slip zones were found, but not exactly where they end; try "
            "another load or tolerance."
        )
    left = final.residual
    moves = geometry in FINITE and final.geometry_change > 0.5 * left
    if not left <= tolerance and moves:
        return False, (
            f"The {BEYOND[geometry]} of finite strain still change by "
            f"{final.geometry_change:.1e} (relative), which leaves the contact conditions violated "
            f"by {left:.1e}, more than the tolerance {tolerance:g}; try a smaller load, a "
            'larger tolerance or `geometry = "curved"`.'
        )
    if not left <= tolerance:
        return False, (f"{violated(left, tolerance)}; {ACCEPT_IT}.")
    is_met, words = verdict(final)
    if not is_met:
        return False, words
    return True, f"Solved and verified: residual {left:.1e}, {words}"


def verdict(final: MeshSolution) -> tuple[bool, str]:
    """Return whether the claimed errors meet the tolerance, and a sentence about them.

    A claimed error has a share from the mesh and a share from the model. In a geometry of finite
    strain the share of the model meets every tolerance of 1e-3 or more, even where it is larger
    than that, and the mesh may then leave as much of the same figure. It meets no finer tolerance.
    """
    relative, tolerance = relative_claims(final), final.contact.tolerance
    if not relative:
        return False, "The solution has no pressure in the nip, so that no error can be estimated."
    model_errors = model_shares(final)
    shares = {name: model_errors[name] for name in relative}
    is_met = tolerance >= FINEST_OF_FINITE
    allowed = {name: max(tolerance, shares[name]) if is_met else tolerance for name in relative}
    worst, ratio = worst_error(relative, allowed)
    if ratio <= 1.0 + ROUNDING:
        more = left_open(relative, tolerance, "the model and the mesh leave")
        return True, f"errors within the tolerance {tolerance:g}{more}."
    if relative[worst] <= shares[worst] * (1.0 + ROUNDING):
        return False, (
            f"{estimated_error_of(WORDS[worst], f'{100.0 * relative[worst]:.2g} %')}, more than "
            f"the tolerance {tolerance:g}: no mesh makes {_LEFT_BY[final.geometry]} "
            f"better. Ask for a tolerance of {FINEST_OF_FINITE:g} or more, or for geometry "
            '"curved" or "linear".'
        )
    return False, missed(WORDS[worst], relative[worst], ratio, tolerance)


def missed(figure: str, error: float, ratio: float, tolerance: float) -> str:
    """Return the sentence for a relative error that is ``ratio`` times the allowed one."""
    return (
        f"{estimated_error_of(figure, error)}, {ratio:.1f} times what the tolerance "
        f"{tolerance:g} allows, on the finest mesh; {ACCEPT_IT}."
    )


def violated(by: float, tolerance: float) -> str:
    """Return the beginning of the sentence for contact conditions that are not met."""
    return (
        f"The contact conditions are violated by {by:.1e} (relative), more than the tolerance "
        f"{tolerance:g}"
    )


def estimated_error_of(figure: str, error: float | str) -> str:
    """Return the beginning of a sentence about an error: a relative one, or one given in words."""
    size = error if isinstance(error, str) else f"{error:.1e} (relative)"
    return f"The estimated error of the {figure} is {size}"


def worst_error(relative: Mapping[str, float], allowed: Mapping[str, float]) -> tuple[str, float]:
    """Return the figure with the largest ratio of error to allowed error, and this ratio.

    A ratio that is nan counts as the largest.
    """
    ratios = {name: relative[name] / allowed[name] for name in relative}
    worst = max(ratios, key=lambda name: inf if isnan(ratios[name]) else ratios[name])
    return worst, ratios[worst]


def left_open(relative: Mapping[str, float], tolerance: float, by: str) -> str:
    """Return words for those errors that exceed the tolerance; "" where none does.

    Parameters
    ----------
    relative : relative errors by the names of `WORDS`, or by words.
    tolerance : the relative tolerance.
    by : what leaves these errors, with its verb, such as "the samples leave".
    """
    beyond = tolerance * (1.0 + ROUNDING)
    larger = {name: share for name, share in relative.items() if share > beyond}
    if not larger:
        return ""
    words = {WORDS.get(name, name): 100.0 * share for name, share in larger.items()}
    named = ", ".join(f"{word} {share:.2g} %" for word, share in words.items())
    return f", and what {by} open ({named})"


def too_thin(final: MeshSolution) -> str:
    """Return a sentence on a covering so thin that it cannot only flow sideways; "" if none.

    In "finite" it says, too, where columns of elements are too long for the tolerance.
    """
    nip, half, out = final.nip, 0.5 * final.figures.nip_width, ""
    if final.geometry == "finite" and long_columns(final) > final.contact.tolerance:
        out = f" {_LONG_COLUMNS}"
    for name, roller in (("upper", nip.upper), ("lower", nip.lower)):
        if not roller.layers or not 0.0 < roller.coating_thickness < _THIN * half:
            continue
        if all(layer.material.poisson == 0.5 for layer in roller.layers):
            return out + (
                f" The covering of the {name} roller is {half / roller.coating_thickness:.0f} "
                f"times thinner than half the nip width.{_VOLUME}"
            )
    return out


def too_slippery(nip: Nip, tolerance: float) -> str:
    """Return a sentence on friction smaller than the tolerance; "" where it is larger.

    The zones of stick are then about as short, relative to the nip width, as the friction is small.
    """
    if not 0.0 < nip.friction <= tolerance:
        return ""
    return (
        " So little friction hardly changes approach, nip width and pressure: take `friction = 0`, "
        "which has no creepage."
    )
