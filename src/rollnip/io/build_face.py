"""The builder of shafts, crowns, coverings and faces from tables of right form."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from functools import partial
from math import inf
from pathlib import Path
from typing import Any, TypeVar

from rollnip._errors import InvalidInputError, RollnipError
from rollnip.io.profile import read_covering, read_crown
from rollnip.io.tables_face import (
    CoveringTableTable,
    CrownTableTable,
    FaceTable,
    JournalStepTable,
    ShaftTable,
)
from rollnip.materials import Material
from rollnip.shafts import (
    CoveringTable,
    Crown,
    CrownTable,
    Face,
    JournalStep,
    PivotArm,
    Shaft,
)

T = TypeVar("T")


def face_of(table: FaceTable) -> Face:
    """Return the face of a table. Raises InvalidInputError."""
    return Face(
        length=table.length,
        skew=table.skew,
        end_loads=end_loads_of(table),
        bearing_offset=table.bearing_offset,
        nip_angle=table.nip_angle,
        sheet_across=table.sheet_across,
        ends=table.ends,
        end_radius=table.end_radius,
    )


def end_loads_of(table: FaceTable) -> tuple[float, float] | None:
    """Return the end loads [N] that a table gives, or that its arms make; None without either.

    Raises InvalidInputError where there are neither one nor two arms.
    """
    if table.arms is None:
        return None if table.end_loads is None else tuple(table.end_loads)  # type: ignore[return-value]
    if len(table.arms) not in (1, 2):
        raise InvalidInputError(f"`arms` must hold one arm or two, got {len(table.arms)}.")
    loads = [
        PivotArm(arm.bearing_lever, tuple((one.force, one.lever) for one in arm.forces)).end_load
        for arm in table.arms
    ]
    return loads[0], loads[-1]


def _step(table: JournalStepTable) -> JournalStep:
    return JournalStep(table.diameter, inf if table.length is None else table.length)


@dataclass(frozen=True, slots=True)
class ShaftBuilder:
    """Builds a shaft; a part that is refused is None and a line in errors.

    Attributes
    ----------
    made : calls a constructor and notes what it refuses, under a path.
    errors : lines so far.
    folder : where files are found; None: no file is read.
    material : of the outermost layer, for hardness; None without layers.
    """

    made: Callable[[str, Callable[[], Any]], Any]
    errors: list[str]
    folder: Path | None
    material: Material | None

    def shaft(self, path: str, table: ShaftTable | None) -> Shaft | None:
        """Return the shaft of a table; None where there is none, or where it was refused."""
        if table is None:
            return None
        before = len(self.errors)
        crown = Crown(0.0) if table.crown is None else self._crown(f"{path}.crown", table.crown)
        profiles = tuple(
            self._crown(f"{path}.profiles[{i}]", one) for i, one in enumerate(table.profiles)
        )
        journals = tuple(
            self._built(f"{path}.journals[{i}]", partial(_step, one))
            for i, one in enumerate(table.journals)
        )
        covering = self._covering(f"{path}.covering", table.covering)
        if len(self.errors) > before:
            return None
        values = table.model_dump(exclude={"crown", "profiles", "journals", "covering", "modulus"})
        if table.modulus is not None:
            values["modulus"] = table.modulus
        parts: dict[str, Any] = {
            "crown": crown,
            "profiles": profiles,
            "journals": journals,
            "covering": covering,
        }
        shaft: Shaft | None = self.made(path, lambda: Shaft(**values, **parts))
        return shaft

    def _crown(self, path: str, table: float | CrownTableTable) -> Crown | CrownTable | None:
        if isinstance(table, float):
            return self._built(path, lambda: Crown(table))
        listed = table.y is not None or table.diameter is not None
        if (table.height is not None) + (table.file is not None) + listed != 1:
            self.errors.append(f"{path}: must hold either height or file, or y and diameter.")
            return None
        if table.height is not None:
            height, shape = table.height, table.shape
            return self._built(path, lambda: Crown(height, shape))
        if table.file is not None:
            return self._read(path, table.file, read_crown)
        y, diameter = table.y or [], table.diameter or []
        return self._built(path, lambda: CrownTable(y, diameter))

    def _covering(self, path: str, table: CoveringTableTable | None) -> CoveringTable | None:
        if table is None:
            return None
        listed = table.y is not None
        if listed == (table.file is not None):
            self.errors.append(f"{path}: must hold either file, or y with thickness or stiffness.")
            return None
        if table.file is not None:
            material = self.material
            return self._read(path, table.file, lambda file: read_covering(file, material))
        y = table.y or []
        return self._built(path, lambda: CoveringTable(y, table.thickness, table.stiffness))

    def _built(self, path: str, make: Callable[[], T]) -> T | None:
        part: T | None = self.made(path, make)
        return part

    def _read(self, path: str, name: str, read: Callable[[Path], T]) -> T | None:
        if self.folder is None:
            self.errors.append(f"{path}: names a file, which is read for a case file alone.")
            return None
        try:
            return read(self.folder / name)
        except RollnipError as error:
            self.errors.append(f"{path}: {error}")
            return None
