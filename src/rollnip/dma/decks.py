"""Prony series in the formats of finite-element programs and pyvisco, read and written."""

from __future__ import annotations

import re
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Literal

from rollnip._errors import InvalidInputError
from rollnip._units import parse_quantity
from rollnip.dma.export import checked_name
from rollnip.dma.heads import bare_unit
from rollnip.io.cells import read_cells, read_text
from rollnip.io.columns import EXCEL
from rollnip.materials import WLF, Prony, Shift

Deck = Literal["abaqus", "ansys", "pyvisco"]

_NEARLY = 1e-6  # difference between shear and bulk ratios that is rounding
_INCOMPRESSIBLE = 0.49  # Poisson ratio from which the bulk modulus hardly affects E
_WRITTEN = 15  # digits of a ratio; the further ones of a float are rounding
_READ = 13  # digits of a modulus that ratios with so many determine
_NUMBER = re.compile(r"[+-]?(?:\d+\.?\d*|\.\d+)(?:[eEdD][+-]?\d+)?")


@dataclass(frozen=True, slots=True)
class ReadDeck:
    """A Prony series read from a deck.

    Attributes
    ----------
    material : the material, with its shift law, at the reference temperature, where the deck has
        one.
    format : format of the deck.
    notes : assumptions made in reading, in plain words.
    """

    material: Prony
    format: Deck
    notes: tuple[str, ...]


def prony_deck(material: Prony, to: Deck, name: str = "rubber") -> str:
    """Write a Prony series for Abaqus (keywords), Ansys (APDL) or pyvisco (CSV).

    Units are N, mm, MPa, s, degC. G and K have the same ratios, because the Poisson ratio of a
    material here does not relax. The terms are those at the reference temperature of the shift law,
    which is written too if it is WLF.

    Raises
    ------
    InvalidInputError
        where the format is unknown or the name is not valid in a deck.
    """
    checked_name(name)
    writers = {"abaqus": _abaqus, "ansys": _ansys, "pyvisco": _pyvisco}
    if to not in writers:
        raise InvalidInputError(f'`to` must be abaqus, ansys or pyvisco, got "{to}".')
    return "\n".join(writers[to](material, name)) + "\n"


def read_deck(
    path: str | Path, *, unit: str | None = None, poisson: float | None = None
) -> ReadDeck:
    """Read a Prony series from an Abaqus or Ansys deck, or a table of pyvisco.

    Parameters
    ----------
    path :
        path of the file; the format is recognised from its content.
    unit :
        unit of the moduli in a deck, such as "MPa", since decks carry none. Times are in seconds.
    poisson :
        Poisson ratio, where the file has none.

    Raises
    ------
    InvalidInputError
        where there is no Prony series, or a number or the unit is missing.
    """
    source = str(path)
    if Path(path).suffix.lower() in EXCEL:
        return _read_pyvisco(path, poisson)
    text = read_text(path)[0]
    upper = text.upper()
    if "*VISCOELASTIC" in upper:
        return _read_abaqus(text, source, _scale(unit, source), poisson)
    if re.search(r"^\s*TB\s*,\s*PRON", upper, re.MULTILINE):
        return _read_ansys(text, source, _scale(unit, source), poisson)
    if "TAU_I" in upper:
        return _read_pyvisco(path, poisson)
    raise InvalidInputError(
        f"{source}: must hold *VISCOELASTIC (Abaqus), TB,PRONY (Ansys) or a column tau_i (pyvisco)."
    )


def _abaqus(material: Prony, name: str) -> Iterator[str]:
    yield "** N, mm, MPa, s, degC"
    yield f"*MATERIAL, NAME={name}"
    yield "*ELASTIC, MODULI=LONG TERM"
    yield f"{material.modulus!r}, {material.poisson!r}"
    if material.poisson == 0.5:
        yield "** Poisson's ratio of 0.5: use hybrid elements"
    yield "*VISCOELASTIC, TIME=PRONY"
    for ratio, time in _ratios(material):
        yield f"{ratio!r}, {ratio!r}, {time!r}"
    if isinstance(material.shift, WLF):
        law = material.shift
        yield "*TRS, DEFINITION=WLF"
        yield f"{law.reference!r}, {law.c1!r}, {law.c2!r}"
    yield from (f"** {said}" for said in _left_out(material))


