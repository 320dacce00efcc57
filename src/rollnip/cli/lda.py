"""The commands ``lda``: simulate a measurement, estimate velocities, compare with a solution."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any, cast

import typer

from rollnip._errors import InvalidInputError
from rollnip._files import one_run
from rollnip.cli.console import clear_failures, named, named_by, overridden, say, write
from rollnip.cli.options import Force, Geometry

if TYPE_CHECKING:
    from rollnip._units import Dimension
    from rollnip.io.velocities import Settings
    from rollnip.lda import Comparison, Instrument, Scan, VelocityProfile
    from rollnip.rollers import Side
    from rollnip.solution import Solution

lda = typer.Typer(
    name="lda",
    help="Laser-Doppler anemometry: simulate, estimate, compare.",
    add_completion=False,
    rich_markup_mode=None,
    no_args_is_help=True,
)

_CASE = typer.Argument(help="Case file, TOML or JSON; - is the standard input.")
_FILE = typer.Argument(help="CSV: x [mm] and velocity [mm/s] or frequency [Hz], a row per burst.")
_WAVELENGTH = typer.Option(help='Wavelength of the light, such as "632.8 nm".')
_ANGLE = typer.Option(help='Full angle between the beams, such as "10 deg".')
_HALF_WIDTH = typer.Option(help='1/e2 half-width of the volume along x, such as "0.05 mm".')
_RATE = typer.Option(help='Sample rate of the detector, such as "250 kHz".')
_SHIFT = typer.Option(help='Frequency shift of one beam, such as "40 kHz".')
_ROLLER = typer.Option(help="Roller whose surface is measured: upper or lower.")
_CONFIDENCE = typer.Option(help='Confidence of bands and intervals, such as "95 %".')
_OPTIONS = {
    "positions": "--positions",
    "bursts": "--bursts",
    "snr": "--snr",
    "spread": "--spread",
    "wavelength": "--wavelength",
    "beam_angle": "--beam-angle",
    "half_width": "--half-width",
    "sample_rate": "--sample-rate",
    "shift": "--shift",
}
"""The option that says each value of instrument and scan."""


@lda.command()
def simulate(
    case: Annotated[str, _CASE],
    out: Annotated[
        Path, typer.Option(help="Table name.csv, or a folder for data, truth and picture.")
    ],
    positions: Annotated[int, typer.Option(help="Places along the nip.")] = 41,
    bursts: Annotated[int, typer.Option(help="Mean number of bursts at each place.")] = 50,
    snr: Annotated[
        float, typer.Option(help="Power of a burst at its peak over that of the noise.")
    ] = 30.0,
    spread: Annotated[
        str, typer.Option(help="Standard deviation of the rollers' speed in time, relative.")
    ] = "0.5 %",
    seed: Annotated[int, typer.Option(help="Seed of the random numbers.")] = 0,
    wavelength: Annotated[str, _WAVELENGTH] = "632.8 nm",
    beam_angle: Annotated[str, _ANGLE] = "10 deg",
    half_width: Annotated[str, _HALF_WIDTH] = "0.05 mm",
    sample_rate: Annotated[str, _RATE] = "250 kHz",
    shift: Annotated[str, _SHIFT] = "0 Hz",
    roller: Annotated[str, _ROLLER] = "upper",
    geometry: Geometry = None,
    json: Annotated[bool, typer.Option("--json", help="Print the bursts as JSON.")] = False,
    force: Force = False,
) -> None:
    """Simulate a measurement of a computed nip: bursts, noise, detection, frequencies.

    The exit code is 0 where the solution was verified, 1 where it did not converge, 2 for wrong
    input.
    """
    with clear_failures(), one_run(force=force) as run:
        from rollnip._units import parse_quantity
        from rollnip.lda import Instrument, Seeding, simulate_scan

        known = _settings(wavelength, beam_angle, half_width, sample_rate, shift, None, roller)
        with named("--spread"):
            fraction = parse_quantity(spread, "ratio")
        with named_by(_OPTIONS, case):
            instrument = _instrument(known, Instrument)
            seeding = Seeding(bursts=bursts, snr=snr, spread=fraction)
        if seed < 0:
            raise InvalidInputError(f"`--seed` must be zero or positive, got {seed}.")
        solution, source = _solved(case, geometry)
        _make_ready(out)
        run.reserve({f"--out ({one.name})": one for one in _scan_files(out)})
        with named_by(_OPTIONS, source):
            scan = simulate_scan(
                solution, instrument, seeding, side=_side(known), positions=positions, seed=seed
            )
        _write_scan(scan, solution, out)
        if json:
            write(_json(_scan_tree(scan, seed, _scan_files(out))))
    _leave(solution)


@lda.command()
def estimate(
    file: Annotated[Path, _FILE],
    speed: Annotated[
        str | None,
        typer.Option(help='Speed of the roller, such as "100 mm/s", from which strain follows.'),
    ] = None,
    out: Annotated[Path | None, typer.Option(help="Write the table: name.csv.")] = None,
    json: Annotated[bool, typer.Option("--json", help="Print JSON.")] = False,
    plot: Annotated[
        Path | None, typer.Option(help="Draw the result: name.png, .svg or .pdf.")
    ] = None,
    confidence: Annotated[str, _CONFIDENCE] = "95 %",
    wavelength: Annotated[str | None, _WAVELENGTH] = None,
    beam_angle: Annotated[str | None, _ANGLE] = None,
    shift: Annotated[str | None, _SHIFT] = None,
    sample_rate: Annotated[str | None, _RATE] = None,
    force: Force = False,
) -> None:
    """Estimate velocity and strain at each position, with confidence bands, as CSV."""
    with clear_failures(), one_run(force=force) as run:
        from rollnip.io.velocities import profile_csv, read_velocities

        known = _settings(wavelength, beam_angle, None, sample_rate, shift, speed, None)
        level = _confidence(confidence)
        _check_targets(out, plot)
        readings = read_velocities(file)
        run.reserve({"--out": out, "--plot": plot})
        profile = readings.profile(known.over(readings.settings), confidence=level)
        text = profile_csv(profile)
        if readings.simulated:
            text = "# simulated: no measurement\n" + text
        if out is not None:
            _write_text(out, text)
        if json:
            write(_json(_profile_tree(profile, simulated=readings.simulated)))
        elif out is None:
            write(text)
        if plot is not None:
            from rollnip.plots.lda import save_velocity

            save_velocity(profile, plot)


@lda.command()
def compare(
    case: Annotated[str, _CASE],
    file: Annotated[Path, _FILE],
    plot: Annotated[
        Path | None, typer.Option(help="Draw the result: name.png, .svg or .pdf.")
    ] = None,
    json: Annotated[bool, typer.Option("--json", help="Print JSON.")] = False,
    confidence: Annotated[str, _CONFIDENCE] = "95 %",
    roller: Annotated[str | None, _ROLLER] = None,
    wavelength: Annotated[str | None, _WAVELENGTH] = None,
    beam_angle: Annotated[str | None, _ANGLE] = None,
    half_width: Annotated[str | None, _HALF_WIDTH] = None,
    shift: Annotated[str | None, _SHIFT] = None,
    sample_rate: Annotated[str | None, _RATE] = None,
    geometry: Geometry = None,
    force: Force = False,
) -> None:
    """Align measured velocities with the computed ones in x and V, and compare them.

    The exit code is 0 where the solution was verified, 1 where it did not converge, 2 for wrong
    input.
    """
    with clear_failures(), one_run(force=force) as run:
        from rollnip.io.velocities import read_velocities
        from rollnip.lda import compare as align

        known = _settings(wavelength, beam_angle, half_width, sample_rate, shift, None, roller)
        level = _confidence(confidence)
        _check_targets(None, plot)
        readings = read_velocities(file)
        run.reserve({"--plot": plot})
        known = known.over(readings.settings)
        profile = readings.profile(known, confidence=level)
        solution, _ = _solved(case, geometry)
        given = {"half_width": half_width, "wavelength": wavelength, "beam_angle": beam_angle}
        options = {name: _OPTIONS[name] for name, text in given.items() if text is not None}
        with named_by(options, str(file)):
            result = align(
                profile,
                solution,
                side=_side(known),
                width=known.averaging_width,
                blur=known.largest_blur,
                confidence=level,
            )
        if plot is not None:
            from rollnip.plots.lda import save_comparison

            save_comparison(result, plot, simulated=readings.simulated)
        write(_text(result, simulated=readings.simulated, as_json=json))
    _leave(solution)


def _settings(
    wavelength: str | None,
    beam_angle: str | None,
    half_width: str | None,
    sample_rate: str | None,
    shift: str | None,
    speed: str | None,
    roller: str | None,
) -> Settings:
    """Return the instrument settings given by the options; a wrong value is named by its option."""
    from rollnip._units import parse_quantity
    from rollnip.io.velocities import Settings

    def read(option: str, text: str | None, kind: Dimension) -> float | None:
        if text is None:
            return None
        with named(option):
            value = parse_quantity(text, kind)
            if value <= 0.0 and option != "--shift":
                raise InvalidInputError(f"must be positive, got {text}.")
        return value

    if roller not in (None, "upper", "lower"):
        raise InvalidInputError(f'`--roller` must be "upper" or "lower", got "{roller}".')
    return Settings(
        wavelength=read("--wavelength", wavelength, "length"),
        beam_angle=read("--beam-angle", beam_angle, "angle"),
        half_width=read("--half-width", half_width, "length"),
        sample_rate=read("--sample-rate", sample_rate, "frequency"),
        shift=read("--shift", shift, "frequency"),
        roller_speed=read("--speed", speed, "speed"),
        roller=roller,
    )


def _instrument(known: Settings, make: type[Instrument]) -> Instrument:
    names = ("wavelength", "beam_angle", "half_width", "sample_rate", "shift")
    return make(**{name: getattr(known, name) for name in names})


def _side(known: Settings) -> Side:
    return cast("Side", known.roller or "upper")


def _confidence(text: str) -> float:
    from rollnip._units import parse_quantity

    with named("--confidence"):
        level = parse_quantity(text, "ratio")
    if not 0.5 <= level < 1.0:
        raise InvalidInputError(
            f"`--confidence` must be 50 % or more and less than 100 %, got {text}."
        )
    return level


def _solved(case: str, geometry: str | None) -> tuple[Solution, str]:
    from rollnip.io import read_case

    problem = read_case(case)
    model = overridden(problem.model, geometry, None)
    from rollnip.solver import solve

    with named(problem.source):
        return solve(problem.nip, model, on_failure="return"), problem.source


def _leave(solution: Solution) -> None:
    if not solution.converged:
        say(f"rollnip: {solution.status}\n")
        raise typer.Exit(1)


def _check_targets(out: Path | None, plot: Path | None) -> None:
    from rollnip._files import check_target

    if out is not None:
        check_target(out, (".csv",))
    if plot is not None:
        check_target(plot, (".png", ".svg", ".pdf"))


def _make_ready(out: Path) -> None:
    """Make ``out`` a folder unless it is a file name.csv; RollnipError where it can be neither."""
    from rollnip._files import check_target, make_folder

    if out.suffix.lower() == ".csv":
        check_target(out, (".csv",))
    else:
        make_folder(out)


def _scan_files(out: Path) -> list[Path]:
    """The files of a simulated scan: one table, or data, truth and picture in a folder."""
    if out.suffix.lower() == ".csv":
        return [out]
    return [out / name for name in ("bursts.csv", "truth.csv", "bursts.png")]


def _write_text(path: Path, text: str) -> None:
    from rollnip._files import write_whole

    write_whole(path, lambda file: file.write_text(text, "utf-8"))


def _write_scan(scan: Scan, solution: Solution, out: Path) -> None:
    from rollnip.io.velocities import scan_csv, truth_csv

    if out.suffix.lower() == ".csv":
        _write_text(out, scan_csv(scan))
        return
    from rollnip.plots.lda import save_record

    data, truth, picture = _scan_files(out)
    _write_text(data, scan_csv(scan))
    _write_text(truth, truth_csv(scan, solution))
    save_record(scan, picture)


def _scan_tree(scan: Scan, seed: int, files: list[Path]) -> dict[str, Any]:
    """One entry per burst in mm, Hz and mm/s, and the files that were written."""
    return {
        "simulated": True,
        "seed": seed,
        "roller": scan.side,
        "roller_speed": scan.roller_speed,
        "x": scan.x.tolist(),
        "frequency": scan.frequency.tolist(),
        "velocity": scan.velocity.tolist(),
        "snr": scan.snr.tolist(),
        "files": [str(one) for one in files],
    }


def _profile_tree(profile: VelocityProfile, *, simulated: bool) -> dict[str, Any]:
    """Columns of the table by name, in mm and mm/s; strain is None without the roller's speed."""
    strain = profile.strain
    return {
        "simulated": simulated,
        "confidence": profile.confidence,
        "speed": profile.speed,
        "x": profile.x.tolist(),
        "velocity": profile.velocity.tolist(),
        "error": profile.error.tolist(),
        "band": profile.band.tolist(),
        "strain": None if strain is None else strain.tolist(),
        "count": profile.count.tolist(),
        "rejected": profile.rejected.tolist(),
    }


