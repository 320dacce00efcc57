"""The nips in code are those of the examples; what is assumed can be changed."""

from dataclasses import replace
from pathlib import Path

import pytest

import rollnip as rn
from rollnip._errors import InvalidInputError
from rollnip.paper import (
    FIGURE_4_THICKNESSES,
    configuration,
    figure_4,
    figure_5_elastic,
    figure_5_viscoelastic,
)

EXAMPLES = Path(__file__).parents[2] / "examples"
NIPS = {
    "figure-5-elastic-driven": figure_5_elastic(),
    "figure-5-viscoelastic-free": figure_5_viscoelastic(),
    **{
        f"figure-4-top-layer-{d:g}mm" if d else "figure-4-no-top-layer": figure_4(d)
        for d in FIGURE_4_THICKNESSES
    },
    **{
        f"configuration-{n}-{'driven' if driven else 'free'}": configuration(n, driven=driven)
        for n in (1, 2, 3)
        for driven in (False, True)
    },
}


@pytest.mark.parametrize("name", NIPS)
def test_the_examples_are_the_same_nips(name):
    case = rn.read_case(EXAMPLES / f"{name}.toml")
    assert replace(case.nip, title="") == replace(NIPS[name], title="")


def test_a_fourth_configuration_is_refused():
    with pytest.raises(InvalidInputError, match="`number`"):
        configuration(4, driven=True)