def _ansys(material: Prony, name: str) -> Iterator[str]:
    pairs = list(_ratios(material))
    yield f"! {name}: N, mm, MPa, s, degC"
    yield f"MP,EX,1,{_instantaneous(material)!r}    ! instantaneous"
    yield f"MP,PRXY,1,{material.poisson!r}"
    for part in ("SHEAR", "BULK"):
        yield f"TB,PRONY,1,1,{len(pairs)},{part}"
        for k, group in enumerate(pairs[i : i + 3] for i in range(0, len(pairs), 3)):
            numbers = ",".join(f"{ratio!r},{time!r}" for ratio, time in group)
            yield f"TBDATA,{6 * k + 1},{numbers}"
    if isinstance(material.shift, WLF):
        law = material.shift
        yield "TB,SHIFT,1,1,3,WLF"
        yield f"TBDATA,1,{law.reference!r},{law.c1!r},{law.c2!r}"
    yield from (f"! {said}" for said in _left_out(material))


def _pyvisco(material: Prony, _name: str) -> Iterator[str]:
    whole = _instantaneous(material)
    yield "i,tau_i,alpha_i,E_0,E_i"
    yield "-,s,-,MPa,MPa"
    for index, ((modulus, time), (ratio, _)) in enumerate(
        zip(material.terms, _ratios(material), strict=True), 1
    ):
        yield f"{index},{time!r},{ratio!r},{whole!r},{modulus!r}"


def _instantaneous(material: Prony) -> float:
    return _rounded(material.modulus + sum(modulus for modulus, _ in material.terms))


def _ratios(material: Prony) -> Iterator[tuple[float, float]]:
    whole = _instantaneous(material)
    yield from ((_rounded(modulus / whole), time) for modulus, time in material.terms)


def _rounded(computed: float, digits: int = _WRITTEN) -> float:
    """Return a computed number without the rounding of its last digits: 0.1, no 0.0999999999..."""
    return float(f"{computed:.{digits}g}")


def _left_out(material: Prony) -> Iterator[str]:
    law = material.shift
    if law is not None and not isinstance(law, WLF):
        yield f"the shift law is not written; the series holds at {law.reference:g} degC"
    if law is not None and law.vertical != "none":
        yield f"vertical shifts are not written; moduli are those at {law.reference:g} degC"


def _scale(unit: str | None, source: str) -> float:
    if unit is None:
        raise InvalidInputError(
            f'{source}: `unit` must say in which unit the moduli are, such as "MPa": a deck '
            "carries none."
        )
    return parse_quantity(f"1 {unit}", "pressure")


def _read_abaqus(text: str, source: str, scale: float, poisson: float | None) -> ReadDeck:
    options = list(_keywords(text))
    elastic = _one(options, "ELASTIC", source)
    series = _one(options, "VISCOELASTIC", source)
    if "PRONY" not in series[0].upper():
        raise InvalidInputError(
            f"{source}: *VISCOELASTIC must say TIME=PRONY or FREQUENCY=PRONY, got "
            f'"{series[0].strip()}".'
        )
    constants = elastic[1][0] if elastic[1] else []
    if not constants:
        raise InvalidInputError(f"{source}: *ELASTIC must have a line of constants.")
    given = constants[1] if len(constants) > 1 else poisson
    rows = [row for row in series[1] if len(row) >= 2]
    terms = [(row[0], row[-1] if len(row) == 2 else row[2]) for row in rows]
    bulk = [row[1] if len(row) > 2 else 0.0 for row in rows]
    instantaneous = "INSTANTANEOUS" in elastic[0].upper()
    notes = [] if "MODULI" in elastic[0].upper() else ["*ELASTIC says no MODULI: long term."]
    law = _abaqus_shift(options)
    return _deck_of_ratios(
        source, scale * constants[0], instantaneous, terms, bulk, given, law, "abaqus", notes
    )


