"""The reservation: a record of what a user should know about a result that stands."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass, field, replace

from rollnip.rollers import Side


@dataclass(frozen=True, slots=True)
class Reservation:
    """A reservation on a result: its kind, its numbers and the sentence that states them.

    Attributes
    ----------
    kind : one name for all reservations that differ only in their numbers, such as
        "far_temperature".
    sentence :
        template of its text for `str.format`: ``{where}`` is the place, ``{side}`` the roller, and
        the other names are keys of ``figures``.
    figures : what the template names: numbers, or words such as the name of a law.
    side : the roller concerned; None where it concerns the whole nip.
    material : number of the material concerned, counted from the surface of that roller; None where
        it concerns no single material.
    excess : the quantity that is over its limit, divided by that limit; 0 where there is no limit.
    advice : a sentence that recommends a geometry without this fault; empty where there is none.
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
        """The roller or the material concerned, in the words that begin the sentence."""
        if self.material is None:
            return f"The {self.side} roller"
        return f"Material {self.material} (from the surface) of the {self.side} roller"

    @property
    def text(self) -> str:
        """The sentence with its numbers filled in, followed by the advice."""
        said = self.sentence.format(**self.figures, where=self.where, side=self.side)
        return f"{said} {self.advice}".rstrip()


def texts(reservations: Iterable[Reservation]) -> tuple[str, ...]:
    """Return the sentences of reservations, as results list them under `warnings`."""
    return tuple(one.text for one in reservations)


def instead_of(left: Sequence[tuple[str, str]], geometry: str) -> tuple[Reservation, ...]:
    """Return the reservations that say which geometries had no solution, and which one was solved.

    Parameters
    ----------
    left : the geometries without a solution, in the order tried, each with the reason.
    geometry : the one that was solved.
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
    """Return reservations without the advice to use a geometry that was tried in vain."""
    said = tuple(reservations)
    left = {one.figures["geometry"] for one in said if one.kind == "other_geometry"}
    return tuple(replace(one, advice="") if "finite" in left else one for one in said)
