"""What the workers compute: from the body of a request to the body of the answer."""

from __future__ import annotations

from collections import OrderedDict
from collections.abc import Callable
from typing import Any

from rollnip._errors import RollnipError
from rollnip.io import Case, parse_case, result_text
from rollnip.solution import Solution
from rollnip.solve import solve
from rollnip.web.answers import SOURCE, Reply, json_bytes, refusal

_KEPT = 4  # solutions; the page asks for surfaces and interior of the nip it has just solved


class Tasks:
    """The tasks by name, and the last solutions, so that a second question needs no solve."""

    def __init__(self) -> None:
        self._kept: OrderedDict[Any, Solution] = OrderedDict()
        self._tasks: dict[str, Callable[[dict[str, Any]], Reply]] = {
            "solve": self._solve,
            "case": self._case,
        }

    def run(self, name: str, body: dict[str, Any]) -> Reply:
        """Compute one answer; what a client can cause is a refusal, never an exception."""
        try:
            return self._tasks[name](body)
        except RollnipError as error:
            return Reply(422, json_bytes(refusal(error)))

    def _solve(self, body: dict[str, Any]) -> Reply:
        case = parse_case(body["case"], source=SOURCE)
        return Reply(200, result_text(self._solution(case)).encode())

    def _case(self, body: dict[str, Any]) -> Reply:
        parse_case(body["case"], source=SOURCE)
        return Reply(200, json_bytes({"case": body["case"]}))

    def _solution(self, case: Case) -> Solution:
        key = (case.nip, case.model)
        if key in self._kept:
            self._kept.move_to_end(key)
            return self._kept[key]
        solution = solve(case.nip, case.model)
        self._kept[key] = solution
        if len(self._kept) > _KEPT:
            self._kept.popitem(last=False)
        return solution
