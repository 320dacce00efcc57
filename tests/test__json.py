"""Results as JSON: finite numbers, and one zero."""

import json
from math import copysign, inf

import numpy as np
import pytest

from rollnip._json import json_bytes, json_text

TREE = {"a": -0.0, "b": [-0.0, (1.5, -2.0)], "c": {"d": np.float64(-0.0)}, "e": "-0.0", "f": None}


@pytest.mark.parametrize(
    "write", [json_text, json_bytes, lambda tree: json_text(tree, indent=None)]
)
def test_a_zero_has_no_sign_and_nothing_else_changes(write):
    read = json.loads(write(TREE))
    assert read == {"a": 0.0, "b": [0.0, [1.5, -2.0]], "c": {"d": 0.0}, "e": "-0.0", "f": None}
    zeros = (read["a"], read["b"][0], read["c"]["d"])
    assert all(copysign(1.0, zero) == 1.0 for zero in zeros)
    assert isinstance(json.loads(write([True, 1]))[0], bool)


@pytest.mark.parametrize("write", [json_text, json_bytes])
def test_what_is_not_finite_is_an_error(write):
    with pytest.raises(ValueError, match="not JSON compliant"):
        write({"a": [inf]})


def test_layout():
    assert json_text({"a": [1]}) == '{\n  "a": [\n    1\n  ]\n}'
    assert json_text({"a": [1]}, indent=None) == '{"a": [1]}'
    assert json_bytes({"a": [1, 2]}) == b'{"a":[1,2]}'