def _abaqus_shift(options: Sequence[tuple[str, list[list[float]]]]) -> Shift | None:
    found = next((rows for line, rows in options if line.upper().startswith("*TRS")), None)
    line = next((line for line, _ in options if line.upper().startswith("*TRS")), "")
    if found and len(found[0]) >= 3 and ("DEFINITION" not in line.upper() or "WLF" in line.upper()):
        reference, c1, c2 = found[0][:3]
        return WLF(c1, c2, reference)
    return None


def _keywords(text: str) -> Iterator[tuple[str, list[list[float]]]]:
    """Yield keyword lines, without blanks, each with the numbers of the data lines below it."""
    line = ""
    rows: list[list[float]] = []
    for raw in text.splitlines():
        if raw.lstrip().startswith("**") or not raw.strip():
            continue
        if raw.lstrip().startswith("*"):
            if line:
                yield line, rows
            line, rows = raw.replace(" ", "").strip(), []
        else:
            rows.append([_float(cell) for cell in raw.split(",") if cell.strip()])
    if line:
        yield line, rows


def _one(
    options: Sequence[tuple[str, list[list[float]]]], keyword: str, source: str
) -> tuple[str, list[list[float]]]:
    found = [one for one in options if re.match(rf"\*{keyword}(,|$)", one[0], re.IGNORECASE)]
    if len(found) != 1:
        raise InvalidInputError(
            f"{source}: must hold *{keyword} once, has it {len(found)} times; keep one material."
        )
    return found[0]


def _read_ansys(text: str, source: str, scale: float, poisson: float | None) -> ReadDeck:
    modulus: float | None = None
    given = poisson
    pairs: dict[str, list[float]] = {"SHEAR": [], "BULK": []}
    wlf: list[float] = []
    into: list[float] | None = None
    for raw in text.splitlines():
        cells = [cell.strip() for cell in raw.split("!")[0].split(",")]
        head = cells[0].upper()
        if head in {"MP", "MPDATA"} and len(cells) > 3:
            value = next((c for c in reversed(cells) if _NUMBER.fullmatch(c)), "")
            if cells[1].upper() == "EX":
                modulus = _float(value)
            elif cells[1].upper() in {"PRXY", "NUXY"}:
                given = _float(value)
        elif head == "TB":
            into = _table(cells, pairs, wlf)
        elif head == "TBDATA" and into is not None:
            into += [_float(cell) for cell in cells[2:] if cell]
    if modulus is None:
        raise InvalidInputError(f"{source}: must hold MP,EX: the instantaneous modulus.")
    terms = list(zip(pairs["SHEAR"][::2], pairs["SHEAR"][1::2], strict=False))
    bulk = pairs["BULK"][::2] + [0.0] * len(terms)
    law = WLF(wlf[1], wlf[2], wlf[0]) if len(wlf) >= 3 else None
    return _deck_of_ratios(
        source, scale * modulus, True, terms, bulk[: len(terms)], given, law, "ansys", []
    )


def _table(
    cells: Sequence[str], pairs: dict[str, list[float]], wlf: list[float]
) -> list[float] | None:
    """Return the list that the TBDATA below a TB line fill; None for tables that are not read."""
    kind = cells[1].upper() if len(cells) > 1 else ""
    last = cells[5].upper() if len(cells) > 5 else ""
    if kind.startswith("PRON"):
        return pairs["BULK" if last.startswith("BULK") else "SHEAR"]
    if kind.startswith("SHIF") and last in {"WLF", "1"}:
        return wlf
    return None


