"""Case files: reading one from a path or a text, and what identifies it."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from rollnip._results.case import problem_hash
from rollnip.cooling import HeatBalance
from rollnip.io.build import Builder
from rollnip.io.document import folder_of, read_document, tree_of
from rollnip.io.kinds import require_kind
from rollnip.io.messages import checked_form, refuse, wrong_controls
from rollnip.io.tables import TABLES, CaseTable
from rollnip.model import Model
from rollnip.nip import Nip
from rollnip.shafts import Face


@dataclass(frozen=True, slots=True, kw_only=True)
class Case:
    """A case file as read.

    Attributes
    ----------
    nip :
        the problem.
    model :
        the model of the geometry and the tolerance.
    source :
        the file's name.
    face :
        the nip along its rollers; None where the case has no such table.
    heat :
        where its heat goes; None where the case has no such table.
    """

    nip: Nip
    model: Model
    source: str
    face: Face | None = None
    heat: HeatBalance | None = None


def read_case(path: str | Path) -> Case:
    """Read a case file, TOML or JSON, and the measured profiles that it names.

    Parameters
    ----------
    path :
        the file; ``-`` is the standard input. Profiles are looked for in its folder.

    Raises
    ------
    CaseFileError
        where the file cannot be read or does not describe a nip; one line for each error, with
        the name of the file and the path of the key.
    """
    tree = read_document(path, hint="`rollnip.io.parse_case` takes a tree")
    return built_case(tree, str(path), folder_of(path))


def parse_case(case: str | Mapping[str, Any], *, source: str = "case") -> Case:
    """Read a case from a text (TOML or JSON) or from the tree that such a text holds.

    ``source`` names it in messages. Raises CaseFileError as `read_case` does, and where the case
    names a file: none is ever read.
    """
    return built_case(tree_of(case, source), source, folder=None)


def built_case(tree: dict[str, Any], source: str, folder: Path | None) -> Case:
    """Return the case that a tree holds; ``folder`` is where the files it names are."""
    builder = Builder(_checked(tree, source), folder)
    nip, model, face = builder.nip(), builder.model(), builder.face()
    heat = builder.heat()
    if nip is None or model is None or builder.errors:
        refuse(source, builder.errors)
    return Case(nip=nip, model=model, source=source, face=face, heat=heat)


def case_hash(case: Case) -> str:
    """Return the hash of a case: 16 hexadecimal digits of the problem and the model.

    The hash depends on the values in base units, not on how they were written, and not on the
    title, the name of the file or the version of rollnip.
    """
    return problem_hash(case.nip, case.model, case.face, case.heat)


def case_schema(*, ref: str = "#/$defs/{model}") -> dict[str, Any]:
    """JSON schema of the case file, for editors and other programs.

    ``ref`` says how its parts refer to each other, for a schema that holds it.
    """
    return CaseTable.model_json_schema(ref_template=ref)


def _checked(tree: dict[str, Any], source: str) -> CaseTable:
    if "patch" in tree:
        line = (
            "patch: is a table of cases in three dimensions; use `rollnip solve` or `rollnip patch`"
        )
        refuse(source, [f"{line}, in Python `rn.read_patch_case`."])
    require_kind(tree, source, "case")
    return checked_form(tree, source, CaseTable, TABLES, wrong_controls(tree))
