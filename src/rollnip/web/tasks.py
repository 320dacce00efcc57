"""The tasks of the workers: from the body of a request to the body of the answer."""

from __future__ import annotations

import logging
from collections.abc import Callable, Mapping
from itertools import pairwise
from math import isfinite
from typing import Any

import numpy as np
from numpy.typing import NDArray

from rollnip._errors import CaseFileError, InvalidInputError, RollnipError
from rollnip._json import json_bytes
from rollnip._units import Dimension, base_unit, parse_quantity
from rollnip.design import find
from rollnip.influence import KernelCache
from rollnip.io import (
    Case,
    base_tree,
    case_hash,
    case_parts,
    case_python,
    case_toml,
    dimension_at,
    parse_case,
    result_dict,
    units_of,
    with_values,
)
from rollnip.io.document import parse_document
from rollnip.materials import Prony
from rollnip.rollers import Roller
from rollnip.solution import Solution
from rollnip.solver import solve
from rollnip.sweeps import scalars
from rollnip.web.answers import SOURCE, Reply, as_json, at_keys, error_tree, refusal
from rollnip.web.faces import Faces
from rollnip.web.heats import Heats
from rollnip.web.impressions import read_impression
from rollnip.web.kept import Kept
from rollnip.web.known import accuracy, at_end, bands, is_judged, spread
from rollnip.web.library import Library
from rollnip.web.limits import Limits
from rollnip.web.patches import solved_patch

Body = Mapping[str, Any]
Array = NDArray[np.float64]

_log = logging.getLogger(__name__)
_KEPT = 4  # solutions; the page asks for surfaces and interior of the nip it has just solved
_FIELDS = {
    "u_x": "u_x",
    "u_z": "u_z",
    "s_xx": "s_xx",
    "s_zz": "s_zz",
    "s_xz": "s_xz",
    "mises": "von_mises",
    "max_shear": "max_shear",
}
_DIGITS = 6  # significant digits, by the largest value of an interior field
_CORE_DEPTH = 2.0  # nip widths below the layers that are shown of a half-space core
_TOO_LARGE = (
    "One solve may take {} MB of memory here, and this case needs more; try fewer layers or a "
    "larger tolerance."
)
_TOO_FAR = "The numbers of this case lie too far apart to be computed with; check their units."
_SMALLEST, _LARGEST = 1e-6, 1e9  # limits of radius and thickness that are solved here [mm]
_BELOW = 1e-9  # of a layer: how far below its upper face its first row lies


