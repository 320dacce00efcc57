"""The commands ``dma``: from dynamic-mechanical data to a material."""

from __future__ import annotations

import sys
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

import typer

from rollnip._errors import InvalidInputError, require_finite
from rollnip._files import one_run
from rollnip._json import json_text
from rollnip.cli.console import clear_failures, named, named_by, read_option, warn
from rollnip.cli.dma_files import convert, show
from rollnip.cli.options import Force, Frequency, InstrumentFile, Sheet, Temperature

if TYPE_CHECKING:
    from rollnip.dma import DmaData, DmaFit, DmaMethod, TimeData, TimeFit

dma = typer.Typer(
    name="dma",
    help="Dynamic-mechanical data: master curve and material.",
    add_completion=False,
    rich_markup_mode=None,
    no_args_is_help=True,
)


_OPTIONS = {
    "model": "--model",
    "shift": "--shift",
    "reference": "--reference",
    "vertical": "--vertical",
    "terms": "--terms",
    "poisson": "--poisson",
    "c1": "--c1",
    "c2": "--c2",
    "activation_energy": "--energy",
}
"""The option that says each value of the method."""


dma.command()(show)
dma.command()(convert)


@dma.command()
def fit(
    file: InstrumentFile,
    out: Annotated[
        Path | None, typer.Option(help="Write the material: name.toml, for [materials] of a case.")
    ] = None,
    plot: Annotated[
        Path | None, typer.Option(help="Draw data and material: name.png, .svg or .pdf.")
    ] = None,
    name: Annotated[str, typer.Option(help="Name of the material in the case.")] = "rubber",
    model: Annotated[
        str, typer.Option(help="Model of the material: prony or fractional-zener.")
    ] = "prony",
    shift: Annotated[
        str, typer.Option(help="Shift law: wlf, arrhenius or none (one temperature).")
    ] = "wlf",
    c1: Annotated[
        float | None, typer.Option("--c1", help="Constant C1 of a known WLF law.")
    ] = None,
    c2: Annotated[
        str | None, typer.Option("--c2", help='Constant C2 of a known WLF law, such as "51.6 K".')
    ] = None,
    energy: Annotated[
        str | None,
        typer.Option(help='Activation energy of a known Arrhenius law, such as "60 kJ/mol".'),
    ] = None,
    reference: Annotated[
        str | None,
        typer.Option(
            help='Reference temperature, such as "23 degC"; by default, the middle isotherm.'
        ),
    ] = None,
    vertical: Annotated[
        str, typer.Option(help="Shift of moduli: none, entropic (as T in kelvin) or free.")
    ] = "none",
    terms: Annotated[
        int | None,
        typer.Option(
            help="Number of terms of the Prony series; by default, from cross-validation."
        ),
    ] = None,
    robust: Annotated[
        bool, typer.Option("--robust", help="Give rows that lie far off less weight.")
    ] = False,
    modulus: Annotated[
        str | None,
        typer.Option(help="Modulus that was measured, E or G, where the heads do not say it."),
    ] = None,
    poisson: Annotated[
        float, typer.Option(help="Poisson's ratio, which turns G into E and goes into the case.")
    ] = 0.5,
    temperature: Temperature = None,
    frequency: Frequency = None,
    sheet: Sheet = None,
    table: Annotated[
        list[int] | None,
        typer.Option(help="Number of a table to use, as `dma show` counts them; may be repeated."),
    ] = None,
    case: Annotated[
        Path | None,
        typer.Option(
            help="Case that names the material; a warning says if its nip lies outside the data."
        ),
    ] = None,
    json: Annotated[
        bool, typer.Option("--json", help="Print what was found as JSON, in place of the table.")
    ] = False,
    force: Force = False,
) -> None:
    """Shift isotherms to a master curve and fit a Prony series or a fractional Zener solid.

    Takes sweeps of frequency or temperature, relaxation moduli and creep compliances over time.

    Prints the material as a table for the case file, with its range and its deviation from the
    data in comments; warnings go to the standard error.
    """
    with clear_failures(), one_run(force=force) as run:
        from rollnip.dma import DmaMethod, fit_dict, material_toml

        _check_targets(out, plot)
        _choose("--modulus", modulus, ("E", "G", None))
        degrees = read_option("--reference", reference, "temperature")
        c2_read = read_option("--c2", c2, "temperature difference")
        law = _law(shift, c1, c2_read, energy, degrees)
        with named("--poisson"):
            require_finite("poisson", poisson)
        data = _data(
            file,
            modulus=modulus,
            poisson=poisson,
            temperature=read_option("--temperature", temperature, "temperature"),
            frequency=read_option("--frequency", frequency, "frequency"),
            sheet=sheet,
            tables=tuple(table or ()),
        )
        run.reserve({"--out": out, "--plot": plot})
        with named_by(_OPTIONS, str(file)):
            method = DmaMethod(
                model=model,  # type: ignore[arg-type]
                shift=law,
                reference=degrees,
                vertical=vertical,  # type: ignore[arg-type]
                terms=terms,
                robust=robust,
            )
            found = _fitted(data, method)
        text = material_toml(found, name)
        warnings = [*found.warnings, *([] if case is None else _in_the_nip(found, case, name))]
        _write(found, text, out, plot)
        if json:
            tree = fit_dict(found) | {"warnings": warnings}
            sys.stdout.write(json_text(tree) + "\n")
        elif out is None:
            sys.stdout.write(text)
        sys.stdout.flush()
        warn(warnings)


