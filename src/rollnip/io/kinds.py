"""What a file is: a case, a result, or a study of some command, told by its keys."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any, Literal

from rollnip._errors import CaseFileError

FileKind = Literal["case", "patch case", "sweep", "optimise", "tolerance", "fit", "result"]

_IS = {
    "case": "is a case",
    "patch case": "is a case of a patch",
    "sweep": "is a study for `rollnip sweep`",
    "optimise": "is a study for `rollnip optimise`",
    "tolerance": "is a study for `rollnip tolerance`",
    "fit": "is a fit file for `rollnip fit`",
    "result": "is a result",
}
_WANTED = {
    "case": "a case is needed, with [nip], [upper] and [lower]",
    "sweep": "a study names it with `case` and holds [[parameters]]",
    "optimise": (
        "a study of an optimum names it with `case` and holds [[parameters]] and [objective]"
    ),
    "tolerance": "a study of tolerances names it with `case` and holds [[parameters]] or `fit`",
    "fit": "a fit file names it with `case` and holds [[unknowns]] and [[data]]",
}


def require_kind(
    tree: Mapping[str, Any],
    source: str,
    wanted: Literal["case", "sweep", "optimise", "tolerance", "fit"],
) -> None:
    """Raise CaseFileError where a file is clearly of another kind than the one wanted.

    Its keys tell; what has keys of both kinds, or of none, is left to the check of its form.

    Parameters
    ----------
    tree : of the file.
    source : its name, for the message.
    wanted : what the command reads; "case" takes those of patches, too.
    """
    kind = _kind(tree)
    if kind is None or kind == wanted or (kind, wanted) == ("patch case", "case"):
        return
    text = _WANTED[wanted]
    if not kind.endswith("case"):
        text = text.replace(" names it with ", " names a case with ")
    raise CaseFileError(f"{source}: {_IS[kind]}; {text}.")


def _kind(tree: Mapping[str, Any]) -> FileKind | None:
    """Return the kind of a file; None where its keys do not tell it."""
    keys = set(tree)
    if {"schema", "converged"} <= keys:
        return "result"
    is_study, is_case = "case" in keys, bool(keys & {"nip", "upper", "lower", "patch"})
    found: FileKind | None = None
    if is_case and not keys & {"case", "parameters", "unknowns", "data", "objective", "fit"}:
        found = "patch case" if "patch" in keys else "case"
    elif is_study and not is_case:
        found = _kind_of_study(tree)
    return found


def _kind_of_study(tree: Mapping[str, Any]) -> FileKind | None:
    """Return the kind of a file that names a case; None where it might be several."""
    if "unknowns" in tree or "data" in tree:
        return "fit"
    if "objective" in tree:
        return "optimise"
    scatters = any("distribution" in one for one in _tables(tree.get("parameters")))
    if scatters or "correlations" in tree or "fit" in tree:
        return "tolerance"
    steps = any({"values", "start", "table"} & set(one) for one in _tables(tree.get("parameters")))
    return "sweep" if steps else None


def _tables(value: Any) -> list[Mapping[str, Any]]:
    return [one for one in value if isinstance(one, Mapping)] if isinstance(value, list) else []
