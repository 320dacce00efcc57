"""Reservations as records: their sentences, places and kinds."""

import ast
from pathlib import Path
from string import Formatter

import pytest

import rollnip
import rollnip as rn
from rollnip.reservation import Reservation, consistent, instead_of, texts

PACKAGE = Path(rollnip.__file__).parent


def test_a_sentence_is_filled_with_its_figures_and_its_place():
    said = "{where} of {share:.0f} % on the {side} side."
    one = Reservation("kind", said, {"share": 12.4}, "lower", 2)
    where = "Material 2 (from the surface) of the lower roller"
    assert one.text == f"{where} of 12 % on the lower side."
    assert Reservation("kind", "{where}", side="upper").text == "The upper roller"
    assert texts((one, one)) == (one.text, one.text)


def test_no_advice_to_take_a_geometry_that_had_no_solution():
    """A reservation of "second" says "take finite", but not where "finite" gave way to it."""
    advised = Reservation("kind", "Terms are left out.", advice='Take geometry "finite".')
    assert advised.text == 'Terms are left out. Take geometry "finite".'
    assert consistent((advised,)) == (advised,)
    second = instead_of([("second", "it did not settle")], "curved")
    assert consistent((*second, advised)) == (*second, advised)
    finite = instead_of([("finite", "it did not settle")], "second")
    assert texts(consistent((*finite, advised)))[1] == "Terms are left out."


def test_figures_are_those_of_the_solution():
    layer = rn.Layer(2.0, rn.Elastic(modulus=1.0, poisson=0.45))
    nip = rn.Nip(
        upper=rn.Roller(radius=50.0, layers=(layer,)),
        lower=rn.Roller(radius=50.0),
        normal=rn.Approach(0.6),
        friction=0.0,
    )
    solution = rn.solve(nip, rn.Model(geometry="curved"))
    (one,) = (one for one in solution.reservations if one.kind == "pressed_in")
    assert one.figures["pressed"] == pytest.approx(30.0)
    assert one.excess == pytest.approx(0.3 / 0.16)
    assert one.text in solution.warnings


def _calls():
    for path in sorted(PACKAGE.rglob("*.py")):
        for node in ast.walk(ast.parse(path.read_text(encoding="utf-8"))):
            if isinstance(node, ast.Call) and getattr(node.func, "id", "") == "Reservation":
                yield pytest.param(node, id=f"{path.name}:{node.lineno}")


def _constants(nodes):
    return {one.value for one in nodes if isinstance(one, ast.Constant)}


@pytest.mark.parametrize("call", list(_calls()))
def test_every_name_in_a_sentence_is_one_of_its_figures(call):
    """A name that is missing would raise where the sentence is shown, not where it is made."""
    sentences = [one for one in call.args[1:2] if isinstance(one, ast.Constant)]
    given = {"where", "side"}
    for one in (*call.args, *(keyword.value for keyword in call.keywords)):
        given |= _constants(one.keys) if isinstance(one, ast.Dict) else set()
    for one in sentences:
        wanted = {name for _, name, _, _ in Formatter().parse(one.value) if name}
        assert wanted <= given


def test_no_kind_says_two_sentences():
    """What counts as the same for a warm nip is told by its kind; its sentence is the same, too."""
    said = {}
    for call in (one.values[0] for one in _calls()):
        kind, sentence = call.args[0], call.args[1]
        if isinstance(kind, ast.Constant) and isinstance(sentence, ast.Constant):
            assert said.setdefault(kind.value, sentence.value) == sentence.value
