"""Strain energies fitted to homogeneous tests.

Each residual is the difference of nominal stresses divided by |measured| + 5 % of the largest
stress of its test: relative at larger strains, absolute near the origin. Yeoh's energy is linear in
its constants. The exponents of Ogden's are searched for from several starts; its terms are kept
positive (mu_n a_n > 0), which makes each of them stable.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from itertools import combinations
from typing import Literal, get_args

import numpy as np
from scipy.optimize import least_squares, nnls
from scipy.stats import t as student

from rollnip._errors import InvalidInputError, require_finite
from rollnip.identification.intervals import covariance
from rollnip.materials import Elastic, Energy, Gent, NeoHookean, Ogden, Yeoh
from rollnip.rubber.data import Array, RubberData, Test
from rollnip.rubber.laws import nominal_stress, stretches, unstable_from

Law = Literal["neo-hookean", "yeoh", "gent", "ogden"]
LAWS: tuple[Law, ...] = get_args(Law)
CONFIDENCE = 0.95
_START = 0.05  # of the largest stress of a test, added to every |stress| in the denominator
_EXPONENTS = (-8.0, -5.0, -3.0, -2.0, -1.0, 0.5, 1.0, 1.5, 2.0, 3.0, 4.0, 6.0, 9.0, 13.0)
_STARTS = 6
_MOST_TERMS = 4
_FARTHEST_EXPONENT = 40.0
_NO_STRAIN, _NO_STRESS = 1e-9, 1e-12  # MPa; what is not larger counts as zero
_USUAL = (0.5, 2.0)  # stretches that a cover may reach: instability within them gives a warning
_LOADINGS: dict[Test, str] = {
    "tension": "tension or compression",
    "equibiaxial": "equibiaxial tension or compression",
    "planar": "plane strain",
}
_Model = Callable[[Array], tuple[float, Energy]]


@dataclass(frozen=True)
class Constant:
    """A fitted constant with the ends of its 95 % confidence interval from a linearised model."""

    name: str
    value: float
    low: float
    high: float
    unit: str = ""


@dataclass(frozen=True)
class RubberFit:
    """A strain energy fitted to the tests of a rubber.

    Attributes
    ----------
    data : the measurements used.
    law : name of the energy.
    material : material with the fitted modulus and energy.
    constants : the fitted constants; for "ogden" each term's share mu a/2 of G, and its exponent a.
    deviation : (n,) computed less measured nominal stress [MPa].
    rms : by test, rms of the deviations over the largest stress of the test.
    unstable : by test, the stretches below and above 1 from which the energy is unstable; None
        where it is stable within the range examined.
    warnings : reservations, each a sentence.
    """

    data: RubberData
    law: Law
    material: Elastic
    constants: tuple[Constant, ...]
    deviation: Array
    rms: dict[Test, float]
    unstable: dict[Test, tuple[float | None, float | None]]
    warnings: tuple[str, ...]

    @property
    def shear_modulus(self) -> float:
        """Initial shear modulus G [MPa]."""
        return 0.5 * self.material.modulus / (1.0 + self.material.poisson)

    @property
    def energy(self) -> Energy:
        """The strain energy of the material."""
        assert self.material.energy is not None
        return self.material.energy


def fit_rubber(
    data: RubberData, law: Law = "yeoh", *, terms: int = 2, poisson: float = 0.5
) -> RubberFit:
    """Fit a strain energy to homogeneous tests of a rubber, taken as incompressible.

    Parameters
    ----------
    data :
        one kind of test or several; several can distinguish energies, one often cannot.
    law :
        "neo-hookean", "yeoh", "gent" or "ogden".
    terms :
        number of terms of "ogden", 1 to 4.
    poisson :
        Poisson ratio assigned to the material; the tests do not determine it.

    Raises
    ------
    InvalidInputError
        where the law is unknown, the number of terms or the Poisson ratio lies outside its range,
        there are not more measurements than constants, a test has only zero strains or stresses, or
        the stresses have the opposite sign to the strains.
    """
    if law not in LAWS:
        raise InvalidInputError(f"`law` must be one of {', '.join(LAWS)}, got {law!r}.")
    if not 1 <= terms <= _MOST_TERMS:
        raise InvalidInputError(f"`terms` must lie between 1 and {_MOST_TERMS}, got {terms!r}.")
    require_finite("poisson", poisson)
    _require_strain_and_stress(data)
    problem = _EnergyResiduals(data)
    number = {"neo-hookean": 1, "yeoh": 3, "gent": 2, "ogden": 2 * terms}[law]
    if data.stress.size <= number:
        raise InvalidInputError(
            f"{data.source}: must hold more than {number} measurements for as many constants, "
            f"holds {data.stress.size}."
        )
    if not problem.neo_hookean > 0.0:
        raise _wrong_way(data, problem.neo_hookean)
    model, starts, names = _search_setup(law, terms, problem)
    best = min((problem.minimised(model, start) for start in starts), key=lambda one: one[1])[0]
    shear, energy = model(best)
    if not shear > 0.0:
        raise _wrong_way(data, shear)
    material = Elastic(modulus=float(2.0 * (1.0 + poisson) * shear), poisson=poisson, energy=energy)
    unstable = {test: unstable_from(energy, test) for test in _LOADINGS}
    deviation = problem.stress(shear, energy) - data.stress
    rms = {
        test: float(np.sqrt(np.mean((deviation / problem.largest)[data.rows(test)] ** 2)))
        for test in data.tests
    }
    constants = _constants(problem, model, best, names)
    warnings = (
        *_stability(law, data, unstable),
        *_one_test_only(data),
        *_undetermined(constants, shear),
    )
    return RubberFit(data, law, material, constants, deviation, rms, unstable, warnings)


def _require_strain_and_stress(data: RubberData) -> None:
    """Raise where all strains or all stresses of a test are zero."""
    for test in data.tests:
        rows, rest = data.rows(test), 0.0 if test == "shear" else 1.0
        for name, is_found in (
            ("strain", np.any(np.abs(data.stretch[rows] - rest) > _NO_STRAIN)),
            ("stress", np.any(np.abs(data.stress[rows]) > _NO_STRESS)),
        ):
            if not is_found:
                raise InvalidInputError(
                    f"{data.source}: must hold a measurement of {test} with a {name}; all of them "
                    "are zero. Leave these rows out."
                )


def _wrong_way(data: RubberData, shear: float) -> InvalidInputError:
    """Return the error for stresses opposite in sign to the strains."""
    return InvalidInputError(
        f"{data.source}: the stresses must go the way of the strains; the fitted shear modulus "
        f"is {shear:.3g} MPa. Check the signs of the columns."
    )


class _EnergyResiduals:
    """Residuals of strain energies against given data."""

    def __init__(self, data: RubberData) -> None:
        self.data = data
        self.largest = np.empty(data.stress.size)
        for test in data.tests:
            rows = data.rows(test)
            self.largest[rows] = float(np.abs(data.stress[rows]).max())
        self.scale = np.abs(data.stress) + _START * self.largest
        soft = self.stress(1.0, NeoHookean()) / self.scale
        self.neo_hookean = float(soft @ (data.stress / self.scale) / (soft @ soft))  # G [MPa]

    def stress(self, shear: float, energy: Energy) -> Array:
        """Return the nominal stresses of an energy, (n,) [MPa]."""
        out = np.empty(self.data.stress.size)
        for test in self.data.tests:
            rows = self.data.rows(test)
            out[rows] = shear * nominal_stress(energy, test, self.data.stretch[rows])
        return out

    def residuals(self, model: _Model, at: Array) -> Array:
        """Return the residuals, (n,); 1e3 where the energy cannot reach a stretch."""
        with np.errstate(all="ignore"):
            found = (self.stress(*model(at)) - self.data.stress) / self.scale
        return np.where(np.isfinite(found), np.clip(found, -1e3, 1e3), 1e3)

    def minimised(self, model: _Model, start: Array) -> tuple[Array, float]:
        """Return the best constants found from a start, and half the sum of squares."""
        found = least_squares(lambda at: self.residuals(model, at), start, x_scale="jac")
        return found.x, float(found.cost)

    def ogden_starts(self, terms: int) -> list[Array]:
        """Return the best few starts over all choices of exponents, with non-negative terms."""
        bases = {a: self.stress(1.0, Ogden(((a, a),))) / self.scale for a in _EXPONENTS}
        wanted = self.data.stress / self.scale
        tried = []
        for exponents in combinations(_EXPONENTS, terms):
            shares, misfit = nnls(np.stack([bases[a] for a in exponents], axis=1), wanted)
            least = 1e-4 * max(float(shares.sum()), 1e-12)
            tried.append((misfit, np.ravel([np.log(np.maximum(shares, least)), exponents])))
        tried.sort(key=lambda one: one[0])
        return [start for _, start in tried[:_STARTS]]


def _search_setup(
    law: Law, terms: int, problem: _EnergyResiduals
) -> tuple[_Model, list[Array], list[str]]:
    """Return the energy as a function of the fit variables, starts, and names of the constants."""
    shear = problem.neo_hookean
    if law == "neo-hookean":
        return lambda at: (at[0], NeoHookean()), [np.array([shear])], ["G"]
    if law == "yeoh":
        start = np.array([shear, 0.0, 0.0])
        return (
            lambda at: (at[0], Yeoh(at[1] / at[0], at[2] / at[0])),
            [start],
            ["G", "second", "third"],
        )
    if law == "gent":
        excess = max(_largest_excess(problem.data), 1e-3)
        starts = [np.array([shear, np.log(0.1 * excess)]), np.array([shear, np.log(10 * excess)])]
        # the limit of I1 - 3 stays above its largest measured value
        return lambda at: (at[0], Gent(excess + np.exp(at[1]))), starts, ["G", "limit"]

    def ogden(at: Array) -> tuple[float, Energy]:
        shares, exponents = np.exp(at[:terms]), at[terms:]
        exponents = np.clip(exponents, -_FARTHEST_EXPONENT, _FARTHEST_EXPONENT)
        exponents = np.where(np.abs(exponents) < 1e-3, 1e-3, exponents)
        pairs = tuple((2.0 * g / a, a) for g, a in zip(shares, exponents, strict=True))
        return float(shares.sum()), Ogden(pairs)

    names = [f"share {n + 1}" for n in range(terms)] + [f"exponent {n + 1}" for n in range(terms)]
    return ogden, problem.ogden_starts(terms), names


def _largest_excess(data: RubberData) -> float:
    """Return the largest I1 - 3 in the tests."""
    found = [
        (stretches(test, data.stretch[data.rows(test)]) ** 2).sum(axis=0) - 3.0
        for test in data.tests
    ]
    return float(np.concatenate(found).max())


def _constants(
    problem: _EnergyResiduals, model: _Model, best: Array, names: list[str]
) -> tuple[Constant, ...]:
    """Return the constants with intervals from the Jacobian of the residuals at the best fit.

    The intervals of positive constants are computed for their logarithm.
    """
    count = problem.data.stress.size
    step = 1e-5 * np.maximum(np.abs(best), 1e-3)
    sides = [(best + move, best - move) for move in np.diag(step)]
    slopes = [problem.residuals(model, a) - problem.residuals(model, b) for a, b in sides]
    jacobian = np.stack(slopes, axis=1) / (2.0 * step)
    variance = float(np.sum(problem.residuals(model, best) ** 2)) / (count - best.size)
    spread = covariance(jacobian, np.ones(count)) * variance
    reach = float(student.ppf(0.5 + 0.5 * CONFIDENCE, count - best.size))
    out = []
    for name in names:
        is_log = not name.startswith(("second", "third", "exponent"))

        def shown(at: Array, name: str = name, is_log: bool = is_log) -> float:
            value = _value(name, *model(at))
            return float(np.log(value)) if is_log else value

        slope = np.array([shown(a) - shown(b) for a, b in sides]) / (2.0 * step)
        middle, half = shown(best), reach * max(float(slope @ spread @ slope), 0.0) ** 0.5
        low, high = middle - half, middle + half
        if is_log:
            low, high = (float(np.exp(np.clip(end, -700.0, 700.0))) for end in (low, high))
        unit = "MPa" if name == "G" or name.startswith("share") else ""
        out.append(Constant(name, _value(name, *model(best)), float(low), float(high), unit))
    return tuple(out)


def _value(name: str, shear: float, energy: Energy) -> float:
    """Return the value of a constant, given its name."""
    if name == "G":
        return shear
    if isinstance(energy, Ogden):
        kind, _, number = name.partition(" ")
        weight, exponent = energy.terms[int(number) - 1]
        return 0.5 * weight * exponent if kind == "share" else exponent
    return float(getattr(energy, name))


def _stability(
    law: Law, data: RubberData, unstable: dict[Test, tuple[float | None, float | None]]
) -> list[str]:
    """Return warnings where the energy is unstable at stretches that were measured or are usual."""
    lines = []
    for test, ends in unstable.items():
        rows = data.rows("tension") | data.rows("compression") if test == "tension" else None
        rows = data.rows(test) if rows is None else rows
        seen = data.stretch[rows]
        least = min(_USUAL[0], float(seen.min(initial=1.0)))
        most = max(_USUAL[1], float(seen.max(initial=1.0)))
        for end, is_seen in ((ends[0], least), (ends[1], most)):
            if end is not None and (is_seen <= end if end < 1.0 else end <= is_seen):
                side = "below" if end < 1.0 else "beyond"
                lines.append(
                    f"The energy ({law}) is not stable in {_LOADINGS[test]} {side} a stretch of "
                    f"{end:.2f}: more strain takes less stress there (Drucker). Take another law, "
                    "or measure there."
                )
    return lines


def _one_test_only(data: RubberData) -> list[str]:
    """Return a warning where only one kind of test exists, which does not determine others."""
    if len(data.tests) > 1:
        return []
    return [
        f"One kind of test alone ({data.tests[0]}) does not tell energies apart: a nip shears and "
        "presses rubber in the plane, so add planar or shear tests, or compression."
    ]


def _undetermined(constants: tuple[Constant, ...], shear: float) -> list[str]:
    """Return a warning about constants that the data do not determine.

    The width of an interval is compared with G for a modulus, and for a number with its absolute
    value
    or 1, whichever is larger.
    """
    lost = [
        one.name
        for one in constants
        if not np.isfinite(one.high - one.low)
        or one.high - one.low > 2.0 * (shear if one.unit else max(1.0, abs(one.value)))
    ]
    if not lost:
        return []
    return [
        f"The data leave {', '.join(lost)} open (see the intervals): take fewer terms, another law "
        "or more strain."
    ]
