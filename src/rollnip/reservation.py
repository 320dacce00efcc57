"""The reservation: what a user should know of a result that stands, as a record."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass, field, replace

from rollnip.rollers import Side


@dataclass(frozen=True, slots=True)
class Reservation:
    """A reservation on a result: its kind, its figures and the sentence that says them.

    Attributes
    ----------
    kind : one name for all that say the same of other figures, such as "far_temperature".
    sentence :
        its text for any figures, as `str.format` takes it: ``{where}`` is the place, ``{side}``
        the roller, the other names are those of ``figures``.
    figures : what the sentence names: numbers, or words such as the name of a law.
    side : the roller it is about; None where it is about the nip.
    material : number of the material from the surface of that roller; None where it is about none.
    excess : what is over its limit, over that limit; 0 where there is no limit.
    advice : a sentence on a geometry without this fault; empty where there is none.
    """

    kind: str
    sentence: str
    figures: Mapping[str, float | str] = field(default_factory=dict)
    side: Side | None = None
    material: int | None = None
    excess: float = 0.0
    advice: str = ""

    @property
    def where(self) -> str:
        """The roller or the material that the sentence is about, as a sentence begins with it."""
        if self.material is None:
            return f"The {self.side} roller"
        return f"Material {self.material} (from the surface) of the {self.side} roller"

    @property
    def text(self) -> str:
        """The sentence with its figures, and the advice."""
        said = self.sentence.format(**self.figures, where=self.where, side=self.side)
        return f"{said} {self.advice}".rstrip()


def texts(reservations: Iterable[Reservation]) -> tuple[str, ...]:
    """Return the sentences of reservations, as results show them under `warnings`."""
    return tuple(one.text for one in reservations)


def instead_of(left: Sequence[tuple[str, str]], geometry: str) -> tuple[Reservation, ...]:
    """Return reservations that say which geometries had no solution, and which is solved.

    Parameters
    ----------
    left : geometries without a solution, the first tried first, each with the reason.
    geometry : the one that is solved.
    """
    none = 'No solution of geometry "{geometry}" was found: {cause}.'
    solved = ' All figures are those of geometry "{solved}".'
    return tuple(
        Reservation(
            "other_geometry",
            none if number < len(left) else none + solved,
            {"geometry": one, "cause": cause, "solved": geometry},
        )
        for number, (one, cause) in enumerate(left, start=1)
    )


def consistent(reservations: Iterable[Reservation]) -> tuple[Reservation, ...]:
    """Return reservations without the advice to take a geometry that had no solution."""
    said = tuple(reservations)
    left = {one.figures["geometry"] for one in said if one.kind == "other_geometry"}
    return tuple(replace(one, advice="") if "finite" in left else one for one in said)
