"""The commands ``dma show`` and ``dma convert``: files of instruments and of other programs."""

from __future__ import annotations

import sys
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from rollnip._errors import InvalidInputError
from rollnip._files import one_run
from rollnip._json import json_text
from rollnip.cli.console import clear_failures, read_option, warn
from rollnip.cli.options import Force, Frequency, InstrumentFile, Sheet, Temperature

if TYPE_CHECKING:
    from rollnip.materials import Prony


def show(
    file: InstrumentFile,
    temperature: Temperature = None,
    frequency: Frequency = None,
    sheet: Sheet = None,
    json: Annotated[
        bool, typer.Option("--json", help="Print the same as JSON, ranges in base units.")
    ] = False,
) -> None:
    """Print how a file is understood: tables, columns, units, ranges, and what is left out."""
    with clear_failures():
        from rollnip.dma import read_tables

        reading = read_tables(
            file,
            temperature=read_option("--temperature", temperature, "temperature"),
            frequency=read_option("--frequency", frequency, "frequency"),
            sheet=sheet,
        )
        text = json_text(reading.as_dict()) + "\n"
        sys.stdout.write(text if json else reading.text())
        sys.stdout.flush()


def convert(
    file: Annotated[
        Path,
        typer.Argument(help="Abaqus or Ansys deck, table of pyvisco, or a case or material, TOML."),
    ],
    to: Annotated[
        str,
        typer.Option(help="Format: toml (for [materials] of a case), abaqus, ansys or pyvisco."),
    ] = "toml",
    out: Annotated[
        Path | None, typer.Option(help="Write the result to this file; by default, print it.")
    ] = None,
    name: Annotated[
        str, typer.Option(help="Name of the material, in TOML or in the deck.")
    ] = "rubber",
    unit: Annotated[
        str | None, typer.Option(help="Unit of the moduli of a deck, such as MPa; times are in s.")
    ] = None,
    poisson: Annotated[
        float | None, typer.Option(help="Poisson's ratio, where the file has none.")
    ] = None,
    force: Force = False,
) -> None:
    """Convert a Prony series from the format of one program to that of another.

    What another program cannot hold is said in comments; warnings go to the standard error.
    """
    with clear_failures(), one_run(force=force) as run:
        from rollnip._files import check_place, write_whole
        from rollnip.dma import material_keys, prony_deck, read_deck
        from rollnip.dma.export import checked_name

        if to not in ("toml", "abaqus", "ansys", "pyvisco"):
            raise InvalidInputError(
                f'`--to` must be one of toml, abaqus, ansys, pyvisco, got "{to}".'
            )
        checked_name(name)
        if out is not None:
            check_place(out)
        notes: tuple[str, ...] = ()
        if file.suffix.lower() in (".toml", ".json"):
            material = _of_case(file, name)
        else:
            deck = read_deck(file, unit=unit, poisson=poisson)
            material, notes = deck.material, deck.notes
        run.reserve({"--out": out})
        if to == "toml":
            text = "\n".join([f"[materials.{name}]", *material_keys(material)]) + "\n"
        else:
            text = prony_deck(material, to, name)  # type: ignore[arg-type]
        if out is None:
            sys.stdout.write(text)
        else:
            write_whole(out, lambda target: target.write_text(text, "utf-8"))
        sys.stdout.flush()
        warn(notes)


def _of_case(file: Path, name: str) -> Prony:
    """The material of a case file, or of one that holds [materials] alone, as a Prony series."""
    from rollnip._errors import CaseFileError
    from rollnip.io import parse_case
    from rollnip.io.document import read_document
    from rollnip.materials import Prony, StandardLinearSolid

    materials = read_document(file).get("materials", {})
    if not isinstance(materials, dict) or name not in materials:
        known = ", ".join(materials) if isinstance(materials, dict) else ""
        raise CaseFileError(
            f"{file}: must hold a material named `{name}`, has {known or 'none'}; see --name."
        )
    bare = {"radius": 50.0, "layers": [{"thickness": 1.0, "material": name}]}
    tree = {
        "nip": {"load": 1.0, "friction": 0.5, "speed": 1.0},
        "upper": bare,
        "lower": {"radius": 50.0},
        "materials": {name: materials[name]},
    }
    material = parse_case(tree, source=str(file)).nip.upper.layers[0].material
    if isinstance(material, StandardLinearSolid):
        return Prony(
            modulus=material.modulus,
            terms=((material.stiffening, material.relaxation_time),),
            poisson=material.poisson,
            temperature=material.temperature,
            shift=material.shift,
        )
    if not isinstance(material, Prony):
        raise InvalidInputError(
            f"{file}: materials.{name} must be a Prony series or a standard linear solid, got "
            f"{type(material).__name__}."
        )
    return material
