"""What newcomers try in Python gets a sentence that says what to write."""

import pytest

import rollnip as rn

RUBBER = rn.Elastic(modulus=1.0, poisson=0.5)


@pytest.mark.parametrize(
    ("attempt", "said"),
    [
        (lambda: rn.Roller(diameter=100), "give `radius`, half of the diameter"),
        (lambda: rn.Roller(radius=50, layer=[]), "give `layers`, a list"),
        (lambda: rn.Roller(raduis=50), "did you mean `radius`?"),
        (lambda: rn.Layer(2.0, shore_a=60), "rn.Elastic.from_shore_a(60)"),
        (lambda: rn.Elastic(shore_a=60), "rn.Elastic.from_shore_a(60)"),
        (lambda: rn.Elastic(shear_modulus=0.3), "rn.Elastic.from_shear_modulus"),
        (lambda: rn.Prony(modulus=1, tau=0.1, poisson=0.5), "give `relaxation_time`"),
        (lambda: rn.Nip(load=1.0), "give `normal=rn.LineLoad(1.78)`"),
        (lambda: rn.Nip(geometry="linear"), "belongs to the model"),
        (lambda: rn.Model(speed=100), "belongs to the nip"),
        (lambda: rn.Model(tol=1e-3), "did you mean `tolerance`?"),
    ],
)
def test_a_wrong_keyword_is_told_the_right_one(attempt, said):
    with pytest.raises(rn.InvalidInputError) as caught:
        attempt()
    assert said in str(caught.value)


@pytest.mark.parametrize(
    ("attempt", "said"),
    [
        (lambda: rn.Layer("2 mm", RUBBER), "`thickness` must be positive and finite, got the text"),
        (lambda: rn.Layer("2 mm", RUBBER), "in Python give a number in mm: 2.0"),
        (lambda: rn.Roller(radius="2 in"), "a number in mm: 50.8"),
        (lambda: rn.LineLoad("1.78 kN/m"), "a number in N/mm: 1.78"),
        (lambda: rn.Elastic(modulus="130 psi", poisson=0.5), "a number in MPa: 0.896"),
        (lambda: rn.Creepage("2 %"), "a plain number: 0.02"),
        (lambda: rn.Layer("thick", RUBBER), "got the text 'thick'; give a number."),
    ],
)
def test_a_text_with_a_unit_is_told_the_number(attempt, said):
    with pytest.raises(rn.InvalidInputError) as caught:
        attempt()
    assert said in str(caught.value)


@pytest.mark.parametrize(
    ("attempt", "said"),
    [
        (lambda: rn.Elastic(0.91), "Elastic(modulus=..., poisson=...), got 1 without a name."),
        (lambda: rn.Roller(50, [rn.Layer(2.0, RUBBER)]), "as in Roller(radius=...), got 2"),
        (lambda: rn.Nip(RUBBER), "as in Nip(upper=..., lower=..., normal=...)"),
        (lambda: rn.Model("curved"), "as in Model(geometry=...)"),
        (lambda: rn.Sheet(0.1), "as in Sheet(thickness=..., modulus=...)"),
        (lambda: rn.Face(1600), "as in Face(length=...)"),
        (lambda: rn.Shaft(1800), "as in Shaft(bearing_distance=...)"),
        (lambda: rn.Thermal(0.2), "as in Thermal(conductivity=..., density=..., heat_capacity"),
        (lambda: rn.Profile([0, 1], [0, 0]), "as in Profile(x=..., height=...), got 2"),
    ],
)
def test_a_value_without_its_name_is_told_to_have_one(attempt, said):
    with pytest.raises(rn.InvalidInputError) as caught:
        attempt()
    assert said in str(caught.value)


def test_every_hint_is_python_that_works():
    assert rn.Elastic.from_shore_a(60).modulus > 0.0
    assert rn.Elastic.from_shear_modulus(0.3, 0.5).modulus == pytest.approx(0.9)
    for part in (rn.LineLoad(1.78), rn.Approach(0.3), rn.Traction(0.5), rn.Creepage(0.01)):
        assert part
