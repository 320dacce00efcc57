"""The registry of figures: complete, described once, and read by everyone who shows a figure."""

import json
import re
from dataclasses import replace
from importlib.resources import files
from pathlib import Path
from typing import get_args

import pytest

import rollnip as rn
from rollnip.face.figures import (
    FACE_FIGURES,
    FACE_PROFILES,
    SHEET_FACE_FIGURES,
    SHEET_FACE_PROFILES,
)
from rollnip.figure import LOST, ROUNDING, Dimension
from rollnip.figures import CLAIMED, FIELDS, FIGURES, INTERFACE_FIGURES, PROFILES, PULL
from rollnip.heat.figures import BALANCE_FIGURES, COURSES, ROLLER_FIGURES
from rollnip.io import result_dict
from rollnip.patch.figures import PATCH_FIELDS, PATCH_FIGURES, PATCH_PLACES
from rollnip.sheet_figures import SHEET_FIGURES, SHEET_PROFILES
from rollnip.solution import Profiles, Solution
from rollnip.sweeps import SCALARS

REGISTRIES = {
    "interfaces": {**INTERFACE_FIGURES, "pull": PULL},
    "sheet": {**SHEET_FIGURES, **SHEET_PROFILES},
    "face": {**FACE_FIGURES, **SHEET_FACE_FIGURES},
    "face, curves": {**FACE_PROFILES, **SHEET_FACE_PROFILES},
    "heat, rollers": ROLLER_FIGURES,
    "heat": BALANCE_FIGURES,
    "heat, courses": COURSES,
    "patch": PATCH_FIGURES,
    "patch, fields": PATCH_FIELDS,
    "patch, places": PATCH_PLACES,
    "inside": FIELDS,
}
SOURCE = Path(str(files("rollnip")))
READERS = (
    "io/netcdf.py",
    "io/result.py",
    "cli/summary.py",
    "plots/overview.py",
    "sweeps/row.py",
    "cli/paper.py",
    "face/report.py",
    "heat/report.py",
    "patch/report.py",
    "web/static/js/quantities.js",
    "web/static/js/answers.js",
    "web/static/js/faceview.js",
    "web/static/js/heatview.js",
    "web/static/js/patchplots.js",
    "web/static/js/units.js",
)
PICTURES = (
    "face",
    "field",
    "heat",
    "overview",
    "paper",
    "patch",
    "pressure",
    "section",
    "sheet",
    "surfaces",
)


@pytest.mark.parametrize("one", FIGURES.values(), ids=FIGURES)
def test_a_figure_says_everything_in_plain_sentences(one):
    assert isinstance(getattr(Solution, one.name, None), property) or one.name in (
        "max_surface_strain",  # a field of the solution
    )
    assert one.symbol
    assert one.label == one.label.strip()
    for sentence in filter(None, (one.sentence, one.sign)):
        assert re.fullmatch(r"[A-Z][^.]*\.", sentence), sentence
    assert set(one.size) <= set(FIGURES)


@pytest.mark.parametrize("name", REGISTRIES)
def test_every_registry_is_of_figures_with_a_sentence_and_a_name_of_their_own(name):
    registry = REGISTRIES[name]
    for key, one in registry.items():
        assert one.key == key
        assert one.label == one.label.strip()
        for sentence in filter(None, (one.sentence, one.sign)):
            assert re.fullmatch(r"[A-Z0-9].*\.", sentence), sentence
        assert one.described["units"] == one.unit
    assert len({one.label for one in registry.values()}) == len(registry)


def test_labels_and_symbols_tell_figures_apart():
    assert len({one.label for one in FIGURES.values()}) == len(FIGURES)
    assert len({one.symbol for one in FIGURES.values()}) == len(FIGURES)


def test_the_result_holds_every_figure_and_every_claim(solution):
    tree = result_dict(solution)
    for key, one in FIGURES.items():
        table, _, last = key.rpartition(".")
        assert (tree[table] if table else tree)[last] == one.value(solution)
    assert list(tree["error"]) == list(CLAIMED)
    assert list(tree["profiles"]) == list(PROFILES) == list(Profiles.__dataclass_fields__)


def test_tables_of_sweeps_hold_every_figure_with_its_unit():
    assert {name: SCALARS[name] for name in FIGURES} == {
        name: one.unit for name, one in FIGURES.items()
    }
    assert {name: SCALARS[name] for name in SHEET_FIGURES} == {
        name: one.unit for name, one in SHEET_FIGURES.items()
    }
    claimed = {name for name, one in SHEET_FIGURES.items() if one.claimed}
    assert {name for name in SCALARS if name.startswith("error.")} == {
        f"error.{name}" for name in {*CLAIMED} | claimed
    }


@pytest.mark.parametrize(
    "reader", ["cli/paper.py", "face/report.py", "heat/report.py", "patch/report.py"]
)
def test_no_reader_has_units_of_its_own(reader):
    """Of figures; bearing forces and fixed errors are no figures of a registry."""
    text = (SOURCE / reader).read_text(encoding="utf-8")
    assert not re.findall(r'"(?:mm|N/mm|MPa|degC|mW/mm|W/m|%)"', text)