def _read_pyvisco(path: str | Path, poisson: float | None) -> ReadDeck:
    source = str(path)
    rows = [row for sheet in read_cells(path).sheets for row in sheet.rows]
    heads = next(([str(c) for c in row] for row in rows if "tau_i" in row), [])
    kind = next((k for k in "EG" if f"{k}_0" in heads and "alpha_i" in heads), None)
    if kind is None:
        raise InvalidInputError(f"{source}: must have the columns tau_i, alpha_i and E_0 or G_0.")
    columns = [heads.index(name) for name in ("tau_i", "alpha_i", f"{kind}_0")]
    start = next(i for i, row in enumerate(rows) if "tau_i" in row) + 1
    short = next((row for row in rows[start:] if len(row) <= max(columns)), None)
    if short is not None:
        raise InvalidInputError(f"{source}: a row must have {len(heads)} cells, has {len(short)}.")
    unit = bare_unit(str(rows[start][columns[2]])) if start < len(rows) else ""
    scale = parse_quantity(f"1 {unit}", "pressure")
    values = [[_float(str(row[i])) for i in columns] for row in rows[start + 1 :]]
    if not values:
        raise InvalidInputError(f"{source}: must have a row for each term.")
    given = 0.5 if poisson is None and kind == "G" else poisson
    factor = 2.0 * (1.0 + (given or 0.0)) if kind == "G" else 1.0
    terms = [(ratio, time) for time, ratio, _ in values]
    ratios = [ratio for ratio, _ in terms]
    whole = factor * scale * values[0][2]
    return _deck_of_ratios(source, whole, True, terms, ratios, given, None, "pyvisco", [])


def _deck_of_ratios(
    source: str,
    modulus: float,
    instantaneous: bool,
    terms: Sequence[tuple[float, float]],
    bulk: Sequence[float],
    poisson: float | None,
    law: Shift | None,
    kind: Deck,
    notes: list[str],
) -> ReadDeck:
    """Return the material of ratios g_i = E_i/E_0, with E_inf = E_0 (1 - sum g_i)."""
    if poisson is None:
        raise InvalidInputError(f"{source}: `poisson` must be given: the file has none.")
    left = 1.0 - sum(ratio for ratio, _ in terms)
    if len(terms) > 1 and instantaneous and abs(left) < _NEARLY:
        # in tables of pyvisco the ratios add up to 1: the slowest term serves as the plateau
        slowest = max(range(len(terms)), key=lambda k: terms[k][1])
        left, time = terms[slowest]
        terms = [term for k, term in enumerate(terms) if k != slowest]
        bulk = [ratio for k, ratio in enumerate(bulk) if k != slowest]
        notes.append(
            "The ratios add up to 1, which leaves no relaxed modulus: that of the slowest term, "
            f"of {time:.3g} s, is taken for it. Much slower than that the material is too stiff."
        )
    if not terms or left <= 0.0:
        raise InvalidInputError(
            f"{source}: must hold ratios g_i that add up to less than 1, got {1.0 - left:.6g} of "
            f"{len(terms)} terms."
        )
    whole = modulus if instantaneous else modulus / left
    differ = any(abs(g - k) > _NEARLY for (g, _), k in zip(terms, bulk, strict=True))
    if differ and poisson < _INCOMPRESSIBLE:
        notes.append(
            "Shear and bulk relax differently in the file; here Poisson's ratio stays at "
            f"{poisson:g} and Young's modulus relaxes as the shear modulus does."
        )
    material = Prony(
        modulus=_rounded(whole * left, _READ),
        terms=tuple((_rounded(whole * ratio, _READ), time) for ratio, time in terms),
        poisson=poisson,
        temperature=None if law is None else law.reference,
        shift=law,
    )
    return ReadDeck(material, kind, tuple(notes))


def _float(text: str) -> float:
    if _NUMBER.fullmatch(text.strip()) is None:
        raise InvalidInputError(f'A number must stand where "{text.strip()}" stands in the deck.')
    return float(text.strip().replace("D", "E").replace("d", "e"))