class Tasks:
    """The tasks by name, and the last solutions, so that a second question needs no solve.

    Parameters
    ----------
    limits :
        limits of layers, terms and accuracy.
    """

    def __init__(self, limits: Limits) -> None:
        self._limits = limits
        self._kept: Kept[Solution] = Kept(_KEPT)
        self._kernels = KernelCache()
        self._faces = Faces(self._kernels)
        self._heats = Heats(self._kernels)
        self._library: Library | None = None
        self._tasks: dict[str, Callable[[Body], Reply]] = {
            "solve": self._solve,
            "surfaces": self._surfaces,
            "interior": self._interior,
            "value": self._value,
            "find": self._find,
            "known": self._known,
            "face": self._face,
            "crown": self._crown,
            "heat": self._heat,
            "warm-up": self._warm_up,
            "runaway": self._runaway,
            "patch": self._patch,
            "impression": self._impression,
            "case": self._case,
            "toml": self._toml,
        }

    def run(self, name: str, body: Body) -> Reply:
        """Compute one answer; an error of the client is a refusal, one of ours goes to the log."""
        try:
            return self._tasks[name](body)
        except RollnipError as error:
            return Reply(422, json_bytes(refusal(error)))
        except MemoryError:
            return Reply(422, json_bytes(error_tree(_TOO_LARGE.format(self._limits.memory))))
        except (ArithmeticError, np.linalg.LinAlgError) as error:
            _log.warning("Task %r ended in %r.", name, error)
            return Reply(422, json_bytes(error_tree(_TOO_FAR)))
        except Exception:  # noqa: BLE001 - the next task must find the worker as it was
            _log.exception("Task %r failed.", name)
            text = "The solver failed on this case in a way it should not; please report it."
            return Reply(500, json_bytes(error_tree(text)))

    def _solve(self, body: Body) -> Reply:
        case = self._read(body["case"])
        tree = result_dict(self._solution(case), interfaces=body["interfaces"])
        if body.get("whole"):
            along = None if case.face is None else self._faces.solution(case)
            warm = None if case.heat is None else self._heats.solution(case)
            tree |= case_parts(along, warm)
        tree["title"] = case.nip.title  # the hash leaves it out, so a kept solution has another
        return Reply(200, json_bytes(tree), case_hash(case))

    def _surfaces(self, body: Body) -> Reply:
        case = self._read(body["case"])
        surfaces = self._solution(case).deformed_surfaces
        x = surfaces.x.tolist()
        tree = {
            "upper": {"x": x, "z": _numbers(surfaces.upper)},
            "lower": {"x": x, "z": _numbers(surfaces.lower)},
        }
        return Reply(200, json_bytes(tree), case_hash(case))

    def _interior(self, body: Body) -> Reply:
        case = self._read(body["case"])
        name = body["roller"]
        roller = case.nip.upper if name == "upper" else case.nip.lower
        if roller.is_rigid:
            raise CaseFileError(f"{SOURCE}: roller: must deform, the {name} one is bare and rigid.")
        solution = self._solution(case)
        trailing, leading = solution.contact[0][0], solution.contact[-1][1]
        width = leading - trailing
        x = _rounded(np.linspace(trailing - width, leading + width, body["nx"]))
        field = solution.interior(name, _rows(roller, width, body["nz"]), x)
        values = {key: getattr(field, name) for key, name in _FIELDS.items()}
        if roller.is_viscoelastic:
            values["loss"] = field.loss_density
        tree: dict[str, Any] = {"x": _numbers(x), "z": _numbers(field.z)}
        tree |= {key: _numbers(_rounded(value)) for key, value in values.items()}
        tree["layer"] = field.layer.tolist()
        tree["interfaces"] = list(roller.interfaces)
        tree["finite_strain"] = field.is_finite
        return Reply(200, json_bytes(tree), case_hash(case))

    def _value(self, body: Body) -> Reply:
        """One value of a sweep; a case that cannot be solved is an error in its row."""
        path, dimension = body["path"], _dimension(body["case"], body["path"])
        tree: dict[str, Any] = {"unit": base_unit(dimension), "value": None}
        try:
            tree["value"] = parse_quantity(body["value"], dimension, infinite=True)
            tree["result"] = _flat(self._row(with_values(body["case"], {path: tree["value"]})))
        except RollnipError as error:
            tree["result"] = {"error": refusal(error)["error"]}
        if tree["value"] is not None and not isfinite(tree["value"]):
            tree["value"] = "inf"
        return Reply(200, json_bytes(tree))

    def _find(self, body: Body) -> Reply:
        case = self._read(body["case"])
        _dimension(body["case"], body["path"])
        names = ("case", "path", "quantity", "wanted", "low", "high")
        found = find(*(body[name] for name in names), evaluate=self._row_or_message)
        tree = {
            "found": found.value is not None,
            "value": found.value,
            "unit": found.unit,
            "error": found.error,
            "others": list(found.others),
            "quantity": found.quantity,
            "wanted": found.wanted,
            "points": [list(point) for point in found.points],
            "result": _flat(found.scalars),
            "message": found.message,
        }
        return Reply(200, json_bytes(tree), case_hash(case))

    def _known(self, body: Body) -> Reply:
        """Accuracy of the model, and the figures at both ends of the bands of the materials."""
        case = self._read(body["case"])
        solution = self._solution(case)
        base = base_tree(body["case"])
        self._library = self._library or Library.read()
        found = bands(base, self._library.materials, body["measured"])
        answer: dict[str, Any] = {
            "geometry": solution.model.geometry,
            "accuracy": accuracy(solution),
            "is_judged": is_judged(solution),
            "materials": [band._asdict() for band in found],
            "figures": {},
            "message": "",
        }
        if found:
            try:
                ends = [_flat(self._sound_row(at_end(base, found, end))) for end in ("low", "high")]
                answer["figures"] = spread(_flat(scalars(solution)), *ends)
            except RollnipError as error:
                answer["message"] = refusal(error)["error"]
        return Reply(200, json_bytes(answer), case_hash(case))

    def _face(self, body: Body) -> Reply:
        case = self._read(body["case"])
        return Reply(200, json_bytes(self._faces.face(case)), case_hash(case))

    def _crown(self, body: Body) -> Reply:
        case = self._read(body["case"])
        tree = self._faces.crown(case, body["roller"], body["within"])
        return Reply(200, json_bytes(tree), case_hash(case))

    def _heat(self, body: Body) -> Reply:
        case = self._read(body["case"])
        return Reply(200, json_bytes(self._heats.steady(case)), case_hash(case))

    def _warm_up(self, body: Body) -> Reply:
        case = self._read(body["case"])
        return Reply(200, json_bytes(self._heats.warm_up(case)), case_hash(case))

    def _runaway(self, body: Body) -> Reply:
        case = self._read(body["case"])
        tree = self._heats.runaway(case, body["parameter"])
        return Reply(200, json_bytes(tree), case_hash(case))

    def _patch(self, body: Body) -> Reply:
        return Reply(200, json_bytes(solved_patch(body["case"], self._limits)))

    def _impression(self, body: Body) -> Reply:
        case = self._read(body["case"])
        return Reply(200, json_bytes(read_impression(case, body)), case_hash(case))

    def _sound_row(self, tree: Body) -> dict[str, Any]:
        """The scalars of a case's solution. Raises CaseFileError where it did not converge."""
        row = self._row(tree)
        if not row["converged"]:
            raise CaseFileError(f"{SOURCE}: at an end of the band there is no converged solution.")
        return row

    def _case(self, body: Body) -> Reply:
        tree = body["case"]
        case = self._read(tree)
        base = base_tree(tree)
        answer = {
            "hash": case_hash(case),
            "toml": case_toml(tree),
            "python": case_python(case),
            "case": base,
            "units": units_of(base),
        }
        return Reply(200, json_bytes(answer), case_hash(case))

    def _toml(self, body: Body) -> Reply:
        tree = as_json(parse_document(body["text"], SOURCE))
        if _depth(tree) > self._limits.depth:
            raise CaseFileError(f"{SOURCE}: is nested too deeply for a case file.")
        return Reply(200, json_bytes({"case": tree}))

    def _row(self, tree: Body) -> dict[str, Any]:
        """The scalars of a case's solution, and its warnings."""
        solution = self._solution(self._read(tree))
        return scalars(solution) | {"warnings": list(solution.warnings)}

    def _row_or_message(self, tree: Body) -> dict[str, Any]:
        try:
            return self._row(tree)
        except RollnipError as error:
            return {"converged": False, "message": refusal(error)["error"]}

    def _read(self, tree: Body) -> Case:
        """The case, where it keeps to the limits and names no file of this machine."""
        for name in ("upper", "lower"):
            roller = tree.get(name)
            if isinstance(roller, dict) and roller.get("profile") is not None:
                raise CaseFileError(
                    f"{SOURCE}: {name}.profile: must be left out here: the server reads no files."
                )
        case = parse_case(tree, source=SOURCE)
        lines = _beyond(case, self._limits)
        if lines:
            raise CaseFileError("\n".join(f"{SOURCE}: {line}" for line in lines))
        return case

    def _solution(self, case: Case) -> Solution:
        key = case_hash(case)
        if (kept := self._kept.get(key)) is not None:
            return kept
        with at_keys():
            return self._kept.put(key, solve(case.nip, case.model, cache=self._kernels))