@pytest.mark.parametrize("name", PICTURES)
def test_pictures_and_files_read_units_from_the_registry(name):
    """No text of a picture ends in a unit; docstrings name units without quotation marks."""
    text = (SOURCE / "plots" / f"{name}.py").read_text(encoding="utf-8")
    assert not re.findall(r"""\[(?:mm|µm|MPa|N/mm|%|mm/s|mm/m|degC|°C|mW/mm³)\]["']""", text)
    assert not re.findall(r"[0-9}] (?:degC|MPa)[\"',]", text.replace("_plain", ""))


def test_files_of_fields_read_the_registry():
    for name in ("fields", "patch_files"):
        text = (SOURCE / "io" / f"{name}.py").read_text(encoding="utf-8")
        assert '"MPa"' not in text
        assert '"mm"' not in text


@pytest.mark.parametrize("reader", READERS)
def test_no_label_and_no_sentence_stands_twice(reader):
    text = (SOURCE / reader).read_text(encoding="utf-8").casefold()
    # Some labels are keys of the result or dimensions as well.
    others = {*FIGURES, *PROFILES, *get_args(Dimension)}
    for one in (*FIGURES.values(), *PROFILES.values()):
        assert one.label in others or f'"{one.label}"'.casefold() not in text
        assert one.sentence.casefold() not in text


def test_the_page_gets_the_registry_as_a_module():
    library = pytest.importorskip("rollnip.web.library")
    lines = dict(
        re.findall(r"^export const (\w+) = (.*);$", library.figures_module(), re.MULTILINE)
    )
    shown = json.loads(lines["FIGURES"])
    assert {one["key"] for one in shown} == {
        one.name for key, one in FIGURES.items() if key != "peak_pressure_x"
    }
    assert all(
        one["label"].casefold() == one["label"][0].lower() + one["label"][1:] for one in shown
    )
    assert json.loads(lines["ROUNDING"]) == ROUNDING
    assert json.loads(lines["LOST"]) == LOST
    assert {one["key"] for one in shown if not one["has_sign"]} >= {
        *("dissipation_friction", "dissipation_viscous", "rolling_resistance"),
    }
    assert {one["key"] for one in shown if one["has_sign"]} >= {"creepage", "torque_upper"}
    assert json.loads(lines["RESULT_UNITS"])["share"]["metric"] == ["%", 0.01]


def test_noise_is_zero_and_a_small_figure_is_not(solution):
    loss = FIGURES["dissipation.friction"]
    assert loss.cleaned(replace(solution, dissipation_friction=5e-15)) == 0.0
    # A slow cover: 1e-8 of load times speed is meant.
    slow = replace(solution, dissipation_friction=1e-8 * 1.78 * 100.0)
    assert loss.cleaned(slow) == pytest.approx(1.78e-6)
    place = FIGURES["peak_pressure_x"]
    assert place.cleaned(replace(solution, peak_pressure_x=-1e-12)) == 0.0
    assert place.cleaned(replace(solution, peak_pressure_x=1e-6)) == 1e-6


def rolling_freely(**changes):
    rubber = rn.Elastic(modulus=0.91, poisson=0.5)
    roller = rn.Roller(radius=50, layers=[rn.Layer(2.0, rubber)])
    nip = rn.Nip(
        upper=roller, lower=rn.Roller(radius=25), normal=rn.LineLoad(1.78), friction=0.5, speed=100
    )
    return rn.solve(replace(nip, **changes))


def test_what_is_exactly_zero_in_free_rolling_is_shown_as_zero():
    # Elastic and incompressible, no traction: torques, traction and losses are 0 by symmetry.
    solution = rolling_freely()
    noisy = ("traction", "torque_upper", "torque_lower", "peak_pressure_x", "dissipation.friction")
    assert any(FIGURES[key].value(solution) != 0.0 for key in noisy)
    assert [FIGURES[key].cleaned(solution) for key in noisy] == [0.0] * len(noisy)


def test_the_smallest_losses_that_are_meant_are_shown():
    """They are far below load times speed and their claimed errors, and right to 0.1 %."""
    slow = rn.StandardLinearSolid(modulus=2, stiffening=0.2, relaxation_time=0.003, poisson=0.45)
    roller = rn.Roller(radius=50, layers=[rn.Layer(2.0, slow)])
    solution = rolling_freely(upper=roller, speed=1e-3)
    for key in ("dissipation.viscous", "rolling_resistance"):
        value = FIGURES[key].value(solution)
        assert value is not None
        assert FIGURES[key].cleaned(solution) == value != 0.0


def test_what_is_far_less_than_its_own_error_is_shown_as_zero(solution):
    """The page and the summary have one rule: less than a twentieth of the error is nothing."""
    creepage = FIGURES["creepage"]
    for share, shown in ((0.04, 0.0), (-0.04, 0.0), (0.06, 0.06), (-0.06, -0.06)):
        changed = replace(solution, creepage=share * 1e-3, error={"creepage": 1e-3})
        assert creepage.cleaned(changed) == pytest.approx(shown * 1e-3)
        assert creepage.value(changed) == share * 1e-3  # files keep it


def test_long_times_are_shown_in_minutes():
    time = COURSES["time"]
    assert time.text(90.0) == "90.0 s"
    assert time.text(600.0) == "10.0 min"
    assert time.shown_for(3600.0) == ("min", pytest.approx(1.0 / 60.0), 0.0)
    assert time.axis == "time [s]"


def test_a_text_may_have_other_digits_than_the_figure():
    assert FIGURES["load"].text(2.0) == "2.000 N/mm"
    assert FIGURES["load"].text(2.0, 2) == "2.0 N/mm"
