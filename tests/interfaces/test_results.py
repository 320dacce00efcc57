"""Results stay as they were computed, whatever is done with what they hand out."""

import pickle
import re
from dataclasses import is_dataclass
from pathlib import Path

import numpy as np
import pytest

import rollnip as rn
from rollnip.identification import NipWidths, Unknown

EXAMPLES = Path(__file__).parents[2] / "examples"
MODEL = rn.Model(geometry="linear")


def example(name):
    return rn.read_case(EXAMPLES / f"{name}.toml")


def fitted():
    tree = {
        "nip": {"load": 2.0, "friction": 0.0},
        "model": {"geometry": "linear"},
        "upper": {"radius": 60.0, "layers": [{"thickness": 8.0, "material": "cover"}]},
        "lower": {"radius": 50.0},
        "materials": {"cover": {"model": "elastic", "modulus": 3.0, "poisson": 0.48}},
    }
    widths = NipWidths(at={"nip.load": [1.0, 2.0]}, measured=[6.8, 9.1], standard_error=0.15)
    return rn.identify(tree, [Unknown(path="materials.cover.modulus", low=2.0, high=4.0)], widths)


RESULTS = {
    "smooth": lambda: rn.solve(example("figure-4-no-top-layer").nip, MODEL),
    "sheet": lambda: rn.solve(example("sheet-feed-nip").nip, MODEL),
    "rough": lambda: rn.solve(example("rough-roller").nip, MODEL),
    "face": lambda: rn.solve_face(example("press-face").nip, example("press-face").face, MODEL),
    "web": lambda: rn.solve_face(example("web-face").nip, example("web-face").face, MODEL),
    "heat": lambda: rn.solve_heat(example("heat-wheel").nip, example("heat-wheel").heat, MODEL),
    "patch": lambda: rn.solve_patch(rn.read_patch_case(EXAMPLES / "patch/durometer.toml").patch),
    "fit": fitted,
}
INSIDE = ("profiles", "deformed_surfaces", "interfaces", "sheet", "upper", "lower", "sets")
"""Results that a result holds."""


def arrays_of(result, name):
    """Every array that a result keeps and hands out, those of results inside it too."""
    for key in dir(result):
        part = None if key.startswith("_") else getattr(result, key, None)
        if isinstance(part, np.ndarray):
            if np.shares_memory(part, getattr(result, key)):
                yield f"{name}.{key}", part
        elif key in INSIDE:
            for one in part if isinstance(part, tuple) else (part,):
                yield from arrays_of(one, f"{name}.{key}") if is_dataclass(one) else ()


@pytest.mark.parametrize("kind", RESULTS)
def test_a_result_cannot_be_written_and_equals_itself_alone(kind):
    result = RESULTS[kind]()
    arrays = dict(arrays_of(result, kind))
    assert arrays
    assert [name for name, array in arrays.items() if array.flags.writeable] == []
    assert result in {result}
    assert re.fullmatch(rf"<{type(result).__name__} .+>", repr(result))
    assert len(repr(result)) < 250
    assert result != pickle.loads(pickle.dumps(result))
