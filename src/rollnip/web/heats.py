"""Temperatures of rollers for the page: steady states, which are kept, warm-ups and branches."""

from __future__ import annotations

from typing import Any, Literal

from rollnip._errors import CaseFileError, InvalidInputError
from rollnip.cooling import HeatBalance
from rollnip.heat import HeatSolution, follow_heat, solve_heat, warm_up
from rollnip.heat.report import branch_dict, heat_dict, warm_up_dict
from rollnip.influence import KernelCache
from rollnip.io import Case, case_hash
from rollnip.web.answers import SOURCE, at_its_key
from rollnip.web.kept import Kept

_KEPT = 4
_FROM, _TO = 0.1, 10.0  # of the case's own value: where a branch begins and ends
_PLACES = {"speed": "nip.speed", "profile": "upper.profile", "film": "upper.heat.film"}


class Heats:
    """Solves nips and temperatures together, and keeps the last steady states.

    Parameters
    ----------
    kernels :
        influence functions, shared with other solves.
    """

    def __init__(self, kernels: KernelCache) -> None:
        self._kernels = kernels
        self._kept: Kept[HeatSolution] = Kept(_KEPT)

    def solution(self, case: Case) -> HeatSolution:
        """Solve a case and the temperatures of its rollers.

        Raises
        ------
        CaseFileError
            where the case has no table ``heat``, or something in it does not fit.
        """
        key = case_hash(case)
        if (kept := self._kept.get(key)) is not None:
            return kept
        try:
            found = solve_heat(case.nip, _heat_of(case), case.model, cache=self._kernels)
        except InvalidInputError as error:
            raise _placed(error) from None
        return self._kept.put(key, found)

    def steady(self, case: Case) -> dict[str, Any]:
        """Return the key "heat" of the result of a case. Raises CaseFileError as `solution`."""
        return heat_dict(self.solution(case))

    def warm_up(self, case: Case) -> dict[str, Any]:
        """Return the key "warm_up": temperatures over time, from the start of the case."""
        heat = _heat_of(case)
        steady = self.solution(case)
        try:
            course = warm_up(case.nip, heat, case.model, steady=steady, cache=self._kernels)
        except InvalidInputError as error:
            raise _placed(error) from None
        return warm_up_dict(course)

    def runaway(self, case: Case, parameter: Literal["speed", "load"]) -> dict[str, Any]:
        """Return the key "branch" over speed or load, and how far the case is from its runaway.

        ``value`` is that of the case, ``margin`` the share by which it may rise; None without
        runaway.
        """
        heat = _heat_of(case)
        value = _value_of(case, parameter)
        try:
            branch = follow_heat(
                case.nip,
                heat,
                case.model,
                parameter=parameter,
                low=_FROM * value,
                high=_TO * value,
                cache=self._kernels,
            )
        except InvalidInputError as error:
            raise _placed(error) from None
        return branch_dict(branch) | {"value": value, "margin": branch.margin(value)}


def _heat_of(case: Case) -> HeatBalance:
    if case.heat is None:
        raise CaseFileError(f"{SOURCE}: heat: is missing; add a table [heat] with ambient.")
    return case.heat


def _value_of(case: Case, parameter: Literal["speed", "load"]) -> float:
    """Return the speed or the line load of a case. Raises CaseFileError where it is not given."""
    normal = case.nip.normal
    value = case.nip.speed if parameter == "speed" else getattr(normal, "load", None)
    if value is None:
        raise CaseFileError(
            f"{SOURCE}: nip.{parameter}: must be given to follow the steady states over it."
        )
    return float(value)


def _placed(error: InvalidInputError) -> CaseFileError:
    """Return the error with the path of the key that it names."""
    return at_its_key(error, lambda name: _PLACES.get(name, "heat"))