def _dimension(tree: Body, path: str) -> Dimension:
    """Return the dimension of the quantity at a path of a case."""
    try:
        dimension = dimension_at(tree, path)
    except InvalidInputError as error:
        raise CaseFileError(f"{SOURCE}: path: {error}") from None
    if dimension is None:
        raise CaseFileError(f"{SOURCE}: path: must lead to a number, got {path!r}.")
    return dimension


def _flat(row: Mapping[str, Any]) -> dict[str, Any]:
    """The scalars of a result under names without points: ``dissipation_friction``, ..."""
    return {name.replace(".", "_"): value for name, value in row.items()}


def _beyond(case: Case, limits: Limits) -> list[str]:
    """Return lines about what exceeds the limits of the server."""
    lines = []
    for name, roller in (("upper", case.nip.upper), ("lower", case.nip.lower)):
        lines += _absurd(name, roller)
        if len(roller.layers) > limits.layers:
            lines.append(
                f"{name}.layers: must be at most {limits.layers} here, got {len(roller.layers)}."
            )
        for material in roller.materials:
            if isinstance(material, Prony) and len(material.terms) > limits.terms:
                lines.append(
                    f"{name}.layers: a Prony series must have at most {limits.terms} terms here, "
                    f"got {len(material.terms)}."
                )
    if case.model.tolerance < limits.tolerance:
        lines.append(
            f"solver.tolerance: must be at least {limits.tolerance:g} here, "
            f"got {case.model.tolerance:g}."
        )
    return lines