def _data(
    file: Path,
    *,
    modulus: Any,
    poisson: float,
    temperature: float | None,
    frequency: float | None,
    sheet: str | None,
    tables: tuple[int, ...],
) -> DmaData | TimeData:
    """The measurements of a file: dynamic ones where it holds any, else those over time."""
    from rollnip.dma import read_dma, read_tables, read_time_data

    reading = read_tables(file, temperature=temperature, frequency=frequency, sheet=sheet)
    used = [reading.tables[n - 1] for n in tables if n <= len(reading.tables)] or reading.tables
    kinds = {one.kind for one in used} - {None}
    if kinds and "dynamic" not in kinds:
        if frequency is not None:
            raise InvalidInputError(f"`--frequency` must not be given: {file} is over time.")
        return read_time_data(
            file,
            modulus=modulus,
            poisson=poisson,
            temperature=temperature,
            sheet=sheet,
            tables=tables,
        )
    return read_dma(
        file,
        modulus=modulus,
        poisson=poisson,
        temperature=temperature,
        frequency=frequency,
        sheet=sheet,
        tables=tables,
    )


def _fitted(data: DmaData | TimeData, method: DmaMethod) -> DmaFit | TimeFit:
    from rollnip.dma import TimeData, fit_dma, fit_time

    return fit_time(data, method) if isinstance(data, TimeData) else fit_dma(data, method)


def _choose(option: str, value: str | None, known: tuple[str | None, ...]) -> None:
    if value not in known:
        shown = ", ".join(one for one in known if one)
        raise InvalidInputError(f'`{option}` must be one of {shown}, got "{value}".')


def _law(
    shift: str, c1: float | None, c2: float | None, energy: str | None, reference: float | None
) -> Any:
    """The name of a law to fit, or the law that the options give."""
    from rollnip.materials import WLF, Arrhenius

    joules = read_option("--energy", energy, "molar energy")
    if (c1 is None) != (c2 is None):
        raise InvalidInputError("`--c1` and `--c2` must be given together.")
    if c1 is None and joules is None:
        return shift
    if reference is None:
        raise InvalidInputError("`--reference` must be given with a known law: it belongs to it.")
    if c1 is not None and joules is not None:
        raise InvalidInputError("`--energy` must not be given with `--c1`: they are two laws.")
    with named_by(_OPTIONS, "--reference"):
        if joules is not None:
            return Arrhenius(joules, reference)
        assert c1 is not None
        assert c2 is not None
        return WLF(c1, c2, reference)


def _check_targets(out: Path | None, plot: Path | None) -> None:
    from rollnip._files import check_target

    if out is not None:
        check_target(out, (".toml",))
    if plot is not None:
        check_target(plot, (".png", ".svg", ".pdf"))


def _write(found: DmaFit | TimeFit, text: str, out: Path | None, plot: Path | None) -> None:
    from rollnip._files import write_whole

    if out is not None:
        write_whole(out, lambda file: file.write_text(text, "utf-8"))
    if plot is not None:
        from rollnip.dma import TimeFit, plot_dma, plot_time
        from rollnip.plots import save_figure

        figure = plot_time(found) if isinstance(found, TimeFit) else plot_dma(found)
        save_figure(figure, plot)


def _in_the_nip(found: DmaFit | TimeFit, case: Path, name: str) -> list[str]:
    """Return the warnings of a case's nip, solved with the fitted material in its [materials]."""
    from rollnip.dma import frequency_warning, material_toml, temperature_warning
    from rollnip.io import parse_case
    from rollnip.io.document import parse_document, read_document
    from rollnip.solver import solve

    tree = read_document(case)
    fitted = parse_document(material_toml(found, name), "material")
    materials = tree.get("materials", {})
    if not isinstance(materials, dict) or name not in materials:
        raise InvalidInputError(
            f"{case}: must hold a material named `{name}` for it to be put in its place; "
            "see --name."
        )
    given = materials[name].get("temperature") if isinstance(materials[name], dict) else None
    table = fitted["materials"][name]
    if given is not None and "shift" in table:
        table["temperature"] = given
    problem = parse_case({**tree, "materials": {**materials, name: table}}, source=str(case))
    with named(str(case)):
        solution = solve(problem.nip, problem.model, on_failure="return")
        at = _temperature(table)
        said = [frequency_warning(found, solution, at)]
        if at is not None:
            said.append(temperature_warning(found, at))
    if not solution.converged:
        said.append(solution.status)
    return [one for one in said if one]


def _temperature(table: dict[str, Any]) -> float | None:
    """Temperature [degC] of a material's table; None where it has none."""
    from rollnip._units import parse_quantity

    given = table.get("temperature")
    return None if given is None else parse_quantity(given, "temperature")