def _json(tree: dict[str, Any]) -> str:
    from rollnip._json import json_text

    return json_text(tree) + "\n"


def _text(result: Comparison, *, simulated: bool, as_json: bool) -> str:
    tree: dict[str, Any] = {
        "simulated": simulated,
        "positions": result.x.size,
        "left_out": result.left_out,
        "confidence": result.confidence,
        **{
            name: {"value": fit.value, "low": fit.low, "high": fit.high}
            for name, fit in (("shift", result.shift), ("speed", result.speed))
        },
        "rms_strain": result.rms,
        "noise_strain": result.noise,
        "chi_square": result.chi_square,
        "degrees_of_freedom": result.degrees,
        "probability": result.probability,
    }
    if as_json:
        return _json(tree)
    level = f"{100.0 * result.confidence:g} %"
    blurred = f"; {result.left_out} more left out: too steep for the volume"
    lines = [
        f"{result.x.size} positions{', SIMULATED' if simulated else ''}"
        f"{blurred if result.left_out else ''}",
        f"shift        {result.shift.value:10.4f} mm    {level} from {result.shift.low:.4f} "
        f"to {result.shift.high:.4f}",
        f"V            {result.speed.value:10.4f} mm/s  {level} from {result.speed.low:.4f} "
        f"to {result.speed.high:.4f}",
        f"rms strain   {result.rms:10.2e}       standard errors alone {result.noise:.2e}",
        f"chi-square   {result.chi_square:10.4g}       {result.degrees} degrees of freedom, "
        f"probability {result.probability:.3g}",
    ]
    return "\n".join(lines) + "\n"