def _absurd(name: str, roller: Roller) -> list[str]:
    """Return lines about sizes that no roller has; numbers beyond them overflow."""
    sizes = [(f"{name}.radius", roller.radius)] if isfinite(roller.radius) else []
    sizes += [
        (f"{name}.layers[{i}].thickness", layer.thickness) for i, layer in enumerate(roller.layers)
    ]
    return [
        f"{path}: must lie between {_SMALLEST:g} mm and {_LARGEST:g} mm here, got {size:g}."
        for path, size in sizes
        if not _SMALLEST <= size <= _LARGEST
    ]


def _rows(roller: Roller, width: float, count: int) -> Array:
    """Depths of an interior field, (about count,): all layers, both sides of every interface."""
    faces = [0.0, *roller.interfaces]
    if roller.core is not None:
        faces.append(faces[-1] + _CORE_DEPTH * width)
    pieces = []
    for top, bottom in pairwise(faces):
        share = (bottom - top) / (faces[-1] - faces[0])
        piece = np.linspace(top, bottom, max(3, round(share * count)))
        if top > 0.0:
            piece[0] += _BELOW * (bottom - top)
        pieces.append(piece)
    return np.concatenate(pieces)


def _rounded(values: Array) -> Array:
    """Return the numbers rounded to six digits of the largest: a third of the text."""
    largest = float(np.max(np.abs(values), initial=0.0, where=np.isfinite(values)))
    if largest == 0.0:
        return values
    return np.round(values, int(_DIGITS - np.floor(np.log10(largest)) - 1))


def _numbers(values: Array) -> Any:
    """Return nested lists; None where a value is not finite."""
    if np.all(np.isfinite(values)):
        return values.tolist()
    out = values.astype(object)
    out[~np.isfinite(values)] = None
    return out.tolist()


def _depth(value: Any) -> int:
    """Return how deep tables and lists are nested in a value."""
    parts = value.values() if isinstance(value, dict) else value if isinstance(value, list) else ()
    return 1 + max(map(_depth, parts), default=-1) if isinstance(value, dict | list) else 0
