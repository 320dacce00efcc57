"""Predictions: one solve for each nip, whatever fails is no prediction, the door is a function."""

import sys

import numpy as np
import pytest

import rollnip as rn
import rollnip.identification.fit  # the submodule must not hide the function of the same name
from rollnip.identification import Approaches, Creepages, LeastSquares, NipWidths, Unknown
from rollnip.identification.forward import Forward, model_of

from .conftest import MODULUS, tree_of

LOADS = {"nip.load": [2.0, 4.0]}
WIDTHS = NipWidths(at=LOADS, measured=[1.0, 1.0])
APPROACHES = Approaches(at=LOADS, measured=[1.0, 1.0])


def test_sets_share_the_solves_of_the_same_nips():
    counted = []
    forward = Forward(tree_of(), (WIDTHS, APPROACHES), {}, counted.append)
    widths, approaches = forward.predict({MODULUS: 2.0})
    assert forward.solves == 2
    assert counted == [1, 2]
    assert np.all(np.diff(widths) > 0.0)
    assert np.all(np.diff(approaches) > 0.0)
    assert forward.is_verified


def test_what_has_no_solution_is_no_prediction():
    part = Creepages(at={"nip.traction": 1.0}, measured=0.1)
    forward = Forward(tree_of(), (part,), {})
    assert forward.predict({"nip.friction": 0.1}) is None
    assert "traction" in forward.refused
    assert forward.predict({"nip.friction": 0.6}) is not None


@pytest.mark.parametrize("error", [ZeroDivisionError("x"), np.linalg.LinAlgError("x")])
def test_a_solver_that_fails_is_no_prediction(monkeypatch, error):
    def failing(*_, **__):
        raise error

    monkeypatch.setattr(sys.modules[Forward.__module__], "solve", failing)
    forward = Forward(tree_of(), (WIDTHS,), {})
    assert forward.predict({MODULUS: 2.0}) is None
    assert "solver failed" in forward.refused


def test_a_result_that_is_not_defined_is_no_prediction():
    tree = tree_of()
    tree["nip"]["friction"] = 0.0
    forward = Forward(tree, (Creepages(at={}, measured=0.1),), {})
    assert forward.predict({MODULUS: 2.0}) is None
    assert "not defined" in forward.refused


@pytest.mark.slow
def test_nips_that_fall_back_to_another_geometry_are_told():
    tree = tree_of()
    tree["model"] = {"geometry": "second"}
    unknown = (Unknown(path=MODULUS, low=0.2, high=0.9, log=True),)
    cost = NipWidths(at={"nip.load": [1.0, 25.0]}, measured=[13.0, 37.8], standard_error=1.0)
    fit = rn.identify(tree, unknown, cost, LeastSquares(tried=0, profile=False))
    assert any("a simpler geometry was used" in said for said in fit.warnings)


def test_geometry_and_tolerance_are_those_of_the_case_or_of_the_method():
    assert model_of(tree_of(), None, None) == rn.Model(geometry="linear", tolerance=1e-2)
    assert model_of(tree_of(), "curved", 1e-3) == rn.Model(geometry="curved", tolerance=1e-3)


def test_identify_is_the_function():
    assert callable(rn.identify)
    assert rn.identify is rollnip.identification.identify
